#pragma once

namespace cattaneo
{

/// The third direction: it cannot strain, or it carries no stress.
enum class PlaneState
{
   strain,
   stress
};

/// Isotropic linear elasticity in the plane.
struct Material
{
   double young = 1.0;   ///< Young's modulus, > 0
   double poisson = 0.3; ///< Poisson's ratio, -1 < ν < 0.5 in plane strain, < 1 in plane stress
   PlaneState state = PlaneState::strain; ///< not used about an axis of revolution

   /// First Lamé coefficient of the plane problem (plane stress: 2λμ/(λ+2μ)).
   double lambda() const;
   /// Shear modulus.
   double mu() const;
   /// E/(1-ν²) in plane strain, E in plane stress.
   double plane_modulus() const;
   /// InputError if outside the ranges above.
   void validate() const;
};

} // namespace cattaneo
