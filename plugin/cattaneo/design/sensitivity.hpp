#pragma once

#include <cattaneo/design/response.hpp>
#include <cattaneo/monitor.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cattaneo
{

/// Derivatives of the stiffness and the loads of a reduced problem by a number, for instance by
/// a modulus in which they are linear.
struct StiffnessChange
{
   Eigen::MatrixXd K; ///< of ReducedProblem::K, symmetric
   /// Change of the forces {q; p} of each pattern, one column each. No columns if they do not
   /// change.
   Eigen::MatrixXd loads;
   Eigen::MatrixXd H; ///< of ReducedProblem::H; no rows: it does not change
};

/// The change of all stiffnesses by one factor, per unit of it: K and the forces of prescribed
/// displacements themselves, and -H for applied forces. It is valid for one body on a rigid
/// obstacle, or for bodies that change together. InputError if patterns of both controls act on
/// each other in H.
StiffnessChange stiffness_scale(const ReducedProblem &problem);

/** One number for each parameter of a march: how much it changes, or the derivative of a
    response by it. Empty: no change.

    A cycle ends with the loads that it begins with: derivatives by the multipliers at these two
    points add up, as at all points with the same loads. */
struct Parameters
{
   Eigen::VectorXd friction;    ///< of each node, size n
   Eigen::VectorXd gap;         ///< of each node, size n
   Eigen::MatrixXd multipliers; ///< of LoadHistory: patterns × points
   Eigen::VectorXd stiffness;   ///< of each StiffnessChange
   Eigen::VectorXd wear;        ///< of Archard's k of each node (MarchTrace::wear), size n

   /// Σ derivative × change, over all parameters that both have. InputError if sizes differ.
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

   /// Derivative of a response along the change. InputError if it is not known, or if the
   /// response belongs to another trace.
   double of(const Response &response) const;
};

/** Derivatives of what a march returned by its parameters, exact in the discrete problem: by
    friction and gap of each node, by the load multipliers of the history, by changes of the
    stiffness and, where the trace has a law of wear, by its k of each node. Where depth is
    added to the gap (trace_wear()), its effect on all later states is included.

    At the end of each increment the states of the nodes stand for linear equations,

        stick       v = v before,  w = -g           forward slip   q + f p = 0,  w = -g
        separation  q = 0,  p = 0                   backward slip  q - f p = 0,  w = -g

    (with two tangential components a slip q |Δv| + f p Δv = 0 opposes its direction) whose
    derivatives contain those of the slip before. Where an increment ends at a change of state
    on the exact path, the loads there are one more unknown, and the boundary that the node has
    met one more equation.

    gradient() goes back through the march, one transposed solve an increment, for all
    parameters at once; along() goes forward, for all responses. Both use one factor as long as
    states stay, and follow changes of states by low-rank updates.

    Derivatives are those of the march as it was cut into increments, with the states that its
    nodes had; where a node has two at once they are one-sided, see ties(). The state at the
    start is given and does not depend on the parameters.

    If the states leave a body free (it touches at one node, or slips everywhere), only the
    history determines its place, and this free motion is assumed not to change. Derivatives of
    numbers that do not depend on it are known. For others gradient() returns `found` false;
    along() does not check this. Without friction the same holds for a body that is free to
    slide, and derivatives by friction, and by loads that push it, are NaN. */
class Sensitivity
{
public:
   /// InputError if the trace is not one of the problem, if sizes of a change do not fit it, or
   /// if the problem has two tangential components per node.
   Sensitivity(const ReducedProblem &problem, const MarchTrace &trace,
               std::vector<StiffnessChange> stiffness = {});
   ~Sensitivity();
   /// Can be moved, not copied.
   Sensitivity(Sensitivity &&) noexcept;

   /// InputError if the response belongs to another trace. The monitor is called between
   /// states; if it stops the gradient, `found` is false.
   Gradient gradient(const Response &response, const Monitor &monitor = {});
   /// InputError if sizes do not fit the problem and the history.
   TraceChange along(const Parameters &change, const Monitor &monitor = {});

   /// Number of dense factorisations so far.
   long factorisations() const;
   /// How often an unknown was bordered to a factor so far.
   long updates() const;

private:
   struct System;
   std::unique_ptr<System> system_;
};

} // namespace cattaneo
