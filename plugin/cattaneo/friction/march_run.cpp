#include <algorithm>
#include <cattaneo/friction/advance.hpp>
#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/march_run.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::VectorXd;

namespace
{

/// Largest relative residual with which a state is accepted that could be replaced by another
/// one.
constexpr double known_to = 1e-9;

} // namespace

int steps_of_piece(const MarchSettings &settings, const LoadPiece &piece)
{
   const auto point = static_cast<std::size_t>(piece.point);
   return point < settings.increments_of_piece.size() ? settings.increments_of_piece[point]
                                                      : settings.increments;
}

bool friction_bends(const ReducedProblem &problem)
{
   const std::vector<FrictionBound> bounds = friction_bounds(problem);
   return std::any_of(bounds.begin(), bounds.end(),
                      [](const FrictionBound &of) { return of.bends(); });
}

double SteppedPiece::end_of(double step) const
{
   return step >= steps_ ? loads_.end : loads_.start + loads_.duration() * step / steps_;
}

double SteppedPiece::end_of_step(double time) const
{
   int k = 1;
   while (end_of(k) <= time) { ++k; }
   return end_of(k);
}

VectorXd SteppedPiece::multipliers(double time) const
{
   if (time == loads_.end) { return loads_.to; }
   // Late in a long history the start of a piece takes the last digits of a time, so equal
   // steps are computed from equal shares.
   const double share = (time - loads_.start) / duration(), steps = std::round(share * steps_);
   return loads_.at(time == end_of(steps) ? steps / steps_ : share);
}

double take_up_clearance(const ReducedProblem &problem, const LoadHistory &history,
                         ContactState &state)
{
   const bool virgin = state.time <= history.times[0] && state.multipliers.isZero(0) &&
                       state.peak_force == 0 && state.displacements().isZero(0);
   if (!virgin || problem.rigid_motions.cols() == 0) { return 0; }
   const int points = static_cast<int>(history.times.size());
   for (int k = 0; k + 1 < points; ++k)
   {
      const VectorXd rate = history.multipliers.col(k + 1) - history.multipliers.col(k);
      const auto u = taken_up_clearance(problem, problem.clamped_forces(rate));
      if (!u) { continue; }
      state.v = state.slip_origin = u->head(problem.slips());
      state.w = u->tail(problem.nodes());
      return u->cwiseAbs().maxCoeff();
   }
   return 0;
}

MarchRun::MarchRun(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                   const MarchSettings &settings, const MarchObserver &observer)
   : solver_(solver), problem_(solver.problem()), near_(solver), history_(history),
     state_(state), settings_(settings), friction_bends_(friction_bends(problem_)),
     record_(problem_, state, settings, observer), progress_(settings.monitor),
     began_(state.time), end_(history.piece(history.pieces() - 1).end)
{
}

/// Share of the history, from the start of the march, that is done.
double MarchRun::share() const
{
   return end_ > began_ ? std::min(1.0, (state_.time - began_) / (end_ - began_)) : 1.0;
}

/// `whole`: solved with all nodes, because contact may advance over most of them.
MarchStep MarchRun::attempt(double time, bool whole)
{
   MarchStep trial;
   trial.state = state_;
   trial.state.time = time;
   const VectorXd loads = piece_.multipliers(time);
   trial.increment =
      whole ? solver_.solve(trial.state, loads) : near_.solve(trial.state, loads);
   return trial;
}

void MarchRun::accept(MarchStep &&step)
{
   step.resumes = !path_;
   record_.accept(std::move(step), piece_.loads());
   progress_.note(share(), record_.report.counters.increments, state_.time);
}

/// Called between increments, wherever the march can be resumed.
bool MarchRun::is_stopped()
{
   if (!settings_.monitor.stopped()) { return false; }
   IncrementReport asked;
   asked.status = FrictionStatus::stopped;
   asked.message = "the march was stopped on request";
   record_.stop(asked);
   return true;
}

/// Is there a path from one change of state to the next? Gauss–Seidel sweeps solve increments
/// only.
bool MarchRun::has_path() const
{
   return problem_.components() == 1 &&
          solver_.settings().method != FrictionMethod::gauss_seidel;
}

