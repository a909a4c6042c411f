#include <algorithm>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/input_error.hpp>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

void MarchSettings::validate() const
{
   friction.validate();
   require(increments >= 1, "march settings: increments is ", increments,
           ", must be at least 1");
   for (int count : increments_of_piece)
   {
      require(count >= 1, "march settings: increments_of_piece has ", count,
              ", must be at least 1");
   }
   require(max_halvings >= 0, "march settings: max_halvings is ", max_halvings,
           ", must not be negative");
   require(steady_tolerance >= 0, "march settings: steady_tolerance is ", steady_tolerance,
           ", must not be negative");
}

namespace
{

VectorXd displacements(const ContactState &state)
{
   VectorXd u(state.v.size() + state.w.size());
   u << state.v, state.w;
   return u;
}

VectorXd pattern_forces(const LoadPattern &pattern)
{
   VectorXd f(pattern.q.size() + pattern.p.size());
   f << pattern.q, pattern.p;
   return f;
}

/// What each load pattern meets: the displacement of a force, the reaction of a prescribed
/// displacement.
VectorXd conjugates(const ReducedProblem &problem, const ContactState &state)
{
   VectorXd g = problem.H * state.multipliers;
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      const double work = pattern.q.dot(state.v) + pattern.p.dot(state.w);
      g[k] += pattern.control == Control::force ? -work : work;
   }
   return g;
}

/// Forces of a state that is handed out where another could be chosen, over the largest.
constexpr double known_to = 1e-9;

bool solved(const IncrementReport &increment)
{
   return increment.status == FrictionStatus::converged ||
          increment.status == FrictionStatus::not_unique;
}

/// True if a node closes and bears. One that only comes to touch, as where a body rocks until
/// it does, has had no friction on its way: the forces are those of an open node.
bool closes(const ReducedProblem &problem, const ContactState &before,
            const ContactState &after)
{
   const std::vector<NodeState> settled = settled_states(problem, after);
   for (std::size_t i = 0; i < settled.size(); ++i)
   {
      if (closed(settled[i]) && !closed(before.status[i])) { return true; }
   }
   return false;
}

/// One march in progress.
class March
{
public:
   March(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
         const MarchSettings &settings, const MarchObserver &observer)
      : solver_(solver), problem_(solver.problem()), history_(history), state_(state),
        settings_(settings), observer_(observer)
   {
   }

   MarchReport run();

private:
   bool march_piece(int piece);
   bool march_exactly(int piece, double until);
   bool follows_closing(const ContactState &next) const;
   bool increment_to(int piece, double target, bool exact);
   double first_closing(int piece, double target);
   double changed_while_closing(const ContactState &next) const;
   int increments(int piece) const;
   void stop(const IncrementReport &failure);
   bool exact_in_one(int piece) const;
   bool advances_too_far(const ContactState &next) const;
   double grid_time(int piece, double step) const;
   VectorXd loads(int piece, double time) const;
   void accept(ContactState &&next, int piece, const IncrementReport &increment, bool exact);
   void end_cycle();
   void bisect_event(int piece, double failed, IncrementReport failure);

   FrictionSolver &solver_;
   const ReducedProblem &problem_;
   const LoadHistory &history_;
   ContactState &state_;
   const MarchSettings &settings_;
   const MarchObserver &observer_;
   MarchReport report_;
   CycleRecord cycle_;
   std::unique_ptr<ExactPath> path_; // made when first needed
   bool following_ = false;          // march_exactly() is at work
   double external_work_ = 0, dissipation_ = 0, normal_work_ = 0;
   double changed_ = 0; // see changed_while_closing()
};

/// End of an equal step of a piece.
double March::grid_time(int piece, double step) const
{
   const double t0 = history_.start_time(piece), t1 = history_.end_time(piece);
   const int count = increments(piece);
   return step >= count ? t1 : t0 + (t1 - t0) * step / count;
}

VectorXd March::loads(int piece, double time) const
{
   const double t0 = history_.start_time(piece), t1 = history_.end_time(piece);
   if (time == t1) { return history_.end(piece); }
   // Late in a long history t0 hides the last digits of a time; equal steps have equal shares.
   const int count = increments(piece);
   const double share = (time - t0) / (t1 - t0), steps = std::round(share * count);
   const double fraction = time == grid_time(piece, steps) ? steps / count : share;
   return history_.start(piece) + fraction * (history_.end(piece) - history_.start(piece));
}

