#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <vector>

namespace cattaneo
{

/// A point on the contact line found between nodes.
struct Edge
{
   double position = 0; ///< arc length
   double error = 0;    ///< estimate: half a node spacing where nothing better is known
};

/// A run of contact nodes in one state, with its ends read out between the nodes.
struct Zone
{
   NodeState state;
   Edge from, to;
   Eigen::Index first, last; ///< nodes
};

/** Zones of a state along the contact line, in the order of the nodes. Ends of the line are
   exact.

    Edges are read out between the nodes by extrapolating, to zero, what is smooth there:
    - end of contact: from inside the square of the pressure (which falls as the square root of
      the distance), from outside the opening^(2/3), extrapolated by parabolas, and of the
      two the surer one;
    - advancing slip front: |v - slip_origin|^(2/3), a parabola through five nodes behind it;
    - else, at the edge of stick: the square of the frictional reserve f p - |q|, a straight
   line through three nodes.

    Displacements are smoother than nodal forces, since the edge of the discrete solution is a
    node: against finer meshes, opening and slip are right to about 0.05 spacings, pressure to
    0.2. The error estimate is the change when other nodes are used; where the extrapolation
    leaves the interval between the nodes, the edge is its middle, ± half of it.

    With two tangential components |v - slip_origin| and |q| are lengths of vectors, and nodes
    that slip form one zone whatever their directions.

    Needs the problem's arc_length and weights. */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state);

/// The widest zone in the given state; first > last if there is none.
Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which);

/// From the first closed node to the last; first > last if all are apart.
Zone contact_zone(const ReducedProblem &problem, const ContactState &state);

/// Tractions (force over consistent weight) of nodal forces of one component, size n. Zero
/// where the weight is zero (the axis node of quadratic axisymmetric elements).
Eigen::VectorXd tractions(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces);

} // namespace cattaneo
