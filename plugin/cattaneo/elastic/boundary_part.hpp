#pragma once

#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace cattaneo
{

/// A value that may vary over the plane; a plain number converts to a constant.
class ScalarField
{
public:
   ScalarField(double constant) : f_([constant](double, double) { return constant; }) {}
   ScalarField(std::function<double(double x, double y)> f) : f_(std::move(f)) {}
   template <class F,
             class = std::enable_if_t<std::is_invocable_r_v<double, F, double, double>>>
   ScalarField(F f) : f_(std::move(f))
   {
   }
   double operator()(double x, double y) const { return f_(x, y); }

private:
   std::function<double(double, double)> f_;
};

/// Part of a body's boundary: all boundary elements of the given attributes, or only the piece
/// of them where lo <= coordinate <= hi. The ends of the interval need not be nodes of the
/// mesh.
struct BoundaryPart
{
   std::vector<int> attributes;
   int axis = 0; ///< coordinate of the interval: 0 = x, 1 = y
   double lo = -std::numeric_limits<double>::infinity();
   double hi = std::numeric_limits<double>::infinity();

   BoundaryPart(int attribute) : attributes{attribute} {}
   BoundaryPart(std::vector<int> some) : attributes(std::move(some)) {}
   BoundaryPart(std::vector<int> some, int axis_, double lo_, double hi_)
      : attributes(std::move(some)), axis(axis_), lo(lo_), hi(hi_)
   {
   }
};

} // namespace cattaneo
