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
   /** From one change of state to the next, exactly. The increments are stops: the states
       there are recorded, whatever number of changes lies between. Pieces that one increment
       solves exactly take that one. Where the path does not go on the march ends, if there is
       no equilibrium beyond. Else an increment is made instead, to the next stop or to where a
       node closes first: counted, with the reason, in the report. A state that is no
       equilibrium (an initial slip, an interference) is brought to equilibrium by an increment
       first.

       With two tangential components there is no such path, and FrictionMethod::gauss_seidel
       knows none. Equal increments are taken, halved while contact advances by more than one
      layer of nodes: each newly closed node must have had a closed neighbour on its chain, or,
      on a chain that bore nothing yet, close there first, alone or beside another. */
   exact
};

/// How a history is marched. The defaults need no tuning.
struct MarchSettings
{
   FrictionSettings friction;             ///< of every increment
   int increments = 20;                   ///< increments of each piece of the history
   std::vector<int> increments_of_piece;  ///< overrides `increments` for the points' pieces
   Stepping stepping = Stepping::exact;   ///< how their ends are reached
   bool single_increment_if_exact = true; ///< false: cut even where one increment is exact
   /// Events of an exact path end the increments, in place of stops: the observer and the
   /// report have their states, and MarchReport::changes lists the changes with which the next
   /// steps set out. Else they are only counted.
   bool every_event = false;
   int max_halvings = 12;            ///< of an increment, for advancing contact or failure
   bool stop_at_steady_state = true; ///< the cycles that are left would be the same
   /// Steady: slip at the end of a cycle differs from that one or two cycles before by less
   /// than this times the largest slip of the history.
   double steady_tolerance = 1e-10;
   /// Keep every IncrementRecord in the report; else only the observer sees them, and the
   /// report of a march of millions of increments stays small.
   bool keep_increments = true;
   /// Where increments are taken that are not exact, march again to say how wrong their loss
   /// may be, see MarchReport::loss_error: along the exact path, or, where there is none, with
   /// half and a quarter of the increments. That may take as long again.
   bool loss_error = false;
   Monitor monitor; ///< hears of progress, and may stop the march

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// One accepted increment, on an exact path the way from one stop to the next.
struct IncrementRecord
{
   double time = 0;             ///< at its end
   int cycle = 0;               ///< 0: opening part
   Eigen::VectorXd multipliers; ///< of the load patterns, at its end
   Eigen::VectorXd conjugates;  ///< of these: displacement or reaction, see conjugates()
   int stick = 0;               ///< number of nodes that stick, of settled_states()
   int separation = 0;          ///< … that are apart
   int forward_slip = 0;        ///< … that slip forward, or in no direction
   int backward_slip = 0;       ///< … that slip backward
   int slip = 0; ///< with two tangential components: nodes that slip in whatever direction
   /// Lost by friction, ½ f (p₀ + p₁)|Δv| of each node: what wears. Never negative.
   double dissipation = 0;
   /// -½(q₀ + q₁)·Δv of all nodes: with the other works it balances the energy to round-off.
   /// On an exact path it is the dissipation; with two tangents, where the direction of slip
   /// turns within an increment, it is less by the second order.
   double friction_work = 0;
   /// Work of the loads, trapezoidal (exact for linear increments, and on an exact path); of
   /// the contact's part of the conjugates alone where H is not known.
   double external_work = 0;
   double residual_normal = 0;     ///< see IncrementReport; the largest on the way, as the next
   double residual_tangential = 0; ///< see IncrementReport
   double round_off = 0;           ///< see IncrementReport
   /// The method that found it: one of IncrementReport's, or of the exact path ("event path",
   /// and how its rates were found where not by Newton), or "unchanged" where the loads stay.
   const char *found_by = "";
   /// A march taken up from the state here goes on to the last bit. False amid an exact path:
   /// to round-off.
   bool resumes = true;
   /// Node that comes to the boundary of its state, or to a bend of its law, where the
   /// increment ends, see MarchSettings::every_event. In the state of this row it still has its
   /// old state; the next step sets out with the new one. The loads are those at which it comes
   /// there. -1: there is no such node, and the loads are those of the history at the row's
   /// time.
   Eigen::Index event = -1;
};

/// What a state alone says of it: time, multipliers, conjugates and numbers of nodes.
IncrementRecord record_of(const ReducedProblem &problem, const ContactState &state);

/// The first state of a march of which there may be others: from there on its states are one of
/// several.
struct NotUnique
{
   double time = 0;             ///< of the load history
   Eigen::VectorXd multipliers; ///< of the load patterns
   std::string message;         ///< the node and its friction
};

/** How far the loss of a march by increments may be from that of its path: the whole loss, and
    the loss of each of its cycles.

    Increments know the path at their ends alone: a node that turns round or comes to rest
   within one is given one way and one direction. The loss is wrong by that to the first order
   of the increments, the balance of energy to the second: MarchReport::energy_imbalance is no
   measure of it. */
struct LossError
{
   /// In the unit of the loss, at least 0. NaN: it was not asked for, or not found.
   double value = std::numeric_limits<double>::quiet_NaN();
   /// True: the exact path was followed beside the march from the same state, and the value is
   /// the difference: a bound, to round-off. False: an estimate, by two marches with other
   /// increments.
   bool bound = false;
   /// The loss of this march without increments, by extrapolation, where it holds: thirty nodes
   /// or more share the loss, and its changes from march to march fall in one ratio (0.15 to
   /// 0.65; increments of each piece are a multiple of four, or fewer than four). NaN: it does
   /// not, or the value is a bound.
   double extrapolated = std::numeric_limits<double>::quiet_NaN();
   std::string by;    ///< what was marched beside it, or why nothing is known; one sentence
   Counters counters; ///< of that march; not in the report's own
};

/// What a march came to.
struct MarchReport
{
   FrictionStatus status = FrictionStatus::converged; ///< of the whole march
   std::string message;                               ///< one sentence, empty if converged
   double time = 0;                                   ///< reached
   /// Where the outcome is not `converged`: time and load multipliers at which it came about.
   /// An exact path that ends has them exactly, at the event after which it does not go on; the
   /// state is that event's. After an increment that failed they are those of the last
   /// equilibrium, found by bisection; the state is the last one whose forces are known to
   /// 1e-9. A first proportional loading without a gap has none, and they are those of its
   /// start. `not_unique` does not end a march: they are then the ones of `not_unique`.
   /// `stopped`: time and multipliers of the state.
   double event_time = 0;
   Eigen::VectorXd event_multipliers;   ///< in the order of the patterns
   std::optional<NotUnique> not_unique; ///< also where the march ended later for another reason
   std::vector<IncrementRecord> increments; ///< see MarchSettings::keep_increments
   std::vector<CycleRecord> cycles;         ///< of those that were marched
   /// Stepping::exact with one tangential component or none: how many changes of state of
   /// nodes there were. Of an increment that was taken instead of the path they are the
   /// differences of the states at both ends.
   long events = 0;
   /// With MarchSettings::every_event the list of them, in the order of the path. A step lists
   /// the changes with which it sets out. No step follows the event at which a march ends, so
   /// that its change is not among them. A piece that took one increment lists its changes at
   /// its start.
   std::vector<StateChange> changes;
   int fallbacks = 0;           ///< increments made where the exact path did not go on
   std::string fallback_reason; ///< of the first of them, a sentence of docs/increments.md
   int stalled = 0;      ///< increments that were halved as none was found; probes do not count
   int steady_cycle = 0; ///< first cycle of the steady state; 0: not reached
   int steady_period = 0; ///< 1 or 2
   /// The error of the loss by friction, with MarchSettings::loss_error.
   LossError loss_error;
   /// Energy balance of the march: external work - change of elastic energy - dissipation -
   /// normal work, over the largest of them on the way, or a millionth of the elastic energy
   /// that it began with where none is as large; 0 where it is no more than the round-off of
   /// these. Normal work, of pressures on nodes that close or open within an increment, is none
   /// of the path; what it is there changes no state. It is of the second order of the
   /// increments, and goes to zero faster than the error of the loss: see `loss_error` for
   /// that.
   double energy_imbalance = 0;
   /// Error of friction forces where contact advances. They depend on how the loads are cut
   /// into increments, since friction acts on a node from the beginning of the increment in
   /// which it closes. This is four times the largest change of a friction force in an
   /// increment in which a node closed, over the largest force. It is a rule: all of the change
   /// may be wrong, at the node that closed and at those that it makes slip or stick. It goes
   /// to zero with the increments, and is 0 where the exact path was followed while nodes
   /// closed, see Stepping.
   double advance_error = 0;
   /// Ends of lines at which contact was cut off, each with the first accepted state in which
   /// it was so: the results are those of a line that was named too short.
   std::vector<CutOffContact> cut_off;
   double largest_residual = 0; ///< of all increments, relative
   /// Where no first increment was found: how far, at most, bodies that nothing held and that
   /// touched nothing were moved before the march to where the first loads that push them press
   /// them on: as rigid bodies, without friction, the nearest such place. The slip of the march
   /// begins there.
   double taken_up_clearance = 0;
   Counters counters;  ///< of this march (what making the solver took is in the solver's own)
   double seconds = 0; ///< wall time
};

/// Called after every accepted increment.
using MarchObserver = std::function<void(const ContactState &, const IncrementRecord &)>;

/** Marches the state along a load history. The state's own time says where it stands, so that a
    march can be cut and resumed: the result is the same to the last bit (on an exact path to
    round-off, where no increment had to be taken instead: the factor of its equations is kept
    over stops and pieces). The same input gives the same bits. Stops early, with the status in
    the report, when there is no equilibrium or when the monitor says so; the state is then the
    last one found. The monitor is asked between increments: the state of a march that was
    stopped, taken up again, comes to what the march would have come to. What an observer throws
   ends the march, the state being what it was called with. InputError also where the history
   does not go on with the loads that the state has, unless there is no friction: the way there
   would matter. */
MarchReport march(const ReducedProblem &problem, const LoadHistory &history,
                  ContactState &state, const MarchSettings &settings = {},
                  const MarchObserver &observer = {});

/// The same with a solver made before (many marches of one problem); settings.friction is the
/// solver's own.
MarchReport march(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                  const MarchSettings &settings = {}, const MarchObserver &observer = {});

} // namespace cattaneo
