#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>

namespace cattaneo
{

/// What closed_contact() is to be made of.
struct StayedClosed
{
   std::vector<Eigen::Index> nodes; ///< closed throughout the cycles, in increasing order
   MarchReport march;               ///< the nodes are right only if it converged
};

/** The nodes that are closed throughout some cycles at a load factor, marched from rest through
    the constant load and the vertices of the cycle in their order; fewer cycles, once they are
    steady. Nodes that are open while the constant load is applied may close. InputError as
   LoadCycle::validate() and for less than one cycle. */
StayedClosed stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                         double load_factor, int cycles, const Monitor &monitor = {});

} // namespace cattaneo
