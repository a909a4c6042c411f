#pragma once

#include <cattaneo/friction/contact_law.hpp>
#include <optional>

namespace cattaneo
{

// Bodies that no support holds: they have rigid motions, and contact alone keeps them where
// they are. All of this is asked only where a problem has rigid motions.

/// A rigid motion along which the loads do work that no admissible contact forces can balance.
struct Mechanism
{
   bool exists = false;
   /// {v; w} of the contact nodes, largest entry 1. Clamped forces do positive work along it:
   /// the bodies go the other way.
   Eigen::VectorXd motion;
   bool slides = false; ///< moves along the contact somewhere (else it only lifts off)
   bool spins = false;  ///< slides in the circumferential direction somewhere
};

/// Edges of the friction cones as the motions Z = {v; w} (a column each) feel them: two columns
/// for each tangential component of each node, the pressure 1 with the forces of the bound.
/// Without tangential rows in Z the pressure alone, twice.
Eigen::MatrixXd cone_edges(const Eigen::MatrixXd &Z, const std::vector<FrictionBound> &bound);

/** Can contact forces inside the friction cones (p >= 0, |q| <= f p) balance the given clamped
    forces {q; p} along the rigid motions? By Farkas' lemma either they can, or there is a
    mechanism: the residual of a non-negative least-squares problem in the edges of the cones.
    A round cone (two tangential components) has edges in all directions; those that the
    residual points at are added until none points at it any more. That they can is necessary
    for equilibrium; that they cannot is the cause when there is none.

    `negligible`: a resultant whose largest share of a node is no larger is none (loads that
    balance each other to round-off). */
Mechanism find_mechanism(const ReducedProblem &problem, const Eigen::VectorXd &clamped_forces,
                         double negligible = 0);
/// The same of nodes that hold no more than these lines, which may have intercepts.
Mechanism find_mechanism(const ReducedProblem &problem, const std::vector<FrictionBound> &bound,
                         const Eigen::VectorXd &clamped_forces, double negligible);

/** Do the clamped forces drive a steady rotation about the axis? It meets f p at every node,
    with the pressure of a contact without friction: all of friction is circumferential then,
    and moves no node in its plane. Torques between this and the greatest that a contact can
    carry at rest have both a steady rotation and an equilibrium, so that this is the cause
    only where no equilibrium was found. False if not just one rigid motion is tangential, with
    two components, or if the torque is `negligible` as above. */
Mechanism find_spinning(const ReducedProblem &problem,
                        const Eigen::VectorXd &frictionless_pressure,
                        const Eigen::VectorXd &clamped_forces, double negligible = 0);

/// Rigid motions of bodies that touch, which no node that sticks or bears resists.
Eigen::MatrixXd free_motions(const ReducedProblem &problem,
                             const std::vector<NodeState> &states);

/** Where bodies that nothing holds and that touch nothing come to rest as soon as the given
    clamped forces {q; p} begin to push them: the relative displacement {v; w}. As rigid bodies
    and without friction, which there is none of before anything presses, they go on until their
    contacts bear these forces; of several such places to the nearest one,

        min |c - t d|,  W c + g >= 0,

    with d the forces along the free motions c, W the normal rows of these and t large: for all
    t from some one on that is the nearest solution of the linear programme max dᵀc (Mangasarian
    1979). Motions that a touching node would see are left to friction. None if nothing is
    pushed, or if no contact stops it. */
std::optional<Eigen::VectorXd> taken_up_clearance(const ReducedProblem &problem,
                                                  const Eigen::VectorXd &clamped_forces);

} // namespace cattaneo
