#pragma once

#include <cattaneo/friction/settled_states.hpp>
#include <vector>

namespace cattaneo
{

/// A point on the contact line found between nodes.
struct ZoneBorder
{
   double position = 0; ///< arc length
   /// Estimate of the distance to the edge of the finest solution, no bound: a mesh of few
   /// elements may miss the edge by more. Exact ends of the line have 0.
   double error = 0;
};

/// A run of contact nodes in one state, with its ends read out between the nodes.
struct Zone
{
   NodeState state;    ///< of all its nodes
   ZoneBorder from;    ///< where it begins
   ZoneBorder to;      ///< where it ends
   Eigen::Index first; ///< first node
   Eigen::Index last;  ///< last node
   int chain = 0;      ///< of the contact line, see chain_numbers()
};

/// Number of the chain of each node, from 0.
std::vector<int> chain_numbers(const ReducedProblem &problem);

/** Zones of a state along the contact line, in the order of the nodes, from settled_states().
    No zone reaches from one chain of nodes to the next. Ends of chains are exact. A closed line
    is cut where its arc length begins, or at the border before it, which then has a negative
    arc length. The zones add up to the whole line.

    Edges are read out between the nodes by extrapolating, to zero, what is smooth there:
    - end of contact: from inside the square of the pressure (which falls as the square root of
      the distance), from outside the opening^(2/3), both extrapolated by parabolas; the one
      with the smaller error is used;
    - advancing slip front: |v - slip_origin|^(2/3), a parabola through five nodes behind it;
    - else, at the edge of stick: the square of the frictional reserve f p - |q|, a straight
      line through three nodes.

    Displacements are smoother than nodal forces, since the edge of the discrete solution is a
    node: against finer meshes, the edge by opening and slip has an error of about 0.05
    spacings, by pressure of 0.2. A single mesh does not prove that. The estimate of the error
    is the change when other nodes are used, but at least a quarter of a spacing. It is half a
    spacing where the nodes allow only a straight line or there is only pressure, and a whole
    one where there are too few nodes. The edge is then the middle between its two neighbours.
    So is each end of a contact of one node, whose body may have any tilt. Tractions are
    singular at an end of the line that is in contact and a corner of one of the bodies. A
    border of stick or slip k nodes from such an end has an estimate of at least 16/k spacings,
    or its distance from that end.

    With two tangential components |v - slip_origin| and |q| are lengths of vectors, and nodes
    that slip form one zone whatever their directions.

    Needs the problem's arc_length and weights. */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state);

/** Zones of a part of a march, for the nodes in contact at one of its states: nodes that
    slipped at any time within it (state slip), and nodes that did not (stick). Borders of stick
    are read from the range alone, with the power 2/3 as above, of nodes that were never open.
    */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state,
                        const SlipRange &slip);

/// The widest of some zones in the given state; first > last if there is none.
Zone widest_zone(const std::vector<Zone> &zones, NodeState which);

/** The widest stick zone, with the errors of its ends as borders of stick. A zone that ends
    with the contact, without a node of slip between, is known to a spacing only, because slip
    between the last two nodes does not show. So is a zone of a single node, which may not
    exist.
 */
Zone stick_zone(const ReducedProblem &problem, const std::vector<Zone> &zones);
/// The same for a state.
Zone stick_zone(const ReducedProblem &problem, const ContactState &state);

/// Stretches of contact: runs of closed nodes of one chain, in the order of the nodes. Their
/// state is given as stick, even if nodes slip.
std::vector<Zone> contact_zones(const std::vector<Zone> &zones);
/// The widest of them; first > last if all nodes are apart.
Zone contact_zone(const ReducedProblem &problem, const ContactState &state);

/// Tractions (force over consistent weight) of nodal forces of one component or more, all nodes
/// of the first one, then of the next: p of size n, q of size c·n. Zero where the weight is
/// zero (the axis node of quadratic axisymmetric elements).
Eigen::VectorXd tractions(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces);

} // namespace cattaneo
