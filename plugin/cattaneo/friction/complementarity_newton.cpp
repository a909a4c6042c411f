#include <cattaneo/friction/complementarity.hpp>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// The state that a Newton step gives node i: what the present solution asks for.
NodeState wanted(const StateEquations &equations, Choice choice, Index i, const VectorXd &x,
                 const VectorXd &F, const VectorXd &round_off)
{
   const NodeState s = equations.states()[i];
   const VectorXd &stiffness = equations.diagonal();
   const FrictionBound &bound = equations.bound()[i];
   const Index m = equations.normal_row(i);
   const double tiny = std::max(round_off[i], round_off[m]);
   switch (choice)
   {
   case Choice::open:
      return NodeState::separation;
   case Choice::held:
      return NodeState::stick;
   case Choice::sliding:
      return equations.smooth_contact(i, x);
   case Choice::forward:
   case Choice::backward:
   {
      const NodeState slip =
         choice == Choice::forward ? NodeState::forward_slip : NodeState::backward_slip;
      const double way = sense(slip), left = s == slip ? stiffness[i] * way * x[i]
                                                       : bound.reserve(F[i], F[m], way);
      return (s == slip) == (left >= -tiny) ? slip : NodeState::stick;
   }
   case Choice::any:
      break;
   }
   ContactNode node;
   node.gap = x[m];
   node.p = F[m];
   node.kn = stiffness[m];
   if (equations.smooth(i))
   {
      const NodeState next = wanted_state(node, s, tiny, tiny);
      return closed(next) ? equations.smooth_contact(i, x) : next;
   }
   node.slip = x.segment<1>(i);
   node.q = F.segment<1>(i);
   node.kt = stiffness[i];
   node.bound = bound;
   return wanted_state(node, s, tiny, tiny);
}

} // namespace

ComplementarityReport solve_by_newton(StateEquations &equations,
                                      const ComplementarityProblem &problem, int max_steps,
                                      ComplementarityReport start)
{
   ComplementarityReport report = std::move(start);
   bool known = report.x.size() == problem.b.size();
   std::set<std::vector<NodeState>> visited;
   while (report.newton_steps < max_steps)
   {
      if (!visited.insert(equations.states()).second) { break; } // it cycles
      if (!known)
      {
         ++report.newton_steps;
         if (!equations.solve(problem.b, report.x, report.F)) { break; }
      }
      known = false;
      const VectorXd tiny = equations.round_off(problem.b, report.x);
      std::vector<NodeState> next = equations.states();
      for (Index i = 0; i < equations.nodes(); ++i)
      {
         next[i] = wanted(equations, problem.choice[i], i, report.x, report.F, tiny);
      }
      if (next == equations.states())
      {
         report.solved = true;
         break;
      }
      if (!equations.set(next)) { break; }
   }
   return report;
}

} // namespace cattaneo
