#pragma once

#include <cattaneo/elastic/field.hpp>
#include <cattaneo/material.hpp>

namespace cattaneo
{

/// Isotropic elasticity whose constants vary over a body.
struct VaryingMaterial
{
   Field young, poisson;
   PlaneState state = PlaneState::strain;

   /// At the point that is set in the transformation; InputError that names it if the material
   /// is not sound there.
   Material at(mfem::ElementTransformation &place) const;
};

} // namespace cattaneo
