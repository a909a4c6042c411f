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

/** Zones of a state along the contact line, in the order of the nodes; ends of the line are
    exact.

    Near an edge at distance d inside, the pressure goes as d^(1/2) and so does the frictional
    reserve f p - |q| of a stick zone; outside, the opening goes as d^(3/2) and so does the slip
    behind an advancing slip front. p², (f p - |q|)², (w + g)^(2/3) and |v - slip_before|^(2/3)
   are smooth: a parabola through up to eight nodes is extrapolated to zero. The error estimate
   is its distance from a straight line through the nearest half of the nodes; of the two sides
   the surer one is taken. Where an extrapolation leaves the interval between the two nodes by
   more than a spacing, or there are too few nodes, the edge is the middle of the interval, ±
   half of it. Displacements are smoother than nodal forces: an edge is found to about a
   fiftieth of a spacing by opening and slip, a tenth by pressure and reserve.

    `slip_before`: slip v at the last reversal of the load (zero for a first loading; empty: not
    known, and slip is not used). After a reversal the reserve keeps kinks of older slip zones,
   and slip since the reversal is the only smooth witness.

    Needs the problem's arc_length and weights. Plane problems (one tangential component). */
std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state,
                        const Eigen::VectorXd &slip_before = {});

/// The widest zone in the given state; first > last if there is none.
Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which,
                 const Eigen::VectorXd &slip_before = {});

/// From the first closed node to the last; first > last if all are apart.
Zone contact_zone(const ReducedProblem &problem, const ContactState &state);

/// Tractions (force over consistent weight) of nodal forces of one component, size n. Zero
/// where the weight is zero (the axis node of quadratic axisymmetric elements).
Eigen::VectorXd tractions(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces);

} // namespace cattaneo
