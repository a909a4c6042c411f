#pragma once

#include <cattaneo/elastic/material.hpp>

namespace cattaneo
{

/// Stress at a point of a plane body, tension positive, force per area.
struct Stress
{
   double xx = 0, yy = 0;
   double zz = 0; ///< ν(σxx + σyy) in plane strain, 0 in plane stress
   double xy = 0; ///< shear stress

   /// Equivalent stress of von Mises, of the full three-dimensional state.
   double von_mises() const;
};

/// Stress of an isotropic material for the strains ε_xx, ε_yy and the shear angle γ_xy = 2
/// ε_xy.
Stress stress(const Material &material, double strain_xx, double strain_yy, double shear_angle);

} // namespace cattaneo