/// True where one increment gives the exact end of a piece, however long it is.
bool March::exact_in_one(int piece) const
{
   if (!settings_.single_increment_if_exact) { return false; }
   if (solver_.frictionless()) { return true; }
   // Self-similar: first proportional loading, no gap: everything scales with the load.
   const bool virgin = state_.v.isZero(0) && state_.q.isZero(0) && state_.p.isZero(0);
   if (virgin && problem_.gap.isZero(0) && history_.start(piece).isZero(0)) { return true; }
   // Normal loading of an uncoupled contact that carries no shear: nothing ever slips. Shear of
   // 1e-8 of the pressure is what round-off leaves of two equal bodies.
   if (!solver_.uncoupled() || !state_.v.isZero(0)) { return false; }
   const VectorXd f = problem_.clamped_forces(history_.end(piece));
   const double normal = f.tail(problem_.nodes()).cwiseAbs().maxCoeff();
   return f.head(problem_.slips()).cwiseAbs().maxCoeff() <= 1e-8 * normal &&
          (state_.q.isZero(0) || state_.q.cwiseAbs().maxCoeff() <= 1e-8 * normal);
}

bool March::advances_too_far(const ContactState &next) const
{
   if (settings_.stepping == Stepping::fixed || solver_.frictionless()) { return false; }
   for (const ContactChain &chain : problem_.chains)
   {
      const Index first = chain.first, count = chain.nodes;
      const auto was_closed = [&](Index k)
      {
         if (chain.loop) { k = (k + count) % count; }
         return k >= 0 && k < count && closed(state_.status[first + k]);
      };
      bool bore = false;
      Index low = count, high = -1, alone = 0; // newly closed, without a closed neighbour
      for (Index k = 0; k < count; ++k)
      {
         bore = bore || was_closed(k);
         if (!closed(next.status[first + k]) || was_closed(k) || was_closed(k - 1) ||
             was_closed(k + 1))
         {
            continue;
         }
         low = std::min(low, k);
         high = k;
         ++alone;
      }
      const bool beside = high == low + 1 || (chain.loop && high - low == count - 1);
      if (alone > 0 && (bore || alone > 2 || (alone == 2 && !beside))) { return true; }
   }
   return false;
}

/// Friction acts on a node from the beginning of the increment in which it closes, not from
/// where it does: what friction forces change by in that increment may be wrong, and stays.
double March::changed_while_closing(const ContactState &next) const
{
   if (solver_.frictionless() || !closes(problem_, state_, next)) { return 0; }
   double most = 0;
   const Index n = problem_.nodes();
   for (Index i = 0; i < n; ++i)
   {
      double change = 0;
      for (Index k = i; k < next.q.size(); k += n)
      {
         change = std::hypot(change, next.q[k] - state_.q[k]);
      }
      most = std::max(most, change);
   }
   return most;
}

