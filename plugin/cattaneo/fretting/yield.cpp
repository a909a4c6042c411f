#include <algorithm>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

double square(double x)
{
   return x * x;
}

} // namespace

double surface_von_mises(double f, double constraint, double t)
{
   require_positive("the friction coefficient", f);
   const double m = square(1 - 2 * constraint);
   if (t < 0)
   {
      // The only nonzero stress in the plane is 2f(√(1-t) - √-t). Plane strain adds its share
      // out of the plane.
      return std::sqrt(4 * (1 - constraint + square(constraint))) * f /
             (std::sqrt(1 - t) + std::sqrt(-t));
   }
   if (t <= 1)
   {
      return std::sqrt(3 * square(f) + m * square(f * std::sqrt(1 - t) - std::sqrt(t)));
   }
   return std::sqrt(m * t + 3 * square(f / (std::sqrt(t) + std::sqrt(t - 1))));
}

double first_yield_load(double f, double constraint)
{
   require_positive("the friction coefficient", f);
   const double m = square(1 - 2 * constraint);
   return std::sqrt(3 / (3 * f * f + m * std::max(1.0, f * f)));
}

double full_yield_load(double f)
{
   require_positive("the friction coefficient", f);
   return 1 / f;
}

} // namespace cattaneo::fretting
