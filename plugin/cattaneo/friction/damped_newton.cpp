// Two tangents: damped Newton on the natural map, from the start and from random places.

#include <cattaneo/friction/methods.hpp>
#include <cmath>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool ends_from_natural_states(Increment &at)
{
   for (Index i = 0; i < at.system.n; ++i)
   {
      const ContactNode node = at.node(i);
      at.status[i] = natural_state(node);
      if (at.status[i] == NodeState::slip)
      {
         at.direction[i] = DiscSlip(node.trial(), node.bound.at(node.p));
      }
   }
   return polished(at) && !may_slide(at);
}

namespace
{

/// The natural map of all nodes: zero in a solution, else forces.
VectorXd natural_map(const Increment &at)
{
   const FrictionSystem &s = at.system;
   VectorXd R(at.F.size());
   for (Index i = 0; i < s.n; ++i)
   {
      const NodeResidual r = residual(at.node(i));
      R[s.m(i)] = r.normal;
      for (Index k = 0; k < s.c; ++k) { R[s.t(i, k)] = r.tangential[k]; }
   }
   return R;
}

/// Its derivative by the displacements.
MatrixXd natural_map_derivative(const Increment &at)
{
   const FrictionSystem &s = at.system;
   MatrixXd J = MatrixXd::Zero(at.F.size(), at.F.size());
   for (Index i = 0; i < s.n; ++i)
   {
      const ContactNode node = at.node(i);
      const Index m = s.m(i);
      if (node.kn * node.gap > node.p) { J.row(m) = s.K.row(m); }
      else { J(m, m) = node.kn; }
      const FrictionDerivative d = friction_derivative(node);
      for (Index k = 0; k < s.c; ++k)
      {
         auto row = J.row(s.t(i, k));
         for (Index l = 0; l < s.c; ++l)
         {
            const double share = (k == l) - d.P(k, l);
            if (share != 0) { row += share * s.K.row(s.t(i, l)); }
         }
         if (d.slope != 0) { row -= d.slope * d.n[k] * s.K.row(m); }
         for (Index l = 0; l < s.c; ++l) { row[s.t(i, l)] += d.P(k, l) * node.kt; }
      }
   }
   return J;
}

/// Newton's method on the natural map from the present displacements, damped so that the
/// residual falls in every step. False if it does not vanish in the given number of steps.
bool descend(Increment &at, long most)
{
   FrictionSystem &s = at.system;
   at.F = at.f + s.product->times(at.u);
   VectorXd R = natural_map(at);
   for (long k = 0; k < std::min<long>(most, 2 * s.settings.max_newton); ++k)
   {
      // Close enough for the active set to continue from here.
      if (R.norm() <= 1e-9 * at.reference + at.round_off().maxCoeff()) { return true; }
      ++s.counters.newton_steps;
      ++s.counters.dense_factorisations;
      DenseLU factor;
      if (!factor.compute(natural_map_derivative(at))) { return false; }
      const VectorXd from = at.u;
      const double size = R.norm();
      VectorXd &step = R;
      factor.solve(step);
      VectorXd next;
      double share = 2;
      do {
         share *= 0.5;
         if (share < 1e-6) { return false; }
         at.u = from - share * step;
         at.F = at.f + s.product->times(at.u);
         next = natural_map(at);
      } while (!(next.norm() < (1 - 1e-4 * share) * size));
      R = next;
   }
   return false;
}

} // namespace

/// Starts from the displacements at the start of the increment and from random ones at growing
/// distances. The unit of distance is the displacement that the loads cause at a node alone.
/// The number of starts is limited by the number of operations (half a second). The generator
/// is seeded afresh, so that equal increments start alike.
Search damped_newton(Increment &at)
{
   FrictionSystem &s = at.system;
   // A body that drifts away is unlikely to have an equilibrium elsewhere, so the search for
   // one is shorter.
   const double operations = moves_away(at) ? 2e8 : 1e9,
                step = disc_step_operations(static_cast<double>(s.K.rows()));
   const VectorXd u_old = at.start.displacements();
   const VectorXd far = at.reference * s.K.diagonal().cwiseInverse();
   const Index starts = std::clamp<Index>(4000000 / (s.n * s.n * s.n), 2, 1000);
   const long first_step = s.counters.newton_steps;
   std::mt19937_64 random(1);
   for (Index start = 0; start < starts; ++start)
   {
      // 1. The start itself is worth ten times as many. With 700 nodes that is not one step.
      const double left = (start == 0 ? 10 : 1) * operations -
                          step * static_cast<double>(s.counters.newton_steps - first_step);
      if (left < step) { break; }
      // 2. Displacements.
      at.u = u_old;
      const double size = std::pow(10, -2 + 4.0 * start / starts);
      for (Index k = 0; k < at.u.size() && start > 0; ++k)
      {
         at.u[k] += size * far[k] * (std::ldexp(double(random() >> 11), -52) - 1);
      }
      // 3. A solution.
      if (!descend(at, static_cast<long>(left / step))) { continue; }
      if (ends_from_natural_states(at)) { return Search::found; }
   }
   return Search::not_here;
}

} // namespace cattaneo
