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

/// Where each node last stuck, opened or turned round, see ContactState::slip_origin.
void find_slip_origin(const ContactState &before, ContactState &next)
{
   const auto n = static_cast<Index>(next.status.size());
   for (Index i = 0; i < n; ++i)
   {
      const NodeState then = before.status[i], now = next.status[i];
      double along = 0; // old shear along the new: negative if slip has turned round
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
   : problem_(problem), state_(state), settings_(settings), observer_(observer),
     conjugates_(conjugates(problem, state)), energy_at_start_(elastic_energy(problem, state))
{
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

double MarchRecord::external_work(const IncrementRecord &record) const
{
   double sum = 0;
   for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
   {
      Loop way(problem_.patterns[k].control, state_.multipliers[k], conjugates_[k]);
      way.add(record.multipliers[k], record.conjugates[k]);
      sum += way.work();
   }
   return sum;
}

void MarchRecord::accept(ContactState &&next, const LoadPiece &piece,
                         const IncrementReport &increment, bool exact, bool resumes,
                         Index event)
{
   find_slip_origin(state_, next);
   IncrementRecord record = record_of(problem_, next);
   record.cycle = piece.cycle;
   record.resumes = resumes;
   record.event = event;
   record.residual_normal = increment.residual_normal;
   record.residual_tangential = increment.residual_tangential;
   record.round_off = increment.round_off;
   record.found_by = increment.found_by;
   // On the exact path a node closes at the event that its piece begins with, and is found to
   // have too much friction within it.
   const NotUnique doubtful = exact
                                 ? NotUnique{state_.time, state_.multipliers, increment.message}
                                 : NotUnique{next.time, next.multipliers, increment.message};
   const VectorXd lost = frictional_loss(problem_, state_, next);
   record.dissipation = lost.sum();
   record.external_work = external_work(record);
   const double normal_work = -0.5 * (state_.p + next.p).dot(next.w - state_.w);
   next.cycle.reset();
   if (piece.cycle > 0)
   {
      const bool known = state_.cycle && state_.cycle->cycle == piece.cycle;
      if (!known) { begin_cycle(piece.cycle, false); }
      next.cycle = std::move(state_.cycle);
      CycleRecord &cycle = *next.cycle;
      cycle.node_dissipation += lost;
      cycle.dissipation += record.dissipation;
      cycle.external_work += record.external_work;
      cycle.normal_work += normal_work;
      for (std::size_t k = 0; k < cycle.loops.size(); ++k)
      {
         cycle.loops[k].add(record.multipliers[k], record.conjugates[k]);
      }
   }
   if (piece.end != piece_end_)
   {
      piece_losses_.push_back(0);
      piece_end_ = piece.end;
   }
   piece_losses_.back() += record.dissipation;
   if (node_losses_.size() == 0) { node_losses_ = VectorXd::Zero(lost.size()); }
   node_losses_ += lost;
   inexact_ = inexact_ || !exact;
   if (!exact) { changed_ = std::max(changed_, changed_while_closing(problem_, state_, next)); }
   external_work_ += record.external_work;
   most_work_ = std::max(most_work_, std::abs(external_work_));
   dissipation_ += record.dissipation;
   normal_work_ += normal_work;
   // Work is a load times the difference of two places, which may lie far away.
   moved_energy_ += std::abs(record.external_work) + record.dissipation +
                    std::abs(normal_work) +
                    record.multipliers.cwiseAbs().dot(record.conjugates.cwiseAbs());
   next.dissipation += record.dissipation;
   state_ = std::move(next);
   conjugates_ = record.conjugates;
   if (settings_.keep_increments) { report.increments.push_back(record); }
   for (const CutOffContact &found : cut_off_contact(problem_, state_))
   {
      const bool known =
         std::any_of(report.cut_off.begin(), report.cut_off.end(),
                     [&](const CutOffContact &other)
                     { return other.node == found.node && other.at_first == found.at_first; });
      if (!known) { report.cut_off.push_back(found); }
   }
   report.largest_residual =
      std::max({report.largest_residual, record.residual_normal, record.residual_tangential});
   ++report.counters.increments;
   if (increment.status == FrictionStatus::not_unique && !report.not_unique)
   {
      report.not_unique = doubtful;
      stop(increment); // the status, which an end of the march may still replace
      report.event_time = doubtful.time;
      report.event_multipliers = doubtful.multipliers;
   }
   // What is observed is whole: a march that is taken up from it knows of this cycle.
   if (piece.ends_cycle && state_.time >= piece.end) { end_cycle(); }
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
   report.time = state_.time;
   if (changed_ > 0) { report.advance_error = 4 * changed_ / state_.peak_force; }
   const double stored = elastic_energy(problem_, state_) - energy_at_start_;
   // Where the loads give back what they had put in, all three at the end are round-off of the
   // work on the way; of a closed elastic cycle of the energy that it began with.
   const double most =
      std::max({most_work_, std::abs(stored), dissipation_, 1e-6 * std::abs(energy_at_start_)});
   const double left = external_work_ - stored - dissipation_ - normal_work_;
   // Sums of so many terms, each right to the solver's residual or to rounding.
   const double right_to = std::max(report.largest_residual, 1e-14),
                known_to = right_to * (moved_energy_ + std::abs(energy_at_start_));
   if (std::abs(left) > known_to) { report.energy_imbalance = left / most; }
}

} // namespace cattaneo
