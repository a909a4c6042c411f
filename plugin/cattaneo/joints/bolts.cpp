#include <algorithm>
#include <atomic>
#include <cattaneo/friction/loop.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

/// A part of the march in which the same bolts are shanks: a piece of the opening part, or all
/// after the last tightening.
struct BoltedJoint::Part
{
   std::vector<bool> shanks; ///< of each bolt: does its shank act?
   ReducedProblem problem;   ///< of these
   LoadHistory history;      ///< multipliers of the other bolts are forces
   ContactState start;       ///< of this problem
};

namespace
{

ReducedProblem problem_of(Reduction reduction, const std::vector<Bolt> &bolts,
                          const std::vector<bool> &shanks,
                          const std::function<void(Reduction &)> &complete)
{
   for (std::size_t b = 0; b < bolts.size(); ++b)
   {
      if (shanks[b]) { reduction.add_shank(bolts[b].load, bolts[b].stiffness); }
   }
   if (complete) { complete(reduction); }
   return std::move(reduction.problem);
}

/// The report of a march joined with that of the march that continued from its state.
MarchReport joined(const MarchReport &first, MarchReport then)
{
   const auto put_before = [](auto &list, const auto &before)
   { list.insert(list.begin(), before.begin(), before.end()); };
   put_before(then.increments, first.increments);
   put_before(then.changes, first.changes);
   put_before(then.cut_off, first.cut_off);
   if (first.not_unique) { then.not_unique = first.not_unique; }
   if (then.fallbacks == 0) { then.fallback_reason = first.fallback_reason; }
   then.events += first.events;
   then.fallbacks += first.fallbacks;
   then.stalled += first.stalled;
   then.loss_error.value += first.loss_error.value;
   then.loss_error.bound = then.loss_error.bound && first.loss_error.bound;
   then.loss_error.counters += first.loss_error.counters;
   then.energy_imbalance = std::max(first.energy_imbalance, then.energy_imbalance);
   then.advance_error = std::max(first.advance_error, then.advance_error);
   then.largest_residual = std::max(first.largest_residual, then.largest_residual);
   then.taken_up_clearance = std::max(first.taken_up_clearance, then.taken_up_clearance);
   then.counters += first.counters;
   then.seconds += first.seconds;
   return then;
}

/// The report of a march that has not begun. Later reports are joined to it.
MarchReport nothing_yet(double time)
{
   MarchReport report;
   report.time = time;
   report.loss_error.value = 0;
   report.loss_error.bound = true;
   return report;
}

/// A straight path from the loads of one state to those of another.
LoadHistory way(double from, const VectorXd &first, double to, const VectorXd &last)
{
   LoadHistory history;
   history.times = Eigen::Vector2d(from, to);
   history.multipliers.resize(first.size(), 2);
   history.multipliers << first, last;
   history.cycles = 1;
   return history;
}

} // namespace

BoltedJoint::BoltedJoint(Reduction loose, std::vector<Bolt> bolts,
                         std::function<void(Reduction &)> complete)
   : loose_(std::move(loose)), bolts_(std::move(bolts)), complete_(std::move(complete)),
     problem_(problem_of(loose_, bolts_, std::vector<bool>(bolts_.size(), true), complete_))
{
}

Reduction BoltedJoint::tightened() const
{
   Reduction made = loose_;
   for (const Bolt &bolt : bolts_) { made.add_shank(bolt.load, bolt.stiffness); }
   if (complete_) { complete_(made); }
   return made;
}

Index BoltedJoint::load(std::size_t bolt) const
{
   return problem_.pattern(bolts_[bolt].load);
}

/// How far the ends of each bolt have come together.
VectorXd BoltedJoint::approaches(const ReducedProblem &problem, const ContactState &state) const
{
   const VectorXd all = conjugates(problem, state);
   VectorXd found(bolts_.size());
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      found[static_cast<Index>(b)] = all[load(b)];
   }
   return found;
}

VectorXd BoltedJoint::forces(const ContactState &state) const
{
   VectorXd found = approaches(problem_, state);
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      double &its = found[static_cast<Index>(b)];
      its = state.multipliers[load(b)] - bolts_[b].stiffness * its;
   }
   return found;
}

bool BoltedJoint::tightens(std::size_t bolt, const LoadHistory &history,
                           const LoadPiece &piece) const
{
   const Index k = load(bolt);
   // A bolt that was never tightened and is named with a force of zero remains loose.
   const bool none = piece.from[k] == 0 && piece.to[k] == 0;
   return piece.from[k] != piece.to[k] || (!none && history.states(piece.point + 1, k));
}

