#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/friction_disc.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/lemke.hpp>
#include <cattaneo/friction/mechanism.hpp>
#include <cattaneo/friction/semidefinite.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

const char *name(FrictionStatus status)
{
   switch (status)
   {
   case FrictionStatus::converged:
      return "converged";
   case FrictionStatus::gross_sliding:
      return "gross sliding";
   case FrictionStatus::not_unique:
      return "not unique";
   case FrictionStatus::no_solution:
      return "no solution";
   case FrictionStatus::stalled:
      return "stalled";
   }
   return "";
}

void FrictionSettings::validate() const
{
   require(tolerance > 0 && tolerance < 1, "friction settings: tolerance is ", tolerance,
           ", must be between 0 and 1");
   require(sweeps >= 0, "friction settings: sweeps is ", sweeps, ", must not be negative");
   require(max_attempts >= 1, "friction settings: max_attempts is ", max_attempts,
           ", must be at least 1");
   require(max_newton >= 1, "friction settings: max_newton is ", max_newton,
           ", must be at least 1");
   require(max_sweeps >= 1, "friction settings: max_sweeps is ", max_sweeps,
           ", must be at least 1");
}

namespace
{

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Stiffness of the closed nodes when the open ones are free, kept for as long as these are the
/// same.
struct EliminatedNodes
{
   std::vector<signed char> key;
   std::vector<Index> open, kept; // rows of K: all components of the open, closed nodes
   std::vector<Index> place;      // of a closed node's first component among `kept`
   Eigen::LLT<MatrixXd> factor;   // L Lᵀ of the open ones
   MatrixXd X;                    // L⁻¹ K(open, kept)
   MatrixXd K;                    // K(kept, kept) - Xᵀ X
   bool singular = false;
};

} // namespace

struct FrictionSolver::Implementation
{
   ReducedProblem problem;
   FrictionSettings settings;
   Counters counters;

   Index n = 0, c = 0; // nodes and tangential components (frictionless: none)
   bool frictionless = false, uncoupled = false;
   VectorXd ktt, ktn, knn; // each node's own stiffness block (disc: ktt is its mean)
   VectorXd critical;      // friction of each node
   VectorXd no_friction;   // zeros
   MatrixXd K;             // [A Bᵀ; B C], or the normal stiffness alone if frictionless
   double K_norm = 0;      // row-sum norm
   double critical_friction = std::numeric_limits<double>::infinity();
   Index critical_node = 0;
   std::unique_ptr<SemidefiniteSolver> tangential; // frictionless: A⁻¹
   // Equations of the states: all at once, or the gaps and then the slip (B = 0).
   std::unique_ptr<StateEquations> coupled_equations, normal_equations, tangential_equations;
   EliminatedNodes eliminated;
   std::unique_ptr<MatrixXd> motions; // rigid motions, found when first needed
   Mechanism mechanism;
   std::unique_ptr<FrictionSolver> smooth; // disc: the contact without friction, likewise

   // One increment's working set.
   VectorXd f;    // forces with v = w = 0 at the new loads
   VectorXd u, F; // displacements {v; w} and forces {q; p} (frictionless: w, p)
   VectorXd v_old;
   std::vector<NodeState> status;
   std::vector<DiscSlip> direction; // disc: of the slipping nodes, as last linearised
   double reference = 0;            // largest clamped force so far

   Implementation(const ReducedProblem &given, const FrictionSettings &chosen);

   bool disc() const { return c == 2; } // friction force in the disc |q| <= f p
   Index t(Index i) const { return i; } // row of node i's tangential entry
   Index t(Index i, Index k) const { return k * n + i; } // and of its k-th
   Index m(Index i) const { return c * n + i; }          // row of its normal entry
   double gap(Index i) const { return u[m(i)] + problem.gap[i]; }
   double slip(Index i) const { return u[t(i)] - v_old[i]; }
   Vector2d disc_slip(Index i) const { return at(u, i) - at(v_old, i); }
   Vector2d disc_trial(Index i) const { return at(F, i) - ktt[i] * disc_slip(i); }
   /// The two tangential entries of node i.
   Vector2d at(const VectorXd &x, Index i) const { return {x[i], x[n + i]}; }
   double bound(Index i) const { return problem.friction[i] * std::max(F[m(i)], 0.0); }

