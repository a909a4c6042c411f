#include <cattaneo/friction/friction_disc.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace
{

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A⁻¹ b by cofactors: a mirrored A and b give the mirrored answer to the last bit.
Vector2d solve(const Matrix2d &A, const Vector2d &b)
{
   const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
   return {(A(1, 1) * b[0] - A(0, 1) * b[1]) / det, (A(0, 0) * b[1] - A(1, 0) * b[0]) / det};
}

double dot(const Vector2d &a, const Vector2d &b)
{
   return a[0] * b[0] + a[1] * b[1];
}

/// The slip equation over t = s/(s + k) in 0…1, k of the size of A: finite at both ends and
/// linear where A is a multiple of I.
struct SlipEquation
{
   const DiscNode &node;
   double k = 0.5 * node.A.trace();

   /// x = -(1-t) y with ((1-t) A + t k I) y = q0.
   Vector2d y(double t) const
   {
      return solve((1 - t) * node.A + t * k * Matrix2d::Identity(), node.q0);
   }
   /// |q| - f p.
   double operator()(double t) const
   {
      const Vector2d at = y(t);
      const double p = node.p0 - (1 - t) * dot(node.b, at);
      return k * t * std::hypot(at[0], at[1]) - node.friction * p;
   }
};

/// Sign change in low…high, where g(low) <= 0 < g(high) (Illinois variant of false position).
double root(const SlipEquation &g, double low, double high)
{
   double g_low = g(low), g_high = g(high);
   const double scale = std::max(std::abs(g_low), std::abs(g_high));
   for (int k = 0, last = 0; k < 100 && high - low > eps * high; ++k)
   {
      const double t =
         k < 50 ? (low * g_high - high * g_low) / (g_high - g_low) : 0.5 * (low + high);
      const double value = g(t);
      if (value > 0)
      {
         high = t;
         g_high = value;
         if (last == 1) { g_low *= 0.5; }
         last = 1;
      }
      else
      {
         low = t;
         g_low = value;
         if (last == -1) { g_high *= 0.5; }
         last = -1;
      }
      if (std::abs(value) <= eps * scale) { return t; }
   }
   return low;
}

} // namespace

DiscMove solve_node(const DiscNode &node)
{
   DiscMove move;
   const Vector2d free = solve(node.A, node.q0), lift = solve(node.A, node.b);
   const double frictionless = node.p0 - dot(node.b, free);
   if (frictionless < 0)
   {
      move.found = true;
      move.state = NodeState::separation;
      move.gap = -frictionless / (node.c - dot(node.b, lift));
      move.slip = -free - move.gap * lift;
      return move;
   }
   const double q0 = std::hypot(node.q0[0], node.q0[1]);
   if (node.p0 >= 0 && q0 <= node.friction * node.p0)
   {
      move.found = true;
      return move;
   }
   const SlipEquation equation{node};
   const double t = root(equation, 0, 1);
   move.state = NodeState::slip;
   move.slip = -(1 - t) * equation.y(t);
   move.found = node.p0 + dot(node.b, move.slip) >= 0;
   return move;
}

double critical_friction(const Matrix2d &A, const Vector2d &b)
{
   const double mean = 0.5 * A.trace();
   const double spread = std::hypot(0.5 * (A(0, 0) - A(1, 1)), A(0, 1));
   return (mean - spread) / std::hypot(b[0], b[1]);
}

DiscSlip::DiscSlip(const Vector2d &trial, double bound)
{
   const double length = std::hypot(trial[0], trial[1]);
   n = trial / length;
   share = std::min(bound / length, 1.0);
}

} // namespace cattaneo
