#pragma once

#include "contact/contact_in_space.hpp"

namespace miniapp
{

/** Gives each load of the problem its size, see cattaneo::LoadSize, from the case and from the
    forces on the nodes of its bodies. Some loads have no known size: those with a function in
    place of a number, and those of bodies on several ranks. */
void set_load_sizes(OwnBodies &own, const JointCase &joint);
/// The same of bodies in space.
void set_load_sizes(BodiesInSpace &own, const JointCase &joint);

/// Writes `load_sizes` into the results, and prints them with --verbose.
void report_load_sizes(Study &study, const cattaneo::ReducedProblem &problem);

} // namespace miniapp
