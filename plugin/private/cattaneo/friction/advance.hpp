#pragma once

#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

// How contact advances in an increment. Friction acts on a node from the beginning of the
// increment in which it closes, not from the moment of closing.

/// True if a node closes and carries a force. A node that only comes to touch, as when a body
/// rocks onto it, had no friction during the increment: its forces are those of an open node.
bool closes(const ReducedProblem &problem, const ContactState &before,
            const ContactState &after);

/// True if contact advances by more than a layer of nodes (see Stepping::exact).
bool advances_too_far(const ReducedProblem &problem, const ContactState &before,
                      const ContactState &after);

/// Largest change of a node's friction force if a node closes in the increment, else 0. The
/// change may be wrong by as much, and later increments do not correct it.
double changed_while_closing(const ReducedProblem &problem, const ContactState &before,
                             const ContactState &after);

} // namespace cattaneo
