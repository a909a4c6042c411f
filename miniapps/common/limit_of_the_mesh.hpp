#pragma once

#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>
#include <cattaneo/shakedown/residual_forces.hpp>
#include <optional>
#include <vector>

namespace miniapp
{

/// The nodes that are closed throughout some cycles marched from rest; none if the monitor
/// stopped the march. InputError if it does not end well.
std::optional<std::vector<Eigen::Index>> stay_closed(const cattaneo::ReducedProblem &problem,
                                                     const cattaneo::LoadCycle &cycle,
                                                     double load_factor, int cycles,
                                                     const cattaneo::Monitor &monitor);

/// Of the work that the mechanism of a limit dissipates, f p |slip|: the share within 1 % of
/// the length from either end of the contact line. NaN without a mechanism.
double share_of_ends(const cattaneo::ReducedProblem &problem,
                     const cattaneo::StuckForces &stuck, const cattaneo::LimitReport &limit,
                     double load_factor, double friction);

/// Where the contact that stays closed ends within its line, and stuck shear is singular: the
/// last such closed node, numbered in the part, or -1.
Eigen::Index singular_end(const cattaneo::ReducedProblem &whole,
                          const cattaneo::ClosedContact &part,
                          const cattaneo::StuckForces &stuck);

} // namespace miniapp
