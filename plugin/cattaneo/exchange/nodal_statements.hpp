#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

namespace cattaneo
{

// The language of supports and loads (docs/contact.md) for bodies whose nodes are in sets.
// `called` is what the text is called in an error.

/// Supports, separated by spaces: "FLOOR:y WALL:xy".
void add_supports(NodalStiffness &body, const std::string &called, const std::string &text);

/// Loads, separated by semicolons: "P traction TOP 0 -1" (per length, on the outer edges whose
/// nodes are in the set), "P force TOP 0 -1" (at each node), "D displacement-x END 0.01".
/// `order` of the elements along a set, whose nodes are in a row, where none are known.
void add_loads(NodalStiffness &body, const std::string &called, const std::string &text,
               int order = 0);

} // namespace cattaneo
