#pragma once

#include "arguments.hpp"
#include <cattaneo/friction/march.hpp>
#include <variant>

// Code shared by all functions that march a contact.

namespace cattaneo::python
{

/// A LoadHistory, or points that continue from the loads of a state.
CATTANEO_ARGUMENT(History,
                  "LoadHistory | collections.abc.Sequence[collections.abc.Mapping[str, float]]",
                  anything);

/// Points of a history.
CATTANEO_ARGUMENT(Points, "collections.abc.Sequence[collections.abc.Mapping[str, float]]",
                  anything);

/// A MarchReport as a Python object.
nb::object march_report(const ReducedProblem &problem, MarchReport report, ContactState state);

/// Warns if `what` ended with an outcome that a script should not ignore.
void warn_of_status(const std::string &what, FrictionStatus status, const std::string &message);
/// The same, and warns of contact that was cut off.
void warn_of(const std::string &what, const MarchReport &report);

/// The history of a march that begins at `state`. Loads that the first point does not name are
/// those of the state. A list of points continues from the time of the state; a history has its
/// own times.
LoadHistory history_from(const ReducedProblem &problem, const History &history,
                         const ContactState &state);

/// `state`, which must belong to the problem, or the virgin state if none is given.
ContactState state_or_rest(const ReducedProblem &problem, const ContactState *state);

} // namespace cattaneo::python
