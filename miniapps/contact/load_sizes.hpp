#pragma once

#include "contact/own_bodies.hpp"

namespace miniapp
{

/** Gives each load of the problem its size, see cattaneo::LoadSize, from what the case says and
    from the forces on the nodes of its bodies. A load of which no size is known keeps none:
    functions in the place of a number, bodies on several ranks. */
void set_load_sizes(OwnBodies &own, const JointCase &joint);

/// Writes `load_sizes` into the results, and prints them with --verbose.
void report_load_sizes(Study &study, const cattaneo::ReducedProblem &problem);

} // namespace miniapp
