#pragma once

#include "common/study.hpp"
#include "design/design_choice.hpp"

#include <cattaneo/design/design.hpp>

namespace miniapp
{

/// Positions along the contact from the middle of it.
Eigen::VectorXd places(const cattaneo::ReducedProblem &problem);

/// Energy that each node that has a weight loses per area, from the first state to the last.
std::vector<cattaneo::Response> densities(const cattaneo::ReducedProblem &problem,
                                          const cattaneo::Responses &of,
                                          const std::vector<std::size_t> &states);

/// Where the march of a case without equilibrium, the first of them, came to its event:
/// `event_time` and `event_loads`.
void report_event(Study &study, const cattaneo::DesignProblem &problem,
                  const Eigen::VectorXd &x, cattaneo::MarchSettings settings);

/// All cases before and after, marched: a table `cases`, the pressures where they are largest
/// and, if the goal is the energy that a node loses, that of all nodes.
void report_cases(Study &study, const cattaneo::DesignProblem &problem,
                  const cattaneo::DesignReport &report, const DesignVariables &variables,
                  const std::string &goal, const cattaneo::MarchSettings &settings);

/// The goal along each variable through the optimum, where limits hold: it is to have its
/// least value there.
void draw_lines(Study &study, const cattaneo::DesignProblem &problem,
                const cattaneo::DesignReport &report, const DesignVariables &variables,
                const std::string &goal, const cattaneo::MarchSettings &settings, int steps);

} // namespace miniapp
