#pragma once

#include <cattaneo/contact/contact_line.hpp>

namespace cattaneo
{

/// Global true dofs of a contact line, {x; y} of all its nodes (torsion: the twist).
/// InputError, on all ranks, if there are none, if they are not of this body, or if one is
/// held.
std::vector<int> contact_dofs(const ElasticBody &body, const ContactLine &line);

} // namespace cattaneo
