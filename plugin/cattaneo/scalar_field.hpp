#pragma once

#include <functional>
#include <type_traits>
#include <utility>

namespace cattaneo
{

/// A value that may vary over the plane; a plain number converts to a constant.
class ScalarField
{
public:
   /// The same everywhere.
   ScalarField(double constant) : f_([constant](double, double) { return constant; }) {}
   /// A function of the place.
   ScalarField(std::function<double(double x, double y)> f) : f_(std::move(f)) {}
   /// Anything that is called with (x, y).
   template <class F,
             class = std::enable_if_t<std::is_invocable_r_v<double, F, double, double>>>
   ScalarField(F f) : f_(std::move(f))
   {
   }
   /// Its value at a place.
   double operator()(double x, double y) const { return f_(x, y); }

private:
   std::function<double(double, double)> f_;
};

} // namespace cattaneo
