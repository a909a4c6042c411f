#include <cattaneo/condense/trace.hpp>
#include <cattaneo/elastic/field.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

/// The place of the point that is set, for messages.
std::string place_of(mfem::ElementTransformation &at)
{
   mfem::Vector x(at.GetSpaceDim());
   at.Transform(at.GetIntPoint(), x);
   const bool space = x.Size() == 3;
   return place_text({x(0), x(1), space ? x(2) : 0.0},
                     space ? Formulation::space : Formulation::plane);
}

} // namespace

double Field::at(mfem::ElementTransformation &place, const std::string &where) const
{
   const double value = f_(place);
   if (std::isfinite(value)) { return value; }
   require(false, where, ": the value at ", place_of(place), " is ", value, ", must be finite");
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
      require(false, error.what(), ", found at ", place_of(place));
   }
   return material;
}

} // namespace cattaneo
