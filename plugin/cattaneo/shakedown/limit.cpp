#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <sstream>

namespace cattaneo
{

LimitProblem limit_problem(ReducedProblem reduced, LoadCycle cycle)
{
   ResidualForces residual = residual_forces(reduced);
   cycle.validate(reduced);
   const double coupling = residual.uncoupled ? 0 : degree_of_coupling(reduced);
   return {std::move(reduced), std::move(residual), coupling, std::move(cycle)};
}

const char *name(LimitStatus status)
{
   const char *const names[] = {"certified", "bracketed", "unlimited",  "no solution",
                                "failed",    "stopped",   "unavailable"};
   return names[static_cast<int>(status)];
}

std::string nine_digits(double value)
{
   std::ostringstream text;
   text.precision(9);
   text << value;
   return text.str();
}

std::vector<std::string> LimitReport::statement() const
{
   if (!proven() && status != LimitStatus::unlimited) { return {}; }
   std::vector<std::string> all = {std::string("assumed: ") + limit_assumption};
   if (!starts.empty()) { all.push_back(starts); }
   if (!of_the_mesh.empty()) { all.push_back("of this mesh only: " + of_the_mesh); }
   return all;
}

void LimitSettings::validate() const
{
   require(tolerance >= 1e-9 && tolerance < 1, "shakedown: tolerance is ", tolerance,
           ", must be at least 1e-9 and below 1");
   require_at_least("shakedown: max_iterations", max_iterations, 1);
   require_positive("shakedown: largest_factor", largest_factor);
   require_positive("shakedown: largest_friction", largest_friction);
   monitor.validate();
}

} // namespace cattaneo