/// `exact`: by the exact path, or by one increment where that is exact.
void March::accept(ContactState &&next, int piece, const IncrementReport &increment, bool exact)
{
   IncrementRecord record;
   record.time = next.time;
   record.cycle = history_.cycle(piece);
   record.residual_normal = increment.residual_normal;
   record.residual_tangential = increment.residual_tangential;
   record.round_off = increment.round_off;
   const Index n = problem_.nodes();
   for (Index i = 0; i < n; ++i)
   {
      const NodeState before = state_.status[i], now = next.status[i];
      double along = 0; // old shear along the new: negative if slip has turned round
      for (Index k = i; now == NodeState::slip && k < next.q.size(); k += n)
      {
         along += state_.q[k] * next.q[k];
      }
      const bool turned = slips(before) && (before != now || along < 0);
      for (Index k = i; k < next.v.size(); k += n)
      {
         if (!slips(now)) { next.slip_origin[k] = next.v[k]; }
         else if (turned) { next.slip_origin[k] = state_.v[k]; }
      }
   }
   for (NodeState s : settled_states(problem_, next))
   {
      switch (s)
      {
      case NodeState::stick:
         ++record.stick;
         break;
      case NodeState::separation:
         ++record.separation;
         break;
      case NodeState::forward_slip:
         ++record.forward_slip;
         break;
      case NodeState::backward_slip:
         ++record.backward_slip;
         break;
      case NodeState::slip:
         ++record.slip;
         break;
      }
   }
   const VectorXd lost = frictional_loss(problem_, state_, next);
   const double normal_work = -0.5 * (state_.p + next.p).dot(next.w - state_.w);
   record.dissipation = lost.sum();
   const VectorXd g0 = conjugates(problem_, state_), g1 = conjugates(problem_, next);
   for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
   {
      const double mean = 0.5 * (state_.multipliers[k] + next.multipliers[k]);
      record.external_work +=
         problem_.patterns[k].control == Control::force
            ? mean * (g1[k] - g0[k])
            : 0.5 * (g0[k] + g1[k]) * (next.multipliers[k] - state_.multipliers[k]);
   }
   if (record.cycle > 0)
   {
      if (cycle_.node_dissipation.size() == 0)
      {
         cycle_.node_dissipation = VectorXd::Zero(lost.size());
      }
      cycle_.node_dissipation += lost;
      cycle_.dissipation += record.dissipation;
      cycle_.external_work += record.external_work;
      cycle_.normal_work += normal_work;
   }
   if (!exact) { changed_ = std::max(changed_, changed_while_closing(next)); }
   external_work_ += record.external_work;
   dissipation_ += record.dissipation;
   normal_work_ += normal_work;
   next.dissipation += record.dissipation;
   state_ = std::move(next);
   report_.increments.push_back(record);
   for (const CutOffContact &found : cut_off_contact(problem_, state_))
   {
      const bool known =
         std::any_of(report_.cut_off.begin(), report_.cut_off.end(),
                     [&](const CutOffContact &other)
                     { return other.node == found.node && other.at_first == found.at_first; });
      if (!known) { report_.cut_off.push_back(found); }
   }
   report_.largest_residual =
      std::max({report_.largest_residual, record.residual_normal, record.residual_tangential});
   ++report_.counters.increments;
   if (increment.status == FrictionStatus::not_unique && !report_.not_unique)
   {
      report_.not_unique = {state_.time, state_.multipliers, increment.message};
      stop(increment); // the status, which an end of the march may still replace
   }
   if (observer_) { observer_(state_, record); }
}

/// No equilibrium at `failed`: approaches the last load at which there is one.
void March::bisect_event(int piece, double failed, IncrementReport failure)
{
   const double duration = history_.end_time(piece) - history_.start_time(piece);
   const double beyond = failed + 1e-6 * duration, resolution = 1e-10 * duration;
   if (failure.status == FrictionStatus::stalled && beyond < history_.end_time(piece))
   {
      // At the limit itself a node or two carry everything: what happens there shows beyond.
      ContactState next = state_;
      next.time = beyond;
      const IncrementReport increment = solver_.solve(next, loads(piece, beyond));
      if (!solved(increment)) { failure = increment; }
   }
   double reached = state_.time; // an equilibrium
   while (failed - reached > resolution)
   {
      ContactState next = state_;
      next.time = 0.5 * (reached + failed);
      if (next.time <= reached || next.time >= failed) { break; }
      const IncrementReport increment = solver_.solve(next, loads(piece, next.time));
      if (!solved(increment))
      {
         failed = next.time;
         ++report_.counters.rejected_increments;
         continue;
      }
      reached = next.time;
      // So near to the limit few nodes hold everything, and forces lose digits: such a load is
      // known to have an equilibrium, but that is not handed out.
      const double stated = std::max(
         {increment.residual_normal, increment.residual_tangential, increment.round_off});
      if (stated <= known_to) { accept(std::move(next), piece, increment, false); }
   }
   stop(failure);
   report_.event_time = reached;
   report_.event_multipliers = loads(piece, reached);
}

/// The state stands at the last load with an equilibrium.
void March::stop(const IncrementReport &failure)
{
   report_.status = failure.status;
   report_.message = failure.message;
   report_.event_time = state_.time;
   report_.event_multipliers = state_.multipliers;
}

int March::increments(int piece) const
{
   const auto point = static_cast<std::size_t>(history_.point(piece));
   return point < settings_.increments_of_piece.size() ? settings_.increments_of_piece[point]
                                                       : settings_.increments;
}

