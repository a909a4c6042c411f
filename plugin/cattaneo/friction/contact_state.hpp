#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/loop.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/// State of a contact node (thesis 3.5 and 3.6, with an initial gap g).
enum class NodeState : signed char
{
   stick,         ///< w + g = 0, v̇ = 0, |q| <= f p
   separation,    ///< p = q = 0, w + g > 0
   forward_slip,  ///< w + g = 0, q = -f p, v̇ > 0
   backward_slip, ///< w + g = 0, q = +f p, v̇ < 0
   slip ///< two tangential components: w + g = 0, q = -f p v̇/|v̇|, so that q tells its direction
};

/// As it is printed.
const char *name(NodeState state);

/// Does the node touch?
inline bool closed(NodeState state)
{
   return state != NodeState::separation;
}
/// Does the node slip, in whatever direction?
inline bool slips(NodeState state)
{
   return closed(state) && state != NodeState::stick;
}

/// Sense of slip: +1 forward (q = -f p), -1 backward (q = +f p), 0 in stick and separation and
/// where slip has a direction in the plane of contact.
inline double sense(NodeState state)
{
   return state == NodeState::forward_slip    ? 1.0
          : state == NodeState::backward_slip ? -1.0
                                              : 0.0;
}

/** All data on which the future of a frictional contact depends: one value, which can be copied
    and saved. Sizes as in ReducedProblem; lengths and forces in the problem's own units. */
struct ContactState
{
   Eigen::VectorXd v; ///< slip: relative tangential displacement
   Eigen::VectorXd w; ///< relative normal displacement
   Eigen::VectorXd q; ///< tangential nodal forces
   Eigen::VectorXd p; ///< normal nodal forces, compression positive
   /// Slip v at which each node last stuck, opened or reversed (with two components: turned by
   /// more than a right angle in one increment). v - slip_origin is the distance that it has
   /// slipped since, which is zero at an advancing slip front. Size c·n.
   Eigen::VectorXd slip_origin;
   std::vector<NodeState> status; ///< of each node, at the end of the last increment
   Eigen::VectorXd multipliers;   ///< of the load patterns
   /// Names of these patterns; empty: those of the problem with which the state is used.
   std::vector<std::string> loads;
   double time = 0.0;        ///< of the load history
   double step = 0.0;        ///< next trial increment of time; 0: not chosen yet
   double peak_force = 0.0;  ///< of a node so far, see FrictionSettings::tolerance
   double dissipation = 0.0; ///< frictional energy lost so far
   /// Slip at the end of the last three cycles (the latest last), see steady_period().
   std::vector<Eigen::VectorXd> cycle_slip;
   /// The record of the present cycle so far, so that a march that is resumed within a cycle
   /// knows all of it. Empty between cycles.
   std::optional<CycleRecord> cycle;
   /// Other values that a program saves with a state, under names of its choice, for instance
   /// the range of a bolt's force. Marches do not use them.
   std::map<std::string, std::vector<double>> kept;

   /// {v; w}.
   Eigen::VectorXd displacements() const;
   /// {q; p}.
   Eigen::VectorXd forces() const;

   /// The number of cycles, 1 or 2, after which the last slip of cycle_slip repeats within this
   /// share; 0: no period is known.
   int steady_period(double tolerance) const;

   /// The state before any load: no slip, and all nodes without a gap stick.
   static ContactState virgin(const ReducedProblem &problem);

   /// The virgin state with a given slip v (an initial dislocation), size c·n. InputError if it
   /// has another size, or moves a row that the problem holds.
   static ContactState with_slip(const ReducedProblem &problem, const Eigen::VectorXd &v);

   /// InputError if sizes do not fit the problem, a value is not finite, or v moves a row that
   /// the problem holds by more than 1e-9 of the largest slip (round-off).
   void validate(const ReducedProblem &problem) const;
   /// The same, and InputError if its forces are not those of its displacements and loads. This
   /// finds a state of another problem with as many nodes, whatever the gap. A state before any
   /// load fits every such problem.
   void require_of(const ReducedProblem &problem) const;
   /// InputError if a value is not finite.
   void require_finite() const;
};

/// Writes a state as JSON, from which every double is restored to the last bit. InputError if a
/// value is not finite or the file cannot be written.
void save(const ContactState &state, const std::string &file);
/// Reads what save() wrote. InputError if the file is missing or is not a contact state.
ContactState load_contact_state(const std::string &file);

/// A node changes its state on the exact path.
struct StateChange
{
   double time = 0;                   ///< of the load history
   Eigen::VectorXd multipliers;       ///< of the load patterns
   Eigen::Index node = 0;             ///< number in the problem
   NodeState from = NodeState::stick; ///< state before
   NodeState to = NodeState::stick;   ///< state after
};

} // namespace cattaneo
