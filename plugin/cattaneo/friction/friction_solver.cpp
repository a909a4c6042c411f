#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/friction_implementation.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <utility>

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

FrictionSolver::Implementation::Implementation(const ReducedProblem &given,
                                               const FrictionSettings &chosen,
                                               bool tangential_unknowns)
   : problem(given), settings(chosen), n(given.nodes()),
     frictionless(given.components() == 0 ||
                  (given.friction.maxCoeff() == 0 && !tangential_unknowns)),
     K(frictionless ? normal : problem.K)
{
   settings.validate();
   problem.validate();
   require(problem.components() <= 2, "friction solver: the reduced problem has ",
           problem.components(), " tangential components a node, at most 2 are supported");
   c = frictionless ? 0 : problem.components();
   require(!disc() || settings.method != FrictionMethod::lemke,
           "friction solver: method lemke needs one tangential component a node, the reduced "
           "problem has 2");
   knn = problem.C().diagonal();
   if (frictionless)
   {
      normal = problem.C();
      uncoupled = true;
      if (problem.components() > 0)
      {
         tangential = std::make_unique<SemidefiniteSolver>(problem.A());
         slides_freely = tangential->null_space();
         const bool lengths = problem.weights.size() == n && problem.weights.minCoeff() > 0;
         const VectorXd weight = lengths ? problem.weights : VectorXd::Ones(n);
         const MatrixXd weighted =
            weight.replicate(problem.components(), 1).asDiagonal() * slides_freely;
         if (slides_freely.cols() > 0)
         {
            const MatrixXd square = slides_freely.transpose() * weighted;
            share_of_motion = square.ldlt().solve(weighted.transpose());
         }
         whole_arithmetic = std::make_unique<RoundOff>(problem.K);
         ++counters.dense_factorisations;
         normal -= problem.B() * tangential->solve(problem.B().transpose());
         normal = (0.5 * (normal + normal.transpose())).eval();
         knn = K.diagonal();
      }
   }
   else
   {
      counters.tangential_unknowns = c * n;
      ktt = problem.A().diagonal().head(n);
      ktn = problem.B().diagonal();
      uncoupled = !problem.coupled;
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
   // Without friction what little is left of K where a body is free to slide away up a slope is
   // round-off of C.
   arithmetic = std::make_unique<RoundOff>(problem.K.bottomRightCorner(K.rows(), K.rows()));
}

void FrictionSolver::Implementation::start(const ContactState &state,
                                           const VectorXd &multipliers)
{
   const VectorXd clamped = problem.clamped_forces(multipliers);
   v_old = state.v;
   status = state.status;
   reference = std::max(state.peak_force, clamped.cwiseAbs().maxCoeff());
   // Initial interference loads the contact too.
   reference = std::max(reference, (-problem.gap.array() * knn.array()).maxCoeff());
   if (!frictionless)
   {
      f = clamped;
      u.resize((c + 1) * n);
      u << state.v, state.w;
   }
   else
   {
      f = clamped.tail(n);
      if (tangential) { f -= problem.B() * tangential->solve(clamped.head(problem.slips())); }
      u = state.w;
   }
   for (Index i = 0; i < n; ++i)
   {
      if (closed(status[i])) { u[m(i)] = -problem.gap[i]; }
   }
   if (!frictionless && state.peak_force > 0)
   {
      // The state of an increment before: where sweeps begin; what is accepted is formed anew.
      F.resize(f.size());
      F << state.q, state.p;
      F -= problem.clamped_forces(state.multipliers);
   }
   else { F = K * u; }
   // So does initial slip; slip that displacements elsewhere follow does not.
   reference = std::max(reference, F.cwiseAbs().maxCoeff());
   F += f;
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
      const VectorXd clamped = problem.clamped_forces(multipliers).head(problem.slips());
      const VectorXd before = state.v;
      state.v = -tangential->solve(problem.B().transpose() * state.w + clamped);
      // What nothing holds has not moved on the whole, as the contact's length goes.
      if (slides_freely.cols() > 0)
      {
         const VectorXd moved = state.v - before;
         state.v -= slides_freely * (share_of_motion * moved);
      }
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

/// Of a solution: false where it moves so far that its forces cannot be told from round-off,
/// which is remembered.
bool FrictionSolver::Implementation::accepted(const IncrementReport &report)
{
   if (report.round_off < 1e-6) { return true; }
   // Above that, a residual within round-off shows nothing.
   if (report.round_off < 0.1) { lost_in_round_off = report.round_off; }
   return false;
}

/// The last word on a solution, in the equations and with the state as they are given, and what
/// is reported of it.
bool FrictionSolver::Implementation::obeys_laws(const ContactState &next,
                                                IncrementReport &report) const
{
   const double scale = reference > 0 ? reference : 1.0;
   // With the tangential displacements also where they were eliminated: what slips without
   // friction may go far, and bears on the pressure.
   VectorXd all(next.v.size() + n);
   all << next.v, next.w;
   const VectorXd clamped = problem.clamped_forces(next.multipliers);
   const VectorXd forces = clamped + (tangential ? problem.K : K) * all;
   const VectorXd rows =
      (tangential ? whole_arithmetic : arithmetic)->rows(all.cwiseAbs(), clamped);
   report.round_off = std::max(report.round_off, rows.maxCoeff() / scale);
   if (!(report.round_off < 1e-6)) { return false; }
   const LawCheck check =
      check_laws(problem, v_old, next, forces, settings.tolerance * scale, rows);
   report.residual_normal = check.normal / scale;
   report.residual_tangential = check.tangential / scale;
   return check.obeyed;
}

/// Displacements so large that round-off hides the forces may be a body that slides away, with
/// an imbalance that no residual shows, or one that nothing holds and that could as well stay.
bool FrictionSolver::Implementation::runs_away(const IncrementReport &report,
                                               const ContactState &state,
                                               const VectorXd &multipliers)
{
   return report.round_off > may_hide_sliding &&
          (finds_mechanism(multipliers) || moves_away(state, multipliers) || at_rest);
}

bool FrictionSolver::Implementation::run_automatic(IncrementReport &report,
                                                   const ContactState &state,
                                                   const VectorXd &multipliers)
{
   VectorXd u_swept;
   std::vector<NodeState> status_swept;
   auto finds = [&](auto &&method)
   {
      if (method()) { return true; }
      u = u_swept;
      status = status_swept;
      F = f + K * u;
      return false;
   };
   int sweeps = settings.sweeps;
   for (int k = 0; k < settings.max_attempts; ++k)
   {
      for (int j = 0; j < sweeps; ++j) { sweep(); }
      u_swept = u;
      status_swept = status;
      if (finds([&] { return newton_accepted(report); })) { return true; }
      if (k == 1 && finds_mechanism(multipliers)) { return false; }
      sweeps = std::max(4, 2 * sweeps);
   }
   if (!disc() && finds([&] { return run_path(report, state); })) { return true; }
   if (brief) { return false; }
   // A body that drifts away hardly has an equilibrium elsewhere: it is not looked for as long.
   const bool away = moves_away(state, multipliers);
   if (!away && rested && finds([&] { return settles(report); })) { return true; }
   if (!away && at_rest) { return false; } // see solve()
   const double operations = away ? 2e8 : 3e9;
   if (!frictionless && finds([&] { return run_damped_newton(report, state, operations); }))
   {
      return true;
   }
   // Where these fail, the dense tableau may not; its size allows for small problems only.
   return !away && n <= 32 && finds([&] { return run_lemke(report); });
}

/// From what weak springs hold to an answer without them.
bool FrictionSolver::Implementation::settles(IncrementReport &report)
{
   if (frictionless) { u = rested->w; }
   else { u << rested->v, rested->w; }
   status = rested->status;
   F = f + K * u;
   return newton_accepted(report);
}

/// Found once an increment.
bool FrictionSolver::Implementation::moves_away(const ContactState &state,
                                                const VectorXd &multipliers)
{
   if (!away)
   {
      const bool moves = !brief && (drifts(state, multipliers) || spins(multipliers));
      away = moves ? mechanism : Mechanism{};
   }
   mechanism = *away;
   return away->exists;
}

void FrictionSolver::Implementation::find_motions()
{
   if (motions) { return; }
   motions = std::make_unique<MatrixXd>(rigid_motions(problem));
   if (!problem.rigid_motions) { ++counters.dense_factorisations; }
}

/// True if no admissible contact forces can balance the loads: there is nothing to search for.
bool FrictionSolver::Implementation::finds_mechanism(const VectorXd &multipliers)
{
   find_motions();
   mechanism = find_mechanism(problem, *motions, problem.clamped_forces(multipliers),
                              settings.tolerance * reference);
   return mechanism.exists;
}

/// Holds the rigid motions by weak springs, ever weaker ones, each fixed where the one before
/// let the bodies go. True if a body moves on and on: the force that they bear stays the same.
/// Else what they hold is near an answer without them, or, where they bear nothing, is one (a
/// pivot, balanced so that only round-off would decide which way it leans, stays where it is).
bool FrictionSolver::Implementation::drifts(const ContactState &state,
                                            const VectorXd &multipliers)
{
   find_motions();
   if (motions->cols() == 0) { return false; }
   const MatrixXd &Z = *motions;
   const Index along = problem.slips(), components = problem.components();
   const auto count = static_cast<Index>(problem.patterns.size());
   mechanism = {};
   VectorXd own(along + n), borne;
   own << problem.A().diagonal(), problem.C().diagonal();
   const double soft = own.minCoeff(), mean = own.mean();
   // Weak against the softest node and felt by the stiffest, or they prove nothing.
   // Above critical friction a body that slides may as well lock itself.
   const bool tell = soft > 1e-6 * own.maxCoeff() && above_critical() < 0;
   VectorXd anchor(along + n);
   anchor << state.v, state.w;
   VectorXd loads(count + 1);
   loads << multipliers, 1;
   ContactState begin = state;
   begin.multipliers.conservativeResize(count + 1);
   begin.multipliers[count] = 1;
   int alike = 0; // springs in a row that bore the same as the one before
   for (double weakness : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
   {
      const double spring = weakness * (tell ? soft : mean);
      if (spring < 1e-13 * own.maxCoeff()) { break; } // round-off
      ReducedProblem held = problem;
      held.K += spring * Z * Z.transpose();
      complete(held);
      const VectorXd pull = -spring * Z * (Z.transpose() * anchor);
      held.patterns.push_back({"springs", Control::force, pull.head(along), pull.tail(n)});
      held.H.conservativeResizeLike(MatrixXd::Zero(count + 1, count + 1));
      held.rigid_motions = MatrixXd(along + n, 0);
      held.chains.clear();
      held.held.clear();
      FrictionSolver solver(held, settings);
      solver.impl_->brief = true;
      ContactState next = begin;
      const IncrementReport report = solver.solve(next, loads);
      counters += solver.counters();
      if (report.status != FrictionStatus::converged &&
          report.status != FrictionStatus::not_unique)
      {
         if (alike > 0) { break; }
         borne.resize(0);
         continue;
      }
      mechanism = {};
      VectorXd u_next(along + n);
      u_next << next.v, next.w;
      const VectorXd bears = spring * Z * (Z.transpose() * (u_next - anchor));
      anchor = u_next;
      const double size = bears.cwiseAbs().maxCoeff();
      rested = next;
      rested->multipliers = multipliers;
      rested->peak_force = reference;
      at_rest = size <= settings.tolerance * reference;
      if (at_rest) { return false; }
      const VectorXd before = std::exchange(borne, bears);
      if (!tell || before.size() == 0 || size <= 1e-9 * reference ||
          (bears - before).cwiseAbs().maxCoeff() > 0.01 * size)
      {
         alike = 0;
         continue;
      }
      ++alike;
      mechanism.motion = bears / size;
      for (Index i = 0; i < n; ++i)
      {
         if (!closed(next.status[i])) { continue; }
         for (Index k = 0; k < components; ++k)
         {
            const bool slips = std::abs(mechanism.motion[k * n + i]) > 1e-6;
            mechanism.slides = mechanism.slides || slips;
            mechanism.spins = mechanism.spins || (k == 1 && slips);
         }
      }
   }
   // What opens everywhere is for find_mechanism() to prove: a spring may hold a body before it
   // touches.
   mechanism.exists = mechanism.slides && alike > 1;
   return mechanism.exists;
}

/// True if the loads drive a steady rotation, which friction in the disc can hide from the
/// springs above.
bool FrictionSolver::Implementation::spins(const VectorXd &multipliers)
{
   if (!disc() || problem.friction.maxCoeff() == 0) { return false; }
   find_motions();
   if (motions->cols() == 0) { return false; }
   if (!smooth)
   {
      ReducedProblem without = problem;
      set_friction(without, 0);
      // It could not bear the torque.
      const MatrixXd Z = SemidefiniteSolver(problem.A()).null_space();
      for (LoadPattern &pattern : without.patterns)
      {
         pattern.q -= Z * (Z.transpose() * pattern.q);
      }
      smooth = std::make_unique<FrictionSolver>(without);
   }
   ContactState state = ContactState::virgin(problem);
   if (smooth->solve(state, multipliers).status != FrictionStatus::converged) { return false; }
   mechanism = find_spinning(problem, state.p, problem.clamped_forces(multipliers),
                             settings.tolerance * reference);
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
   else if (lost_in_round_off > 0)
   {
      report.status = FrictionStatus::stalled;
      message << "the contact moves so far that its forces are lost in round-off ("
              << lost_in_round_off << " of the largest)";
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
      message << "no equilibrium was found";
      if (motions && can_lock(problem, *motions))
      {
         message
            << ", and there may be none near the last one: the contact can lock itself, and "
               "where it loses its grip a body jumps free";
      }
      message << "; residuals " << report.residual_normal << " (normal) and "
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
   lost_in_round_off = 0;
   away.reset();
   rested.reset();
   at_rest = false;
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
   if (solved && runs_away(report, state, multipliers)) { solved = false; }
   ContactState next = state;
   if (solved)
   {
      finish(next, multipliers);
      solved = obeys_laws(next, report);
      if (!solved && refined())
      {
         next = state;
         finish(next, multipliers);
         solved = obeys_laws(next, report);
      }
      if (report.round_off >= 1e-6) { lost_in_round_off = report.round_off; }
      // What is eliminated has moved far: it is not left to round-off.
      if (tangential && report.round_off > may_hide_sliding) { solved = false; }
   }
   if (!solved && !mechanism.exists && !finds_mechanism(multipliers))
   {
      if (tangential && !brief) { return solve_whole(state, multipliers); }
      if (!moves_away(state, multipliers) && at_rest)
      {
         next = *rested;
         u << next.v, next.w;
         status = next.status;
         report = {};
         solved = obeys_laws(next, report);
      }
   }
   if (!solved)
   {
      explain_failure(report);
      return report;
   }
   mechanism = {};
   state = std::move(next);
   const IncrementReport unique = uniqueness(status);
   report.status = unique.status;
   report.message = unique.message;
   return report;
}

/// A frictionless contact whose tangential unknowns cost too many digits to be eliminated: a
/// free body on a line that is nearly straight.
IncrementReport FrictionSolver::Implementation::solve_whole(ContactState &state,
                                                            const VectorXd &multipliers)
{
   if (!slippery)
   {
      slippery = std::make_unique<Implementation>(problem, settings, true);
      counters += slippery->counters;
   }
   const Counters before = slippery->counters;
   const IncrementReport report = slippery->solve(state, multipliers);
   counters += slippery->counters;
   counters -= before;
   return report;
}

IncrementReport FrictionSolver::Implementation::judge(const ContactState &before,
                                                      const ContactState &after)
{
   const VectorXd clamped = problem.clamped_forces(after.multipliers);
   v_old = before.v;
   reference = std::max({before.peak_force, after.peak_force, clamped.cwiseAbs().maxCoeff()});
   IncrementReport report = uniqueness(after.status);
   const bool obeyed = obeys_laws(after, report);
   std::ostringstream message;
   if (!(report.round_off < 1e-6))
   {
      message << "the forces of the state are lost in round-off (" << report.round_off
              << " of the largest)";
   }
   else if (!obeyed)
   {
      message << "the state breaks the equations or the laws by "
              << std::max(report.residual_normal, report.residual_tangential)
              << " of the largest force";
   }
   if (!message.str().empty())
   {
      report.status = FrictionStatus::stalled;
      report.message = message.str();
   }
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
IncrementReport FrictionSolver::judge(const ContactState &before, const ContactState &after)
{
   return impl_->judge(before, after);
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
