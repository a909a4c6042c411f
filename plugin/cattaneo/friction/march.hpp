#pragma once

#include <cattaneo/friction/cut_off.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/load_history.hpp>
#include <cattaneo/monitor.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace cattaneo
{

/// How a piece of the load history is marched.
enum class Stepping
{
   /// Equal increments, for comparison, but only one where that is exact: a first proportional
   /// loading without a gap (self-similar, unless a law of friction bends with pressure), and
   /// any piece without friction.
   fixed,
   /** From one change of state to the next, exactly. The increments are stops: the states there
       are recorded, whatever number of changes lies between. Pieces that one increment solves
       exactly take that one. If the path cannot be continued, the march ends if there is no
       equilibrium beyond. Otherwise an increment is taken instead, to the next stop or to the
       load at which a node closes first. The report has the number of such increments, and the
       reason. A state that is no equilibrium (an initial slip, an interference) is brought to
       equilibrium by an increment first.

       With two tangential components there is no such path, and FrictionMethod::gauss_seidel
       knows none. Equal increments are taken, halved while contact advances by more than one
       layer of nodes: each newly closed node must have had a closed neighbour on its chain, or,
       on a chain without contact so far, be the first to close, alone or beside another. */
   exact
};

/// How a history is marched. The defaults need no tuning.
struct MarchSettings
{
   FrictionSettings friction;            ///< of every increment
   int increments = 20;                  ///< increments of each piece of the history
   std::vector<int> increments_of_piece; ///< increments of each piece, in place of `increments`
   Stepping stepping = Stepping::exact;  ///< how their ends are reached
   /// false: take all increments even if a single one is exact
   bool single_increment_if_exact = true;
   /// Increments end at the events of an exact path, not at stops. The observer and the report
   /// get the states there, and MarchReport::changes lists the changes with which the next
   /// steps begin. Otherwise events are only counted.
   bool every_event = false;
   /// Halvings of an increment, if contact advances or no solution is found
   int max_halvings = 12;
   bool stop_at_steady_state = true; ///< ends the march at a steady state, because the
                                     ///< remaining cycles would be the same
   /// A cycle is steady if the slip at its end differs from that one or two cycles before by
   /// less than this share of the largest slip of the history.
   double steady_tolerance = 1e-10;
   /// Keep every IncrementRecord in the report. Otherwise only the observer gets them, so that
   /// the report of millions of increments stays small.
   bool keep_increments = true;
   /// If increments are taken that are not exact, march again to estimate the error of their
   /// loss, see MarchReport::loss_error. The second march follows the exact path; if there is
   /// none, two marches take half and a quarter of the increments. This may take as long as the
   /// march itself.
   bool loss_error = false;
   Monitor monitor; ///< is called with the progress, and may stop the march

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// One accepted increment; on an exact path the part from one stop to the next.
struct IncrementRecord
{
   double time = 0;             ///< at its end
   int cycle = 0;               ///< 0: opening part
   Eigen::VectorXd multipliers; ///< of the load patterns, at its end
   Eigen::VectorXd conjugates;  ///< of these: displacement or reaction, see conjugates()
   int stick = 0;               ///< number of nodes that stick, of settled_states()
   int separation = 0;          ///< … that are open
   int forward_slip = 0;        ///< … that slip forward, or in no direction
   int backward_slip = 0;       ///< … that slip backward
   int slip = 0; ///< with two tangential components: nodes that slip in any direction
   /// Energy lost by friction, ½ f (p₀ + p₁)|Δv| of each node, which causes wear. Never
   /// negative.
   double dissipation = 0;
   /// -½(q₀ + q₁)·Δv of all nodes: with the other works it balances the energy to round-off. On
   /// an exact path it is the dissipation. With two tangents it is smaller, by the second order
   /// of the increment, if the direction of slip turns within the increment.
   double friction_work = 0;
   /// Work of the loads by trapezoids (exact for linear increments, and on an exact path). If H
   /// is not known, only that of the contact's part of the conjugates.
   double external_work = 0;
   /// See IncrementReport; the largest within the increment, also below
   double residual_normal = 0;
   double residual_tangential = 0; ///< see IncrementReport
   double round_off = 0;           ///< see IncrementReport
   /// The method that found it: one of IncrementReport's, or that of the exact path ("event
   /// path", and how its rates were found if not by Newton), or "unchanged" if the loads stay.
   const char *found_by = "";
   /// True: a march that is resumed from this state has the same bits. False within an exact
   /// path, where it is the same to round-off.
   bool resumes = true;
   /// Node that comes to the boundary of its state, or to a bend of its law, where the
   /// increment ends, see MarchSettings::every_event. In this row it still has its old state;
   /// the next step begins with the new one. The loads are those at which it gets there. -1:
   /// there is no such node, and the loads are those of the history at the row's time.
   Eigen::Index event = -1;
};

/// The entries that follow from a state alone: time, multipliers, conjugates and numbers of
/// nodes.
IncrementRecord record_of(const ReducedProblem &problem, const ContactState &state);

/// The first state of a march that may not be unique: from here on there may be other states.
struct NotUnique
{
   double time = 0;             ///< of the load history
   Eigen::VectorXd multipliers; ///< of the load patterns
   std::string message;         ///< the node and its friction
};

/** Error of the loss of a march by increments, compared with that of its exact path: of the
    whole loss, and of the loss of each cycle.

    Increments know the path only at their ends. A node that reverses or comes to rest within
    one slips in one direction only. This changes the loss in first order of the increments, but
    the balance of energy in second order, so that MarchReport::energy_imbalance does not
    measure it. */
struct LossError
{
   /// The error, in the unit of the loss, at least 0. NaN: it was not requested, or not found.
   double value = std::numeric_limits<double>::quiet_NaN();
   /// True: the value is the difference from the exact path, which was followed from the same
   /// state: a bound, to round-off. False: an estimate, by two marches with other increments.
   bool bound = false;
   /// The loss of this march without increments, by extrapolation, where it holds: thirty nodes
   /// or more share the loss, and its changes from march to march fall in one ratio (0.15 to
   /// 0.65; increments of each piece are a multiple of four, or fewer than four). NaN: it does
   /// not, or the value is a bound.
   double extrapolated = std::numeric_limits<double>::quiet_NaN();
   std::string
      by; ///< what was marched for comparison, or why the error is not known; one sentence
   Counters counters; ///< of the march for comparison; not included in those of the report
};

/// The result of a march.
struct MarchReport
{
   FrictionStatus status = FrictionStatus::converged; ///< of the whole march
   std::string message;                               ///< one sentence, empty if converged
   double time = 0;                                   ///< reached
   /// Where the outcome is not `converged`: time and load multipliers at which it occurred. If
   /// an exact path ends they are exact, those of its last event, and the state is that
   /// event's. After an increment that failed they are those of the last equilibrium, found by
   /// bisection; the state is the last one whose forces are known to 1e-9. In a first
   /// proportional loading without a gap no load has an equilibrium then, and they are those of
   /// its start. `not_unique` does not end a march: they are then the ones of
   /// `not_unique`. `stopped`: time and multipliers of the state.
   double event_time = 0;
   Eigen::VectorXd event_multipliers;   ///< in the order of the patterns
   std::optional<NotUnique> not_unique; ///< also if the march ended later for another reason
   std::vector<IncrementRecord> increments; ///< see MarchSettings::keep_increments
   std::vector<CycleRecord> cycles;         ///< of those that were marched
   /// With Stepping::exact and one tangential component or none: number of changes of state of
   /// nodes. For an increment that replaced the path this counts the differences of the states
   /// at both ends.
   long events = 0;
   /// With MarchSettings::every_event the list of these changes, in the order of the path. A
   /// step lists the changes with which it begins. No step follows the event at which a march
   /// ends, so that its change is not among them. A piece that took one increment lists its
   /// changes at its start.
   std::vector<StateChange> changes;
   int fallbacks =
      0; ///< increments that were taken because the exact path could not be continued
   std::string
      fallback_reason; ///< reason of the first of them, a sentence of docs/increments.md
   /// Increments that were halved because no solution was found; probes do not count
   int stalled = 0;
   int steady_cycle = 0;  ///< first cycle of the steady state; 0: not reached
   int steady_period = 0; ///< 1 or 2
   /// The error of the loss by friction, with MarchSettings::loss_error.
   LossError loss_error;
   /// Energy balance of the march: external work - change of elastic energy - dissipation -
   /// normal work, over the largest of these during the march, or over a millionth of the
   /// initial elastic energy if that is larger. 0 if it is no more than their round-off. Normal
   /// work is that of pressures on nodes that close or open within an increment; an exact path
   /// has none. The imbalance is of the second order of the increments and goes to zero faster
   /// than the error of the loss, for which see `loss_error`.
   double energy_imbalance = 0;
   /// Error of friction forces where contact advances. They depend on the division of the loads
   /// into increments, because friction acts on a node from the beginning of the increment in
   /// which it closes. This is four times the largest change of a friction force in an
   /// increment in which a node closed, over the largest force. This is a rule of thumb: the
   /// whole change may be wrong, at the node that closed and at nodes that slip or stick
   /// because of it. It goes to zero with the increments, and is 0 if the exact path was
   /// followed while nodes closed, see Stepping.
   double advance_error = 0;
   /// Ends of lines at which contact was cut off, each with the first accepted state in which
   /// it was: the results belong to a line that is too short.
   std::vector<CutOffContact> cut_off;
   double largest_residual = 0; ///< of all increments, relative
   /// Largest distance by which free bodies that touched nothing were moved before the march,
   /// if no first increment was found. They are moved as rigid bodies, without friction, to the
   /// nearest place where they touch under the first loads that push them. The slip of the
   /// march begins there.
   double taken_up_clearance = 0;
   /// of this march (those of making the solver are in the solver's counters)
   Counters counters;
   double seconds = 0; ///< wall time
};

/// Called after every accepted increment.
using MarchObserver = std::function<void(const ContactState &, const IncrementRecord &)>;

/** Marches the state along a load history. The march begins at the time of the state, so that
    it can be cut and resumed: the result is the same to the last bit (on an exact path to
    round-off, where no increment had to be taken instead: the factor of its equations is kept
    over stops and pieces). The same input gives the same bits. Stops early, with the status in
    the report, when there is no equilibrium or when the monitor says so; the state is then the
    last one found. The monitor is called between increments: a march that was stopped and
    resumed gives the same result as one that was not stopped. An exception of an observer ends
    the march; the state is then the one with which the observer was called. InputError also if
    the history does not continue from the loads of the state, because the path between both
    would matter (not without friction). */
MarchReport march(const ReducedProblem &problem, const LoadHistory &history,
                  ContactState &state, const MarchSettings &settings = {},
                  const MarchObserver &observer = {});

/// The same with an existing solver, for many marches of one problem. settings.friction is that
/// of the solver.
MarchReport march(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                  const MarchSettings &settings = {}, const MarchObserver &observer = {});

} // namespace cattaneo
