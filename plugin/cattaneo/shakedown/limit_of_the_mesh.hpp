#pragma once

#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>

namespace cattaneo
{

// A limit that is decided where the stuck tractions are singular is one of the mesh, which
// changes with the spacing of its nodes, and not one of the bodies. There are two such places.

/** The ends of the contact line, where corners are: of the work that the mechanism of a limit
    dissipates, -q slip, the share that is done within 1 % of the length from either end of
    the line, 0 to 1; a large one says that the limit is one of the mesh. NaN if the limit has
    no mechanism.
    @param stuck of the same problem
    @param load_factor at which the mechanism moves */
double share_of_ends(const ReducedProblem &problem, const StuckForces &stuck,
                     const LimitReport &limit, double load_factor);

/** An end of contact within the line, where the pressure falls to zero and the stuck shear does
    not: the last node of the part that is the last one closed before open ones, on the same
    chain, and feels shear from the cycle; numbered in the part, -1 if there is none.
    @param whole of which @a part is the closed part
    @param stuck of the part */
Eigen::Index singular_end(const ReducedProblem &whole, const ClosedContact &part,
                          const StuckForces &stuck);

} // namespace cattaneo
