#pragma once

#include "contact/own_bodies.hpp"

namespace miniapp
{

/// Mean normal of a line's nodes, by their weights.
Eigen::Vector2d mean_normal(const cattaneo::ContactLine &line);

/// Reduces a case whose last body is a half-plane, which touches the lowest contact nodes of
/// those that stand on it, across their mean normal, as a rigid line does. Contact nodes that
/// are held lie on a plane of symmetry, which the half-plane then has as well. InputError
/// naming bodies and keys.
void stand_on_half_plane(OwnBodies &own, std::vector<cattaneo::CondensedBody> bodies,
                         std::vector<cattaneo::Interface> interfaces, const JointCase &joint);

} // namespace miniapp
