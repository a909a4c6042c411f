// The linear equations that node states stand for, at an increment.

#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// True if displacements are much smaller than those that they were counted from: the round-off
/// of these is then a large part of them. By the nodes' own stiffness, K: its diagonal.
bool cancels(const VectorXd &K, const VectorXd &from, const VectorXd &u)
{
   const VectorXd unit = K.cwiseMax(0.0).cwiseSqrt();
   return unit.cwiseProduct(from).cwiseAbs().maxCoeff() >
          4 * unit.cwiseProduct(u).cwiseAbs().maxCoeff();
}

/// Normal displacements to solve from: a gap that is large against the load would cost digits.
VectorXd closed_gaps(const Increment &at)
{
   VectorXd w = -at.system.problem.gap;
   for (Index i = 0; i < at.system.n; ++i)
   {
      if (!closed(at.status[i])) { w[i] = 0; }
   }
   return w;
}

/// Moves the nodes that slip or are open from displacements `u` to those that meet the
/// equations of the states; forces: K u + f, and with u = 0.
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

/// Frictionless, or B = 0: gaps from the normal equations of the open nodes alone.
bool solve_normal(Increment &at, bool from_here)
{
   FrictionSystem &s = at.system;
   std::vector<NodeState> states(s.n);
   for (Index i = 0; i < s.n; ++i)
   {
      states[i] = closed(at.status[i]) ? NodeState::stick : NodeState::separation;
   }
   VectorXd w = from_here ? at.u.tail(s.n) : closed_gaps(at), p;
   if (!solve_equations(s, s.normal_equations, s.K.bottomRightCorner(s.n, s.n), states,
                        at.f.tail(s.n), w, p))
   {
      return false;
   }
   at.u.tail(s.n) = w;
   at.F.tail(s.n) = p;
   return true;
}

/// B = 0: normal equations of the open nodes, then tangential ones with the pressure known.
bool solve_uncoupled(Increment &at, bool from_here)
{
   if (!solve_normal(at, from_here)) { return false; }
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
   VectorXd v = from_here ? at.u.head(n) : at.v_old, q;
   if (!solve_equations(s, s.tangential_equations, s.problem.A(), states,
                        at.f.head(n) + resistance, v, q))
   {
      return false;
   }
   at.u.head(n) = v;
   at.F.head(n) = q - resistance;
   return true;
}

bool solve_coupled(Increment &at, bool from_here)
{
   FrictionSystem &s = at.system;
   VectorXd found = at.u;
   if (!from_here) { found << at.v_old, closed_gaps(at); }
   if (!solve_equations(s, s.coupled_equations, s.K, at.status, at.f, found, at.F))
   {
      return false;
   }
   at.u = found;
   return true;
}

/// Eliminates the open nodes, where all forces are zero; kept for as long as they are the same.
bool eliminate_open(FrictionSystem &s, const std::vector<NodeState> &status)
{
   FrictionSystem::EliminatedNodes &eliminated = s.eliminated;
   const Index n = s.n;
   std::vector<signed char> key(n);
   for (Index i = 0; i < n; ++i) { key[i] = closed(status[i]) ? 0 : 1; }
   if (eliminated.key == key) { return !eliminated.singular; }
   eliminated.key = key;
   eliminated.open.clear();
   eliminated.kept.clear();
   eliminated.place.assign(n, 0);
   // B = 0: the gaps are found apart from the rest, and slip does not change the pressure.
   for (Index k = 0; k < (s.problem.coupled ? 3 : 2); ++k)
   {
      for (Index i = 0; i < n; ++i)
      {
         auto &dofs = key[i] ? eliminated.open : eliminated.kept;
         if (k == 0 && !key[i]) { eliminated.place[i] = static_cast<Index>(dofs.size()); }
         dofs.push_back(s.t(i, k));
      }
   }
   ++s.counters.dense_factorisations;
   eliminated.K = s.K(eliminated.kept, eliminated.kept);
   eliminated.singular = false;
   if (eliminated.open.empty()) { return true; }
   eliminated.singular = !eliminated.factor.compute(s.K(eliminated.open, eliminated.open));
   if (eliminated.singular) { return false; }
   eliminated.X = s.K(eliminated.open, eliminated.kept);
   eliminated.factor.solve_half(eliminated.X);
   eliminated.K = minus_square(std::move(eliminated.K), eliminated.X);
   return true;
}

