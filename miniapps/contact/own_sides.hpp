#pragma once

#include "contact/own_part.hpp"

#include <array>
#include <vector>

namespace miniapp
{

/// InputError if both bodies of an interface are the same mesh at the same place.
void require_own_meshes(const JointCase &joint, const std::vector<OwnPart> &parts);

/// InputError if a side reaches into a guide of its body, whose nodes move as one block, or if
/// supports hold all of it. `lines`: of both sides of each interface.
void require_sides_free(const JointCase &joint, const std::vector<OwnPart> &parts,
                        const std::vector<std::array<cattaneo::ContactLine, 2>> &lines);

/// A sentence if sizes of bodies that meet differ by a factor of about 1000, as with metres and
/// millimetres; else empty.
std::string other_units(const JointCase &joint, const std::vector<OwnPart> &parts);

} // namespace miniapp
