#pragma once

#include <cattaneo/friction/state_equations.hpp>
#include <functional>

namespace cattaneo
{

/// States from which a node may choose: all, or for rates only those that its present gap and
/// forces allow.
enum class Choice : signed char
{
   any,      ///< x_n >= 0, p >= 0, one of them zero; in contact |q| <= f p and Coulomb's law
   open,     ///< separation
   stick,    ///< stays in stick
   forward,  ///< x_n = 0; x_t >= 0, q + f p >= 0, one of them zero: stick or forward slip
   backward, ///< x_n = 0; x_t <= 0, f p - q >= 0, one of them zero: stick or backward slip
   sliding   ///< x_n = 0, q = 0: contact without friction; the state has only the sense of slip
};

/** Finds node states whose equations (see StateEquations) have a solution that obeys the laws
    of contact and friction. The displacements x are counted from stick, and the forces are F =
    b + K x. Both increments and rates are problems of this kind. */
struct ComplementarityProblem
{
   Eigen::VectorXd b;
   std::vector<Choice> choice;
   /// Bounds of the nodes, which may bend with the pressure and have intercepts. (The equations
   /// have slopes only.) Empty: the bounds of the equations.
   std::vector<FrictionBound> bounds;
};

struct ComplementarityReport
{
   bool solved = false;
   long newton_steps = 0; ///< semismooth Newton steps (all nodes change at once)
   long pivots = 0;       ///< changes of state of single nodes by Lemke's method
   Eigen::VectorXd x, F;
};

/** Semismooth Newton steps on node states, as increments and rates share them.

    `solve` solves the linear equations of the present states; false if these are singular.
    `ask` gives each node the state, and the piece of its bound, that follow from the solution,
    and returns how many nodes have changed. `choices` are these states and pieces as numbers.

    True if no node changes any more. False if the equations are singular, if choices repeat
    that were tried before, after max_steps, or if `few` nodes or less keep changing and do not
    become fewer. */
bool newton_on_states(const std::function<std::vector<double>()> &choices, int max_steps,
                      Eigen::Index few, const std::function<bool()> &solve,
                      const std::function<Eigen::Index()> &ask);

/// Semismooth Newton steps from the states of `equations`, which are those of the solution
/// afterwards. `start` may contain x and F of the first states, which saves a solution.
ComplementarityReport solve_by_newton(StateEquations &equations,
                                      const ComplementarityProblem &problem, int max_steps,
                                      ComplementarityReport start = {});

/** Of rates: a node whose slip and whose distance from its friction limit do not change keeps
    its state, whichever of stick and slip rounding has given it. Gives such nodes the states
    `before`, and keeps these if all laws hold with them. Then the report and the states of
    `equations` are the new ones. False if nothing has changed. */
bool keep_states_at_rest(StateEquations &equations, const ComplementarityProblem &problem,
                         const std::vector<NodeState> &before, ComplementarityReport &report);

/** Lemke's method [Lemke 1965] with a free start.

    The start: x and F may be anything, such as the solution of a neighbouring problem. They are
    moved so far that they satisfy all inequalities of the present states of `equations`
    strictly, by random amounts of the size `slack` times the largest force, so that no two
    nodes change at once. They are then a solution for some other b.

    The path: b is moved to that of the problem, and the solution follows. Where an inequality
    of a node becomes an equation, the node changes its state, or the piece of its bound. After
    a change b may have to move back for a while. On the path a node may carry a little shear
    beyond f p, in separation too, which vanishes at the end. Slip, stick, opening and closing
    are then one change each.

    Not solved if the path ends in a ray, on which no node changes any more (above critical
    friction, for instance), if the equations are singular at the start or after a change, or if
    20 n + 100 changes have not led to a solution that meets all inequalities. Another start may
    succeed. */
ComplementarityReport solve_by_lemke(StateEquations &equations,
                                     const ComplementarityProblem &problem,
                                     const Eigen::VectorXd &x, const Eigen::VectorXd &F,
                                     double slack, unsigned seed);

} // namespace cattaneo
