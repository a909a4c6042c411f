#pragma once

#include "common/study.hpp"
#include "design/design_choice.hpp"

#include <cattaneo/design/design.hpp>

namespace miniapp
{

/// Positions along the contact, from its middle.
Eigen::VectorXd places(const cattaneo::ReducedProblem &problem);

/// Energy per area that each node with a weight loses from the first state to the last.
std::vector<cattaneo::Response> densities(const cattaneo::ReducedProblem &problem,
                                          const cattaneo::Responses &of,
                                          const std::vector<std::size_t> &states);

/// Writes `event_time` and `event_loads` of the first case whose march found no equilibrium.
void report_event(Study &study, const cattaneo::DesignProblem &problem,
                  const Eigen::VectorXd &x, cattaneo::MarchSettings settings);

/// Marches all cases before and after the design. Writes a table `cases`, the pressures in the
/// state with the largest one and, if the goal is the energy loss of a node, the losses of all
/// nodes.
void report_cases(Study &study, const cattaneo::DesignProblem &problem,
                  const cattaneo::DesignReport &report, const DesignVariables &variables,
                  const std::string &goal, const cattaneo::MarchSettings &settings);

/// Draws the goal along each variable through the optimum, as far as limits allow. It should
/// have its least value there.
void draw_lines(Study &study, const cattaneo::DesignProblem &problem,
                const cattaneo::DesignReport &report, const DesignVariables &variables,
                const std::string &goal, const cattaneo::MarchSettings &settings, int steps);

} // namespace miniapp
