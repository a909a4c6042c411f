#pragma once

#include <cattaneo/material.hpp>

namespace cattaneo
{

/// Stress at a point of a plane body, or (x = r, y = z) of an axisymmetric one, tension
/// positive, force per area.
struct Stress
{
   double xx = 0, yy = 0;
   double zz = 0; ///< ν(σxx + σyy) in plane strain, 0 in plane stress; axisymmetric: σθθ
   double xy = 0; ///< shear stress

   /// Equivalent stress of von Mises, of the full three-dimensional state.
   double von_mises() const;
};

/// Strains at a point: along x, y and out of the plane (r, z and θ in axisymmetry), and the
/// shear angle γ_xy = 2 ε_xy.
struct Strain
{
   double xx = 0, yy = 0, zz = 0, xy = 0;
};

/// Stress of an isotropic material that is kept from straining freely; zz is not asked for in
/// plane stress.
Stress stress(const Material &material, const Strain &strain);

/// Stress of an isotropic material for the strains ε_xx, ε_yy and the shear angle γ_xy = 2
/// ε_xy.
Stress stress(const Material &material, double strain_xx, double strain_yy, double shear_angle);

/// The same of a body of revolution: strains ε_rr, ε_zz, ε_θθ and the shear angle γ_rz.
Stress stress(const Material &material, double strain_rr, double strain_zz, double strain_hoop,
              double shear_angle);

/// Circumferential shear stresses of a body that twists.
struct TorsionStress
{
   double r_theta = 0, theta_z = 0;
};

/// τ_rθ = G r ∂ψ/∂r and τ_θz = G r ∂ψ/∂z of the twist ψ = u_θ/r.
TorsionStress torsion_stress(const Material &material, double r, double dtwist_dr,
                             double dtwist_dz);

} // namespace cattaneo
