#pragma once

#include <cattaneo/friction/increment.hpp>

namespace cattaneo
{

// The methods that look for the end of an increment, each in the file of its name.

enum class Search
{
   found,    ///< the increment stands there, with its report
   not_here, ///< another method may find it
   hopeless  ///< no further method is tried: weak springs bear nothing, and rest is left
};

/// One pass over all nodes, each solved exactly with the others fixed (thesis 3.5, appendix D).
void sweep(Increment &at);
/// Sweeps until nothing changes.
Search gauss_seidel(Increment &at);

/// Plane: semismooth Newton after a few sweeps, where node states stand for linear equations,
/// whose solution asks for states.
Search active_set(Increment &at);
/// From the present states alone.
bool newton(Increment &at);
/// After so many sweeps, which begin where the last ones ended.
bool newton_after_sweeps(Increment &at, int sweeps);
/// Takes the states that the present displacements and forces ask for, with one tangent or
/// none. @return how many nodes changed theirs
Eigen::Index ask_for_states(Increment &at);
/// newton() from a point that may be an answer itself, but for round-off.
bool polished(Increment &at);

/// Plane: follows solutions from elsewhere to the one sought, one node's state at a time. Eight
/// departures from the start of the increment; or departures from random places about it.
Search lemke(Increment &at);
Search lemke_from_afar(Increment &at);

/// Two tangents: Newton from the start itself, then after sweeps, more before each attempt.
Search active_set_in_the_disc(Increment &at);
/// Two tangents: Newton's method on the natural map with a line search, from where the sweeps
/// ended, from the start of the increment, and from random places about it.
Search damped_newton(Increment &at);

/// By the methods before the weak springs alone, which suffice where something holds the
/// bodies.
bool find_end_quickly(Increment &at);

/// Newton's steps without springs from where the weakest springs hold the bodies. Hopeless if
/// these fail and the springs bear nothing: then the place itself may be an answer (rest).
Search weak_springs(Increment &at);
/// Does a body drift or spin away, as weak springs tell? Asked once an increment. If no end is
/// found this is the cause. An end that is found all the same counts, unless round-off may hide
/// the motion (runs_away()).
bool moves_away(Increment &at);

/// Of an answer that was found from afar: may it be a free body that slides away? Round-off of
/// so large displacements hides what drives such a body. That cannot be where the nodes that
/// touch or stick hold all bodies. One that touched nothing before is not believed either: a
/// march moves it to where it touches first, and knows its forces better then.
bool may_slide(const Increment &at);

/// Is it the end of the increment where it stands? A body that slips wherever it touches could
/// slip on as it is, with the same forces: it is moved before to where it has moved the least.
bool ends_with_least_motion(Increment &at);

/// Moves to the solution of the linear equations of the present states. False if they are
/// singular.
bool solve_for_states(Increment &at);
/// The same of the gaps alone, without friction or where slip does not change the pressure.
bool solve_normal(Increment &at);
/// True if displacements are much smaller than those that they were counted from: the round-off
/// of these is then a large part of them. By the nodes' own stiffness, K: its diagonal.
bool cancels(const Eigen::VectorXd &K, const Eigen::VectorXd &from, const Eigen::VectorXd &u);

} // namespace cattaneo
