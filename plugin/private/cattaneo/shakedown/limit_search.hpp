#pragma once

#include <cattaneo/progress_report.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>

namespace cattaneo
{

/// The common part of the searches for a limit of the load and of friction.
class LimitSearch
{
protected:
   /// All but the loads must outlive the search. InputError for settings, a problem or residual
   /// forces that are not sound.
   LimitSearch(const ReducedProblem &reduced, const ResidualForces &residual, StuckForces loads,
               const LimitSettings &settings);

   /// The report with this outcome. Proven bounds stand, even if the search was stopped.
   LimitReport ended(LimitStatus status, const std::string &message);
   /// One cone programme, counted in the report.
   ConeSolution solve(const ConeProgramme &programme, const ConeStart &start);

   const ReducedProblem &reduced_;
   const ResidualForces &residual_;
   const StuckForces loads_;
   const LimitSettings &settings_;
   const Eigen::VectorXd no_slip_;
   ProgressReport progress_;
   LimitReport report_;
};

/// Continues a sentence by what the solver of the last programme said, in brackets, or by that
/// it ended as it should.
std::string because(const std::string &message);

/// The sentence on proven bounds that lie further apart than asked for.
std::string not_closed(const std::string &message);

/// How far the constant loads of a programme stay from its cones: the largest θ with
/// f p + s0 - |q + a p| ≥ θ weight at every node and column.
ConeProgramme clearance_programme(ConeProgramme programme, const Eigen::MatrixXd &weight);

/// A typical force of each node: its largest under the given loads, but not less than a
/// thousandth of the median, so that a node without force of its own still has a scale.
Eigen::VectorXd typical_forces(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p);

/// A point was returned, whatever the outcome.
bool usable(const ConeSolution &solution);

/// Every slip of interest moves no node further than this; a factor ten above the one found.
double slip_size(const Eigen::VectorXd &slip);

} // namespace cattaneo
