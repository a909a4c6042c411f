#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

/** Coulomb's law with a tangential force vector, for one node with two tangential components
    (radial, circumferential): |q| <= f p, and a slip increment x opposes it, q = -f p x/|x|.

    Here the node alone moves: q = q0 + A x + b y and p = p0 + b·x + c y, with x its slip
    increment and y its gap. [A b; bᵀ c] is the node's own block of the reduced stiffness,
    positive definite. */
struct DiscNode
{
   Eigen::Matrix2d A;
   Eigen::Vector2d b;
   double c;
   Eigen::Vector2d q0;
   double p0;
   double friction;
};

struct DiscMove
{
   bool found = false; ///< false: no consistent state (above the critical friction)
   NodeState state = NodeState::stick;
   Eigen::Vector2d slip = Eigen::Vector2d::Zero();
   double gap = 0;
};

/** Exact state of the node: separation if it opens when free, else stick if friction suffices,
    else slip. With s = f p/|x| slip is (A + s I) x = -q0, and what remains is one equation for
    s, which changes sign between s = 0 (p of the node without friction, not negative or it
    would have opened) and s = ∞ (|q0| - f p0, positive or it would have stuck). */
DiscMove solve_node(const DiscNode &node);

/** Least friction coefficient at which the slip of the node need not be unique, from below:
    smallest eigenvalue of A over |b|. (With one component A/|b| is that coefficient.) */
double critical_friction(const Eigen::Matrix2d &A, const Eigen::Vector2d &b);

/** Linearised slip of a node. The trial force τ = q - k x (k > 0 any stiffness) is mapped to
    the nearest point f p τ/|τ| of the disc; q equals it. With the unit vectors n along τ and t
    across, and β = f p/|τ|, Newton's equations for the new q, p and x are

        n·q - f p = 0,      (1 - β) t·q + β k t·x = 0,

    since the derivative of τ/|τ| is (I - n nᵀ)/|τ|. */
struct DiscSlip
{
   Eigen::Vector2d n = Eigen::Vector2d::UnitX();
   double share = 0; ///< β, at most 1

   DiscSlip() = default;
   /// |τ| > 0.
   DiscSlip(const Eigen::Vector2d &trial, double bound);
   Eigen::Vector2d t() const { return {-n[1], n[0]}; }
};

} // namespace cattaneo
