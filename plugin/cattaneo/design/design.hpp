#pragma once

#include <cattaneo/design/sensitivity.hpp>
#include <functional>

namespace cattaneo
{

/// One load case of a design. It is marched from the virgin state.
struct DesignCase
{
   std::string name;    ///< in messages
   LoadHistory history; ///< of the problem's patterns
   double weight = 1;   ///< weight of its responses; a negative weight maximises them
   /// Responses are taken at the points of the history from this time on. NaN: at the last
   /// point only.
   double from = std::nan("");
};

/// Computes the responses of a case. Their number must not depend on the variables. `states`
/// are the states at the points of the history that count.
using DesignObjective = std::function<std::vector<Response>(
   const Responses &of, const std::vector<std::size_t> &states)>;

/// The number that is minimised.
enum class DesignGoal
{
   least_largest, ///< the largest response of all cases, each times its case's weight
   least_sum      ///< the sum of all responses, each times its case's weight
};

/** The variables of a design and its goal. Each variable x_j adds x_j times a change of
    parameters (gap, friction, load multipliers) to those of the problem and its cases, for
    instance

        gap = G0 + Σ x_j g_j.

    A gap of any smooth shape may be added. Variables lie between bounds, and linear
    combinations L x of them between limits. */
struct DesignProblem
{
   ReducedProblem problem;        ///< of x = 0
   std::vector<DesignCase> cases; ///< at least one
   /// Change of the parameters by each variable, per unit of it. Changes of stiffness are not
   /// allowed. Changes of multipliers apply to the histories of all cases alike.
   std::vector<Parameters> variables;
   /// Adds a gap (size n) that may depend on the variables in any way. It writes its
   /// derivatives to `by` (n × number of variables); they must be continuous. Without it the
   /// gap is linear in the variables.
   std::function<Eigen::VectorXd(const Eigen::VectorXd &x, Eigen::MatrixXd &by)> shape;
   Eigen::VectorXd low;                         ///< lower bound of each, finite
   Eigen::VectorXd high;                        ///< upper bound of each, finite
   Eigen::MatrixXd limits;                      ///< L, one row per limit
   Eigen::VectorXd least;                       ///< lower limits of L x; -infinity: none
   Eigen::VectorXd most;                        ///< upper limits of L x; infinity: none
   DesignGoal goal = DesignGoal::least_largest; ///< of the objective's responses
   /// None: pressures of all nodes, so that the goal is the least peak pressure.
   DesignObjective objective;

   /// The problem with values x of the variables. InputError if x has another size.
   ReducedProblem with(const Eigen::VectorXd &x) const;
   /// Change of the parameters by each variable at these values, per unit of it. InputError if
   /// x has another size.
   std::vector<Parameters> changes(const Eigen::VectorXd &x) const;
   /// InputError if sizes do not fit, a bound is not finite or above the other.
   void validate() const;
};

/// Variables that are the columns of G (n × number of variables), added to the gap.
std::vector<Parameters> gap_variables(const Eigen::MatrixXd &G);

/** Adds limits for the second differences of the gap along each chain of nodes: its curvature
    at each node that has two neighbours, positive where it opens to both sides, is to lie
    between `least` and `most`. InputError if variables or positions along the line are missing.
    */
void limit_curvature(DesignProblem &problem, double least, double most);

/// The first row of `limits` that L x violates by more than `tolerance` times the sum of the
/// absolute values of its terms; -1: none.
Eigen::Index violated_limit(const DesignProblem &problem, const Eigen::VectorXd &x,
                            double tolerance = 1e-12);

/** Other starts for a search: `count` points that are spread evenly over the box of the bounds
    (the sequence of the generalised golden ratio). A point that violates limits is replaced by
    the place that is reached from `start` toward it, along the limits that are met. InputError
    unless `start` is within bounds and limits. */
std::vector<Eigen::VectorXd> spread_starts(const DesignProblem &problem,
                                           const Eigen::VectorXd &start, int count);

/// Outcome of a search.
enum class DesignStatus
{
   optimal,        ///< conditions of optimality hold to the tolerance
   improved,       ///< the best design that was found, but the conditions do not hold: see the
                   ///< message
   no_equilibrium, ///< the marches at the start do not reach their end
   unavailable,    ///< built without Ipopt
   stopped         ///< by the monitor: the best design so far (no traces: none)
};

/// As it is printed, in words.
const char *name(DesignStatus status);

/// How a design is searched. The defaults need no tuning.
struct DesignSettings
{
   /// a steady state does not end the march; its monitor is for the whole search
   MarchSettings march;
   /// Largest error of the conditions of optimality, in units of the objective at the start,
   /// and of the limits.
   double tolerance = 1e-8;
   int max_iterations = 300; ///< of Ipopt

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// One response that an optimum depends on.
struct ActiveResponse
{
   std::size_t load_case = 0; ///< in DesignProblem::cases
   std::size_t index = 0;     ///< place in the list of the objective's responses
   double value = 0;          ///< times the case's weight
   double multiplier = 0;     ///< share of it in the optimum, they add up to 1
};

/// The best design that was found, and how well it meets the conditions of an optimum.
struct DesignReport
{
   DesignStatus status = DesignStatus::improved; ///< outcome for x
   std::string message;                          ///< what was found, in one sentence
   Eigen::VectorXd x;                            ///< variables
   double objective = std::nan("");              ///< of x; NaN: not known
   double objective_at_start = std::nan("");     ///< of the start; NaN: not known
   std::vector<MarchTrace> traces;               ///< of each case there
   /// The conditions of optimality (Karush, Kuhn and Tucker), as they hold there, formed anew
   /// from the derivatives. Largest entry of the gradient of the Lagrangian, over the largest
   /// derivative of a response by that variable at the start; product of a multiplier with the
   /// distance from its bound or limit, over the objective at the start. NaN: not known,
   /// because the search ended without multipliers.
   double stationarity = std::nan("");
   double complementarity = std::nan(""); ///< see above
   /// Largest violation of a limit. Its unit is the most that one variable changes the limit
   /// when it changes the objective by the objective's value at the start.
   double violation = std::nan("");
   /// Least-largest goal: the responses with multipliers above 1e-6.
   std::vector<ActiveResponse> active;
   Eigen::VectorXd bound_multipliers; ///< of each variable; positive: of the upper bound
   Eigen::VectorXd limit_multipliers; ///< of each limit; positive: of the upper one
   std::vector<Tie> ties; ///< of the optimum, all cases: derivatives there are one-sided
   int iterations = 0;    ///< of Ipopt
   long marches = 0;      ///< cases that were marched
   long gradients = 0;    ///< cases that were differentiated
   double seconds = 0;    ///< wall time
};

/** Finds the best variables from a start within bounds and limits, by Ipopt with the
    derivatives of Sensitivity. The largest response is minimised through a bound on all
    responses. Peak pressures, which are linear between changes of states, are minimised by
    linear programmes within a trust region. The result is a local optimum, because contact is
    not convex. Responses have kinks where nodes change their states. If this happens at the
    optimum, its conditions need not hold, and the outcome is `improved`: the best design that
    was tried, never worse than the start.

    `start`: a value of each variable. InputError if it is outside of a bound or a limit, if the
    derivatives of a shape are not those of its values, and as DesignProblem::validate() and
    march(). */
DesignReport design(const DesignProblem &problem, const Eigen::VectorXd &start,
                    const DesignSettings &settings = {});

} // namespace cattaneo
