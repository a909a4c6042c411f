#include <algorithm>
#include <cattaneo/friction/complementarity.hpp>
#include <limits>
#include <set>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// The state that a Newton step gives node i, according to the present solution.
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
   case Choice::stick:
      return NodeState::stick;
   case Choice::sliding:
      return equations.frictionless_contact(i, x);
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
   if (equations.frictionless(i))
   {
      const NodeState next = wanted_state(node, s, tiny, tiny);
      return closed(next) ? equations.frictionless_contact(i, x) : next;
   }
   node.slip = x.segment<1>(i);
   node.q = F.segment<1>(i);
   node.kt = stiffness[i];
   node.bound = bound;
   return wanted_state(node, s, tiny, tiny);
}

} // namespace

bool newton_on_states(const std::function<std::vector<double>()> &choices, int max_steps,
                      Index few, const std::function<bool()> &solve,
                      const std::function<Index()> &ask)
{
   std::set<std::vector<double>> tried;
   // If a few of many nodes keep changing, they would do so up to the last allowed step.
   constexpr int enough = 8;
   Index fewest = std::numeric_limits<Index>::max();
   int patience = enough;
   for (int k = 0; k < max_steps && patience > 0; ++k)
   {
      if (!tried.insert(choices()).second) { return false; } // it cycles
      if (!solve()) { return false; }
      const Index changed = ask();
      if (changed == 0) { return true; }
      patience = changed < fewest || fewest > few ? enough : patience - 1;
      fewest = std::min(fewest, changed);
   }
   return false;
}

ComplementarityReport solve_by_newton(StateEquations &equations,
                                      const ComplementarityProblem &problem, int max_steps,
                                      ComplementarityReport start)
{
   ComplementarityReport report = std::move(start);
   bool known = report.x.size() == problem.b.size();
   std::vector<NodeState> states = equations.states();
   const auto solve = [&]
   {
      if (std::exchange(known, false)) { return true; }
      ++report.newton_steps;
      return equations.set(states) && equations.solve(problem.b, report.x, report.F);
   };
   const auto ask = [&]
   {
      const VectorXd tiny = equations.round_off(problem.b, report.x);
      Index changed = 0;
      for (Index i = 0; i < equations.nodes(); ++i)
      {
         const NodeState next =
            wanted(equations, problem.choice[i], i, report.x, report.F, tiny);
         changed += next != states[i];
         states[i] = next;
      }
      return changed;
   };
   const auto choices = [&]
   {
      std::vector<double> key;
      for (const NodeState state : states) { key.push_back(static_cast<double>(state)); }
      return key;
   };
   report.solved = newton_on_states(choices, max_steps, 0, solve, ask);
   return report;
}

bool keep_states_at_rest(StateEquations &equations, const ComplementarityProblem &problem,
                         const std::vector<NodeState> &before, ComplementarityReport &report)
{
   const std::vector<NodeState> found = equations.states();
   if (found == before) { return false; }
   // 1. Displacements have the rounding of the largest of them, which is more than that of the
   // products in a row, for instance where a body slips as a whole.
   const auto rounding = [&](const ComplementarityReport &at)
   {
      return 1e-13 * std::max({problem.b.cwiseAbs().maxCoeff(), at.F.cwiseAbs().maxCoeff(),
                               equations.diagonal().cwiseProduct(at.x).cwiseAbs().maxCoeff()});
   };
   // 2. The nodes that have changed although they are at rest go back.
   std::vector<NodeState> states = found;
   const double tiny = rounding(report);
   for (Index i = 0; i < equations.nodes(); ++i)
   {
      const Choice choice = problem.choice[i];
      if (choice != Choice::forward && choice != Choice::backward) { continue; }
      const double left = equations.bound()[i].reserve(
         report.F[i], report.F[equations.normal_row(i)], choice == Choice::forward ? 1 : -1);
      const double slip = equations.diagonal()[i] * report.x[i];
      if (std::max(std::abs(slip), std::abs(left)) <= tiny) { states[i] = before[i]; }
   }
   if (states == found || !equations.set(states)) { return false; }
   // 3. All nodes must obey the laws.
   ComplementarityReport kept = report;
   bool obeyed = equations.solve(problem.b, kept.x, kept.F);
   VectorXd round_off;
   if (obeyed) { round_off = equations.round_off(problem.b, kept.x).cwiseMax(rounding(kept)); }
   for (Index i = 0; obeyed && i < equations.nodes(); ++i)
   {
      obeyed = states[i] == wanted(equations, problem.choice[i], i, kept.x, kept.F, round_off);
   }
   if (obeyed) { report = std::move(kept); }
   else { equations.set(found); }
   return obeyed;
}

} // namespace cattaneo
