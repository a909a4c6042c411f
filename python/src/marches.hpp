#pragma once

#include "arguments.hpp"
#include <cattaneo/friction/march.hpp>

// What functions share that march a contact.

namespace cattaneo::python
{

CATTANEO_ARGUMENT(History, "cattaneo._core.LoadHistory");
CATTANEO_ARGUMENT(MaybeState, "None | cattaneo._core.ContactState");

/// Settings of each march of longer work, by the names that march() has for them.
MarchSettings march_settings(nb::handle increments, nb::handle stepping,
                             nb::handle single_increment_if_exact, nb::handle max_halvings,
                             nb::handle method);

/// A MarchReport of Python's. `problem` is the object that the march is of.
nb::object march_report(nb::handle problem, MarchReport report, ContactState state);

/// Warns where a script should not pass over how `what` ended.
void warn_of_status(const std::string &what, FrictionStatus status, const std::string &message);
/// The same, and where contact was cut off.
void warn_of(const std::string &what, const MarchReport &report);

/// The history of a march that begins at `state`. A list of points goes on from where the state
/// stands; a history has times of its own.
LoadHistory history_from(const ReducedProblem &problem, nb::handle history,
                         const ContactState &state);

/// `state`, which must be one of the problem, or rest if it is None.
ContactState state_or_rest(const ReducedProblem &problem, nb::handle state);

} // namespace cattaneo::python
