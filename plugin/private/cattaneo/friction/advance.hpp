#pragma once

#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

// How contact advances in an increment. Friction acts on a node from the beginning of the
// increment in which it closes, not from where it does.

/// True if a node closes and bears. One that only comes to touch, as where a body rocks until
/// it does, has had no friction on its way: the forces are those of an open node.
bool closes(const ReducedProblem &problem, const ContactState &before,
            const ContactState &after);

/// True if contact advances by more than a layer of nodes (see Stepping::exact).
bool advances_too_far(const ReducedProblem &problem, const ContactState &before,
                      const ContactState &after);

/// Largest change of a node's friction force in an increment in which a node closes, else 0: it
/// may be wrong, and stays.
double changed_while_closing(const ReducedProblem &problem, const ContactState &before,
                             const ContactState &after);

} // namespace cattaneo
