#pragma once

#include <cattaneo/friction/contact_law.hpp>

namespace cattaneo
{

/// Work of the forces of a load pattern in the displacements of a state.
double work(const LoadPattern &pattern, const ContactState &state);

/** The slip path of each node (size n) over an increment: the distance |Δv|, and the nodal
    pressures at the beginning and the end of this distance. A node that stuck before, or whose
    slip reverses, sticks first. Its slip begins at the pressure at which friction is exhausted,
    if its forces change linearly until then. */
struct Rubbing
{
   Eigen::VectorXd way, p_from, p_to;
};
Rubbing rubbing(const ReducedProblem &problem, const ContactState &before,
                const ContactState &after);

/** Frictional loss of each node (size n) over an increment: ½ (b₀ + b₁)|Δv| with the bounds (f
    p in Coulomb's law) at the pressures of its rubbing(). It is exact for a linear change in
    which the node is in contact and slips in one direction, under a law that does not bend.
    Never negative. */
Eigen::VectorXd frictional_loss(const ReducedProblem &problem, const ContactState &before,
                                const ContactState &after);

/// Work of friction over an increment, -½(q₀ + q₁)·Δv: the forces change linearly.
double friction_work(const ContactState &before, const ContactState &after);

/// Derivatives of a number that depends on the rubbing() of one node, whose path begins when
/// friction is exhausted. They are by its forces before (0) and after (1), its slip Δv, its
/// friction and its own tangential stiffness.
struct RubbingDerivative
{
   NodeVector q0, q1, slip, stiffness;
   double p0 = 0, p1 = 0, friction = 0;
};
/// Derivatives of a number, from its derivatives by way, p_from and p_to of the node.
RubbingDerivative rubbing_derivative(const ReducedProblem &problem, const ContactState &before,
                                     const ContactState &after, Eigen::Index node,
                                     double by_way, double by_from, double by_to);
/// Derivatives of the frictional_loss() of a node with the given rubbing() over the increment.
RubbingDerivative loss_derivative(const ReducedProblem &problem, const ContactState &before,
                                  const ContactState &after, const Rubbing &rub,
                                  Eigen::Index node);

/// Elastic energy of both bodies in a state. The part that the loads store in the clamped
/// bodies is included only if H is known.
double elastic_energy(const ReducedProblem &problem, const ContactState &state);

} // namespace cattaneo
