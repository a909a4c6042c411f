#pragma once

#include <cattaneo/friction/contact_state.hpp>
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
    - a node without friction never sticks; where it has not moved it counts as forward slip. */
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

/// A point on the contact line found between nodes.
struct ZoneBorder
{
   double position = 0; ///< arc length
   /// Bound of the distance to the edge of the finest solution; exact ends of the line have 0.
   double error = 0;
};

/// A run of contact nodes in one state, with its ends read out between the nodes.
struct Zone
{
   NodeState state;
   ZoneBorder from, to;
   Eigen::Index first, last; ///< nodes
   int chain = 0;            ///< of the contact line, see chain_numbers()
};

/// Number of the chain of each node, from 0, see chains_of().
std::vector<int> chain_numbers(const ReducedProblem &problem);

/** Zones of a state along the contact line, in the order of the nodes, from settled_states().
    No zone reaches from one chain of nodes to the next. Ends of chains are exact; a loop is
    cut where its arc length begins.

    Edges are read out between the nodes by extrapolating, to zero, what is smooth there:
    - end of contact: from inside the square of the pressure (which falls as the square root of
      the distance), from outside the opening^(2/3), extrapolated by parabolas, and of the
      two the surer one;
    - advancing slip front: |v - slip_origin|^(2/3), a parabola through five nodes behind it;
    - else, at the edge of stick: the square of the frictional reserve f p - |q|, a straight
      line through three nodes.

    Displacements are smoother than nodal forces, since the edge of the discrete solution is a
    node: against finer meshes, opening and slip are right to about 0.05 spacings, pressure to
    0.2. That is luck which no one mesh can vouch for: the error is the change when other nodes
    are used, but not less than a quarter of a spacing, half of it where a straight line was all
    that the nodes allow or pressure all there is, and a whole one where there are too few
   nodes: the edge is then the middle between the two that it lies between. A border of stick or
   slip k nodes from an end of the line that is a corner of one of the bodies and in contact,
   where tractions are singular, has 16/k spacings at least, or its distance from that end.

    With two tangential components |v - slip_origin| and |q| are lengths of vectors, and nodes
    that slip form one zone whatever their directions.

    Needs the problem's arc_length and weights. */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state);

/** Zones of a stretch of a march, for the nodes in contact at one of its states: those that
    moved at all within it (state slip), and those that did not (stick). Borders of stick are
    read from the range alone, with the power 2/3 as above, of nodes that were never open. */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state,
                        const SlipRange &slip);

/// The widest of some zones in the given state; first > last if there is none.
Zone widest_zone(const std::vector<Zone> &zones, NodeState which);
/// The same of zones(problem, state).
Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which);

/** The widest stick zone, with the errors of its ends as borders of stick: one that ends where
    the contact does, without a node of slip between, is known to a spacing only, since slip
    between the last two nodes does not show. */
Zone stick_zone(const ReducedProblem &problem, const std::vector<Zone> &zones);
Zone stick_zone(const ReducedProblem &problem, const ContactState &state);

/// Stretches of contact: runs of closed nodes of one chain, in the order of the nodes. Their
/// state is stick, whatever slips.
std::vector<Zone> contact_zones(const std::vector<Zone> &zones);
/// The widest of them; first > last if all nodes are apart.
Zone contact_zone(const ReducedProblem &problem, const ContactState &state);

/// Tractions (force over consistent weight) of nodal forces of one component, size n. Zero
/// where the weight is zero (the axis node of quadratic axisymmetric elements).
Eigen::VectorXd tractions(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces);

} // namespace cattaneo
