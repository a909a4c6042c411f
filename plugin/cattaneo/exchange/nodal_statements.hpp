#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

namespace cattaneo
{

// The language of supports and loads (docs/contact.md) for bodies whose nodes are in sets.
// Errors name the text by `called`.

/// Supports, separated by spaces: "FLOOR:y WALL:xy".
void add_supports(NodalStiffness &body, const std::string &called, const std::string &text);

/// Loads, separated by semicolons: "P traction TOP 0 -1" (per length, on the outer edges whose
/// nodes are in the set), "P force TOP 0 -1" (at each node), "D displacement-x END 0.01". If no
/// elements are known, elements of this `order` run along a set, whose nodes must be listed in
/// sequence.
void add_loads(NodalStiffness &body, const std::string &called, const std::string &text,
               int order = 0);

} // namespace cattaneo
