#pragma once

#include <cattaneo/algebra/nonlinear_programme.hpp>
#include <functional>
#include <string>

namespace cattaneo
{

/** Minimise f(y) under low ≤ y ≤ high and least ≤ c(y) ≤ most, all of order one. Bounds of 2e19
    and more count as infinite. */
struct SmoothProgramme
{
   Eigen::VectorXd low, high, least, most;
   /// Are f and c linear?
   bool linear = false;
   /// False: f or c has no value at y.
   std::function<bool(const Eigen::VectorXd &y, double &f, Eigen::VectorXd &c)> values;
   std::function<bool(const Eigen::VectorXd &y, Eigen::VectorXd &f, Eigen::MatrixXd &c)>
      derivatives;
   std::function<bool(int iteration)> goes_on; ///< called in every iteration
};

/// With ∇f + Σ λ ∇c + z = 0, multipliers of upper bounds positive.
struct SmoothSolution
{
   ProgrammeOutcome outcome = ProgrammeOutcome::failed;
   std::string message;
   Eigen::VectorXd y, z, lambda;
   int iterations = 0;
};

SmoothSolution solve(const SmoothProgramme &programme, const Eigen::VectorXd &start,
                     double tolerance, int max_iterations);

} // namespace cattaneo
