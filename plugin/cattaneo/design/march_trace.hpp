#pragma once

#include <cattaneo/wear/wear_march.hpp>
#include <cstdint>
#include <vector>

namespace cattaneo
{

/// A state of a march, and the origin of its loads. With ℓ_k the loads of point k of the
/// history, those of the state are ℓ_point + share (ℓ_point+1 - ℓ_point).
struct TracedState
{
   ContactState state; ///< as the march left it
   int point = 0;      ///< k of the history, from 0
   double share = 0;   ///< share of the path to the next point, 0 to 1
   /// If this node changes its state here (IncrementRecord::event), the share depends on the
   /// solution. -1: it depends only on the history.
   Eigen::Index event = -1;
   /// Depth worn off before the increment that ends here: the gap is g + depth. Empty: no wear.
   Eigen::VectorXd depth = {};
};

/// All states of a march, from which its derivatives are computed.
struct MarchTrace
{
   LoadHistory history;             ///< that was marched
   std::vector<TracedState> states; ///< the first is the one at its start, which is given
   MarchReport report;              ///< of the march
   /// Number of the trace, as responses belong to one trace only. Each marched trace has
   /// another number, copies have the same one. 0: not known.
   std::uint64_t number = 0;
   /// Does the march follow the exact path, on which nodes close one by one? Equal increments
   /// do not.
   bool follows_path = false;
   /// Law by which the depth of the states follows from earlier states, also for worn_depth()
   /// of Responses. Without coefficients nothing wears.
   WearLaw wear;

   /// Index of the last state that was reached not later than a time of the history. InputError
   /// if the march began later or ended earlier.
   std::size_t at(double time) const;
   /// Index of the last state.
   std::size_t last() const { return states.size() - 1; }
};

/// march(), keeping all its states; the last one in `state`. InputError as march().
MarchTrace trace_march(const ReducedProblem &problem, const LoadHistory &history,
                       ContactState &state, const MarchSettings &settings = {});
/// The same from the virgin state.
MarchTrace trace_march(const ReducedProblem &problem, const LoadHistory &history,
                       const MarchSettings &settings = {});

/** wear() with every cycle marched, keeping all states of their increments: times go on from
    cycle to cycle, and `wear` of the trace is the law. The report is that of the last cycle,
    with the status and message of the whole.

    InputError as wear(), for a tolerance (cycles that are jumped over have no states) and where
    a cycle is so severe that its own update is implicit (WearReport::implicit_cycles), which
    has no derivatives. */
MarchTrace trace_wear(const ReducedProblem &problem, const WearLaw &law,
                      const LoadHistory &history, double cycles, WearState &state,
                      const WearSettings &settings = {});
/// The same from the unworn contact, before any load.
MarchTrace trace_wear(const ReducedProblem &problem, const WearLaw &law,
                      const LoadHistory &history, double cycles,
                      const WearSettings &settings = {});

/** A node that meets the laws of two states at once at the end of an increment: it touches
    without force, or lies on the friction limit without having slipped. The effect of a
    parameter then depends on the sign of its change: derivatives are one-sided, and belong to
    the state that the trace has. With the other state in ContactState::status they are those of
    the other side. */
struct Tie
{
   std::size_t state = 0;              ///< of the trace
   Eigen::Index node = 0;              ///< of the problem
   NodeState taken = NodeState::stick; ///< that the trace has
   NodeState other = NodeState::stick; ///< that obeys the laws as well
};

/** All ties of a trace, in its order. The laws may be missed by `tolerance` of the largest
    nodal force so far; lengths become forces by the node's own stiffness. The node at whose
    change of state an increment ends on the exact path is no tie, because the path goes on
    smoothly with its new state; other nodes that change at the same load are ties. At the start
    of an exact path nodes that touch without force are ties (state 0): with a larger gap they
    would close later on the way, and the derivatives of that side belong to another path than
    this trace.

    A tie need not matter. If a cycle returns to its largest load, all nodes that slipped are
    ties; as long as the loads vary together, both sides have the same derivative. */
std::vector<Tie> ties(const ReducedProblem &problem, const MarchTrace &trace,
                      double tolerance = 1e-9);

} // namespace cattaneo
