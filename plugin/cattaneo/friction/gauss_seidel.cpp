#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;

namespace
{

/// Moves one displacement and all forces with it.
void move(Increment &at, Index row, double from, double to, double displacement)
{
   if (to == from) { return; }
   at.F.noalias() += (to - from) * at.system.K.col(row);
   at.u[row] = displacement;
}

} // namespace

void sweep(Increment &at)
{
   FrictionSystem &s = at.system;
   ++s.counters.sweeps;
   for (Index i = 0; i < s.n; ++i)
   {
      // Without resistance the body can slide freely up a slope.
      if (s.frictionless() && !(s.lone.kn[i] > 0)) { continue; }
      LoneNode node = s.frictionless() ? LoneNode{} : lone_node(s.problem, i);
      if (!s.frictionless()) { node.bound = s.bound[i].straight(std::max(at.F[s.m(i)], 0.0)); }
      node.c = s.lone.kn[i];
      const NodeVector slip = at.slip(i);
      const double gap = at.gap(i);
      node.q0 = at.along(at.F, i) - node.A * slip - gap * node.b;
      node.p0 = at.F[s.m(i)] - node.b.dot(slip) - node.c * gap;
      const NodeMove found = solve_node(node);
      // Above the critical friction there may be no consistent state; the node is left as it
      // is.
      if (!found.found) { continue; }
      for (Index k = 0; k < s.c; ++k)
      {
         const Index row = s.t(i, k);
         move(at, row, slip[k], found.slip[k], at.start.v[row] + found.slip[k]);
      }
      move(at, s.m(i), gap, found.gap, found.gap - s.problem.gap[i]);
      at.status[i] = found.state;
   }
}

Search gauss_seidel(Increment &at)
{
   for (long k = 0; k < at.system.settings.max_sweeps; ++k)
   {
      sweep(at);
      // The forces are updated by columns, and computed anew now and then against drift.
      if (k % 64 == 63) { at.F = at.f + at.system.product->times(at.u); }
      if (!at.u.allFinite()) { break; }
      if (at.residuals() && at.ends_here()) { return Search::found; }
   }
   return Search::not_here;
}

} // namespace cattaneo
