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

Rubbing rubbing(const ReducedProblem &problem, const ContactState &before,
                const ContactState &after)
{
   const Index n = problem.nodes(), c = problem.components();
   Rubbing result{VectorXd::Zero(c > 0 ? n : 0), before.p.cwiseMax(0.0), after.p.cwiseMax(0.0)};
   for (Index i = 0; i < result.way.size(); ++i)
   {
      double &way = result.way[i], along = 0;
      for (Index k = i; k < c * n; k += n)
      {
         const double step = after.v[k] - before.v[k];
         way = k == i ? std::abs(step) : std::hypot(way, step);
         along += before.q[k] * after.q[k];
      }
      if (way == 0) { continue; }
      if (slips(before.status[i]) && slips(after.status[i]) && along < 0)
      {
         // |q0 + s (trial - q0)|² = (g0 + s (g1 - g0))², g the bounds: the root in 0…1 beyond
         // s = 0, where friction was exhausted the other way.
         const FrictionBound bound(problem.friction[i]);
         const double g0 = bound.at(before.p[i]), g1 = bound.at(after.p[i]);
         double a = -(g1 - g0) * (g1 - g0), b = -2 * g0 * (g1 - g0);
         for (Index k = i; k < c * n; k += n)
         {
            const double trial = after.q[k] - problem.A()(k, k) * (after.v[k] - before.v[k]);
            const double turning = trial - before.q[k];
            a += turning * turning;
            b += 2 * before.q[k] * turning;
         }
         const double turn = a > 0 ? std::clamp(-b / a, 0.0, 1.0) : 0.0;
         result.p_from[i] += turn * (result.p_to[i] - result.p_from[i]);
      }
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
      const FrictionBound bound(problem.friction[i]);
      lost[i] *= 0.5 * (bound.at(rub.p_from[i]) + bound.at(rub.p_to[i]));
   }
   return lost;
}

RubbingDerivative rubbing_derivative(const ReducedProblem &problem, const ContactState &before,
                                     const ContactState &after, Index node, double by_way,
                                     double by_from, double by_to)
{
   const Index n = problem.nodes(), c = problem.components();
   const double f = problem.friction[node], p0 = std::max(before.p[node], 0.0),
                p1 = std::max(after.p[node], 0.0), dp = p1 - p0;
   const NodeVector none = NodeVector::Zero(c);
   RubbingDerivative by{none, none, none, none};
   NodeVector q0(c), q1(c), slip(c), own(c);
   for (Index k = 0; k < c; ++k)
   {
      const Index row = k * n + node;
      q0[k] = before.q[row];
      q1[k] = after.q[row];
      slip[k] = after.v[row] - before.v[row];
      own[k] = problem.A()(row, row);
   }
   const double way = magnitude(slip);
   if (way == 0) { return by; }
   // p_from = p0 + turn dp, with the share `turn` = -b/a of rubbing().
   double turn = 0;
   const NodeVector turning = q1 - own.cwiseProduct(slip) - q0;
   const double a = turning.squaredNorm() - f * f * dp * dp,
                b = 2 * q0.dot(turning) - 2 * f * f * p0 * dp;
   if (slips(before.status[node]) && slips(after.status[node]) && q0.dot(q1) < 0 && a > 0)
   {
      turn = std::clamp(-b / a, 0.0, 1.0);
   }
   by.slip = by_way / way * slip;
   by.p0 = by_from * (1 - turn);
   by.p1 = by_from * turn + by_to;
   if (turn > 0 && turn < 1)
   {
      // d turn = -(db + turn da)/a
      const double by_both = -by_from * dp / a;
      const NodeVector by_turning = 2 * by_both * (q0 + turn * turning);
      by.q1 = by_turning;
      by.q0 = 2 * by_both * turning - by_turning;
      by.slip -= own.cwiseProduct(by_turning);
      by.stiffness = -slip.cwiseProduct(by_turning);
      by.friction -= 2 * by_both * f * dp * (2 * p0 + turn * dp);
      by.p0 += 2 * by_both * f * f * (p0 - (1 - turn) * dp);
      by.p1 -= 2 * by_both * f * f * (p0 + turn * dp);
   }
   // Nothing is borne in tension.
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
      // Forces store energy in the clamped bodies, apart from that of u; prescribed
      // displacements also work with u.
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
