#pragma once

#include "contact/own_bodies.hpp"

#include <array>
#include <vector>

namespace miniapp
{

/// The interfaces of a case; `lines`: those of both sides of each, empty for an obstacle or a
/// half-plane.
std::vector<cattaneo::Interface>
interfaces_of(const JointCase &joint,
              const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

/// Reduces the bodies at these interfaces, with pairings where the case has them.
cattaneo::Reduction united(const JointCase &joint,
                           std::vector<cattaneo::CondensedBody> condensed,
                           const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

/// Adds friction and gaps of the interfaces, bolts, and obstacles that move, from the case.
/// InputError naming key and place.
void complete(OwnBodies &own, const JointCase &joint,
              const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

} // namespace miniapp
