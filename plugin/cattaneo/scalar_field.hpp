#pragma once

#include <functional>
#include <type_traits>
#include <utility>

namespace cattaneo
{

/// A value that may vary over the plane, or in space; a plain number converts to a constant.
class ScalarField
{
public:
   /// The same everywhere.
   ScalarField(double constant) : f_([constant](double, double, double) { return constant; }) {}
   /// Anything that is called with (x, y), or with (x, y, z).
   template <class F,
             class = std::enable_if_t<std::is_invocable_r_v<double, F, double, double> ||
                                      std::is_invocable_r_v<double, F, double, double, double>>>
   ScalarField(F f)
   {
      if constexpr (std::is_invocable_r_v<double, F, double, double, double>)
      {
         f_ = std::move(f);
      }
      else
      {
         f_ = [of_plane = std::move(f)](double x, double y, double) mutable -> double
         { return of_plane(x, y); };
      }
   }
   /// Its value at a place.
   double operator()(double x, double y, double z = 0) const { return f_(x, y, z); }

private:
   std::function<double(double, double, double)> f_;
};

} // namespace cattaneo
