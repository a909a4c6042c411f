#include <cattaneo/elastic/field.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

double Field::at(mfem::ElementTransformation &place, const std::string &where) const
{
   const double value = f_(place);
   if (std::isfinite(value)) { return value; }
   mfem::Vector x(2);
   place.Transform(place.GetIntPoint(), x);
   require(false, where, ": the value at ", Eigen::Vector2d(x(0), x(1)), " is ", value,
           ", must be finite");
   return value;
}

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
      require(false, error.what(), ", found at ", Eigen::Vector2d(x(0), x(1)));
   }
   return material;
}

} // namespace cattaneo
