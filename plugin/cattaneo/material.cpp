#include <cattaneo/input_error.hpp>
#include <cattaneo/material.hpp>

namespace cattaneo
{

double Material::lambda() const
{
   // (1 - 2ν) in plane strain becomes (1 - ν) in plane stress: λ' = 2λμ/(λ + 2μ).
   const double reduced = state == PlaneState::strain ? 1 - 2 * poisson : 1 - poisson;
   return young * poisson / ((1 + poisson) * reduced);
}

double Material::mu() const
{
   return young / (2 * (1 + poisson));
}

double Material::plane_modulus() const
{
   return state == PlaneState::strain ? young / (1 - poisson * poisson) : young;
}

void Material::validate() const
{
   const bool strain = state == PlaneState::strain;
   const double limit = strain ? 0.5 : 1.0;
   require(poisson > -1 && poisson < limit, "material: Poisson's ratio is ", poisson,
           ", must be above -1 and below ", limit,
           strain ? " in plane strain and in space" : " in plane stress");
   require_positive("material: Young's modulus", young);
}

} // namespace cattaneo