/// First proportional loading without a gap: everything scales with the load, except pressures
/// at which a law of friction bends.
bool MarchRun::self_similar() const
{
   const bool virgin = state_.v.isZero(0) && state_.q.isZero(0) && state_.p.isZero(0);
   return virgin && problem_.gap.isZero(0) && piece_.loads().from.isZero(0) && !friction_bends_;
}

/// True if one increment gives the exact end of the piece, however long it is.
bool MarchRun::exact_in_one() const
{
   if (!settings_.single_increment_if_exact) { return false; }
   if (solver_.frictionless() || self_similar()) { return true; }
   // Normal loading of an uncoupled contact without shear: nothing ever slips. For two equal
   // bodies round-off leaves a shear of 1e-8 of the pressure.
   if (problem_.coupled || !state_.v.isZero(0)) { return false; }
   const VectorXd f = problem_.clamped_forces(piece_.loads().to);
   const double normal = f.tail(problem_.nodes()).cwiseAbs().maxCoeff();
   return f.head(problem_.slips()).cwiseAbs().maxCoeff() <= 1e-8 * normal &&
          (state_.q.isZero(0) || state_.q.cwiseAbs().maxCoeff() <= 1e-8 * normal);
}

/// If no contact forces balance the loads at `failed`, the loads drive a motion, and their work
/// along it is linear in time. There is no equilibrium from the time at which this work exceeds
/// the work that contact forces can do. Returns the earliest known time of this kind, or
/// `failed`.
double MarchRun::first_unbalanced(double failed) const
{
   const Eigen::Index n = problem_.nodes(), slips = problem_.slips();
   const VectorXd before = problem_.clamped_forces(piece_.multipliers(state_.time));
   // Each motion that is found gives a time closer to the end. Bounds that bend with the
   // pressure may hold more than their lines. With one tangent the path itself finds the end.
   for (int k = 0; k < 20 && !friction_bends_ && problem_.components() == 2; ++k)
   {
      const VectorXd forces = problem_.clamped_forces(piece_.multipliers(failed));
      const Mechanism mechanism = find_mechanism(problem_, forces);
      if (!mechanism.exists) { break; }
      // 1. By round-off contact forces do some work along the motion: the work of one unit of
      // pressure, times the present pressure.
      const VectorXd &motion = mechanism.motion;
      double most = 0;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         double along = 0;
         for (Eigen::Index row = i; row < slips; row += n)
         {
            along = std::hypot(along, motion[row]);
         }
         most = std::max(most, motion[slips + i] + problem_.friction[i] * along);
      }
      const double contact = 10 * most * forces.tail(n).lpNorm<1>();
      // 2. The time at which the work of the loads is as large.
      const double drives = motion.dot(forces) - contact, held = motion.dot(before) - contact;
      if (!(held < 0 && drives > 0)) { break; }
      const double cut = failed - (failed - state_.time) * drives / (drives - held);
      if (!(cut < failed && cut > state_.time)) { break; }
      failed = cut;
   }
   return failed;
}

/// No equilibrium at `failed`: approaches the last load at which there is one.
void MarchRun::bisect_last_equilibrium(double failed, IncrementReport failure)
{
   const double beyond = failed + 1e-6 * piece_.duration(),
                resolution = 1e-10 * piece_.duration();
   if (self_similar()) { failed = state_.time; } // no smaller load has one either
   else if (failure.status == FrictionStatus::stalled && beyond < piece_.end())
   {
      // At the limit itself one or two nodes carry all forces, so the kind of failure shows
      // only beyond it.
      const MarchStep trial = attempt(beyond);
      if (!trial.solved()) { failure = trial.increment; }
   }
   double reached = state_.time; // an equilibrium
   // If it is proven at which load equilibrium ends, each step leaves a hundredth of the
   // remaining load, until the solver fails.
   const double unbalanced = first_unbalanced(failed);
   double left = unbalanced < failed ? 0.01 : 0.5;
   failed = unbalanced;
   while (failed - reached > resolution)
   {
      const double middle = failed - left * (failed - reached);
      if (middle <= reached || middle >= failed) { break; }
      MarchStep trial = attempt(middle);
      if (!trial.solved())
      {
         failed = middle;
         left = 0.5;
         ++record_.report.counters.rejected_increments;
         continue;
      }
      reached = middle;
      // So close to the limit few nodes carry all forces, which may lose digits. Then there is
      // an equilibrium at this load, but its state is no increment of the march. All others are
      // increments, with a row of the history each.
      const IncrementReport &found = trial.increment;
      const double stated =
         std::max({found.residual_normal, found.residual_tangential, found.round_off});
      if (stated <= known_to) { accept(std::move(trial)); }
   }
   record_.stop(failure);
   record_.report.event_time = reached;
   record_.report.event_multipliers = piece_.multipliers(reached);
}

