#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>

namespace cattaneo
{

Eigen::MatrixXd LoadCycle::multipliers(double load_factor) const
{
   return (load_factor * varying).colwise() + constant;
}

void LoadCycle::validate(const ReducedProblem &problem) const
{
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   require(constant.size() == patterns, "load cycle: ", constant.size(),
           " constant multipliers for ", patterns, " load patterns");
   require(varying.rows() == patterns, "load cycle: ", varying.rows(),
           " varying multipliers for ", patterns, " load patterns");
   require(varying.cols() > 0, "load cycle: there is no vertex");
   require(constant.allFinite() && varying.allFinite(),
           "load cycle: a multiplier is not finite");
}

LoadCycle held_and_cycled(const ReducedProblem &problem, const std::string &held, double load,
                          const std::string &cycled, double reversal)
{
   require(reversal >= -1 && reversal <= 1, "load cycle: reversal R is ", reversal,
           ", must be between -1 and 1");
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   LoadCycle cycle{Eigen::VectorXd::Zero(patterns), Eigen::MatrixXd::Zero(patterns, 2)};
   cycle.constant[problem.pattern(held)] = load;
   cycle.varying.row(problem.pattern(cycled)) << 1, reversal;
   return cycle;
}

StuckForces stuck_forces(const ReducedProblem &problem, const LoadCycle &cycle)
{
   cycle.validate(problem);
   const Eigen::Index n = problem.nodes(), m = problem.slips(), vertices = cycle.vertices();
   const Eigen::VectorXd constant = problem.clamped_forces(cycle.constant);
   StuckForces forces{constant.head(m).replicate(1, vertices), Eigen::MatrixXd(m, vertices),
                      constant.tail(n).replicate(1, vertices), Eigen::MatrixXd(n, vertices)};
   for (Eigen::Index j = 0; j < vertices; ++j)
   {
      const Eigen::VectorXd varying = problem.clamped_forces(cycle.varying.col(j));
      forces.q1.col(j) = varying.head(m);
      forces.p1.col(j) = varying.tail(n);
   }
   return forces;
}

} // namespace cattaneo
