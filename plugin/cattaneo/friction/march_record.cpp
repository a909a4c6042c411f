#include <algorithm>
#include <cattaneo/friction/advance.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/friction/march_record.hpp>
#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// The slip at which each node last stuck, opened or reversed, see ContactState::slip_origin.
void find_slip_origin(const ContactState &before, ContactState &next)
{
   const auto n = static_cast<Index>(next.status.size());
   for (Index i = 0; i < n; ++i)
   {
      const NodeState then = before.status[i], now = next.status[i];
      double along = 0; // old shear along the new one: negative if slip has reversed
      for (Index k = i; now == NodeState::slip && k < next.q.size(); k += n)
      {
         along += before.q[k] * next.q[k];
      }
      const bool turned = slips(then) && (then != now || along < 0);
      for (Index k = i; k < next.v.size(); k += n)
      {
         if (!slips(now)) { next.slip_origin[k] = next.v[k]; }
         else if (turned) { next.slip_origin[k] = before.v[k]; }
      }
   }
}

} // namespace

IncrementRecord record_of(const ReducedProblem &problem, const ContactState &state)
{
   IncrementRecord record;
   record.time = state.time;
   record.multipliers = state.multipliers;
   record.conjugates = conjugates(problem, state);
   const std::vector<NodeState> settled = settled_states(problem, state);
   const auto count = [&](NodeState of)
   { return static_cast<int>(std::count(settled.begin(), settled.end(), of)); };
   record.stick = count(NodeState::stick);
   record.separation = count(NodeState::separation);
   record.forward_slip =
      count(NodeState::forward_slip) + (problem.components() == 1 ? count(NodeState::slip) : 0);
   record.backward_slip = count(NodeState::backward_slip);
   record.slip = problem.components() == 2 ? count(NodeState::slip) : 0;
   return record;
}

MarchRecord::MarchRecord(const ReducedProblem &problem, ContactState &state,
                         const MarchSettings &settings, const MarchObserver &observer)
   : problem_(problem), state_(state), settings_(settings), observer_(observer)
{
   restart();
}

void MarchRecord::restart()
{
   const Counters counters = report.counters;
   report = {};
   report.counters = counters;
   conjugates_ = conjugates(problem_, state_);
   energy_at_start_ = elastic_energy(problem_, state_);
}

void MarchRecord::begin_cycle(int number, bool whole)
{
   CycleRecord &cycle = state_.cycle.emplace();
   cycle.cycle = number;
   cycle.whole = whole;
   cycle.node_dissipation = VectorXd::Zero(problem_.components() > 0 ? problem_.nodes() : 0);
   for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
   {
      cycle.loops.emplace_back(problem_.patterns[k].control, state_.multipliers[k],
                               conjugates_[k], problem_.knows_loads());
   }
}

double MarchRecord::external_work(const VectorXd &multipliers, const VectorXd &conjugates) const
{
   double sum = 0;
   for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
   {
      Loop way(problem_.patterns[k].control, state_.multipliers[k], conjugates_[k]);
      way.add(multipliers[k], conjugates[k]);
      sum += way.work();
   }
   return sum;
}

/// Adds loss and work of the step to `next` to the sums of the row, the cycle and the march.
/// Returns the loss.
double MarchRecord::add_energies(const ContactState &next, const LoadPiece &piece, bool exact)
{
   const VectorXd lost = frictional_loss(problem_, state_, next),
                  at_end = conjugates(problem_, next);
   const double dissipation = lost.sum(), work = external_work(next.multipliers, at_end),
                normal_work = -0.5 * (state_.p + next.p).dot(next.w - state_.w);
   // 1. Add to the row of the history and, within a cycle, to the record of the state.
   row_.dissipation += dissipation;
   row_.friction_work += friction_work(state_, next);
   row_.external_work += work;
   if (piece.cycle > 0)
   {
      const bool known = state_.cycle && state_.cycle->cycle == piece.cycle;
      if (!known) { begin_cycle(piece.cycle, false); }
      CycleRecord &cycle = *state_.cycle;
      cycle.node_dissipation += lost;
      cycle.dissipation += dissipation;
      cycle.external_work += work;
      cycle.normal_work += normal_work;
      for (std::size_t k = 0; k < cycle.loops.size(); ++k)
      {
         cycle.loops[k].add(next.multipliers[k], at_end[k]);
      }
   }
   // 2. The losses of the march.
   if (piece.end != piece_end_)
   {
      losses_.pieces.push_back(0);
      piece_end_ = piece.end;
   }
   losses_.pieces.back() += dissipation;
   if (losses_.nodes.size() == 0) { losses_.nodes = VectorXd::Zero(lost.size()); }
   losses_.nodes += lost;
   losses_.inexact = losses_.inexact || !exact;
   if (!exact) { changed_ = std::max(changed_, changed_while_closing(problem_, state_, next)); }
   // 3. The balance.
   sums_.external_work += work;
   losses_.most_work = std::max(losses_.most_work, std::abs(sums_.external_work));
   sums_.dissipation += dissipation;
   sums_.normal_work += normal_work;
   // Work is a load times the difference of two displacements, which may both be large.
   sums_.moved += std::abs(work) + dissipation + std::abs(normal_work) +
                  next.multipliers.cwiseAbs().dot(at_end.cwiseAbs());
   conjugates_ = at_end;
   return dissipation;
}

