// Semismooth Newton: node states stand for linear equations, whose solution asks for states.

#include <cattaneo/friction/friction_implementation.hpp>
#include <cmath>
#include <set>

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

} // namespace

/// Solves the linear equations of the present states. False if they are singular.
bool FrictionSolver::Implementation::solve_for_states()
{
   ++counters.newton_steps;
   const bool solvable = frictionless ? solve_normal()
                         : disc()     ? solve_disc()
                         : uncoupled  ? solve_uncoupled()
                                      : solve_coupled();
   return solvable && u.allFinite();
}

/// Displacements are rounded after they were found, and their forces are not quite those of the
/// solution: once more, from there. True if it could be done.
bool FrictionSolver::Implementation::refined()
{
   if (disc()) { return false; } // forms its forces anew at each step
   from_here = true;
   const bool solved = solve_for_states();
   from_here = false;
   return solved;
}

/// Normal displacements to solve from: a gap that is large against the load would cost digits.
VectorXd FrictionSolver::Implementation::closed_gaps() const
{
   VectorXd w = -problem.gap;
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(status[i])) { w[i] = 0; }
   }
   return w;
}

/// Moves the nodes that slip or are open from displacements `u` to those that meet the
/// equations of the states; forces: K u + f, and with u = 0.
bool FrictionSolver::Implementation::solve_equations(
   std::unique_ptr<StateEquations> &equations, const Eigen::Ref<const MatrixXd> &stiffness,
   const std::vector<NodeState> &states, const VectorXd &f, VectorXd &u, VectorXd &forces)
{
   if (!equations)
   {
      equations = std::make_unique<StateEquations>(
         stiffness, stiffness.rows() > n ? problem.friction : no_friction);
   }
   const long factorisations = equations->factorisations(), updates = equations->updates();
   bool solved = equations->set(states);
   for (bool again = false, done = false; solved && !done; again = true)
   {
      const VectorXd from = u;
      VectorXd x;
      solved = equations->solve(f + stiffness * from, x, forces);
      if (solved) { u += x; }
      done = again || !solved || !cancels(equations->diagonal(), from, u);
   }
   counters.dense_factorisations += equations->factorisations() - factorisations;
   counters.dense_updates += equations->updates() - updates;
   return solved;
}

/// Frictionless, or B = 0: gaps from the normal equations of the open nodes alone.
bool FrictionSolver::Implementation::solve_normal()
{
   std::vector<NodeState> states(n);
   for (Index i = 0; i < n; ++i)
   {
      states[i] = closed(status[i]) ? NodeState::stick : NodeState::separation;
   }
   VectorXd w = from_here ? u.tail(n) : closed_gaps(), p;
   if (!solve_equations(normal_equations, K.bottomRightCorner(n, n), states, f.tail(n), w, p))
   {
      return false;
   }
   u.tail(n) = w;
   F.tail(n) = p;
   return true;
}

/// B = 0: normal equations of the open nodes, then tangential ones with the pressure known.
bool FrictionSolver::Implementation::solve_uncoupled()
{
   if (!solve_normal()) { return false; }
   std::vector<NodeState> states(n);
   VectorXd resistance = VectorXd::Zero(n);
   for (Index i = 0; i < n; ++i)
   {
      const bool moves = status[i] != NodeState::stick;
      states[i] = moves ? NodeState::separation : NodeState::stick;
      if (moves) { resistance[i] = sense(status[i]) * problem.friction[i] * F[m(i)]; }
   }
   VectorXd v = from_here ? u.head(n) : v_old, q;
   if (!solve_equations(tangential_equations, problem.A(), states, f.head(n) + resistance, v,
                        q))
   {
      return false;
   }
   u.head(n) = v;
   F.head(n) = q - resistance;
   return true;
}

bool FrictionSolver::Implementation::solve_coupled()
{
   VectorXd found = u;
   if (!from_here) { found << v_old, closed_gaps(); }
   if (!solve_equations(coupled_equations, K, status, f, found, F)) { return false; }
   u = found;
   return true;
}

