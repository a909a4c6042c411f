#pragma once

#include <cattaneo/design/response.hpp>
#include <cattaneo/monitor.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cattaneo
{

/// How the stiffness and the loads of a reduced problem change with a number, a modulus that
/// they are linear in for instance: derivatives by it.
struct StiffnessChange
{
   Eigen::MatrixXd K; ///< of ReducedProblem::K, symmetric
   /// Change of the forces {q; p} of each pattern, one column each. No columns if they do not
   /// change.
   Eigen::MatrixXd loads;
   Eigen::MatrixXd H; ///< of ReducedProblem::H; no rows: it does not change
};

/// All stiffnesses by the same factor, per unit of it: K and the forces of prescribed
/// displacements as they are, -H of applied forces; of one body on a rigid obstacle, or of
/// bodies that change together. InputError if patterns of both controls act on each other in H.
StiffnessChange stiffness_scale(const ReducedProblem &problem);

/** One number for each parameter of a march: how much it changes, or the derivative of a
    response by it. Empty: no change.

    A cycle ends with the loads that it begins with: of the multipliers at these two points, and
    of all points that are one state of loading, derivatives add up. */
struct Parameters
{
   Eigen::VectorXd friction;    ///< of each node, size n
   Eigen::VectorXd gap;         ///< of each node, size n
   Eigen::MatrixXd multipliers; ///< of LoadHistory: patterns × points
   Eigen::VectorXd stiffness;   ///< of each StiffnessChange
   Eigen::VectorXd wear;        ///< of Archard's k of each node (MarchTrace::wear), size n

   /// Σ derivative × change, of whatever both have. InputError if sizes differ.
   double dot(const Parameters &change) const;
};

/// Derivatives, if they are known.
struct Gradient
{
   bool found = false;  ///< the derivatives are known
   std::string message; ///< why not
   Parameters by;       ///< derivative by each parameter
};

/// Changes of all states of a trace with one change of parameters: a column for each state.
struct TraceChange
{
   bool found = false;            ///< the changes are known
   std::string message;           ///< why not
   Eigen::MatrixXd displacements; ///< of {v; w}
   Eigen::MatrixXd forces;        ///< of {q; p}
   Eigen::MatrixXd multipliers;   ///< of the load patterns, also where the exact path turns
   Eigen::MatrixXd conjugates;    ///< of these
   Eigen::MatrixXd loss; ///< of each node over the increment that ends in the state, n × states
   Eigen::MatrixXd worn; ///< of the depth that it wears off; no columns: the trace has no law
   std::uint64_t trace = 0; ///< MarchTrace::number

   /// Derivative of a response along the change. InputError if it is not known, or the response
   /// is none of the trace.
   double of(const Response &response) const;
};

/** Derivatives of what a march returned by its parameters, exact in the discrete problem: by
    friction and gap of each node, by the load multipliers of the history, by changes of the
    stiffness and, where the trace has a law of wear, by its k of each node. Where depth is
    added to the gap (trace_wear()) all of it is followed through.

    At the end of each increment the states of the nodes stand for linear equations,

        stick       v = v before,  w = -g           forward slip   q + f p = 0,  w = -g
        separation  q = 0,  p = 0                   backward slip  q - f p = 0,  w = -g

    (with two tangential components a slip q |Δv| + f p Δv = 0 opposes its direction) whose
    derivative carries the memory: the slip before. Where an increment ends at a change of state
    on the exact path, the loads there are one more unknown, and the boundary that the node has
    met one more equation.

    gradient() goes back through the march, one transposed solve an increment, for all
    parameters at once; along() goes forward, for all responses. Both use one factor as long as
    states stay, and follow changes of states by low-rank updates.

    Derivatives are those of the march as it was cut into increments, with the states that its
    nodes had; where a node has two at once they are one-sided, see ties(). The state at the
    start is given and changes with nothing.

    Where states leave a body free (it touches at one node, or slips everywhere), which the
    history alone holds in place, that motion is taken to stay: derivatives are known of what
    does not depend on it, and gradient() says where it would (`found` is false); along() does
    not. Without friction that is so of a body that is free to slide, and derivatives by
    friction, and by loads that push it, are NaN. */
class Sensitivity
{
public:
   /// InputError if the trace is not one of the problem, if sizes of a change do not fit it, or
   /// if the problem has two tangential components a node.
   Sensitivity(const ReducedProblem &problem, const MarchTrace &trace,
               std::vector<StiffnessChange> stiffness = {});
   ~Sensitivity();
   /// Can be moved, not copied.
   Sensitivity(Sensitivity &&) noexcept;

   /// InputError if the response is none of the trace. The monitor is asked between states; a
   /// gradient that it stops is not found.
   Gradient gradient(const Response &response, const Monitor &monitor = {});
   /// InputError if sizes do not fit the problem and the history.
   TraceChange along(const Parameters &change, const Monitor &monitor = {});

   /// Dense factorisations so far, and unknowns bordered to them instead.
   long factorisations() const;
   /// How often an unknown was bordered to a factor so far.
   long updates() const;

private:
   struct System;
   std::unique_ptr<System> system_;
};

} // namespace cattaneo