/// The last piece of the history in which a bolt is tightened. InputError: see march().
int BoltedJoint::last_tightening(const LoadHistory &history) const
{
   history.validate(problem_);
   int last = -1;
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      const auto forces = history.multipliers.row(load(b));
      const std::string where = "history: the bolt '" + bolts_[b].load + "' ";
      require(forces.minCoeff() >= 0, where, "is tightened to ", forces.minCoeff(),
              ", must not be negative");
      require(forces[0] == 0, where, "is ", forces[0], " at the first point, must be 0");
      bool named = false;
      for (int point = 1; point < forces.size(); ++point)
      {
         named = named || history.states(point, load(b));
      }
      require(forces.maxCoeff() > 0 || (named && history.cycle_start < 0), where,
              "is never tightened: a point must name it, as '", bolts_[b].load,
              "=1', or it must be left out",
              history.cycle_start < 0 ? " (or a point must name it, as '" + bolts_[b].load +
                                           "=0', if a later march that continues from this "
                                           "state tightens it)"
                                      : "");
      if (forces.maxCoeff() == 0)
      {
         last = history.pieces() - 1; // all parts of the history are without it
         continue;
      }
      require(forces[forces.size() - 1] > 0, where,
              "is loosened at the last point, must be tightened there");
      for (int k = 0; k < history.pieces(); ++k)
      {
         const LoadPiece piece = history.piece(k);
         if (!tightens(b, history, piece)) { continue; }
         require(piece.cycle == 0, where,
                 piece.from[load(b)] != piece.to[load(b)] ? "changes its preload" : "is named",
                 " within the cycle, at point ", piece.point + 1,
                 " (from 0), and would be tightened again in each cycle: it must be tightened "
                 "before the cycle, and the points of the cycle must leave it out");
         last = std::max(last, k);
      }
   }
   return last;
}

/// A piece of the first part of the history, in which bolts are tightened, or the rest of the
/// piece after the time of the state.
BoltedJoint::Part BoltedJoint::part(const LoadHistory &history, const LoadPiece &piece,
                                    const ContactState &state) const
{
   Part made;
   made.start = state;
   const double from = std::max(piece.start, state.time),
                share = (from - piece.start) / piece.duration();
   VectorXd first = share > 0 ? piece.at(share) : piece.from, last = piece.to;
   const VectorXd now = forces(state);
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      const Index k = load(b);
      const bool turned = tightens(b, history, piece);
      made.shanks.push_back(piece.from[k] > 0 && !turned);
      if (made.shanks[b]) { first[k] = last[k] = state.multipliers[k]; }
      else
      {
         // A bolt that is not tightened yet has a force of exactly zero.
         const bool begins = piece.from[k] == 0 && share == 0;
         first[k] = begins || !turned ? 0 : now[static_cast<Index>(b)];
         made.start.multipliers[k] = first[k];
      }
   }
   made.history = way(from, first, piece.end, last);
   made.problem = problem_of(loose_, bolts_, made.shanks, complete_);
   return made;
}

/// Number of the first shank that pushes by more than round-off. The number of shanks if none
/// does.
std::size_t BoltedJoint::pushing(const Part &part, const ContactState &state) const
{
   const VectorXd now = approaches(part.problem, state);
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      if (!part.shanks[b]) { continue; }
      const double pretension = state.multipliers[load(b)],
                   given = bolts_[b].stiffness * now[static_cast<Index>(b)];
      if (pretension - given < -1e-9 * std::abs(pretension)) { return b; }
   }
   return bolts_.size();
}

