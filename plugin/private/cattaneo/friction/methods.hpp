#pragma once

#include <cattaneo/friction/increment.hpp>

namespace cattaneo
{

// The methods that seek the end of an increment, each in the file of its name.

enum class Search
{
   found,    ///< the increment is at the end that was found, with its report
   not_here, ///< another method may find it
   hopeless  ///< no further method is tried: weak springs carry no force, so only rest is
             ///< possible
};

/// One pass over all nodes, each solved exactly with the others fixed (thesis 3.5, appendix D).
void sweep(Increment &at);
/// Sweeps until nothing changes.
Search gauss_seidel(Increment &at);

/// Semismooth Newton from the start, in the plane after a few sweeps. Node states give linear
/// equations, and their solution gives new states.
Search active_set(Increment &at);
/// From nothing but the present states.
bool newton(Increment &at);
/// Takes the states that follow from the present displacements and forces, with one tangent or
/// none. @return how many nodes changed their state
Eigen::Index ask_for_states(Increment &at);
/// newton() from a point that may itself be a solution, apart from round-off.
bool polished(Increment &at);

/// Plane: follows solutions of neighbouring problems to that of the increment, and changes the
/// state of one node at a time. It starts eight times near the start of the increment, or from
/// random places about it.
Search lemke(Increment &at);
Search lemke_from_afar(Increment &at);

/// Two tangents: Newton with parts of the loads, each from the end for the previous part.
Search growing_load(Increment &at);
/// Two tangents, where nothing can move freely: follows the solutions with a share of friction,
/// and with rounded laws, while friction grows from zero to its full value.
Search growing_friction(Increment &at);
/// Two tangents: Newton's method on the natural map with a line search, from the start of the
/// increment and from random places about it.
Search damped_newton(Increment &at);

/// Two tangents: Newton's steps from the node states that the natural map gives. An answer that
/// may be a free body that slides away does not count (may_slide()).
bool ends_from_natural_states(Increment &at);
/// Operations of one of Newton's steps with N displacements.
inline double disc_step_operations(double N)
{
   return N * N * (N + 40) + 5e4;
}

/// Uses only the methods before the weak springs, which suffice if something holds the bodies.
bool find_end_quickly(Increment &at);

/// Newton's steps without springs from the place where the weakest springs hold the bodies.
/// Hopeless if they fail and the springs carry no force; then the place itself may be a
/// solution (rest).
Search weak_springs(Increment &at);
/// Does a body drift or spin away, according to weak springs? Checked once in an increment. If
/// no end is found, this is the reason. If an end is found nevertheless it counts, unless
/// round-off may hide the motion (runs_away()).
bool moves_away(Increment &at);

/// For an answer that was found from a distant start: may it belong to a free body that slides
/// away? Round-off of such large displacements hides the force that drives the body. It cannot
/// be so if the nodes that touch or stick hold all bodies. An answer for a body that touched
/// nothing before is not accepted either, because a march moves it until it touches, and then
/// its forces are more accurate.
bool may_slide(const Increment &at);

/// Is the present state the end of the increment? A body that slips at all of its nodes could
/// slip further with the same forces, so it is first moved back to its least displacement.
bool ends_with_least_motion(Increment &at);

/// Moves to the solution of the linear equations of the present states. False if they are
/// singular.
bool solve_for_states(Increment &at);
/// The same only for the gaps, without friction or if slip does not change the pressure.
bool solve_normal(Increment &at);
/// True if displacements are much smaller than the larger ones from which they were computed,
/// so that round-off is a large part of them. Measured with the nodes' own stiffness; K: its
/// diagonal.
bool cancels(const Eigen::VectorXd &K, const Eigen::VectorXd &from, const Eigen::VectorXd &u);

} // namespace cattaneo
