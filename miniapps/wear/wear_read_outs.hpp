#pragma once

#include "wear/wearing_pad.hpp"

#include <cattaneo/wear/wear_march.hpp>
#include <cattaneo/wear/worn_out.hpp>

namespace miniapp
{

/// The problem with worn surfaces.
ReducedProblem with_gap(ReducedProblem problem, const Eigen::VectorXd &depth);

/// Warns of a depth that is not small compared with the width that touches or is worn, because
/// frames, weights and stiffness are those of the unworn bodies.
void warn_of_depth(const ReducedProblem &problem, const Eigen::VectorXd &depth,
                   const cattaneo::ContactState &contact);

/// Computes the state in which wear ends directly, and adds it to the panels of depths and
/// pressures.
/// @param of_pad is it the pad, in its units?
void report_end(Study &study, const WearCase &scene, const cattaneo::WornOut &end, bool of_pad,
                Panel &profiles, Panel &pressures);

/// Marches one more cycle in many increments, for the loop of each load that varies.
void draw_loop(Panel &panel, const std::string &label, const WearCase &scene,
               const cattaneo::WearState &state, cattaneo::MarchSettings settings);

} // namespace miniapp