/// One increment towards `target`. It is shortened if the solver stalls, or if contact would
/// advance too far (unless it is `exact`).
bool MarchRun::step_by_increment(double target, bool exact)
{
   const double whole = target - state_.time,
                smallest = piece_.duration() / (exact ? 1 : piece_.steps()) *
                           std::ldexp(1.0, -settings_.max_halvings);
   // 1. A step that had to be cut grows again by doubling.
   if (state_.step > 0 && state_.time + state_.step < target)
   {
      target = state_.time + state_.step;
   }
   // 2. Halve it until it is solved and contact does not advance too far.
   MarchStep trial;
   while (true)
   {
      trial = attempt(target, exact);
      const double step = target - state_.time;
      // If the solver fails at a load, there is often a solution at loads close by.
      const bool stalled = trial.stalled() && step > smallest && !self_similar();
      if (!trial.solved() && !stalled)
      {
         bisect_last_equilibrium(target, trial.increment);
         return false;
      }
      const bool too_far = !stalled && !exact && settings_.stepping == Stepping::exact &&
                           !solver_.frictionless() && step > smallest &&
                           advances_too_far(problem_, state_, trial.state);
      if (!stalled && !too_far) { break; }
      record_.report.stalled += stalled;
      ++record_.report.counters.rejected_increments;
      state_.step = 0.5 * step;
      target = state_.time + state_.step;
   }
   // 3. The state there.
   double &step = trial.state.step;
   step = 2 * state_.step;
   if (step >= piece_.duration() / piece_.steps() && target - state_.time >= whole)
   {
      step = 0;
   }
   trial.exact = exact;
   if (settings_.stepping == Stepping::exact && problem_.components() < 2)
   {
      std::vector<StateChange> changes;
      list_changes(state_, trial.state.status, changes);
      note(changes);
   }
   accept(std::move(trial));
   return true;
}

/// If one increment to `target` would close a node: the time just before the first node closes,
/// up to which the friction of all others is correct, or just after it, if the state is already
/// there. Else `target`.
double MarchRun::first_closing(double target)
{
   const auto closes_by = [&](double time)
   {
      const MarchStep trial = attempt(time);
      return !trial.solved() || closes(problem_, state_, trial.state);
   };
   if (solver_.frictionless()) { return target; }
   const double resolution = 1e-7 * piece_.duration();
   double before = state_.time, after = target, least = target;
   while (least - before > resolution) { least = 0.5 * (before + least); }
   // Often one node touches almost at once, which is found faster than the time for all nodes.
   if (closes_by(least)) { after = least; }
   else if (!closes_by(target)) { return target; }
   else { before = least; }
   while (after - before > resolution)
   {
      const double middle = 0.5 * (before + after);
      (closes_by(middle) ? after : before) = middle;
   }
   return before > state_.time ? before : first_known(after, target);
}

/// The first of several times, each eight times as far ahead as the one before, at which forces
/// are known. Just after a body has crossed a gap they may be lost in the round-off of its
/// displacement.
double MarchRun::first_known(double from, double target)
{
   while (from < target)
   {
      const MarchStep trial = attempt(from);
      if (trial.solved() && trial.increment.round_off <= known_to) { break; }
      from = std::min(target, state_.time + 8 * (from - state_.time));
   }
   return from;
}

