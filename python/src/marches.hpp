#pragma once

#include "arguments.hpp"
#include <cattaneo/friction/march.hpp>
#include <variant>

// What functions share that march a contact.

namespace cattaneo::python
{

/// A LoadHistory, or points that go on from where a state stands.
CATTANEO_ARGUMENT(History,
                  "LoadHistory | collections.abc.Sequence[collections.abc.Mapping[str, float]]",
                  anything);

/// Points of a history.
CATTANEO_ARGUMENT(Points, "collections.abc.Sequence[collections.abc.Mapping[str, float]]",
                  anything);

/// A MarchReport of Python's.
nb::object march_report(const ReducedProblem &problem, MarchReport report, ContactState state);

/// Warns where a script should not pass over how `what` ended.
void warn_of_status(const std::string &what, FrictionStatus status, const std::string &message);
/// The same, and where contact was cut off.
void warn_of(const std::string &what, const MarchReport &report);

/// The history of a march that begins at `state`, whose loads are those that a first point does
/// not name. A list of points goes on from where the state stands; a history has times of its
/// own.
LoadHistory history_from(const ReducedProblem &problem, const History &history,
                         const ContactState &state);

/// `state`, which must be one of the problem, or rest if there is none.
ContactState state_or_rest(const ReducedProblem &problem, const ContactState *state);

} // namespace cattaneo::python
