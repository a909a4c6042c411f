// Gauss–Seidel: one node after the other (thesis 3.5, appendix D).

#include <cattaneo/friction/friction_implementation.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

void FrictionSolver::Implementation::set_node(Index i, double x, double y, NodeState state)
{
   const double dy = y - gap(i);
   if (dy != 0)
   {
      F.noalias() += dy * K.col(m(i));
      u[m(i)] = y - problem.gap[i];
   }
   if (!frictionless)
   {
      const double dx = x - slip(i);
      if (dx != 0)
      {
         F.noalias() += dx * K.col(t(i));
         u[t(i)] = v_old[i] + x;
      }
   }
   status[i] = state;
}

DiscNode FrictionSolver::Implementation::disc_node(Index i) const
{
   const Index r = t(i, 0), s = t(i, 1);
   DiscNode node;
   node.A << problem.A()(r, r), problem.A()(r, s), problem.A()(s, r), problem.A()(s, s);
   node.b << problem.B()(i, r), problem.B()(i, s);
   node.c = knn[i];
   node.friction = problem.friction[i];
   return node;
}

void FrictionSolver::Implementation::move_disc_node(Index i)
{
   DiscNode node = disc_node(i);
   const Vector2d x = disc_slip(i);
   node.q0 = at(F, i) - node.A * x - gap(i) * node.b;
   node.p0 = F[m(i)] - node.b.dot(x) - node.c * gap(i);
   const DiscMove move = solve_node(node);
   if (!move.found) { return; } // as in the plane
   const Vector2d step = move.slip - x;
   for (Index k = 0; k < 2; ++k)
   {
      if (step[k] == 0) { continue; }
      F.noalias() += step[k] * K.col(t(i, k));
      u[t(i, k)] = v_old[t(i, k)] + move.slip[k];
   }
   const double lift = move.gap - gap(i);
   if (lift != 0)
   {
      F.noalias() += lift * K.col(m(i));
      u[m(i)] = move.gap - problem.gap[i];
   }
   status[i] = move.state;
}

/// One pass over all nodes, each solved exactly with the others held (thesis 3.5): separation
/// if the free node opens, else stick if friction suffices, else slip.
void FrictionSolver::Implementation::sweep()
{
   ++counters.sweeps;
   for (Index i = 0; i < n; ++i)
   {
      if (frictionless)
      {
         // A body that is free to slide away up a slope meets no resistance.
         if (!(knn[i] > 0)) { continue; }
         const double y = gap(i) - F[i] / knn[i];
         set_node(i, 0, std::max(y, 0.0), y > 0 ? NodeState::separation : NodeState::stick);
         continue;
      }
      if (disc())
      {
         move_disc_node(i);
         continue;
      }
      const double x = slip(i), y = gap(i), fi = problem.friction[i];
      const double q0 = F[t(i)] - ktt[i] * x - ktn[i] * y;
      const double p0 = F[m(i)] - ktn[i] * x - knn[i] * y;
      const double det = ktt[i] * knn[i] - ktn[i] * ktn[i];
      const double open = (ktn[i] * q0 - ktt[i] * p0) / det;
      if (open > 0)
      {
         set_node(i, (ktn[i] * p0 - knn[i] * q0) / det, open, NodeState::separation);
         continue;
      }
      if (p0 >= 0 && std::abs(q0) <= fi * p0)
      {
         set_node(i, 0, 0, NodeState::stick);
         continue;
      }
      const double forward = -(q0 + fi * p0) / (ktt[i] + fi * ktn[i]);
      const double backward = -(q0 - fi * p0) / (ktt[i] - fi * ktn[i]);
      if (forward > 0 && p0 + ktn[i] * forward >= 0)
      {
         set_node(i, forward, 0, NodeState::forward_slip);
      }
      else if (backward < 0 && p0 + ktn[i] * backward >= 0)
      {
         set_node(i, backward, 0, NodeState::backward_slip);
      }
      // Above the critical friction there may be no consistent state: the node is left as it
      // is.
   }
}

bool FrictionSolver::Implementation::run_gauss_seidel(IncrementReport &report)
{
   for (long k = 0; k < settings.max_sweeps; ++k)
   {
      sweep();
      // The forces are updated by columns; now and then they are formed anew, against drift.
      if (k % 64 == 63) { F = f + K * u; }
      if (!u.allFinite()) { return false; }
      if (!residuals(report)) { continue; }
      F = f + K * u;
      if (residuals(report)) { return accepted(report); }
   }
   return false;
}

} // namespace cattaneo