/// One increment towards `target`, a shorter one where contact would advance too far or the
/// solver does not finish; `exact` ones are not cut. False, with the march stopped, where there
/// is no equilibrium.
bool March::increment_to(int piece, double target, bool exact)
{
   const double whole = target - state_.time,
                duration = history_.end_time(piece) - history_.start_time(piece),
                smallest = duration / (exact ? 1 : increments(piece)) *
                           std::ldexp(1.0, -settings_.max_halvings);
   // A step that had to be cut grows again by doubling.
   if (state_.step > 0 && state_.time + state_.step < target)
   {
      target = state_.time + state_.step;
   }
   ContactState next;
   IncrementReport increment;
   while (true)
   {
      next = state_;
      next.time = target;
      increment = solver_.solve(next, loads(piece, target));
      const double step = target - state_.time;
      // The loads next to one that the solver cannot finish are often no trouble.
      const bool stalled = increment.status == FrictionStatus::stalled && step > smallest;
      if (!solved(increment) && !stalled)
      {
         bisect_event(piece, target, increment);
         return false;
      }
      if (!stalled && !exact && !following_ && follows_closing(next))
      {
         return march_exactly(piece, target);
      }
      if (!stalled && (exact || step <= smallest || !advances_too_far(next))) { break; }
      report_.stalled += stalled;
      ++report_.counters.rejected_increments;
      state_.step = 0.5 * step;
      target = state_.time + state_.step;
   }
   next.step = state_.step > 0 ? 2 * state_.step : 0;
   if (next.step >= duration / increments(piece) && target - state_.time >= whole)
   {
      next.step = 0;
   }
   if (exact && settings_.stepping == Stepping::exact)
   {
      for (Index i = 0; i < problem_.nodes(); ++i)
      {
         if (next.status[i] == state_.status[i]) { continue; }
         report_.changes.push_back(
            {state_.time, state_.multipliers, i, state_.status[i], next.status[i]});
      }
   }
   accept(std::move(next), piece, increment, exact);
   return true;
}

/// Where one increment to `target` would close a node: the time just before the first one
/// closes, to which the friction of all others can be followed, or just after it, if the state
/// stands there. Else `target`.
double March::first_closing(int piece, double target)
{
   const auto closes_by = [&](double time)
   {
      ContactState next = state_;
      return !solved(solver_.solve(next, loads(piece, time))) || closes(problem_, state_, next);
   };
   if (solver_.frictionless() || !closes_by(target)) { return target; }
   const double resolution = 1e-7 * (history_.end_time(piece) - history_.start_time(piece));
   double before = state_.time, after = target;
   while (after - before > resolution)
   {
      const double middle = 0.5 * (before + after);
      (closes_by(middle) ? after : before) = middle;
   }
   if (before > state_.time) { return before; }
   // So soon after a body has crossed a gap its forces may be lost in the round-off of its way.
   const auto known = [&](double time)
   {
      ContactState next = state_;
      const IncrementReport increment = solver_.solve(next, loads(piece, time));
      return solved(increment) && increment.round_off <= known_to;
   };
   while (after < target && !known(after))
   {
      after = std::min(target, state_.time + 8 * (after - state_.time));
   }
   return after;
}

/// Friction acts on a node from where it closes, not from the beginning of the increment, and
/// where its pressure comes others slip or stick anew: the exact path knows when.
bool March::follows_closing(const ContactState &next) const
{
   return settings_.stepping != Stepping::fixed && !solver_.frictionless() &&
          problem_.components() == 1 && closes(problem_, state_, next);
}

