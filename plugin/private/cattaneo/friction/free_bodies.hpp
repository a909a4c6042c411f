#pragma once

#include <cattaneo/friction/contact_law.hpp>
#include <optional>

namespace cattaneo
{

// Bodies that no support holds: they have rigid motions, and only contact keeps them in place.
// These functions are called only for problems with rigid motions.

/// A rigid motion along which the loads do work that no admissible contact forces can balance.
struct Mechanism
{
   bool exists = false;
   /// {v; w} of the contact nodes, largest entry 1. Clamped forces do positive work along it:
   /// the bodies move in the opposite direction.
   Eigen::VectorXd motion;
   bool slides = false; ///< moves along the contact somewhere (if not, it only lifts off)
   bool spins = false;  ///< slides in the circumferential direction somewhere
};

/// Work of the edges of the friction cones in the motions Z = {v; w} (a column each). Each
/// tangential component of each node has two columns: the pressure 1 with the force of the
/// bound in either sense. Without tangential rows in Z both are just the pressure.
Eigen::MatrixXd cone_edges(const Eigen::MatrixXd &Z, const std::vector<FrictionBound> &bound);

/** Can contact forces inside the friction cones (p >= 0, |q| <= f p) balance the given clamped
    forces {q; p} along the rigid motions? By Farkas' lemma either they can, or there is a
    mechanism: the residual of a non-negative least-squares problem in the edges of the cones. A
    round cone (two tangential components) has edges in all directions; edges along the residual
    are added until the residual has no positive part along any edge. If the forces cannot
    balance, there is no equilibrium, and the mechanism is the reason.

    A resultant whose largest share of a node is at most `negligible` counts as none (loads that
    balance each other to round-off). */
Mechanism find_mechanism(const ReducedProblem &problem, const Eigen::VectorXd &clamped_forces,
                         double negligible = 0);
/// The same for nodes whose bounds are these lines, which may have intercepts.
Mechanism find_mechanism(const ReducedProblem &problem, const std::vector<FrictionBound> &bound,
                         const Eigen::VectorXd &clamped_forces, double negligible);

/** Do the clamped forces drive a steady rotation about the axis? In a steady rotation every
    node has the friction f p, with the pressure of a contact without friction: all friction is
    then circumferential, and moves no node within its plane. Torques between this one and the
    greatest that a contact can carry at rest allow both a steady rotation and an equilibrium.
    So a rotation is the cause only if no equilibrium was found. False unless exactly one rigid
    motion is tangential, with two components, or if the torque is `negligible` as above. */
Mechanism find_spinning(const ReducedProblem &problem,
                        const Eigen::VectorXd &frictionless_pressure,
                        const Eigen::VectorXd &clamped_forces, double negligible = 0);

/// Rigid motions of bodies that touch, which no sticking or loaded node resists.
Eigen::MatrixXd free_motions(const ReducedProblem &problem,
                             const std::vector<NodeState> &states);

/** The relative displacement {v; w} at which bodies that nothing holds and that touch nothing
    come to rest when the given clamped forces {q; p} begin to push them. They move as rigid
    bodies, and without friction (no node presses yet), until their contacts carry these forces.
    Of several such places the nearest one is taken,

        min |c - t d|,  W c + g >= 0,

    with d the forces along the free motions c, W the normal rows of these and t large: for all
    t from some one on that is the nearest solution of the linear programme max dᵀc (Mangasarian
    1979). Motions that would move a touching node are left to friction. Empty if nothing is
    pushed, or if no contact stops the motion. */
std::optional<Eigen::VectorXd> taken_up_clearance(const ReducedProblem &problem,
                                                  const Eigen::VectorXd &clamped_forces);

} // namespace cattaneo
