#pragma once

#include <cattaneo/fretting/edge_fit.hpp>

namespace cattaneo::fretting
{

/** The corner of a complete contact: a pad and a cracked body of the same material meet,
   bonded, at a point. Angles that each fills there, radians: a square punch on a half-plane has
   π/2 and π. */
struct Corner
{
   double pad_angle = 0.0;
   double body_angle = 0.0;
};

/** One of Williams' eigensolutions of the bonded corner, which is a notch that the material
    fills over pad_angle + body_angle. On the interface, at distance r from the corner,

        p = K pressure r^{λ-1},   q = K shear r^{λ-1},

    p > 0 in compression, q the traction on the body, > 0 into the contact. K is normalised as
    usual by the stress r^{λ-1} on the bisector of the material: K_I > 0 is compression across
    it, K_II > 0 shear σ_rθ with θ from the body to the pad. */
struct CornerMode
{
   double eigenvalue = 0.0; ///< λ; the stress is singular if λ < 1
   double pressure = 0.0;
   double shear = 0.0;
   /// Shear on the *pad* into the contact over the pressure. Square punch on a half-plane:
   /// 0.543075578837 in mode I, -0.218923236249 in mode II. Without a sign of its own in the
   /// limit of no pressure (equal angles, mode II), where it is infinite.
   double traction_ratio() const { return -shear / pressure; }
};

struct CornerModes
{
   CornerMode one; ///< sin λα + λ sin α = 0, α the sum of the angles
   CornerMode two; ///< sin λα - λ sin α = 0, λ ≠ 1
};

/** Roots by bracketing, to round-off: 0.544483736782 and 0.908529189846 for the square punch on
    a half-plane. Mode II is singular for sums above 257.45° only.
    InputError unless both angles are positive and π < sum <= 2π: a smaller one has no
    singularity. */
CornerModes corner_modes(const Corner &corner);

struct CornerFit
{
   FittedIntensity k_one; ///< units: stress · length^{1-λ_I}
   FittedIntensity k_two; ///< units: stress · length^{1-λ_II}
   CornerModes modes;
   /// Friction below which the corner slips however small the load, |q/p| of the dominant term.
   double least_friction = 0.0;
};

/** K_I and K_II from fully stuck tractions near a corner, by least squares of p and q together,
    both weighted with r^{1-λ_I}, with a term of the next order, r^{λ_I}, for each. The window
   is chosen as that of fit_edge(): the one of least reported error, which is the larger of the
    standard error and the change when those two terms are left out. Nodes without pressure
    count here: a bonded corner may pull.

    @param tractions edge is the position of the corner, shear is that on the body
    InputError as fit_edge() and corner_modes(); also if mode II is not singular, as regular
    terms then hide it. */
CornerFit fit_corner(const Corner &corner, const EdgeTractions &tractions,
                     const FitSettings &settings = {});

} // namespace cattaneo::fretting