   void start(const ContactState &state, const VectorXd &multipliers);
   void finish(ContactState &state, const VectorXd &multipliers);
   void sweep();
   void set_node(Index i, double x, double y, NodeState state);
   DiscNode disc_node(Index i) const; // without its forces
   void move_disc_node(Index i);
   bool newton(int steps);
   bool newton_disc(int steps);
   bool solve_for_states();
   bool solve_coupled();
   bool solve_normal();
   bool solve_uncoupled();
   bool eliminate_open();
   bool solve_disc();
   VectorXd closed_gaps() const;
   bool solve_equations(std::unique_ptr<StateEquations> &equations, const MatrixXd &stiffness,
                        const std::vector<NodeState> &states, const VectorXd &b, VectorXd &x,
                        VectorXd &forces);
   bool update_states();
   bool lemke_start();
   void residuals(IncrementReport &report) const;
   bool accepted(const IncrementReport &report) const;
   bool runs_away(const IncrementReport &report, const VectorXd &multipliers);
   bool finds_mechanism(const VectorXd &multipliers);
   bool spins(const VectorXd &multipliers);
   Index above_critical() const;
   void explain_failure(IncrementReport &report) const;
   double noise() const
   {
      return std::max(0.1 * settings.tolerance * reference, 0.5 * round_off());
   }
   double round_off() const
   {
      return 4 * eps * (K_norm * u.cwiseAbs().maxCoeff() + f.cwiseAbs().maxCoeff());
   }
   IncrementReport solve(ContactState &state, const VectorXd &multipliers);
   IncrementReport uniqueness(const std::vector<NodeState> &states) const;
   bool run_gauss_seidel(IncrementReport &report);
   bool run_automatic(IncrementReport &report, const ContactState &state,
                      const VectorXd &multipliers);
   bool run_lemke(IncrementReport &report);
   bool run_path(IncrementReport &report, const ContactState &state);
   bool run_loading(IncrementReport &report, const ContactState &state);
   bool polished(IncrementReport &report);
};

FrictionSolver::Implementation::Implementation(const ReducedProblem &given,
                                               const FrictionSettings &chosen)
   : problem(given), settings(chosen), n(given.nodes())
{
   settings.validate();
   problem.validate();
   require(problem.components() <= 2, "friction solver: the reduced problem has ",
           problem.components(), " tangential components a node, at most 2 are supported");
   frictionless = problem.components() == 0 || problem.friction.maxCoeff() == 0;
   c = frictionless ? 0 : problem.components();
   require(!disc() || settings.method != FrictionMethod::lemke,
           "friction solver: method lemke needs one tangential component a node, the reduced "
           "problem has 2");
   knn = problem.C.diagonal();
   if (frictionless)
   {
      K = problem.C;
      uncoupled = true;
      if (problem.components() > 0)
      {
         tangential = std::make_unique<SemidefiniteSolver>(problem.A);
         ++counters.dense_factorisations;
         K -= problem.B * tangential->solve(problem.B.transpose());
         K = (0.5 * (K + K.transpose())).eval();
         knn = K.diagonal();
         // What little is left where a body is free to slide away up a slope is round-off.
         K_norm = problem.C.cwiseAbs().rowwise().sum().maxCoeff();
      }
   }
   else
   {
      counters.tangential_unknowns = c * n;
      ktt = problem.A.diagonal().head(n);
      ktn = problem.B.diagonal();
      const double scale =
         std::sqrt(problem.A.cwiseAbs().maxCoeff() * problem.C.cwiseAbs().maxCoeff());
      // Condensed bodies of great extent carry round-off of 1e-12 of their stiffness.
      uncoupled = problem.B.cwiseAbs().maxCoeff() <= 1e-11 * scale;
      if (uncoupled)
      {
         problem.B.setZero();
         ktn.setZero();
      }
      K = problem.stiffness();
      critical = ktt.cwiseQuotient(ktn.cwiseAbs());
      for (Index i = 0; i < n; ++i)
      {
         if (disc())
         {
            const DiscNode node = disc_node(i);
            ktt[i] = std::sqrt(node.A.determinant());
            critical[i] = cattaneo::critical_friction(node.A, node.b);
         }
         if (critical[i] < critical_friction)
         {
            critical_friction = critical[i];
            critical_node = i;
         }
      }
   }
   no_friction = VectorXd::Zero(n);
   K_norm = std::max(K_norm, K.cwiseAbs().rowwise().sum().maxCoeff());
}

