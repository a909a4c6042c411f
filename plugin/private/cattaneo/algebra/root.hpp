#pragma once

#include <cmath>

namespace cattaneo
{

/** Root of a continuous function between @a a and @a b, where its signs differ (the Illinois
    variant of false position: never leaves the bracket, converges superlinearly). Where they do
    not, round-off has moved a root beyond an end: it is the one at which the function is nearer
    to zero. NaN if the function is so at an end. */
template <class Function>
double find_root(const Function &function, double a, double b)
{
   double fa = function(a), fb = function(b);
   if (std::isnan(fa) || std::isnan(fb)) { return std::nan(""); }
   if (fa != 0 && fb != 0 && (fa > 0) == (fb > 0))
   {
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
