#include <cattaneo/elastic/varying_material.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

Material VaryingMaterial::at(mfem::ElementTransformation &place) const
{
   const Material material{young.at(place, "Young's modulus"),
                           poisson.at(place, "Poisson's ratio"), state};
   try
   {
      material.validate();
   }
   catch (const InputError &error)
   {
      mfem::Vector x(2);
      place.Transform(place.GetIntPoint(), x);
      require(false, error.what(), ", found at (", x(0), ", ", x(1), ")");
   }
   return material;
}

} // namespace cattaneo
