#pragma once

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

/** Root of a continuous function between @a a and @a b, where its signs differ (the Illinois
    variant of false position: never leaves the bracket, converges superlinearly). If the signs
    are equal, round-off may have moved a root beyond an end. That end is returned if the
    function there is below 1e-6 of its value at the other end, or if the ends are as close
    together. InputError otherwise. NaN if the function is NaN at an end. */
template <class Function>
double find_root(const Function &function, double a, double b)
{
   double fa = function(a), fb = function(b);
   if (std::isnan(fa) || std::isnan(fb)) { return std::nan(""); }
   if (fa != 0 && fb != 0 && (fa > 0) == (fb > 0))
   {
      const double small = std::min(std::abs(fa), std::abs(fb)),
                   large = std::max(std::abs(fa), std::abs(fb));
      require(small <= 1e-6 * large || std::abs(b - a) <= 1e-6 * std::abs(b),
              "find_root: between ", a, " and ", b, " the function goes from ", fa, " to ", fb,
              ", its sign must change");
      return std::abs(fa) <= std::abs(fb) ? a : b;
   }
   for (int iteration = 0; iteration < 200 && fa != 0 && fb != 0; iteration++)
   {
      const double c = b - fb * (b - a) / (fb - fa);
      if (!(std::abs(b - a) > 4e-16 * std::abs(b)) || c == b) { break; }
      const double fc = function(c);
      if ((fc > 0) == (fb > 0))
      {
         fa *= 0.5; // the other end is stale
      }
      else
      {
         a = b;
         fa = fb;
      }
      b = c;
      fb = fc;
   }
   return fa == 0 ? a : b;
}

} // namespace cattaneo
