#pragma once

#include "common/run.hpp"

#include <string>
#include <vector>

namespace miniapp
{

/// Cycles of a receding contact's load, and how they are shown.
struct LoadCycles
{
   std::string load;           ///< the pattern
   std::vector<double> lowest; ///< what it is taken back to from 1, each in cycles of their own
   int cycles = 100;           ///< at most
   double shift = 0;           ///< from the arc length to the coordinate that is shown, …
   std::string coordinate, loss; ///< … its name, and that of a loss
};

/** Marches them from the loaded state that the run stands in (thesis 8.2, item 5): the loss in
    each, whether it dies out, and of the first `lowest` the zones and tractions of two cycles.
    Nodes open and close in a cycle, so that no theorem of shakedown applies: what is said was
    marched, from this start, and holds for no other. */
void cycle_the_load(Study &study, Run &run, const LoadCycles &wanted);

} // namespace miniapp
