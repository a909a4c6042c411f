#pragma once

#include "common/receding.hpp"
#include "common/study.hpp"

#include <vector>

namespace miniapp
{

/// Number of nodes before a place on the line.
Eigen::Index nodes_before(const Eigen::VectorXd &x, double at);

/** The bonded strip of an overhang (thesis 5.2): its corner, the friction for full adhesion,
    its traction ratio. @param others overhangs (load patterns of the problem) to draw in its
    place (figure 5.2), with those at which the kind of the strip changes. */
void report_bonded(Study &study, const RecedingOptions &options,
                   const cattaneo::ReducedProblem &problem, double overhang,
                   const std::vector<double> &others);

} // namespace miniapp
