// Lemke's method on the increments of the plane.

#include <algorithm>
#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cmath>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// An increment as a complementarity problem, and one start after the other.
class Starts
{
public:
   explicit Starts(Increment &at) : at_(at), s_(at.system), equations_(s_.coupled_equations())
   {
      stuck_.resize(s_.K.rows());
      stuck_.tail(s_.n) = -s_.problem.gap;
      if (!s_.frictionless()) { stuck_.head(s_.n) = at.start.v; }
      problem_.b = at.f + s_.product->times(stuck_);
      problem_.choice.assign(s_.n, Choice::any);
      if (s_.bends()) { problem_.bounds = s_.bound; }
   }

   /// Begins at displacements u and forces F that fit these states at least approximately. True
   /// if the end of the increment is reached.
   bool from(const VectorXd &u, const VectorXd &F, std::vector<NodeState> states, double slack)
   {
      const long factorisations = equations_.factorisations();
      equations_.begin();
      if (!equations_.set(states))
      {
         states.assign(s_.n, NodeState::stick);
         equations_.set(states);
      }
      const ComplementarityReport found =
         solve_by_lemke(equations_, problem_, u - stuck_, F, slack, ++seed_);
      s_.counters.pivots += found.pivots;
      s_.counters.dense_factorisations += equations_.factorisations() - factorisations;
      // The number of operations that solving and searching take.
      const double N = static_cast<double>(s_.K.rows());
      operations_ += N * N * N + static_cast<double>(found.pivots + 1) * (8 * N * N + 1e4);
      if (!found.solved) { return false; }
      at_.move_to(stuck_ + found.x, equations_.states());
      return polished(at_);
   }
   double operations() const { return operations_; }

private:
   Increment &at_;
   FrictionSystem &s_;
   StateEquations &equations_;
   VectorXd stuck_; // where no node slips and none is open
   ComplementarityProblem problem_;
   unsigned seed_ = 0;
   double operations_ = 0;
};

} // namespace

/// Starts from the state at the start of the increment, which is a solution at other loads.
Search lemke(Increment &at)
{
   const FrictionSystem &s = at.system;
   std::vector<NodeState> states = at.start.status;
   for (NodeState &state : states)
   {
      if (slips(state)) { state = NodeState::stick; }
   }
   const VectorXd u = s.frictionless() ? at.start.w : at.start.displacements(),
                  F = s.frictionless() ? at.start.p : at.start.forces();
   Starts starts(at);
   // Small departures follow the physical path; larger ones avoid its dead ends.
   for (const double slack : {1e-3, 1e-2, 0.1, 1.0, 10.0, 1.0, 0.1, 1.0})
   {
      if (starts.from(u, F, states, slack)) { return Search::found; }
   }
   return Search::not_here;
}

/// Starts from random displacements at growing distances. The unit of distance is the
/// displacement that the loads cause at a node alone. The number of starts is limited by the
/// number of operations (1e9, about a second). The generator is seeded afresh, so that equal
/// increments start alike.
Search lemke_from_afar(Increment &at)
{
   FrictionSystem &s = at.system;
   // Without friction there is one answer, and all starts lead to it.
   if (s.frictionless()) { return Search::not_here; }
   // A body that drifts away is unlikely to have an equilibrium elsewhere, so the search for
   // one is shorter.
   const double operations = moves_away(at) ? 1e8 : 1e9;
   const VectorXd far = at.reference * s.K.diagonal().cwiseInverse();
   constexpr int most = 500;
   const NodeState any[] = {NodeState::stick, NodeState::separation, NodeState::forward_slip,
                            NodeState::backward_slip};
   std::mt19937_64 random(1);
   const auto some = [&] { return std::ldexp(double(random() >> 11), -52) - 1; };
   Starts starts(at);
   for (int k = 0; k < most && starts.operations() < operations; ++k)
   {
      // 1. Displacements.
      const double size = std::pow(10, -2 + 4.0 * k / most);
      VectorXd u = at.start.displacements();
      for (Index row = 0; row < u.size(); ++row) { u[row] += size * far[row] * some(); }
      at.move_to(u, at.start.status);
      // 2. The states that the natural map gives them; every second time any states. To some
      // solutions departures of the first kind hardly ever lead: a free body on a single
      // sticking node moves the farther, the shorter its lever is.
      std::vector<NodeState> states(s.n);
      for (Index i = 0; i < s.n; ++i)
      {
         states[i] = k % 2 == 0 ? natural_state(at.node(i)) : any[random() % 4];
      }
      // 3. A solution.
      const double slack = std::pow(10, 0.5 * (k % 5) - 1.5);
      if (starts.from(at.u, at.F, std::move(states), slack) && !may_slide(at))
      {
         return Search::found;
      }
   }
   return Search::not_here;
}

} // namespace cattaneo