/// Eliminates the open nodes, where all forces are zero; kept for as long as they are the same.
bool FrictionSolver::Implementation::eliminate_open()
{
   std::vector<signed char> key(n);
   for (Index i = 0; i < n; ++i) { key[i] = closed(status[i]) ? 0 : 1; }
   if (eliminated.key == key) { return !eliminated.singular; }
   eliminated.key = key;
   eliminated.open.clear();
   eliminated.kept.clear();
   eliminated.place.assign(n, 0);
   // B = 0: the gaps are found apart from the rest, and slip does not change the pressure.
   for (Index k = 0; k < (uncoupled ? 2 : 3); ++k)
   {
      for (Index i = 0; i < n; ++i)
      {
         auto &dofs = key[i] ? eliminated.open : eliminated.kept;
         if (k == 0 && !key[i]) { eliminated.place[i] = static_cast<Index>(dofs.size()); }
         dofs.push_back(t(i, k));
      }
   }
   ++counters.dense_factorisations;
   eliminated.K = K(eliminated.kept, eliminated.kept);
   eliminated.singular = false;
   if (eliminated.open.empty()) { return true; }
   eliminated.factor.compute(K(eliminated.open, eliminated.open));
   eliminated.singular = eliminated.factor.info() != Eigen::Success;
   if (eliminated.singular) { return false; }
   eliminated.X = K(eliminated.open, eliminated.kept);
   eliminated.factor.matrixL().solveInPlace(eliminated.X);
   eliminated.K.selfadjointView<Eigen::Lower>().rankUpdate(eliminated.X.transpose(), -1);
   eliminated.K.triangularView<Eigen::StrictlyUpper>() = eliminated.K.transpose();
   return true;
}

/// Newton's equations of the disc, for the slip of the slipping nodes.
bool FrictionSolver::Implementation::solve_disc()
{
   if (uncoupled && !solve_normal()) { return false; }
   if (!eliminate_open()) { return false; }
   std::vector<Index> slipping;
   for (Index i = 0; i < n; ++i)
   {
      for (Index k = 0; k < 2; ++k) { u[t(i, k)] = v_old[t(i, k)]; }
      if (!uncoupled) { u[m(i)] = closed(status[i]) ? -problem.gap[i] : 0.0; }
      if (slips(status[i])) { slipping.push_back(i); }
   }
   const std::vector<Index> &open = eliminated.open;
   const auto count = static_cast<Index>(slipping.size()),
              closed_nodes = static_cast<Index>(eliminated.kept.size()) / (uncoupled ? 2 : 3);
   DenseLU factor;
   if (count > 0)
   {
      // Rows n·q - f p and (1 - β) t·q of the slipping nodes, then their own β k t·x.
      MatrixXd M(2 * count, 2 * count);
      for (Index r = 0; r < count; ++r)
      {
         const Index i = slipping[r];
         const DiscSlip &to = direction[i];
         const Vector2d across = (1 - to.share) * to.t(), own = to.share * ktt[i] * to.t();
         const Index row = eliminated.place[i];
         for (Index col = 0; col < 2 * count; ++col)
         {
            const Index from =
               eliminated.place[slipping[col % count]] + (col < count ? 0 : closed_nodes);
            const double *column = eliminated.K.col(from).data() + row;
            const double radial = column[0], circumferential = column[closed_nodes];
            M(r, col) = to.n[0] * radial + to.n[1] * circumferential;
            if (!uncoupled) { M(r, col) -= problem.friction[i] * column[2 * closed_nodes]; }
            M(count + r, col) = across[0] * radial + across[1] * circumferential;
         }
         M(count + r, r) += own[0];
         M(count + r, count + r) += own[1];
      }
      ++counters.dense_factorisations;
      if (!factor.compute(std::move(M))) { return false; }
   }
   const VectorXd stiffness = K.diagonal();
   for (bool again = false;; again = true)
   {
      const VectorXd from = u;
      VectorXd base = f + K * u, lift;
      if (!open.empty())
      {
         lift = base(open);
         eliminated.factor.matrixL().solveInPlace(lift);
         base(eliminated.kept) -= eliminated.X.transpose() * lift;
      }
      VectorXd x(2 * count);
      for (Index r = 0; r < count; ++r)
      {
         const Index i = slipping[r];
         const DiscSlip &to = direction[i];
         const Vector2d q = at(base, i), slip = disc_slip(i);
         x[r] = to.n.dot(q) - problem.friction[i] * base[m(i)];
         x[count + r] = (1 - to.share) * to.t().dot(q) + to.share * ktt[i] * to.t().dot(slip);
      }
      if (count > 0) { factor.solve(x); }
      for (Index r = 0; r < 2 * count; ++r)
      {
         const Index k = r / count, i = slipping[r % count];
         u[t(i, k)] -= x[r];
         if (!open.empty())
         {
            lift -= x[r] * eliminated.X.col(eliminated.place[i] + k * closed_nodes);
         }
      }
      if (!open.empty())
      {
         eliminated.factor.matrixU().solveInPlace(lift);
         u(open) -= lift;
      }
      if (again || !cancels(stiffness, from, u)) { break; }
   }
   F = f + K * u;
   return true;
}