void FrictionSolver::Implementation::start(const ContactState &state,
                                           const VectorXd &multipliers)
{
   const VectorXd clamped = problem.clamped_forces(multipliers);
   v_old = state.v;
   status = state.status;
   reference = std::max(state.peak_force, clamped.cwiseAbs().maxCoeff());
   // Initial interference and initial slip load the contact too.
   reference = std::max(reference, (-problem.gap.array() * knn.array()).maxCoeff());
   if (!frictionless)
   {
      reference = std::max(reference, (problem.A * v_old).cwiseAbs().maxCoeff());
      f = clamped;
      u.resize((c + 1) * n);
      u << state.v, state.w;
   }
   else
   {
      f = clamped.tail(n);
      if (tangential) { f -= problem.B * tangential->solve(clamped.head(problem.A.rows())); }
      u = state.w;
   }
   for (Index i = 0; i < n; ++i)
   {
      if (closed(status[i])) { u[m(i)] = -problem.gap[i]; }
   }
   F = f + K * u;
   direction.resize(disc() ? n : 0);
   // What comes out depends on the state and the loads, not on increments before: a march that
   // is cut and resumed gives the same bits.
   for (auto *equations : {&coupled_equations, &normal_equations, &tangential_equations})
   {
      if (*equations) { (*equations)->begin(); }
   }
}

void FrictionSolver::Implementation::finish(ContactState &state, const VectorXd &multipliers)
{
   state.multipliers = multipliers;
   state.peak_force = reference;
   state.w = u.tail(n);
   state.p = F.tail(n);
   if (!frictionless)
   {
      state.v = u.head(c * n);
      state.q = F.head(c * n);
   }
   else if (tangential)
   {
      const VectorXd clamped = problem.clamped_forces(multipliers).head(problem.A.rows());
      state.v = -tangential->solve(problem.B.transpose() * state.w + clamped);
      state.q.setZero();
      for (Index i = 0; i < n; ++i)
      {
         if (!closed(status[i])) { continue; }
         if (problem.components() == 2) { status[i] = NodeState::slip; }
         else if (state.v[i] >= v_old[i]) { status[i] = NodeState::forward_slip; }
         else { status[i] = NodeState::backward_slip; }
      }
   }
   state.status = status;
   // Exact zeros where the state says zero: round-off must not look like traction or
   // penetration.
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(status[i]))
      {
         state.p[i] = 0;
         for (Index k = i; k < state.q.size(); k += n) { state.q[k] = 0; }
      }
   }
}

// ------------------------------------------------------------------------- Gauss–Seidel sweeps

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
   node.A << problem.A(r, r), problem.A(r, s), problem.A(s, r), problem.A(s, s);
   node.b << problem.B(i, r), problem.B(i, s);
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

// ------------------------------------------------------------------------------- active set

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

/// Solves for displacements x of the nodes that slip or are open, and the forces; b: with x =
/// 0.
bool FrictionSolver::Implementation::solve_equations(std::unique_ptr<StateEquations> &equations,
                                                     const MatrixXd &stiffness,
                                                     const std::vector<NodeState> &states,
                                                     const VectorXd &b, VectorXd &x,
                                                     VectorXd &forces)
{
   if (!equations)
   {
      equations = std::make_unique<StateEquations>(
         stiffness, stiffness.rows() > n ? problem.friction : no_friction);
   }
   const long factorisations = equations->factorisations(), updates = equations->updates();
   const bool solved = equations->set(states) && equations->solve(b, x, forces);
   counters.dense_factorisations += equations->factorisations() - factorisations;
   counters.dense_updates += equations->updates() - updates;
   return solved;
}

