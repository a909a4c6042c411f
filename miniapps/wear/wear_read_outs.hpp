#pragma once

#include "wear/wearing_pad.hpp"

#include <cattaneo/wear/wear_march.hpp>
#include <cattaneo/wear/worn_out.hpp>

namespace miniapp
{

/// A problem whose surfaces are worn.
ReducedProblem with_gap(ReducedProblem problem, const Eigen::VectorXd &depth);

/// Warns of a depth that is not small against what touches or is worn: frames, weights and
/// stiffness are those of the unworn bodies.
void warn_of_depth(const ReducedProblem &problem, const Eigen::VectorXd &depth,
                   const cattaneo::ContactState &contact);

/// The state in which wear ends, solved for directly, also in the panels of depths and
/// pressures.
void report_end(Study &study, const WearCase &scene, const cattaneo::WornOut &end,
                Panel &profiles, Panel &pressures);

/// One cycle more in many increments, for the loop of each load that varies.
void draw_loop(Panel &panel, const std::string &label, const WearCase &scene,
               const cattaneo::WearState &state, cattaneo::MarchSettings settings);

} // namespace miniapp
