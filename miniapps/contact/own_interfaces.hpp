#pragma once

#include "contact/own_bodies.hpp"

#include <array>
#include <vector>

namespace miniapp
{

/// The interfaces of a case; `lines`: of both sides of each, empty of an obstacle or
/// half-plane.
std::vector<cattaneo::Interface>
interfaces_of(const JointCase &joint,
              const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

/// Bodies at these interfaces, paired where the case says so.
cattaneo::Reduction united(const JointCase &joint,
                           std::vector<cattaneo::CondensedBody> condensed,
                           const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

/// Adds what the case says of the interfaces' friction and gaps, of bolts, and of obstacles
/// that move. InputError naming key and place.
void complete(OwnBodies &own, const JointCase &joint,
              const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

} // namespace miniapp