/// Frictionless, or B = 0: gaps from the normal equations of the open nodes alone.
bool FrictionSolver::Implementation::solve_normal()
{
   const MatrixXd &C = frictionless ? K : problem.C;
   std::vector<NodeState> states(n);
   for (Index i = 0; i < n; ++i)
   {
      states[i] = closed(status[i]) ? NodeState::stick : NodeState::separation;
   }
   const VectorXd from = closed_gaps();
   VectorXd x, p;
   if (!solve_equations(normal_equations, C, states, f.tail(n) + C * from, x, p))
   {
      return false;
   }
   u.tail(n) = from + x;
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
   VectorXd x, q;
   if (!solve_equations(tangential_equations, problem.A, states,
                        f.head(n) + problem.A * v_old + resistance, x, q))
   {
      return false;
   }
   u.head(n) = v_old + x;
   F.head(n) = q - resistance;
   return true;
}

bool FrictionSolver::Implementation::solve_coupled()
{
   VectorXd from(2 * n), x;
   from << v_old, closed_gaps();
   if (!solve_equations(coupled_equations, K, status, f + K * from, x, F)) { return false; }
   u = from + x;
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
   VectorXd base = f + K * u;
   VectorXd lift;
   if (!open.empty())
   {
      lift = base(open);
      eliminated.factor.matrixL().solveInPlace(lift);
      base(eliminated.kept) -= eliminated.X.transpose() * lift;
   }
   const auto count = static_cast<Index>(slipping.size());
   if (count > 0)
   {
      const auto closed_nodes =
         static_cast<Index>(eliminated.kept.size()) / (uncoupled ? 2 : 3);
      // Rows n·q - f p and (1 - β) t·q of the slipping nodes, then their own β k t·x.
      MatrixXd M(2 * count, 2 * count);
      VectorXd rhs(2 * count);
      for (Index r = 0; r < count; ++r)
      {
         const Index i = slipping[r];
         const DiscSlip &to = direction[i];
         const Vector2d across = (1 - to.share) * to.t(), own = to.share * ktt[i] * to.t();
         const Vector2d q = at(base, i);
         rhs[r] = to.n[0] * q[0] + to.n[1] * q[1] - problem.friction[i] * base[m(i)];
         rhs[count + r] = across[0] * q[0] + across[1] * q[1];
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
      DenseLU factor;
      if (!factor.compute(std::move(M))) { return false; }
      VectorXd &x = rhs;
      factor.solve(x);
      for (Index r = 0; r < 2 * count; ++r)
      {
         const Index k = r / count, i = slipping[r % count];
         u[t(i, k)] -= x[r];
         if (!open.empty())
         {
            lift -= x[r] * eliminated.X.col(eliminated.place[i] + k * closed_nodes);
         }
      }
   }
   if (!open.empty())
   {
      eliminated.factor.matrixU().solveInPlace(lift);
      u(open) -= lift;
   }
   F = f + K * u;
   return true;
}

/// The states that the present displacements and forces ask for. True if none changed.
/// Violations within round-off change nothing, lest states flicker where two of them meet.
bool FrictionSolver::Implementation::update_states()
{
   const double tiny = noise();
   bool same = true;
   for (Index i = 0; i < n; ++i)
   {
      NodeState next = status[i];
      if (status[i] == NodeState::separation)
      {
         // A node that penetrates sticks first: which way it slips is not known yet.
         if (knn[i] * gap(i) < -tiny) { next = NodeState::stick; }
      }
      else if (F[m(i)] < -tiny) { next = NodeState::separation; }
      else if (disc())
      {
         const Vector2d trial = disc_trial(i);
         const double size = std::hypot(trial[0], trial[1]);
         const bool stays = size <= bound(i) + (slips(status[i]) ? -tiny : tiny);
         next = stays || size == 0 ? NodeState::stick : NodeState::slip;
         if (next == NodeState::slip) { direction[i] = DiscSlip(trial, bound(i)); }
      }
      else if (!frictionless)
      {
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
      residuals(now);
      if (update_states() && accepted(now)) { return true; }
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

// ------------------------------------------------------------------------------- outcomes

void FrictionSolver::Implementation::residuals(IncrementReport &report) const
{
   double normal = 0, tangent = 0;
   for (Index i = 0; i < n; ++i)
   {
      const double p = F[m(i)];
      normal = std::max(normal, std::abs(std::min(knn[i] * gap(i), p)));
      if (frictionless) { continue; }
      const double limit = bound(i);
      if (disc())
      {
         const Vector2d trial = disc_trial(i);
         const double size = std::hypot(trial[0], trial[1]);
         const Vector2d held = size > limit ? Vector2d(limit / size * trial) : trial;
         tangent = std::max(tangent, (at(F, i) - held).norm());
         continue;
      }
      const double trial = F[t(i)] - ktt[i] * slip(i);
      tangent = std::max(tangent, std::abs(F[t(i)] - std::clamp(trial, -limit, limit)));
   }
   const double scale = reference > 0 ? reference : 1.0;
   report.residual_normal = normal / scale;
   report.residual_tangential = tangent / scale;
   report.round_off = round_off() / scale;
}

bool FrictionSolver::Implementation::accepted(const IncrementReport &report) const
{
   const double allowed = std::max(settings.tolerance, report.round_off);
   return report.residual_normal <= allowed && report.residual_tangential <= allowed &&
          report.round_off < 1e-6;
}

/// Displacements so large that round-off hides the forces may be a body that slides away, with
/// an imbalance that no residual shows.
bool FrictionSolver::Implementation::runs_away(const IncrementReport &report,
                                               const VectorXd &multipliers)
{
   return report.round_off > 1e-10 && (finds_mechanism(multipliers) || spins(multipliers));
}

bool FrictionSolver::Implementation::lemke_start()
{
   // Non-dimensional unknowns: each displacement in units of (largest force)/(own stiffness)^½.
   const Index N = frictionless ? n : 3 * n;
   MatrixXd M(N, N);
   VectorXd b(N);
   VectorXd base_u = u;
   for (Index i = 0; i < n; ++i)
   {
      base_u[m(i)] = -problem.gap[i];
      if (!frictionless) { base_u[t(i)] = v_old[i]; }
   }
   const double scale = reference > 0 ? reference : 1.0;
   const VectorXd base = (f + K * base_u) / scale;
   const VectorXd dn = knn.cwiseSqrt().cwiseInverse();
   VectorXd fs; // friction between rows scaled by dt and rows scaled by dn
   if (frictionless)
   {
      M = dn.asDiagonal() * K * dn.asDiagonal();
      b = dn.asDiagonal() * base;
   }
   else
   {
      const VectorXd dt = ktt.cwiseSqrt().cwiseInverse();
      const MatrixXd A = dt.asDiagonal() * problem.A * dt.asDiagonal();
      const MatrixXd B = dn.asDiagonal() * problem.B * dt.asDiagonal();
      const MatrixXd C = dn.asDiagonal() * problem.C * dn.asDiagonal();
      fs = problem.friction.cwiseProduct(dt.cwiseQuotient(dn));
      const MatrixXd fB = fs.asDiagonal() * B, fC = fs.asDiagonal() * C;
      M << C, B, -B, fC + B.transpose(), fB + A, -fB - A, fC - B.transpose(), fB - A, A - fB;
      const VectorXd bq = dt.asDiagonal() * base.head(n), bp = dn.asDiagonal() * base.tail(n);
      const VectorXd fp = fs.asDiagonal() * bp;
      b << bp, fp + bq, fp - bq;
   }
   // The cover is a loading path: extra pressure z0 at every node, and with it extra strength
   // against slip, fading together. An even cover reaches a solution in 98 of 100 random
   // problems with f up to 3, uneven ones in the rest (20,000 of 20,000). The generator is
   // seeded afresh, so that equal problems take equal paths.
   LemkeReport report;
   std::mt19937_64 random(1);
   for (int trial = 0; trial < (frictionless ? 1 : 60) && !report.solved; ++trial)
   {
      auto uneven = [&]
      { return trial ? std::exp(3 * std::ldexp(double(random() >> 11), -53) - 1.5) : 1; };
      VectorXd cover = VectorXd::Ones(N);
      for (Index i = 0; i < n && !frictionless; ++i)
      {
         cover[i] = uneven();
         cover[n + i] = fs[i] * cover[i] + 2 * uneven();
         cover[2 * n + i] = fs[i] * cover[i] + 2 * uneven();
      }
      report = lemke(M, b, cover, 20 * N);
      counters.lemke_pivots += report.pivots;
   }
   if (!report.solved) { return false; }
   u = base_u;
   for (Index i = 0; i < n; ++i)
   {
      const double y = report.z[i];
      status[i] = y > 0 ? NodeState::separation : NodeState::stick;
      u[m(i)] += scale * dn[i] * y;
      if (frictionless) { continue; }
      const double x = report.z[n + i] - report.z[2 * n + i];
      u[t(i)] += scale / std::sqrt(ktt[i]) * x;
      if (y > 0 || x == 0) { continue; }
      status[i] = x > 0 ? NodeState::forward_slip : NodeState::backward_slip;
   }
   F = f + K * u;
   return true;
}

bool FrictionSolver::Implementation::run_lemke(IncrementReport &report)
{
   return !disc() && lemke_start() && polished(report);
}

/// Pivots leave round-off of their own; the equations of the final states remove it.
bool FrictionSolver::Implementation::polished(IncrementReport &report)
{
   const VectorXd u_found = u, F_found = F;
   const std::vector<NodeState> status_found = status;
   if (newton(settings.max_newton))
   {
      residuals(report);
      if (accepted(report)) { return true; }
   }
   u = u_found;
   F = F_found;
   status = status_found;
   residuals(report);
   return accepted(report);
}

/// Follows the solutions from the old loads to the new ones, in steps that Newton's method can
/// take. Only the guess moves: slip counts from the start of the increment all the way, so that
/// what is found is the answer of the whole increment. Where a step fails, sweeps find the
/// direction in which a node begins to slip: no step is short enough to know it. Extra pressure
/// at the start, which fades on the way, holds the nodes that stand between two states (a
/// contact that carries nothing yet): however short the step, they all change theirs in the
/// first.
bool FrictionSolver::Implementation::run_loading(IncrementReport &report,
                                                 const ContactState &state)
{
   const VectorXd f_new = f;
   for (double extra : {0.0, 0.01, 1.0})
   {
      u << state.v, state.w;
      F << state.q, state.p;
      status = state.status;
      for (Index i = 0; i < n && extra > 0; ++i)
      {
         if (!closed(status[i])) { continue; }
         F[m(i)] += extra * reference;
         status[i] = NodeState::stick;
      }
      const VectorXd f_old = F - K * u;
      double reached = 0, step = 0.5;
      bool failed = false;
      while (reached < 1 && step > 1e-4)
      {
         const VectorXd u_reached = u, F_reached = F;
         const std::vector<NodeState> status_reached = status;
         update_states(); // directions of the solution reached
         const double next = std::min(1.0, reached + step);
         f = next < 1 ? VectorXd((1 - next) * f_old + next * f_new) : f_new;
         if (failed)
         {
            F = f + K * u;
            for (int k = 0; k < std::max(4, 2 * settings.sweeps); ++k) { sweep(); }
            update_states();
         }
         failed = !newton_disc(settings.max_newton);
         if (!failed)
         {
            reached = next;
            step *= 2;
            continue;
         }
         u = u_reached;
         F = F_reached;
         status = status_reached;
         step *= 0.5;
      }
      if (reached < 1) { continue; }
      residuals(report);
      return true; // accepted by newton_disc
   }
   f = f_new;
   F = f + K * u;
   return false;
}

/// Follows the solutions from the old loads to the new ones, one node's state at a time.
bool FrictionSolver::Implementation::run_path(IncrementReport &report,
                                              const ContactState &state)
{
   const Index N = K.rows();
   VectorXd stuck(N), forces(N), friction = problem.friction;
   stuck.tail(n) = -problem.gap;
   forces.tail(n) = state.p;
   if (frictionless) { friction.setZero(); }
   else
   {
      stuck.head(n) = v_old;
      forces.head(n) = state.q;
   }
   ComplementarityProblem increment;
   increment.b = f + K * stuck;
   increment.choice.assign(n, Choice::any);
   VectorXd x = VectorXd::Zero(N);
   x.tail(n) = state.w + problem.gap;
   std::vector<NodeState> states = state.status;
   for (NodeState &s : states)
   {
      if (slips(s)) { s = NodeState::stick; }
   }
   // Small departures follow the physical path; larger ones pass by its dead ends.
   const double slacks[] = {1e-3, 1e-2, 0.1, 1, 10, 1, 0.1, 1};
   unsigned seed = 0;
   for (double slack : slacks)
   {
      StateEquations equations(K, friction);
      if (!equations.set(states)) { states.assign(n, NodeState::stick); }
      const ComplementarityReport path =
         solve_by_path(equations, friction, increment, x, forces, slack, ++seed);
      counters.pivots += path.pivots;
      counters.dense_factorisations += equations.factorisations();
      if (!path.solved) { continue; }
      u = stuck + path.x;
      F = f + K * u;
      status = equations.states();
      if (polished(report)) { return true; }
   }
   return false;
}

bool FrictionSolver::Implementation::run_gauss_seidel(IncrementReport &report)
{
   for (long k = 0; k < settings.max_sweeps; ++k)
   {
      sweep();
      // The forces are updated by columns; now and then they are formed anew, against drift.
      if (k % 64 == 63) { F = f + K * u; }
      residuals(report);
      if (!u.allFinite()) { return false; }
      if (accepted(report))
      {
         F = f + K * u;
         residuals(report);
         if (accepted(report)) { return true; }
      }
   }
   return false;
}

bool FrictionSolver::Implementation::run_automatic(IncrementReport &report,
                                                   const ContactState &state,
                                                   const VectorXd &multipliers)
{
   int sweeps = settings.sweeps;
   auto attempt = [&]
   {
      for (int k = 0; k < sweeps; ++k) { sweep(); }
      const VectorXd u_swept = u;
      const std::vector<NodeState> status_swept = status;
      if (newton(settings.max_newton))
      {
         residuals(report);
         if (accepted(report)) { return true; }
      }
      u = u_swept;
      status = status_swept;
      F = f + K * u;
      sweeps = std::max(4, 2 * sweeps);
      return false;
   };
   for (int k = 0; k < settings.max_attempts; ++k)
   {
      if (attempt()) { return true; }
      if (k == 1 && (spins(multipliers) || finds_mechanism(multipliers))) { return false; }
   }
   if (disc())
   {
      const VectorXd u_swept = u;
      const std::vector<NodeState> status_swept = status;
      if (run_loading(report, state)) { return true; }
      // Sweeps are slow but steady.
      u = u_swept;
      status = status_swept;
      F = f + K * u;
      while (sweeps <= 1024)
      {
         if (attempt()) { return true; }
      }
      return false;
   }
   // Where paths from the old state end in rays, those of the dense tableau may not; its size
   // allows for small problems only.
   return run_path(report, state) || (n <= 32 && run_lemke(report));
}

/// True if no admissible contact forces can balance the loads: there is nothing to search for.
bool FrictionSolver::Implementation::finds_mechanism(const VectorXd &multipliers)
{
   if (!motions)
   {
      motions = std::make_unique<MatrixXd>(rigid_motions(problem));
      ++counters.dense_factorisations;
   }
   mechanism = find_mechanism(problem, *motions, problem.clamped_forces(multipliers));
   return mechanism.exists;
}

/// True if the loads drive a steady rotation.
bool FrictionSolver::Implementation::spins(const VectorXd &multipliers)
{
   if (!disc()) { return false; }
   if (!smooth)
   {
      ReducedProblem without = problem;
      set_friction(without, 0);
      smooth = std::make_unique<FrictionSolver>(without);
   }
   ContactState state = ContactState::virgin(problem);
   if (smooth->solve(state, multipliers).status != FrictionStatus::converged) { return false; }
   mechanism = find_spinning(problem, state.p, problem.clamped_forces(multipliers));
   return mechanism.exists;
}

/// The first node with friction above its critical value, -1 if there is none.
Index FrictionSolver::Implementation::above_critical() const
{
   for (Index i = 0; !frictionless && i < n; ++i)
   {
      if (problem.friction[i] >= critical[i]) { return i; }
   }
   return -1;
}

void FrictionSolver::Implementation::explain_failure(IncrementReport &report) const
{
   std::ostringstream message;
   if (mechanism.exists)
   {
      report.status =
         mechanism.slides ? FrictionStatus::gross_sliding : FrictionStatus::no_solution;
      message << (mechanism.spins
                     ? "the torque exceeds what friction can hold: a body spins about its axis"
                  : mechanism.slides ? "the loads exceed what friction can hold: a body slides"
                                     : "the loads pull the contact apart: a body lifts off");
   }
   else if (const Index node = above_critical(); node >= 0)
   {
      report.status = FrictionStatus::no_solution;
      message << "no equilibrium was found, and there may be none: friction "
              << problem.friction[node] << " at node " << node
              << " is above its critical value " << critical[node];
   }
   else
   {
      report.status = FrictionStatus::stalled;
      residuals(report);
      if (motions && can_lock(problem, *motions))
      {
         message << "no equilibrium was found, and there may be none near the last one: the "
                    "contact can lock itself, and where it loses its grip a body jumps free; ";
      }
      message << "residuals " << report.residual_normal << " (normal) and "
              << report.residual_tangential << " (tangential), tolerance "
              << settings.tolerance;
   }
   report.message = message.str();
}

IncrementReport FrictionSolver::Implementation::solve(ContactState &state,
                                                      const VectorXd &multipliers)
{
   IncrementReport report;
   mechanism = {};
   start(state, multipliers);
   bool solved = false;
   switch (settings.method)
   {
   case FrictionMethod::automatic:
      solved = run_automatic(report, state, multipliers);
      break;
   case FrictionMethod::gauss_seidel:
      solved = run_gauss_seidel(report);
      break;
   case FrictionMethod::lemke:
      solved = run_lemke(report);
      break;
   }
   if (solved && runs_away(report, multipliers)) { solved = false; }
   if (!solved)
   {
      if (!mechanism.exists && !finds_mechanism(multipliers)) { spins(multipliers); }
      explain_failure(report);
      return report;
   }
   finish(state, multipliers);
   const IncrementReport unique = uniqueness(status);
   report.status = unique.status;
   report.message = unique.message;
   return report;
}

IncrementReport
FrictionSolver::Implementation::uniqueness(const std::vector<NodeState> &states) const
{
   IncrementReport report;
   report.status = FrictionStatus::converged;
   for (Index i = 0; !frictionless && i < n; ++i)
   {
      if (closed(states[i]) && problem.friction[i] >= critical[i])
      {
         std::ostringstream message;
         message << "friction " << problem.friction[i] << " at node " << i
                 << " is above its critical value " << critical[i];
         report.status = FrictionStatus::not_unique;
         report.message = message.str();
         break;
      }
   }
   return report;
}

// ------------------------------------------------------------------------------- the class

FrictionSolver::FrictionSolver(const ReducedProblem &problem, const FrictionSettings &settings)
   : impl_(std::make_unique<Implementation>(problem, settings))
{
}
FrictionSolver::~FrictionSolver() = default;
FrictionSolver::FrictionSolver(FrictionSolver &&) noexcept = default;

IncrementReport FrictionSolver::solve(ContactState &state, const VectorXd &multipliers)
{
   return impl_->solve(state, multipliers);
}
const ReducedProblem &FrictionSolver::problem() const
{
   return impl_->problem;
}
bool FrictionSolver::frictionless() const
{
   return impl_->frictionless;
}
bool FrictionSolver::uncoupled() const
{
   return impl_->uncoupled;
}
double FrictionSolver::critical_friction() const
{
   return impl_->critical_friction;
}
Index FrictionSolver::critical_node() const
{
   return impl_->critical_node;
}
IncrementReport FrictionSolver::uniqueness(const std::vector<NodeState> &states) const
{
   return impl_->uniqueness(states);
}
const Counters &FrictionSolver::counters() const
{
   return impl_->counters;
}

} // namespace cattaneo
