#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>

namespace cattaneo
{

LoadCycle LoadCycle::through(const ReducedProblem &problem, const NamedLoads &constant,
                             const std::vector<NamedLoads> &vertices)
{
   LoadCycle cycle{problem.multipliers(constant),
                   Eigen::MatrixXd(problem.patterns.size(), vertices.size())};
   for (std::size_t j = 0; j < vertices.size(); ++j)
   {
      cycle.varying.col(j) = problem.multipliers(vertices[j]);
   }
   return cycle;
}

Eigen::MatrixXd LoadCycle::multipliers(double load_factor) const
{
   return (load_factor * varying).colwise() + constant;
}

LoadHistory LoadCycle::history(double load_factor, std::vector<Eigen::VectorXd> opening,
                               bool from_opening, int cycles) const
{
   const Eigen::MatrixXd at = multipliers(load_factor);
   const std::size_t first = opening.size() - (from_opening ? 1 : 0);
   for (const auto vertex : at.colwise()) { opening.emplace_back(vertex); }
   opening.push_back(opening[first]);
   LoadHistory history = LoadHistory::through(opening);
   history.cycle_start = static_cast<int>(first);
   history.cycles = cycles;
   return history;
}

void LoadCycle::validate(const ReducedProblem &problem) const
{
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   require(constant.size() == patterns, "load cycle: ", constant.size(),
           " constant multipliers, must be one for each of the ", patterns, " load patterns");
   require(varying.rows() == patterns, "load cycle: ", varying.rows(),
           " varying multipliers for ", patterns, " load patterns");
   require(varying.cols() > 0, "load cycle: there is no vertex, must be at least one");
   require(constant.allFinite() && varying.allFinite(),
           "load cycle: a multiplier is not finite");
}

LoadCycle held_and_cycled(const ReducedProblem &problem, const std::string &held, double load,
                          const std::string &cycled, double reversal)
{
   require(reversal >= -1 && reversal <= 1, "load cycle: reversal R is ", reversal,
           ", must be between -1 and 1");
   return LoadCycle::through(problem, {{held, load}}, {{{cycled, 1}}, {{cycled, reversal}}});
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
