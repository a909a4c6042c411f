#pragma once

#include <cmath>

namespace cattaneo::test
{

/** Tanh-sinh quadrature of @a function(x) on (a, b); algebraic singularities at the ends are
    welcome. Near an end, x - a is exact only if a = 0. */
template <class Function>
double integrate(const Function &function, double a, double b)
{
   const double half_pi = std::acos(0.0), step = 1.0 / 64;
   double sum = 0;
   for (int k = -300; k <= 300; k++)
   {
      const double u = step * k, g = half_pi * std::sinh(u);
      // Distance of the node from the left end, over b - a.
      const double left =
         g < 0 ? std::exp(2 * g) / (1 + std::exp(2 * g)) : 1 / (1 + std::exp(-2 * g));
      const double weight = half_pi * std::cosh(u) / std::pow(std::cosh(g), 2);
      const double x = a + (b - a) * left;
      if (weight < 1e-60 || left >= 1 || x <= a || x >= b) { continue; }
      sum += weight * function(x);
   }
   return 0.5 * (b - a) * step * sum;
}

/// On (a, ∞), a > 0.
template <class Function>
double integrate_to_infinity(const Function &function, double a)
{
   return integrate([&](double r) { return function(1 / r) / (r * r); }, 0, 1 / a);
}

} // namespace cattaneo::test
