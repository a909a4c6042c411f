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
   throw InputError(where + ": the value at (" + std::to_string(x(0)) + ", " +
                    std::to_string(x(1)) + ") is " + std::to_string(value) +
                    ", must be finite");
}

} // namespace cattaneo