/// Goes to the load at which the force of a bolt is zero, between a state in which it pulls and
/// one in which it pushes. Uses regula falsi over the share of the path (Illinois).
void BoltedJoint::go_back(const Part &part, const ContactState &before,
                          const ContactState &beyond, std::size_t bolt,
                          const MarchSettings &settings, ContactState &state) const
{
   const auto force = [&](const ContactState &at)
   {
      return at.multipliers[load(bolt)] -
             bolts_[bolt].stiffness * approaches(part.problem, at)[static_cast<Index>(bolt)];
   };
   MarchSettings quiet = settings;
   quiet.monitor = {};
   quiet.loss_error = false;
   quiet.increments = 1;
   quiet.increments_of_piece.clear();
   double low = 0, high = 1, at_low = force(before), at_high = force(beyond);
   const double small = 1e-10 * std::abs(before.multipliers[load(bolt)]);
   state = before;
   int side = 0; // side of zero on which the last force was
   for (int k = 0; k < 100 && force(state) > small; ++k)
   {
      const double share = low + (high - low) * at_low / (at_low - at_high),
                   time = before.time + share * (beyond.time - before.time);
      if (time <= before.time || time >= beyond.time) { return; }
      ContactState tried = before;
      const VectorXd loads =
         before.multipliers + share * (beyond.multipliers - before.multipliers);
      const LoadHistory there = way(before.time, before.multipliers, time, loads);
      if (cattaneo::march(part.problem, there, tried, quiet).status !=
          FrictionStatus::converged)
      {
         return;
      }
      const double found = force(tried);
      const bool pulls = found >= -small;
      if (pulls) { state = tried; }
      (pulls ? low : high) = share;
      (pulls ? at_low : at_high) = found;
      // An end that is kept a second time counts half (Illinois).
      if (side == (pulls ? 1 : -1)) { (pulls ? at_high : at_low) *= 0.5; }
      side = pulls ? 1 : -1;
   }
}

/// march() of the problem of one part. The observer gets states of problem().
MarchReport BoltedJoint::march(const Part &part, ContactState &state,
                               const MarchSettings &settings,
                               const MarchObserver &observer) const
{
   const auto told = [&](ContactState reached)
   {
      const VectorXd g = approaches(part.problem, reached);
      for (std::size_t b = 0; b < bolts_.size(); ++b)
      {
         if (part.shanks[b]) { continue; }
         reached.multipliers[load(b)] += bolts_[b].stiffness * g[static_cast<Index>(b)];
      }
      return reached;
   };
   std::atomic<bool> stop{settings.monitor.stopped()};
   MarchSettings own = settings;
   own.monitor.stop = &stop;
   own.keep_increments = false;
   std::vector<IncrementRecord> kept;
   ContactState reached = part.start, before = reached, beyond;
   std::size_t pushes = bolts_.size();
   MarchReport report =
      cattaneo::march(part.problem, part.history, reached, own,
                      [&](const ContactState &at, const IncrementRecord &record)
                      {
                         if (settings.monitor.stopped()) { stop = true; }
                         if (pushes < bolts_.size()) { return; }
                         pushes = pushing(part, at);
                         if (pushes < bolts_.size())
                         {
                            beyond = at;
                            stop = true;
                            return;
                         }
                         before = at;
                         const ContactState made = told(at);
                         IncrementRecord its = record;
                         its.multipliers = made.multipliers;
                         its.conjugates = conjugates(problem_, made);
                         if (settings.keep_increments) { kept.push_back(its); }
                         if (observer) { observer(made, its); }
                      });
   report.increments = std::move(kept);
   if (pushes < bolts_.size())
   {
      go_back(part, before, beyond, pushes, settings, reached);
      report.status = FrictionStatus::stopped;
      report.message = "the bolt '" + bolts_[pushes].load +
                       "' has no tension left and would be compressed, where a real bolt "
                       "becomes loose";
      report.time = report.event_time = reached.time;
      report.event_multipliers = reached.multipliers;
   }
   state = told(reached);
   return report;
}

MarchReport BoltedJoint::march(const LoadHistory &history, ContactState &state,
                               const MarchSettings &settings,
                               const MarchObserver &observer) const
{
   const int last = last_tightening(history);
   MarchReport report = nothing_yet(state.time);
   // 1. March piece by piece as long as bolts are tightened.
   for (int k = 0; k <= last; ++k)
   {
      const LoadPiece piece = history.piece(k);
      if (state.time >= piece.end) { continue; }
      MarchSettings of_piece = settings;
      of_piece.increments_of_piece.clear();
      if (static_cast<std::size_t>(piece.point) < settings.increments_of_piece.size())
      {
         of_piece.increments = settings.increments_of_piece[piece.point];
      }
      report = joined(report, march(part(history, piece, state), state, of_piece, observer));
      if (report.status != FrictionStatus::converged) { return report; }
   }
   // 2. March the rest, in which all bolts are shanks.
   Part rest{std::vector<bool>(bolts_.size(), true), problem_, history, state};
   for (std::size_t b = 0; b < bolts_.size(); ++b)
   {
      rest.history.multipliers.row(load(b)).setConstant(state.multipliers[load(b)]);
   }
   if (state.time >= history.piece(history.pieces() - 1).end) { return report; }
   return joined(report, march(rest, state, settings, observer));
}

} // namespace cattaneo
