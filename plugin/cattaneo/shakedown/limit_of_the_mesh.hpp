#pragma once

#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>
#include <string>

namespace cattaneo
{

// A limit that is decided where the stuck tractions are singular is one of the mesh, which
// changes with the spacing of its nodes, and not one of the bodies. There are two such places.

/** For the ends of the contact line, where corners are: the share of the work of a limit's
    mechanism, -q slip, that is done within 1 % of the length from either end of the line. It is
    0 to 1, and a large share shows a limit of the mesh. NaN if the limit has no mechanism.
    @param stuck of the same problem
    @param load_factor at which the mechanism moves */
double share_of_ends(const ReducedProblem &problem, const StuckForces &stuck,
                     const LimitReport &limit, double load_factor);

/** For an end of contact within the line, where the pressure falls to zero and the stuck shear
    does not: the last node with shear from the cycle at which a chain ends `open`, see
    closed_contact(). -1 if there is none.
    @param stuck of the same problem */
Eigen::Index singular_end(const ReducedProblem &problem, const StuckForces &stuck);

/** The reason why a limit is one of this mesh only, as one sentence without its full stop.
    Empty if nothing shows that it is. A limit is one of the mesh if contact ends within its
    line (singular_end()), or if more than a fifth of the mechanism's work is done at the ends
    of the line (share_of_ends()).
    @param stuck of the same problem
    @param load_factor at which the mechanism moves
    @param friction the limit is a coefficient of friction, not a load factor */
std::string mesh_statement(const ReducedProblem &problem, const StuckForces &stuck,
                           const LimitReport &limit, double load_factor, bool friction);

/// The end of a sentence on a limit of the mesh.
std::string figure_of_the_mesh(bool friction);

} // namespace cattaneo
