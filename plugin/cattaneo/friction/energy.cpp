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

VectorXd frictional_loss(const ReducedProblem &problem, const ContactState &before,
                         const ContactState &after)
{
   const Index n = problem.nodes(), c = problem.components();
   VectorXd lost = VectorXd::Zero(c > 0 ? n : 0);
   for (Index i = 0; i < lost.size(); ++i)
   {
      const FrictionBound bound(problem.friction[i]);
      const double g1 = bound.at(after.p[i]);
      double g0 = bound.at(before.p[i]), length = 0, along = 0;
      for (Index k = i; k < c * n; k += n)
      {
         const double step = after.v[k] - before.v[k];
         length = k == i ? std::abs(step) : std::hypot(length, step);
         along += before.q[k] * after.q[k];
      }
      if (length == 0) { continue; }
      if (slips(before.status[i]) && slips(after.status[i]) && along < 0)
      {
         // |q0 + s (trial - q0)|² = (g0 + s (g1 - g0))², g the bounds: the root in 0…1 beyond
         // s = 0, where friction was exhausted the other way.
         double a = -(g1 - g0) * (g1 - g0), b = -2 * g0 * (g1 - g0);
         for (Index k = i; k < c * n; k += n)
         {
            const double trial = after.q[k] - problem.A()(k, k) * (after.v[k] - before.v[k]);
            const double way = trial - before.q[k];
            a += way * way;
            b += 2 * before.q[k] * way;
         }
         const double turn = a > 0 ? std::clamp(-b / a, 0.0, 1.0) : 0.0;
         g0 += turn * (g1 - g0);
      }
      lost[i] = 0.5 * (g0 + g1) * length;
   }
   return lost;
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
