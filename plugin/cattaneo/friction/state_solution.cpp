// The linear equations of node states in an increment.

#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool cancels(const VectorXd &K, const VectorXd &from, const VectorXd &u)
{
   const VectorXd unit = K.cwiseMax(0.0).cwiseSqrt();
   return unit.cwiseProduct(from).cwiseAbs().maxCoeff() >
          4 * unit.cwiseProduct(u).cwiseAbs().maxCoeff();
}

namespace
{

/// Normal displacements from which to solve. A gap that is large for the load would cost digits
/// otherwise.
VectorXd closed_gaps(const Increment &at)
{
   VectorXd w = -at.system.problem.gap;
   for (Index i = 0; i < at.system.n; ++i)
   {
      if (!closed(at.status[i])) { w[i] = 0; }
   }
   return w;
}

/// Moves the nodes that slip or are open, from displacements `u` to displacements that meet the
/// equations of the states. `f` are the forces with u = 0, and `forces` gets K u + f.
bool solve_equations(FrictionSystem &system, std::unique_ptr<StateEquations> &equations,
                     const Eigen::Ref<const MatrixXd> &stiffness,
                     const std::vector<NodeState> &states, const VectorXd &f, VectorXd &u,
                     VectorXd &forces)
{
   if (!equations)
   {
      equations = std::make_unique<StateEquations>(
         stiffness, stiffness.rows() > system.n
                       ? system.bound
                       : std::vector<FrictionBound>(system.n, FrictionBound()));
   }
   const long factorisations = equations->factorisations(), updates = equations->updates();
   bool solved = equations->set(states);
   for (bool again = false, done = false; solved && !done; again = true)
   {
      const VectorXd from = u;
      VectorXd x;
      const VectorXd stiff = again ? equations->forces(from) : equations->forces_again(from);
      solved = equations->solve(f + stiff, x, forces);
      if (solved) { u += x; }
      done = again || !solved || !cancels(equations->diagonal(), from, u);
   }
   system.counters.dense_factorisations += equations->factorisations() - factorisations;
   system.counters.dense_updates += equations->updates() - updates;
   return solved;
}

} // namespace

bool solve_normal(Increment &at)
{
   FrictionSystem &s = at.system;
   std::vector<NodeState> states(s.n);
   for (Index i = 0; i < s.n; ++i)
   {
      states[i] = closed(at.status[i]) ? NodeState::stick : NodeState::separation;
   }
   VectorXd w = closed_gaps(at), p;
   if (!solve_equations(s, s.equations.normal, s.K.bottomRightCorner(s.n, s.n), states,
                        at.f.tail(s.n), w, p))
   {
      return false;
   }
   at.u.tail(s.n) = w;
   at.F.tail(s.n) = p;
   return true;
}

namespace
{

/// B = 0: normal equations of the open nodes, then tangential ones with the pressure known.
bool solve_uncoupled(Increment &at)
{
   if (!solve_normal(at)) { return false; }
   FrictionSystem &s = at.system;
   const Index n = s.n;
   std::vector<NodeState> states(n);
   VectorXd resistance = VectorXd::Zero(n);
   for (Index i = 0; i < n; ++i)
   {
      const double way = sense(at.status[i]);
      states[i] = at.status[i] == NodeState::stick ? NodeState::stick : NodeState::separation;
      if (way != 0) { resistance[i] = way * s.bound[i].line(at.F[s.m(i)], way); }
   }
   VectorXd v = at.start.v, q;
   if (!solve_equations(s, s.equations.tangential, s.problem.A(), states,
                        at.f.head(n) + resistance, v, q))
   {
      return false;
   }
   at.u.head(n) = v;
   at.F.head(n) = q - resistance;
   return true;
}

bool solve_coupled(Increment &at)
{
   FrictionSystem &s = at.system;
   for (Index i = 0; i < at.piece.size(); ++i)
   {
      if (!s.bound[i].bends()) { continue; }
      s.coupled_equations().set_bound(i, s.bound[i].straight(at.piece[i]));
   }
   VectorXd found(at.u.size());
   found << at.start.v, closed_gaps(at);
   if (!solve_equations(s, s.equations.coupled, s.K, at.status, at.f, found, at.F))
   {
      return false;
   }
   at.u = found;
   return true;
}

} // namespace

bool solve_for_states(Increment &at)
{
   const FrictionSystem &s = at.system;
   ++at.system.counters.newton_steps;
   const bool solved = s.frictionless()    ? solve_normal(at)
                       : s.disc()          ? at.system.disc_equations.solve(at)
                       : s.problem.coupled ? solve_coupled(at)
                                           : solve_uncoupled(at);
   return solved && at.u.allFinite();
}

} // namespace cattaneo
