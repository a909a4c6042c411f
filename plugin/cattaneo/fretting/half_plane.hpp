#pragma once

#include <Eigen/Core>

namespace cattaneo::fretting
{

/// In-plane stress components, tension positive.
struct InPlaneStress
{
   double xx = 0.0; ///< σ_xx, along the surface
   double yy = 0.0; ///< σ_yy, across it
   double xy = 0.0; ///< τ_xy
};

/** Complex extension of a surface traction: a function analytic in the body Im z > 0 whose real
    part on the surface is the traction, {its value, its derivative}. */
using Traction = Eigen::Vector2cd;

/** Stress in the half-plane y >= 0 under a pressure p (> 0 presses) and a shear traction q (> 0
    pulls the body in +x), at depth y.

    The potentials [Muskhelishvili 1953] are Φ_N = -P/2 and Φ_T = iT/2 with P, T the complex
    extensions of p and q at x + iy; then σ_xx + σ_yy = 4 Re Φ and σ_yy - iσ_xy is 2 Re Φ_N +
    2iy conj(Φ_N') for the pressure, 2i Im Φ_T + 2iy conj(Φ_T') for the shear. (2.13) and (2.14)
    are special cases. */
InPlaneStress half_plane_stress(const Traction &pressure, const Traction &shear, double y);

/** σ_zz = c (σ_xx + σ_yy): the constraint c is Poisson's ratio in plane strain and 0 in plane
    stress. These criteria need no other data of the third direction. InputError unless -1 <
    poisson < 0.5. */
double out_of_plane_constraint(double poisson, bool plane_stress);

/// Von Mises' equivalent stress, the root of (2.17), which is 3 J₂: yield at √3 k (2.18).
double von_mises(const InPlaneStress &stress, double constraint);

} // namespace cattaneo::fretting
