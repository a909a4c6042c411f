#pragma once

#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

/** Frictional loss of each node (size n) over an increment: ½ f (p₀ + p₁)|Δv|, exact for a
    linear path along which the node is in contact and slips one way. Where slip has turned
    round since the last increment the node sticks first: p₀ is then the pressure at which
    friction is exhausted again, if the forces of the node that does not slip yet change
    linearly. Never negative. */
Eigen::VectorXd frictional_loss(const ReducedProblem &problem, const ContactState &before,
                                const ContactState &after);

/// Elastic energy stored by the contact displacements and loads of a state (both bodies).
double elastic_energy(const ReducedProblem &problem, const ContactState &state);

/// Work of the loads from one state to another, trapezoidal (exact along a linear path).
double external_work(const ReducedProblem &problem, const ContactState &before,
                     const ContactState &after);

} // namespace cattaneo
