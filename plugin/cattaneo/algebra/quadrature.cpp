#include <array>
#include <cattaneo/algebra/quadrature.hpp>
#include <cmath>
#include <mutex>

namespace cattaneo
{

namespace
{

/// P_n and its first two derivatives, |x| < 1.
struct Legendre
{
   double value = 1, slope = 0, bend = 0;

   Legendre(int n, double x)
   {
      double before = 0;
      for (int k = 1; k <= n; ++k)
      {
         const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
         before = value;
         value = next;
      }
      slope = n * (before - x * value) / (1 - x * x);
      bend = (2 * x * slope - n * (n + 1.0) * value) / (1 - x * x);
   }
};

/// From a start close to the root, by Newton's method.
template <class Step>
double root(double x, Step step)
{
   for (int k = 0; k < 8; ++k) { x -= step(x); }
   return x;
}

QuadratureRule make_gauss_rule(int points)
{
   QuadratureRule rule{Eigen::VectorXd(points), Eigen::VectorXd(points)};
   for (int k = 0; k < points; ++k)
   {
      const double x = root(-std::cos(M_PI * (k + 0.75) / (points + 0.5)),
                            [&](double at)
                            {
                               const Legendre P(points, at);
                               return P.value / P.slope;
                            });
      const Legendre P(points, x);
      rule.points[k] = 0.5 * (1 + x);
      rule.weights[k] = 1 / ((1 - x * x) * P.slope * P.slope);
   }
   return rule;
}

} // namespace

const QuadratureRule &gauss_rule(int points)
{
   // Each rule is made when first needed, because all of them together take as long as a small
   // study.
   static std::array<QuadratureRule, 64> rules;
   static std::array<std::once_flag, 64> made;
   QuadratureRule &rule = rules.at(points - 1);
   std::call_once(made[points - 1], [&] { rule = make_gauss_rule(points); });
   return rule;
}

const QuadratureRule &logarithmic_rule()
{
   static const QuadratureRule rule = []
   {
      QuadratureRule made = gauss_rule(64);
      made.weights.array() *= 6 * made.points.array().pow(5);
      made.points = made.points.array().pow(6);
      return made;
   }();
   return rule;
}

Eigen::VectorXd lobatto_points(int order)
{
   Eigen::VectorXd points(order + 1);
   points[0] = 0;
   points[order] = 1;
   for (int k = 1; k < order; ++k)
   {
      points[k] = 0.5 * (1 + root(-std::cos(M_PI * k / order),
                                  [&](double at)
                                  {
                                     const Legendre P(order, at);
                                     return P.slope / P.bend;
                                  }));
   }
   return points;
}

} // namespace cattaneo
