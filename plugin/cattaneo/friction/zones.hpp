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

/** Zones of a state along the contact line, in the order of the nodes; ends of the line are exact.

    At an edge of contact the pressure falls to zero as the square root of the distance, and so does
    the frictional reserve f p - |q| at the edge of a stick zone. Their squares are smooth there: a
    parabola through up to eight nodes inside the zone is extrapolated to zero (for Hertz and
    Cattaneo–Mindlin it is exact). The error estimate is its distance from a straight line through
    the nearest half of the nodes. Where the extrapolation leaves the interval between the two nodes
    by more than a spacing, the edge is the middle of the interval, ± half of it.

    Needs the problem's arc_length and weights. Plane problems (one tangential component). */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state);

/// The widest zone in the given state; first > last if there is none.
Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which);

/// From the first closed node to the last; first > last if all are apart.
Zone contact_zone(const ReducedProblem &problem, const ContactState &state);

/// Tractions (force over consistent weight) of nodal forces of one component, size n. Zero where
/// the weight is zero (the axis node of quadratic axisymmetric elements).
Eigen::VectorXd tractions(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces);

} // namespace cattaneo
