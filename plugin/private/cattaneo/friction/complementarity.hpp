#pragma once

#include <cattaneo/friction/state_equations.hpp>
#include <functional>

namespace cattaneo
{

/// What a node may choose between: everything, or, where only the rates are sought, what the
/// present gap and forces leave it.
enum class Choice : signed char
{
   any,      ///< x_n >= 0, p >= 0, one of them zero; in contact |q| <= f p and Coulomb's law
   open,     ///< separation
   stick,    ///< stays in stick
   forward,  ///< x_n = 0; x_t >= 0, q + f p >= 0, one of them zero: stick or forward slip
   backward, ///< x_n = 0; x_t <= 0, f p - q >= 0, one of them zero: stick or backward slip
   sliding   ///< x_n = 0, q = 0: contact without friction; the state says the sense only
};

/** Finds node states whose equations (see StateEquations) have a solution that meets the laws
    of contact and friction: the frictional contact problem with the displacements x counted
    from stick and the forces F = b + K x. It is that of an increment, and that of the rates. */
struct ComplementarityProblem
{
   Eigen::VectorXd b;
   std::vector<Choice> choice;
   /// Bounds of the nodes, which may bend with the pressure and have intercepts; the equations
   /// have slopes alone. Empty: those of the equations.
   std::vector<FrictionBound> bounds;
};

struct ComplementarityReport
{
   bool solved = false;
   long newton_steps = 0; ///< semismooth Newton steps (all nodes change at once)
   long pivots = 0;       ///< exchanges of single nodes by Lemke's method
   Eigen::VectorXd x, F;
};

/** Semismooth Newton steps on node states, as increments and rates share them: `solve` finds
   the solution of the linear equations that the states stand for, `ask` gives the nodes the
   states, and the pieces of their bounds, that this asks for and says how many changed;
   `choices` are these as numbers. True where none changes any more; false where they come back
   to ones that were tried, where the equations are singular, after max_steps, or where `few`
   nodes or fewer go on changing. */
bool newton_on_states(const std::function<std::vector<double>()> &choices, int max_steps,
                      Eigen::Index few, const std::function<bool()> &solve,
                      const std::function<Eigen::Index()> &ask);

/// Semismooth Newton steps from the states of `equations`, which hold the solution's if solved.
/// `start` may bring x and F of these states, to save their solution.
ComplementarityReport solve_by_newton(StateEquations &equations,
                                      const ComplementarityProblem &problem, int max_steps,
                                      ComplementarityReport start = {});

/** Lemke's method [Lemke 1965] with a free start: from displacements and forces that meet all
    laws with the present states of `equations` at some other b, follows the solutions while b
    is moved to the problem's, exchanging the state of one node, or the piece of its bound, at a
    time; on this way b may turn back. x and F are the wish for the start (the solution of a
    neighbouring problem, say); they are moved into the inside of all inequalities by the random
    fraction `slack` of the largest force, so that no two nodes exchange at once. On the way a
    node may bear a little shear beyond f p, in separation too, that vanishes at the end: slip,
    stick, opening and closing are then one exchange each. It may end in a ray, above critical
    friction for instance: another start may do better. */
ComplementarityReport solve_by_lemke(StateEquations &equations,
                                     const ComplementarityProblem &problem,
                                     const Eigen::VectorXd &x, const Eigen::VectorXd &F,
                                     double slack, unsigned seed);

} // namespace cattaneo
