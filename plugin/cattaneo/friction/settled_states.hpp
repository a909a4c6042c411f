#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <vector>

namespace cattaneo
{

/** States of the nodes as mechanics decides them, whatever round-off made of ties.

    A solver's status is a tie where two states satisfy the laws at once: a node that touches
    without force, and a closed node that lies on the friction limit but has not moved (at a
    reload peak all nodes between the first and the steady border of stick do; without load all
    nodes do). Everything that is read from states, counted or drawn goes through here:
    - a node is in contact if it is pressed: p above 1e-10 of the largest nodal force so far
      and above the round-off of its displacements. One that only touches carries nothing and
      counts as separated; so does, without load, the whole contact;
    - a node in contact slips if its status says so and it has moved since it last stuck, opened
      or turned, |v - slip_origin|, by more than that force does to it alone; otherwise it
      sticks;
    - a node in contact without friction never sticks; where it has not moved it counts as
      forward slip, and where none has moved by more than 1e-8 of the largest displacement as
      slip in no direction (NodeState::slip). */
std::vector<NodeState> settled_states(const ReducedProblem &problem, const ContactState &state);

/// Number of nodes that touch without force: neither pressed nor open, with the tolerances of
/// settled_states(). They count as separated.
Eigen::Index touching_nodes(const ReducedProblem &problem, const ContactState &state);

/** Largest and smallest slip of each node over a stretch of a march: nodes that slip at all
    within a cycle have a range, those whose state is a tie have none. */
class SlipRange
{
public:
   /// The problem must outlive this.
   explicit SlipRange(const ReducedProblem &problem) : problem_(&problem) {}

   /// Begins with this state.
   void start(const ContactState &state);
   /// One more state of the stretch; the first one begins it.
   void note(const ContactState &state);
   /// Largest - smallest slip, size n; with two tangential components the diagonal of the box
   /// that slip stayed in.
   Eigen::VectorXd range() const;
   /// True for the nodes that were in contact at every state: the others moved freely.
   const std::vector<bool> &always_closed() const { return closed_; }

private:
   const ReducedProblem *problem_;
   Eigen::VectorXd low_, high_;
   std::vector<bool> closed_;
};

/// What each node's slip must exceed to be told from round-off, size n: what the least force
/// that counts (see settled_states) does to it alone.
Eigen::VectorXd least_slip(const ReducedProblem &problem, const ContactState &state);

} // namespace cattaneo
