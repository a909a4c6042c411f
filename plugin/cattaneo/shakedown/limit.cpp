#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit.hpp>

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
