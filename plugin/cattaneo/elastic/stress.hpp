#pragma once

#include <cattaneo/material.hpp>

namespace cattaneo
{

/// Stress at a point of a plane body, (x = r, y = z) of an axisymmetric one, or in space,
/// tension positive, force per area.
struct Stress
{
   double xx = 0; ///< σxx, about an axis σrr
   double yy = 0; ///< σyy, about an axis σzz
   double zz = 0; ///< ν(σxx + σyy) in plane strain, 0 in plane stress; axisymmetric: σθθ
   double xy = 0; ///< shear stress
   double yz = 0; ///< shear stress, 0 but in space
   double xz = 0; ///< shear stress, 0 but in space

   /// Equivalent stress of von Mises, of the full three-dimensional state.
   double von_mises() const;
};

/// Strains at a point: along x, y and out of the plane (r, z and θ in axisymmetry), and the
/// shear angle γ_xy = 2 ε_xy; in space γ_yz and γ_xz as well.
struct Strain
{
   double xx = 0; ///< ε_xx, about an axis ε_rr
   double yy = 0; ///< ε_yy, about an axis ε_zz
   double zz = 0; ///< out of the plane, about an axis ε_θθ
   double xy = 0; ///< γ_xy
   double yz = 0; ///< γ_yz, 0 but in space
   double xz = 0; ///< γ_xz, 0 but in space

   /// Adds another one, times a factor.
   void add(double factor, const Strain &other)
   {
      xx += factor * other.xx;
      yy += factor * other.yy;
      zz += factor * other.zz;
      xy += factor * other.xy;
      yz += factor * other.yz;
      xz += factor * other.xz;
   }
};

/// Stress of an isotropic material under an elastic strain. In plane stress zz is not used.
Stress stress(const Material &material, const Strain &strain);

/// Circumferential shear stresses of a body that twists.
struct TorsionStress
{
   double r_theta = 0; ///< τ_rθ, force per area
   double theta_z = 0; ///< τ_θz, force per area
};

} // namespace cattaneo
