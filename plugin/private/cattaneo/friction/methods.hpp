#pragma once

#include <cattaneo/friction/increment.hpp>

namespace cattaneo
{

// The methods that look for the end of an increment, each in the file of its name.

enum class Search
{
   found,    ///< the increment stands there, with its report
   not_here, ///< another method may find it
   hopeless  ///< there is nothing to search for
};

/// One pass over all nodes, each solved exactly with the others held (thesis 3.5, appendix D).
void sweep(Increment &at);
/// Sweeps until nothing changes.
Search gauss_seidel(Increment &at);

/// Semismooth Newton after a few sweeps, more before each attempt: node states stand for linear
/// equations, whose solution asks for states.
Search active_set(Increment &at);
/// From the present states alone.
bool newton(Increment &at);
/// newton() from a point that may be an answer itself, but for round-off.
bool polished(Increment &at);

/// Follows solutions from elsewhere to the one sought, one node's state at a time.
Search path(Increment &at);

/// From what weak springs hold to an answer without them.
Search weak_springs(Increment &at);
/// Does a body drift or spin away, so that there is no equilibrium? Found once an increment.
bool moves_away(Increment &at);

/// Newton's method on the natural map with a line search, from several starts.
Search damped_newton(Increment &at);

/// A body that slips wherever it touches could slip on as it is, with the same forces: it has
/// moved the least, by the length of the contact, that its states ask for, as where the last
/// node that stuck let go. False if no body can (friction in the disc: not asked).
bool take_least_motion(Increment &at);

/// Rigid motions of bodies that touch, which no node that sticks or bears resists.
Eigen::MatrixXd free_motions(const ReducedProblem &problem,
                             const std::vector<NodeState> &states);

/// Moves to the solution of the linear equations of the present states. False if they are
/// singular. `from_here`: once more from the present displacements, for round-off that is left
/// of them.
bool solve_for_states(Increment &at, bool from_here = false);

} // namespace cattaneo
