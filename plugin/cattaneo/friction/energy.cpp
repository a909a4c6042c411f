#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

double work(const LoadPattern &pattern, const ContactState &state)
{
   return pattern.q.dot(state.v) + pattern.p.dot(state.w);
}

namespace
{

/// One node over an increment, to find when within the increment it begins to slip.
struct NodeWay
{
   NodeWay(const ReducedProblem &problem, const ContactState &before, const ContactState &after,
           Index node);

   NodeVector q0, q1, slip, own; ///< the node's own tangential stiffness
   double p0, p1;
   FrictionBound bound;
   double sense; ///< sign of the slip in the plane
   /// The change of the force as if the node stuck to the end, which is linear.
   NodeVector turning;
   /// (|force|² less the square of the bound) over the share s of the increment: c + b s + a
   /// s².
   double a, b, c;
   double start = 0; ///< the share where it begins to be positive
   double steepness() const { return 2 * a * start + b; }
};

NodeWay::NodeWay(const ReducedProblem &problem, const ContactState &before,
                 const ContactState &after, Index node)
   : q0(problem.components()), q1(q0), slip(q0), own(q0), p0(std::max(before.p[node], 0.0)),
     p1(std::max(after.p[node], 0.0)), bound(friction_bound(problem, node)), sense(0)
{
   for (Index k = 0; k < q0.size(); ++k)
   {
      const Index row = k * problem.nodes() + node;
      q0[k] = before.q[row];
      q1[k] = after.q[row];
      slip[k] = after.v[row] - before.v[row];
      own[k] = problem.A()(row, row);
   }
   turning = q1 - own.cwiseProduct(slip) - q0;
   if (slip.size() == 1) { sense = slip[0] < 0 ? -1 : 1; }
   const double g0 = bound.at(p0, sense), dg = bound.at(p1, sense) - g0, size = magnitude(q0);
   a = turning.squaredNorm() - dg * dg;
   b = 2 * q0.dot(turning) - 2 * g0 * dg;
   c = std::min((size - g0) * (size + g0), 0.0); // friction is not exhausted yet, or only just
   const double root = std::sqrt(std::max(b * b - 4 * a * c, 0.0));
   if (b > 0) { start = -2 * c / (b + root); }
   else if (a > 0) { start = (root - b) / (2 * a); }
   start = std::min(start, 1.0);
}

} // namespace

Rubbing rubbing(const ReducedProblem &problem, const ContactState &before,
                const ContactState &after)
{
   const Index nodes = problem.components() > 0 ? problem.nodes() : 0;
   Rubbing result{VectorXd::Zero(nodes), before.p.cwiseMax(0.0), after.p.cwiseMax(0.0)};
   for (Index i = 0; i < nodes; ++i)
   {
      const NodeWay passed(problem, before, after, i);
      result.way[i] = magnitude(passed.slip);
      if (result.way[i] > 0) { result.p_from[i] += passed.start * (passed.p1 - passed.p0); }
   }
   return result;
}

VectorXd frictional_loss(const ReducedProblem &problem, const ContactState &before,
                         const ContactState &after)
{
   const Rubbing rub = rubbing(problem, before, after);
   VectorXd lost = rub.way;
   for (Index i = 0; i < lost.size(); ++i)
   {
      const double sense = problem.components() == 2 || after.v[i] >= before.v[i] ? 1.0 : -1.0;
      const FrictionBound bound = friction_bound(problem, i);
      lost[i] *= 0.5 * (bound.at(rub.p_from[i], sense) + bound.at(rub.p_to[i], sense));
   }
   return lost;
}

double friction_work(const ContactState &before, const ContactState &after)
{
   return -0.5 * (before.q + after.q).dot(after.v - before.v);
}

RubbingDerivative rubbing_derivative(const ReducedProblem &problem, const ContactState &before,
                                     const ContactState &after, Index node, double by_way,
                                     double by_from, double by_to)
{
   const NodeWay passed(problem, before, after, node);
   const double way = magnitude(passed.slip), s = passed.start, f = passed.bound.slope(),
                dp = passed.p1 - passed.p0;
   const NodeVector none = NodeVector::Zero(passed.slip.size());
   RubbingDerivative by{none, none, none, none};
   if (way == 0) { return by; }
   by.slip = by_way / way * passed.slip;
   by.p0 = by_from * (1 - s);
   by.p1 = by_from * s + by_to;
   if (s > 0 && s < 1 && passed.steepness() > 0)
   {
      // p_from = p0 + s dp, and ds = -(dc + s db + s² da)/steepness.
      const double by_root = -by_from * dp / passed.steepness();
      const NodeVector by_force = 2 * by_root * (passed.q0 + s * passed.turning);
      by.q1 = s * by_force;
      by.q0 = (1 - s) * by_force;
      by.slip -= s * passed.own.cwiseProduct(by_force);
      by.stiffness = -s * passed.slip.cwiseProduct(by_force);
      const double p = passed.p0 + s * dp,
                   by_bound = -2 * by_root * f * p; // derivative by f p at that pressure
      by.friction = by_bound * p;
      by.p0 += by_bound * f * (1 - s);
      by.p1 += by_bound * f * s;
   }
   // There is no force in tension.
   if (before.p[node] <= 0) { by.p0 = 0; }
   if (after.p[node] <= 0) { by.p1 = 0; }
   return by;
}

RubbingDerivative loss_derivative(const ReducedProblem &problem, const ContactState &before,
                                  const ContactState &after, const Rubbing &rub, Index node)
{
   // The loss is ½ f way (p_from + p_to).
   const double half = 0.5 * problem.friction[node], way = rub.way[node],
                sum = rub.p_from[node] + rub.p_to[node];
   RubbingDerivative by =
      rubbing_derivative(problem, before, after, node, half * sum, half * way, half * way);
   by.friction += 0.5 * way * sum;
   return by;
}

double elastic_energy(const ReducedProblem &problem, const ContactState &state)
{
   const VectorXd u = state.displacements();
   double energy = 0.5 * u.dot(problem.K * u);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const Control control = problem.patterns[k].control;
      // Load patterns of forces store energy in the clamped bodies, besides that of u.
      // Prescribed displacements also do work with u.
      if (control == Control::displacement)
      {
         energy += state.multipliers[k] * work(problem.patterns[k], state);
      }
      for (std::size_t l = 0; l < problem.patterns.size(); ++l)
      {
         if (problem.patterns[l].control != control || !problem.knows_loads()) { continue; }
         energy += 0.5 * state.multipliers[k] * problem.H(k, l) * state.multipliers[l];
      }
   }
   return energy;
}

} // namespace cattaneo
