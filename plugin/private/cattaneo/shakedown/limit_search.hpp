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
   /// forces that are not valid.
   LimitSearch(const ReducedProblem &reduced, const ResidualForces &residual, StuckForces loads,
               const LimitSettings &settings);

   /// The report with this outcome. Proven bounds stay valid, even if the search was stopped.
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

/// Appends to a sentence, in brackets, the message of the solver of the last programme, or that
/// it ended as it should.
std::string because(const std::string &message);

/// The sentence on proven bounds with a wider gap than requested.
std::string not_closed(const std::string &message);

/// Margin of the constant loads of a programme to its cones: the largest θ with f p + s0 - |q +
/// a p| ≥ θ weight at every node and column.
ConeProgramme clearance_programme(ConeProgramme programme, const Eigen::MatrixXd &weight);

/// A typical force of each node: its largest under the given loads, but not less than a
/// thousandth of the median, so that a node without force of its own still has a scale.
Eigen::VectorXd typical_forces(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p);

/// Did the solver return a point, whatever the outcome?
bool usable(const ConeSolution &solution);

/// A bound of the slips: ten times the largest displacement of a node in the slip that was
/// found.
double slip_size(const Eigen::VectorXd &slip);

} // namespace cattaneo