/// From event to event.
bool March::march_exactly(int piece, double until)
{
   const double t0 = history_.start_time(piece), t1 = history_.end_time(piece);
   bool settled = true;
   // What increments come to must not depend on paths that were followed before.
   if (!path_ || settings_.stepping != Stepping::exact)
   {
      if (path_) { report_.counters += path_->counters(); }
      path_ = std::make_unique<ExactPath>(problem_);
      settled = path_->starts_from(state_);
      ContactState next = state_;
      if (!settled)
      {
         const IncrementReport increment = solver_.solve(next, loads(piece, state_.time));
         settled = solved(increment);
         if (settled) { accept(std::move(next), piece, increment, true); }
      }
   }
   // Events without progress: nodes that change their states at the same load, one after the
   // other. More than there are nodes and states go round in a circle.
   const long patience = 4 * problem_.nodes() + 16;
   long halted = 0;
   std::vector<StateChange> unlisted;
   std::vector<StateChange> &changes =
      settings_.stepping == Stepping::exact ? report_.changes : unlisted;
   const VectorXd loads_then = loads(piece, until);
   while (state_.time < until)
   {
      ContactState next = state_;
      next.step = 0;
      std::string reason = !settled ? "the state at the start is no equilibrium"
                                    : "states change back and forth at one load";
      if (settled && halted < patience)
      {
         const std::size_t listed = changes.size();
         if (path_->advance(next, until, loads_then, changes))
         {
            // However a state was found, it is judged like any other.
            const IncrementReport reached = solver_.judge(state_, next);
            if (solved(reached))
            {
               halted = next.time > state_.time ? 0 : halted + 1;
               accept(std::move(next), piece, reached, true);
               continue;
            }
            changes.resize(listed);
            reason = "an event on the path: " + reached.message;
         }
         else { reason = path_->failure(); }
      }
      // No rates are an answer if there is no equilibrium at any load beyond; this load is then
      // the exact one.
      next = state_;
      next.time = state_.time + 1e-6 * (t1 - t0);
      if (settled && next.time < until)
      {
         const IncrementReport increment = solver_.solve(next, loads(piece, next.time));
         // A stall is no proof: so small a load can be hidden in round-off.
         if (!solved(increment) && increment.status != FrictionStatus::stalled)
         {
            stop(increment);
            return false;
         }
      }
      double target = until;
      for (int k = increments(piece) - 1; k > 0; --k)
      {
         const double grid = grid_time(piece, k);
         if (grid > state_.time && grid < target) { target = grid; }
      }
      following_ = true;
      const bool taken = increment_to(piece, first_closing(piece, target), false);
      following_ = false;
      if (!taken) { return false; }
      if (report_.fallbacks++ == 0) { report_.fallback_reason = reason; }
      halted = 0;
      settled = true;
   }
   return true;
}

bool March::march_piece(int piece)
{
   const double t1 = history_.end_time(piece);
   if (history_.start(piece) == history_.end(piece))
   {
      // Nothing happens to an equilibrium: what slips goes on to when the loads do.
      ContactState same = state_;
      same.time = t1;
      same.multipliers = history_.end(piece);
      const IncrementReport held = solver_.judge(state_, same);
      if (solved(held))
      {
         accept(std::move(same), piece, held, true);
         return true;
      }
   }
   const bool exact = exact_in_one(piece);
   if (!exact && settings_.stepping == Stepping::exact)
   {
      if (problem_.components() == 1) { return march_exactly(piece, t1); }
      ++report_.fallbacks;
      report_.fallback_reason = "slip has a direction: two tangential components";
   }
   const int count = exact ? 1 : increments(piece);
   int k = 1;
   while (state_.time < t1)
   {
      const auto grid = [&] { return k >= count ? t1 : grid_time(piece, k); };
      while (grid() <= state_.time) { ++k; }
      if (!increment_to(piece, grid(), exact)) { return false; }
   }
   return true;
}

void March::end_cycle()
{
   auto change = [&](const VectorXd &v)
   { return v.size() ? (state_.v - v).cwiseAbs().maxCoeff() : 0.0; };
   auto &past = state_.cycle_slip;
   for (std::size_t period = 1; period <= past.size() && !report_.steady_cycle; ++period)
   {
      const VectorXd &before = past[past.size() - period];
      const double scale = std::max(state_.v.size() ? state_.v.cwiseAbs().maxCoeff() : 0.0,
                                    before.size() ? before.cwiseAbs().maxCoeff() : 0.0);
      if (change(before) <= settings_.steady_tolerance * scale)
      {
         report_.steady_cycle = report_.increments.back().cycle - static_cast<int>(period) + 1;
         report_.steady_period = static_cast<int>(period);
      }
   }
   cycle_.slip_change = past.empty() ? 0.0 : change(past.back());
   report_.cycles.push_back(cycle_);
   cycle_ = {};
   past.push_back(state_.v);
   if (past.size() > 2) { past.erase(past.begin()); }
}

