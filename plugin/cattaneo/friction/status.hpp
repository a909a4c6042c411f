#pragma once

namespace cattaneo
{

/// Outcome of a friction solve or a march. All but the first are answers about the problem or
/// honest failures; none is an exception.
enum class FrictionStatus
{
   converged,
   gross_sliding, ///< a body slides (or rolls, or spins) away: no equilibrium beyond the
                  ///< reported load
   not_unique,    ///< solved, but friction is above its critical value at the named node
   no_solution,   ///< no equilibrium was found, with friction above critical or the body lifted
                  ///< off
   stalled,       ///< no method reached the tolerance: residuals in the report
   stopped        ///< a march was asked to stop (Monitor::stop)
};

const char *name(FrictionStatus status);

} // namespace cattaneo