/// The states that the present displacements and forces ask for. True if none changed.
/// Violations within round-off change nothing, lest states flicker where two of them meet.
bool FrictionSolver::Implementation::update_states()
{
   const VectorXd noise_of_rows = noise();
   bool same = true;
   for (Index i = 0; i < n; ++i)
   {
      NodeState next = status[i];
      double tiny = noise_of_rows[m(i)];
      if (status[i] == NodeState::separation)
      {
         // A node that penetrates sticks first: which way it slips is not known yet.
         if (knn[i] * gap(i) < -tiny) { next = NodeState::stick; }
      }
      else if (F[m(i)] < -tiny) { next = NodeState::separation; }
      else if (disc())
      {
         tiny = std::max({tiny, noise_of_rows[t(i, 0)], noise_of_rows[t(i, 1)]});
         const Vector2d trial = disc_trial(i);
         const double size = std::hypot(trial[0], trial[1]);
         const bool stays = size <= bound(i) + (slips(status[i]) ? -tiny : tiny);
         next = stays || size == 0 ? NodeState::stick : NodeState::slip;
         if (next == NodeState::slip) { direction[i] = DiscSlip(trial, bound(i)); }
      }
      else if (!frictionless)
      {
         tiny = std::max(problem.friction[i] * tiny, noise_of_rows[t(i)]);
         const double trial = F[t(i)] - ktt[i] * slip(i);
         const double margin = slips(status[i]) ? -tiny : tiny;
         if (trial < -bound(i) - margin) { next = NodeState::forward_slip; }
         else if (trial > bound(i) + margin) { next = NodeState::backward_slip; }
         else { next = NodeState::stick; }
      }
      if (next != status[i])
      {
         status[i] = next;
         same = false;
      }
   }
   return same;
}

/// In the disc the directions of slip change from step to step as well: done when the residual
/// is small enough, given up when it has stopped falling.
bool FrictionSolver::Implementation::newton_disc(int steps)
{
   IncrementReport now;
   double best = std::numeric_limits<double>::infinity();
   int patience = 8;
   for (int k = 0; k < steps && patience > 0; ++k)
   {
      if (!solve_for_states()) { return false; }
      const bool small = residuals(now);
      if (update_states() && small) { return accepted(now); }
      const double size = std::max(now.residual_normal, now.residual_tangential);
      if (size < 0.5 * best)
      {
         best = size;
         patience = 8;
      }
      else { --patience; }
   }
   return false;
}

bool FrictionSolver::Implementation::newton(int steps)
{
   if (disc())
   {
      update_states(); // finds the directions
      return newton_disc(steps);
   }
   std::set<std::vector<NodeState>> visited;
   for (int k = 0; k < steps; ++k)
   {
      if (!visited.insert(status).second) { return false; } // the active set cycles
      if (!solve_for_states()) { return false; }
      if (update_states()) { return true; }
   }
   return false;
}

bool FrictionSolver::Implementation::newton_accepted(IncrementReport &report)
{
   if (!newton(settings.max_newton)) { return false; }
   return residuals(report) && accepted(report);
}

} // namespace cattaneo