/// Newton's equations of the disc, for the slip of the slipping nodes.
bool solve_disc(Increment &at, bool from_here)
{
   FrictionSystem &s = at.system;
   if (!s.problem.coupled && !solve_normal(at, from_here)) { return false; }
   if (!eliminate_open(s, at.status)) { return false; }
   std::vector<Index> slipping;
   for (Index i = 0; i < s.n; ++i)
   {
      for (Index k = 0; k < 2; ++k) { at.u[s.t(i, k)] = at.v_old[s.t(i, k)]; }
      if (s.problem.coupled) { at.u[s.m(i)] = closed(at.status[i]) ? -s.problem.gap[i] : 0.0; }
      if (slips(at.status[i])) { slipping.push_back(i); }
   }
   const FrictionSystem::EliminatedNodes &eliminated = s.eliminated;
   const std::vector<Index> &open = eliminated.open;
   const auto count = static_cast<Index>(slipping.size()),
              closed_nodes =
                 static_cast<Index>(eliminated.kept.size()) / (s.problem.coupled ? 3 : 2);
   DenseLU factor;
   if (count > 0)
   {
      // Rows n·q - f p and (1 - β) t·q of the slipping nodes, then their own β k t·x.
      std::vector<Index> rows(count);
      VectorXd slope(count);
      Eigen::Matrix2Xd along(2, count), across(2, count);
      for (Index r = 0; r < count; ++r)
      {
         const Index i = slipping[r];
         const DiscSlip &to = at.direction[i];
         rows[r] = eliminated.place[i];
         slope[r] = s.problem.coupled ? s.bound[i].slope(at.F[s.m(i)]) : 0.0;
         along.col(r) = to.n;
         across.col(r) = (1 - to.share) * to.t();
      }
      MatrixXd M(2 * count, 2 * count);
      for (Index col = 0; col < 2 * count; ++col)
      {
         const Index from = rows[col % count] + (col < count ? 0 : closed_nodes);
         const double *radial = eliminated.K.col(from).data(),
                      *circumferential = radial + closed_nodes,
                      *normal = circumferential + (s.problem.coupled ? closed_nodes : 0);
         double *first = M.col(col).data(), *second = first + count;
         for (Index r = 0; r < count; ++r)
         {
            const double q[2] = {radial[rows[r]], circumferential[rows[r]]};
            first[r] = along(0, r) * q[0] + along(1, r) * q[1] - slope[r] * normal[rows[r]];
            second[r] = across(0, r) * q[0] + across(1, r) * q[1];
         }
      }
      for (Index r = 0; r < count; ++r)
      {
         const DiscSlip &to = at.direction[slipping[r]];
         const Vector2d own = to.share * s.ktt[slipping[r]] * to.t();
         M(count + r, r) += own[0];
         M(count + r, count + r) += own[1];
      }
      ++s.counters.dense_factorisations;
      if (!factor.compute(std::move(M))) { return false; }
   }
   const VectorXd stiffness = s.K.diagonal();
   for (bool again = false;; again = true)
   {
      const VectorXd from = at.u;
      VectorXd base = at.f + (*s.times_K)(at.u);
      MatrixXd lift;
      if (!open.empty())
      {
         lift = base(open);
         eliminated.factor.solve_half(lift);
         base(eliminated.kept) -= eliminated.X.transpose() * lift;
      }
      VectorXd x(2 * count);
      for (Index r = 0; r < count; ++r)
      {
         const Index i = slipping[r];
         const DiscSlip &to = at.direction[i];
         const Vector2d q = at.along(base, i), slip = at.slip(i);
         x[r] = to.n.dot(q) - s.bound[i].line(base[s.m(i)]);
         x[count + r] = (1 - to.share) * to.t().dot(q) + to.share * s.ktt[i] * to.t().dot(slip);
      }
      if (count > 0) { factor.solve(x); }
      for (Index r = 0; r < 2 * count; ++r)
      {
         const Index k = r / count, i = slipping[r % count];
         at.u[s.t(i, k)] -= x[r];
         if (!open.empty())
         {
            lift -= x[r] * eliminated.X.col(eliminated.place[i] + k * closed_nodes);
         }
      }
      if (!open.empty())
      {
         eliminated.factor.solve_other_half(lift);
         at.u(open) -= lift;
      }
      if (again || !cancels(stiffness, from, at.u)) { break; }
   }
   at.F = at.f + (*s.times_K)(at.u);
   return true;
}

} // namespace

bool solve_for_states(Increment &at, bool from_here)
{
   const FrictionSystem &s = at.system;
   ++at.system.counters.newton_steps;
   const auto solve = s.frictionless      ? solve_normal
                      : s.disc()          ? solve_disc
                      : s.problem.coupled ? solve_coupled
                                          : solve_uncoupled;
   return solve(at, from_here) && at.u.allFinite();
}

} // namespace cattaneo
