#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

Search path(Increment &at)
{
   FrictionSystem &s = at.system;
   if (s.disc()) { return Search::not_here; } // it has no straight sides
   const Index n = s.n;
   VectorXd stuck(s.K.rows()), forces(s.K.rows());
   stuck.tail(n) = -s.problem.gap;
   forces.tail(n) = at.start.p;
   if (!s.frictionless())
   {
      stuck.head(n) = at.start.v;
      forces.head(n) = at.start.q;
   }
   ComplementarityProblem increment;
   increment.b = at.f + s.product->times(stuck);
   increment.choice.assign(n, Choice::any);
   VectorXd x = VectorXd::Zero(s.K.rows());
   x.tail(n) = at.start.w + s.problem.gap;
   std::vector<NodeState> states = at.start.status;
   for (NodeState &state : states)
   {
      if (slips(state)) { state = NodeState::stick; }
   }
   // Small departures follow the physical path; larger ones pass by its dead ends.
   const double slacks[] = {1e-3, 1e-2, 0.1, 1, 10, 1, 0.1, 1};
   unsigned seed = 0;
   if (!s.equations.coupled)
   {
      s.equations.coupled = std::make_unique<StateEquations>(s.K, s.bound);
   }
   StateEquations &equations = *s.equations.coupled;
   for (double slack : slacks)
   {
      const long factorisations = equations.factorisations();
      equations.begin();
      if (!equations.set(states)) { states.assign(n, NodeState::stick); }
      const ComplementarityReport found =
         solve_by_path(equations, increment, x, forces, slack, ++seed);
      s.counters.pivots += found.pivots;
      s.counters.dense_factorisations += equations.factorisations() - factorisations;
      if (!found.solved) { continue; }
      at.take(stuck + found.x, equations.states());
      if (polished(at)) { return Search::found; }
   }
   return Search::not_here;
}

} // namespace cattaneo