MarchReport March::run()
{
   const auto began = std::chrono::steady_clock::now();
   settings_.validate();
   state_.validate(problem_);
   history_.validate(static_cast<int>(problem_.patterns.size()));
   const Counters before = solver_.counters();
   const double energy = elastic_energy(problem_, state_);
   if (history_.cycle_start >= 0 && state_.cycle_slip.empty() &&
       state_.time <= history_.times[history_.cycle_start] && history_.cycle_start == 0)
   {
      state_.cycle_slip.push_back(state_.v);
   }
   for (int piece = 0; piece < history_.segments(); ++piece)
   {
      if (state_.time >= history_.end_time(piece)) { continue; }
      const bool marched = march_piece(piece);
      if (!marched) { break; }
      // The first cycle is compared with the state at its start.
      if (piece + 1 == history_.cycle_start) { state_.cycle_slip = {state_.v}; }
      if (history_.ends_cycle(piece))
      {
         end_cycle();
         if (report_.steady_cycle && settings_.stop_at_steady_state) { break; }
      }
   }
   report_.time = state_.time;
   if (changed_ > 0) { report_.advance_error = 4 * changed_ / state_.peak_force; }
   const double stored = elastic_energy(problem_, state_) - energy;
   // Work that is negative is no more than what was stored.
   const double largest = std::max({external_work_, std::abs(stored), dissipation_});
   if (largest > 0)
   {
      report_.energy_imbalance =
         (external_work_ - stored - dissipation_ - normal_work_) / largest;
   }
   report_.counters += solver_.counters();
   report_.counters -= before;
   if (path_) { report_.counters += path_->counters(); }
   report_.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
   return report_;
}

} // namespace

VectorXd frictional_loss(const ReducedProblem &problem, const ContactState &before,
                         const ContactState &after)
{
   const Index n = problem.nodes(), c = problem.components();
   VectorXd lost = VectorXd::Zero(c > 0 ? n : 0);
   for (Index i = 0; i < lost.size(); ++i)
   {
      const FrictionBound bound(problem.friction[i]);
      const double g1 = bound.at(after.p[i]);
      double g0 = bound.at(before.p[i]), length = 0, along = 0;
      for (Index k = i; k < c * n; k += n)
      {
         const double step = after.v[k] - before.v[k];
         length = k == i ? std::abs(step) : std::hypot(length, step);
         along += before.q[k] * after.q[k];
      }
      if (length == 0) { continue; }
      if (slips(before.status[i]) && slips(after.status[i]) && along < 0)
      {
         // |q0 + s (trial - q0)|² = (g0 + s (g1 - g0))², g the bounds: the root in 0…1 beyond
         // s = 0, where friction was exhausted the other way.
         double a = -(g1 - g0) * (g1 - g0), b = -2 * g0 * (g1 - g0);
         for (Index k = i; k < c * n; k += n)
         {
            const double trial = after.q[k] - problem.A()(k, k) * (after.v[k] - before.v[k]);
            const double way = trial - before.q[k];
            a += way * way;
            b += 2 * before.q[k] * way;
         }
         const double turn = a > 0 ? std::clamp(-b / a, 0.0, 1.0) : 0.0;
         g0 += turn * (g1 - g0);
      }
      lost[i] = 0.5 * (g0 + g1) * length;
   }
   return lost;
}

double elastic_energy(const ReducedProblem &problem, const ContactState &state)
{
   const VectorXd u = displacements(state);
   double energy = 0.5 * u.dot(problem.K * u);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const Control control = problem.patterns[k].control;
      // Forces store energy in the clamped bodies, apart from that of u; prescribed
      // displacements also work with u.
      if (control == Control::displacement)
      {
         energy += state.multipliers[k] * pattern_forces(problem.patterns[k]).dot(u);
      }
      for (std::size_t l = 0; l < problem.patterns.size(); ++l)
      {
         if (problem.patterns[l].control != control) { continue; }
         energy += 0.5 * state.multipliers[k] * problem.H(k, l) * state.multipliers[l];
      }
   }
   return energy;
}

MarchReport march(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                  const MarchSettings &settings, const MarchObserver &observer)
{
   return March(solver, history, state, settings, observer).run();
}

MarchReport march(const ReducedProblem &problem, const LoadHistory &history,
                  ContactState &state, const MarchSettings &settings,
                  const MarchObserver &observer)
{
   FrictionSolver solver(problem, settings.friction);
   const Counters made = solver.counters();
   MarchReport report = march(solver, history, state, settings, observer);
   report.counters += made;
   return report;
}

} // namespace cattaneo
