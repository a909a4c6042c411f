#pragma once

#include <cattaneo/progress_report.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cattaneo/shakedown/limit.hpp>

/// What the searches for a limit of the load and of friction have in common.
namespace cattaneo
{

/// InputError for settings, a problem or residual forces that are not sound.
void check_limit(const ReducedProblem &reduced, const ResidualForces &residual,
                 const LimitSettings &settings);

/// A typical force of each node: its largest under the given loads, but not less than a
/// thousandth of the median, so that a node without force of its own still has a scale.
Eigen::VectorXd typical_forces(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p);

/// One cone programme, counted in the report.
ConeSolution solve_counted(const ConeProgramme &programme, const LimitSettings &settings,
                           const ConeStart &start, LimitReport &report,
                           ProgressReport &progress);

/// What is proven stands, whoever wanted it to stop.
LimitStatus unless_stopped(LimitStatus status, const Monitor &monitor);

/// A point was returned, whatever the outcome.
bool usable(const ConeSolution &solution);

/// Every slip of interest moves no node further than this; a factor ten above the one found.
double slip_size(const Eigen::VectorXd &slip);

/** How far the loads stay from the cones of friction @a friction: the largest θ with
    f p - |q| ≥ θ weight at every node and vertex. */
ConeProgramme clearance_programme(const ResidualForces &residual, const StuckForces &loads,
                                  double load_factor, Eigen::VectorXd friction,
                                  const Eigen::MatrixXd &weight,
                                  const Eigen::VectorXd &force_scale);

} // namespace cattaneo