/// Begins a path at the state, which an increment first brings to equilibrium if it is not in
/// one. False if that fails.
bool MarchRun::start_path()
{
   if (path_) { return true; }
   path_ = std::make_unique<NearPath>(near_);
   if (path_->starts_from(state_)) { return true; }
   MarchStep trial = attempt(state_.time);
   if (!trial.solved()) { return false; }
   trial.exact = true;
   accept(std::move(trial));
   return true;
}

/// Follows the path to its next event or stop. False, with the reason, if the path does not go
/// on.
bool MarchRun::path_step(std::string &reason)
{
   // 1. The loads' path leads to the end of the piece, and is followed to the next stop.
   const double stop = settings_.every_event ? piece_.end() : piece_.end_of_step(state_.time);
   const VectorXd at_stop = piece_.multipliers(stop);
   std::vector<StateChange> changes;
   MarchStep step;
   step.state = state_;
   step.state.step = 0;
   if (!path_->advance(step.state, {piece_.end(), piece_.loads().to, stop, at_stop}, changes))
   {
      reason = path_->failure();
      return false;
   }
   // 2. The state is judged like any other, however it was found.
   step.increment = solver_.judge(state_, step.state, path_->slip_error());
   if (!step.solved())
   {
      reason = "an event on the path: " + step.increment.message;
      return false;
   }
   // 3. The state becomes that of the march.
   step.increment.found_by = path_->found_by();
   step.exact = true;
   step.row = settings_.every_event || step.state.time >= stop;
   if (settings_.every_event) { step.event = path_->event(); }
   note(changes);
   accept(std::move(step));
   return true;
}

/// Changes of states of nodes in the present state, with which a step begins.
void MarchRun::note(const std::vector<StateChange> &changes)
{
   MarchReport &report = record_.report;
   report.events += static_cast<long>(changes.size());
   if (!settings_.every_event) { return; }
   report.changes.insert(report.changes.end(), changes.begin(), changes.end());
}

/// The path does not go on: is there no equilibrium beyond? This load is then the exact one at
/// which equilibria end, and the march stops at it.
bool MarchRun::equilibria_end()
{
   const double beyond = state_.time + 1e-6 * piece_.duration();
   if (beyond >= piece_.end()) { return false; }
   const MarchStep trial = attempt(beyond);
   if (trial.solved()) { return false; }
   // A search that fails is not a proof: so small a load may be below round-off, and above
   // critical friction a search may miss one. If the path ends and none is found with a larger
   // load either, there is none in between.
   const bool proven =
      trial.increment.status == FrictionStatus::gross_sliding ||
      find_mechanism(problem_, problem_.clamped_forces(piece_.multipliers(beyond))).exists;
   if (!proven && !(path_->ended() && !attempt(piece_.end_of_step(state_.time)).solved()))
   {
      return false;
   }
   record_.stop(trial.increment);
   return true;
}

/// Follows the path from event to event.
bool MarchRun::follow_path()
{
   // 1. The path begins at an equilibrium.
   bool started = start_path();
   // Events without progress: nodes that change their states at the same load, one after the
   // other. More than four events for each node, and 16, mean that the states repeat
   // themselves.
   const long patience = 4 * problem_.nodes() + 16;
   long halted = 0;
   while (state_.time < piece_.end())
   {
      if (!record_.within_row() && is_stopped()) { return false; }
      // 2. One event or stop after the other.
      std::string reason = !started ? "the state at the start is no equilibrium"
                                    : "node states change back and forth at one load";
      const double before = state_.time;
      if (started && halted < patience && path_step(reason))
      {
         halted = state_.time > before ? 0 : halted + 1;
         continue;
      }
      // 3. If the path does not go on, the rest up to the stop may be round-off, …
      const double stop = piece_.end_of_step(state_.time);
      if (stop - state_.time <= 1e-12 * piece_.duration() && stay(stop)) { continue; }
      // 4. … or there may be no equilibrium beyond.
      if (started && equilibria_end()) { return false; }
      // 5. Otherwise one increment is taken, to the stop or to the load at which a node closes
      // first.
      if (!step_by_increment(first_closing(stop), false)) { return false; }
      if (record_.report.fallbacks++ == 0) { record_.report.fallback_reason = reason; }
      halted = 0;
      started = true;
   }
   return true;
}

