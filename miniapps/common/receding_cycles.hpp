#pragma once

#include "common/run.hpp"

#include <string>
#include <vector>

namespace miniapp
{

/** Cycles of a receding contact's load between 1 and less, from the loaded state that the run
    stands in (thesis 8.2, item 5): the loss in each, and whether it dies out. Nodes open and
    close in a cycle, so that no theorem of shakedown applies: what is said was marched, from
   this start, and holds for no other.
   @param lowest what the load is taken back to, each in cycles of their own
   @param cycles at most */
void cycle_the_load(Study &study, Run &run, const std::string &load,
                    const std::vector<double> &lowest, int cycles);

} // namespace miniapp
