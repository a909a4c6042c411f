#pragma once

#include <cattaneo/shakedown/load_cycle.hpp>
#include <vector>

namespace cattaneo
{

/** The stuck contact (thesis 4.2): with v = w = 0 the contact forces are those of the load
    patterns themselves. Ratios are of nodal forces, which are also those of tractions recovered
    with one weight a node. At a corner they do not converge with the mesh (the ratio of the
    singular tractions does, that of the corner node's forces does not). Every function
    therefore has an argument with the nodes to be used; empty means all. */
using NodeList = std::vector<Eigen::Index>;

/// @a nodes, or all of them if it is empty. InputError if one does not exist.
NodeList chosen_nodes(const ReducedProblem &problem, const NodeList &nodes);

/// Nodes further than a share of the line's length from both its ends. An end on a plane of
/// symmetry does not count, and its mirror image belongs to the length. A closed line has no
/// ends.
NodeList nodes_away_from_ends(const ReducedProblem &problem, double share);

/// q / p of each node (4.2) under the loads @a multipliers, size n; with two components |q| /
/// p. Infinite where p ≤ 0.
Eigen::VectorXd traction_ratio(const ReducedProblem &problem,
                               const Eigen::VectorXd &multipliers);

/// Where and at which friction coefficient the stuck contact first slips (4.3).
struct Adhesion
{
   double load_factor = 0; ///< λ
   double friction = 0;    ///< f_min: largest |q| / p; infinite if a node is in tension
   Eigen::Index node = 0;  ///< where the ratio is largest
};

/// f_min under constant + λ varying.col(vertex), for each λ of @a load_factors (figure 4.3).
std::vector<Adhesion> adhesion_map(const ReducedProblem &problem, const LoadCycle &cycle,
                                   Eigen::Index vertex, const std::vector<double> &load_factors,
                                   const NodeList &nodes = {});

/// An event at the smallest λ ≥ 0 of a load that grows as constant + λ varying.col(vertex).
struct Incipience
{
   double load_factor = 0; ///< infinite if it never happens
   Eigen::Index node = -1; ///< where it happens, -1 if it never does
};

/// First separation: p = 0 somewhere.
Incipience incipient_separation(const ReducedProblem &problem, const LoadCycle &cycle,
                                Eigen::Index vertex, const NodeList &nodes = {});

/// First slip with the friction of the problem: |q| = f p somewhere.
Incipience incipient_slip(const ReducedProblem &problem, const LoadCycle &cycle,
                          Eigen::Index vertex, const NodeList &nodes = {});

} // namespace cattaneo
