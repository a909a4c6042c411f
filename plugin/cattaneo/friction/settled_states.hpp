#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <vector>

namespace cattaneo
{

/** States of the nodes with ties decided by mechanics, not by round-off.

    A tie is a node for which two states satisfy the laws at once: one that touches without
    force, or a closed one that is at the friction limit but has not moved. At a reload peak all
    nodes between the first and the steady border of stick are ties, and without load all nodes
    are. All functions that read, count or draw states use this one:

    - a node is in contact if it is pressed: p above 1e-10 of the largest nodal force so far and
      above the round-off of its displacements. A node that only touches has no force and counts
      as separated; without load all nodes do;
    - a node in contact slips if its status says so and |v - slip_origin|, its movement since it
      last stuck, opened or reversed, is larger than that least force would cause if the node
      moved alone; otherwise it sticks;
    - a node in contact without friction never sticks. If it has not moved it counts as forward
      slip; if no node has moved by more than 1e-8 of the largest displacement all of them count
      as slip in no direction (NodeState::slip). */
std::vector<NodeState> settled_states(const ReducedProblem &problem, const ContactState &state);

/// Number of nodes that touch without force: neither pressed nor open, with the tolerances of
/// settled_states(). They count as separated.
Eigen::Index touching_nodes(const ReducedProblem &problem, const ContactState &state);

/** Largest and smallest slip of each node over a part of a march. Nodes that slip within a
    cycle have a range, those whose state is a tie have none. */
class SlipRange
{
public:
   /// The problem must outlive this.
   explicit SlipRange(const ReducedProblem &problem) : problem_(&problem) {}

   /// Starts the part of the march at this state.
   void start(const ContactState &state);
   /// Adds a state of the part.
   void note(const ContactState &state);
   /// Largest minus smallest slip, size n. With two tangential components it is the diagonal of
   /// the box that contains all slips.
   Eigen::VectorXd range() const;
   /// True for the nodes that were in contact in every state; the others moved freely at times.
   const std::vector<bool> &always_closed() const { return closed_; }

private:
   const ReducedProblem *problem_;
   Eigen::VectorXd low_, high_;
   std::vector<bool> closed_;
};

/// The smallest slip of each node that is not round-off, size n: the displacement by the least
/// force that counts (see settled_states), if this node moves alone.
Eigen::VectorXd least_slip(const ReducedProblem &problem, const ContactState &state);

} // namespace cattaneo