void MarchRecord::accept(MarchStep &&step, const LoadPiece &piece)
{
   // 1. What the step adds to the row that it is a part of.
   ContactState &next = step.state;
   const IncrementReport &increment = step.increment;
   if (!row_begun_) { row_ = {}; }
   row_begun_ = true;
   row_.cycle = piece.cycle;
   row_.resumes = step.resumes;
   row_.event = step.event;
   row_.residual_normal = std::max(row_.residual_normal, increment.residual_normal);
   row_.residual_tangential = std::max(row_.residual_tangential, increment.residual_tangential);
   row_.round_off = std::max(row_.round_off, increment.round_off);
   row_.found_by = increment.found_by;
   report.largest_residual = std::max(
      {report.largest_residual, increment.residual_normal, increment.residual_tangential});
   // Friction above its critical value is noticed in this step. On the exact path the node has
   // closed at the event with which the step began.
   const ContactState &doubtful = step.exact ? state_ : next;
   const NotUnique from{doubtful.time, doubtful.multipliers, increment.message};
   // 2. Energies, which need the previous state.
   find_slip_origin(state_, next);
   next.dissipation += add_energies(next, piece, step.exact);
   if (piece.cycle > 0) { next.cycle = std::move(state_.cycle); }
   else { next.cycle.reset(); }
   // 3. The state.
   state_ = std::move(next);
   find_cut_off();
   if (increment.status == FrictionStatus::not_unique && !report.not_unique)
   {
      report.not_unique = from;
      stop(increment); // the status, which an end of the march may still replace
      report.event_time = from.time;
      report.event_multipliers = from.multipliers;
   }
   // 4. The end of a cycle, and of the row. The observed state is complete: a march that is
   // resumed from it knows this cycle.
   if (piece.ends_cycle && state_.time >= piece.end) { end_cycle(); }
   if (step.row) { end_row(); }
}

/// Adds ends of lines at which contact is cut off for the first time in the present state.
void MarchRecord::find_cut_off()
{
   for (const CutOffContact &found : cut_off_contact(problem_, state_))
   {
      const bool known =
         std::any_of(report.cut_off.begin(), report.cut_off.end(),
                     [&](const CutOffContact &other) { return other.same_place(found); });
      if (!known) { report.cut_off.push_back(found); }
   }
}

/// The steps since the last row make one row.
void MarchRecord::end_row()
{
   IncrementRecord record = record_of(problem_, state_);
   record.cycle = row_.cycle;
   record.dissipation = row_.dissipation;
   record.friction_work = row_.friction_work;
   record.external_work = row_.external_work;
   record.residual_normal = row_.residual_normal;
   record.residual_tangential = row_.residual_tangential;
   record.round_off = row_.round_off;
   record.found_by = row_.found_by;
   record.resumes = row_.resumes;
   record.event = row_.event;
   row_begun_ = false;
   ++report.counters.increments;
   if (settings_.keep_increments) { report.increments.push_back(record); }
   if (observer_) { observer_(state_, record); }
}

void MarchRecord::end_cycle()
{
   auto &past = state_.cycle_slip;
   CycleRecord &cycle = *state_.cycle;
   cycle.slip_change = past.empty() ? 0.0 : (state_.v - past.back()).lpNorm<Eigen::Infinity>();
   past.push_back(state_.v);
   if (past.size() > 3) { past.erase(past.begin()); }
   if (!report.steady_cycle)
   {
      report.steady_period = state_.steady_period(settings_.steady_tolerance);
      if (report.steady_period > 0)
      {
         report.steady_cycle = cycle.cycle - report.steady_period + 1;
      }
   }
   report.cycles.push_back(std::move(cycle));
   state_.cycle.reset();
}

void MarchRecord::stop(const IncrementReport &failure)
{
   report.status = failure.status;
   report.message = failure.message;
   report.event_time = state_.time;
   report.event_multipliers = state_.multipliers;
}

void MarchRecord::close()
{
   // A march that ends between two stops has a row there.
   if (row_begun_) { end_row(); }
   report.time = state_.time;
   if (changed_ > 0) { report.advance_error = 4 * changed_ / state_.peak_force; }
   const double stored = elastic_energy(problem_, state_) - energy_at_start_;
   // If the loads recover all the work that they did, all three are at the end round-off of the
   // work during the march. In a closed elastic cycle they are round-off of the initial energy.
   const double most = std::max({losses_.most_work, std::abs(stored), sums_.dissipation,
                                 1e-6 * std::abs(energy_at_start_)});
   const double left = sums_.external_work - stored - sums_.dissipation - sums_.normal_work;
   // Sums of many terms, each exact to the solver's residual or to rounding.
   const double right_to = std::max(report.largest_residual, 1e-14),
                known_to = right_to * (sums_.moved + std::abs(energy_at_start_));
   if (std::abs(left) > known_to) { report.energy_imbalance = left / most; }
}

} // namespace cattaneo