/// If the loads are constant until a time, an equilibrium is kept as well; slipping nodes go on
/// when the loads change. False if the state is not an equilibrium with these loads.
bool MarchRun::stay(double target)
{
   MarchStep same;
   same.state = state_;
   same.state.time = target;
   same.state.multipliers = piece_.multipliers(target);
   same.increment = solver_.judge(state_, same.state);
   same.increment.found_by = "unchanged";
   same.exact = true;
   if (!same.solved()) { return false; }
   accept(std::move(same));
   return true;
}

bool MarchRun::march_piece()
{
   // 1. Constant loads.
   if (piece_.loads().from == piece_.loads().to && stay(piece_.end())) { return true; }
   // 2. One increment where that is exact.
   const bool exact = exact_in_one();
   // 3. The path, from one change of state to the next.
   if (!exact && settings_.stepping == Stepping::exact && has_path()) { return follow_path(); }
   // 4. Increments where there is none.
   while (state_.time < piece_.end())
   {
      const double target = exact ? piece_.end() : piece_.end_of_step(state_.time);
      if (is_stopped() || !step_by_increment(target, exact)) { return false; }
   }
   return true;
}

/// The present piece begins a cycle, and the state is at its beginning.
void MarchRun::begin_cycle(bool first_piece)
{
   // The first cycle is compared with the state at its start.
   if (piece_.loads().cycle == 1 && (!first_piece || state_.cycle_slip.empty()))
   {
      state_.cycle_slip = {state_.v};
   }
   record_.begin_cycle(piece_.loads().cycle, true);
}

bool MarchRun::march_pieces()
{
   for (int k = 0; k < history_.pieces(); ++k)
   {
      // 1. The next piece that is not behind the state.
      const LoadPiece loads = history_.piece(k);
      if (state_.time >= loads.end) { continue; }
      piece_ = SteppedPiece(loads, steps_of_piece(settings_, loads));
      if (is_stopped()) { return false; }
      // 2. A cycle may begin with it.
      if (loads.begins_cycle && state_.time <= loads.start) { begin_cycle(k == 0); }
      // 3. To its end.
      if (!march_piece()) { return false; }
      // 4. The cycles that are left would be the same.
      if (record_.report.steady_cycle && settings_.stop_at_steady_state) { break; }
   }
   return true;
}

/// For free bodies that touch nothing the first increment can fail, because it begins with
/// rigid motions much larger than all deformations. (If it is found, it includes friction, and
/// nothing is moved.) If it fails, the bodies are moved to where they touch, and the march
/// begins there. False if this does not apply.
bool MarchRun::restart_without_clearance()
{
   const MarchReport &report = record_.report;
   if (report.status != FrictionStatus::stalled || report.counters.increments > 0 ||
       record_.within_row())
   {
      return false;
   }
   state_.step = 0;
   const double moved = take_up_clearance(problem_, history_, state_);
   if (moved == 0) { return false; }
   state_.cycle.reset();
   state_.cycle_slip.clear();
   if (path_) { record_.report.counters += path_->counters(); }
   path_.reset();
   record_.restart();
   record_.report.taken_up_clearance = moved;
   return true;
}

MarchReport MarchRun::run()
{
   // 1. Piece after piece.
   const Counters before = solver_.counters();
   bool finished = march_pieces();
   // 2. The same after the clearance is closed, if it prevented the first increment.
   if (!finished && restart_without_clearance()) { finished = march_pieces(); }
   // 3. The balance, and what was done.
   record_.close();
   MarchReport &report = record_.report;
   report.counters += solver_.counters();
   report.counters -= before;
   report.counters += near_.counters();
   if (path_) { report.counters += path_->counters(); }
   report.seconds = progress_.seconds();
   progress_.end(finished ? 1.0 : share(), report.counters.increments, report.time);
   return report;
}

} // namespace cattaneo
