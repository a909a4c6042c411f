#pragma once

#include "common/study.hpp"

#include <string>

namespace miniapp
{

/** Runs of a study that differ in the values of some options: all combinations, the first key
    slowest, each a process of the same program, as many at a time as there are cores. Table,
    results and figure of the study are then those of the sweep: a row a point, in the order of
    the sweep, with the status of each. A point that is no equilibrium or was refused is a row
    that says so. Ctrl-C leaves the points that were computed.

    @param statements "KEY=values; …", see Options::command(); values are words or numbers with
    spaces between, or from:to:count
    @param wanted results by their places in --json, with spaces between: "peak_pressure
    dissipation.0"; nothing: all single numbers
    InputError, before anything runs, if a key is none or a value is not allowed; and if every
    point is refused. */
void run_sweep(Study &study, const std::string &statements, const std::string &wanted);

} // namespace miniapp
