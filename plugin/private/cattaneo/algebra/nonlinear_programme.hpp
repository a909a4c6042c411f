#pragma once

#include <Eigen/Core>
#include <string>

namespace cattaneo
{

/** Minimise f(x) under low ≤ x ≤ high and least ≤ c(x) ≤ most, in Ipopt's form. Second
    derivatives are those of f + λ·c. Matrices are sparse: Ipopt first calls with `values` null,
    to get the places of the entries, and afterwards to get their values in the same order. A
    function returns false if it has no value at x. */
class NonlinearProgramme
{
public:
   struct Sizes
   {
      Eigen::Index variables = 0, conditions = 0, jacobian = 0, hessian = 0;
   };
   /// Bounds of 2e19 and more count as infinite.
   struct Bounds
   {
      Eigen::VectorXd low, high, least, most;
   };
   virtual ~NonlinearProgramme() = default;
   virtual Sizes sizes() const = 0;
   virtual Bounds bounds() const = 0;
   virtual Eigen::VectorXd start() const = 0;
   /// Multipliers of the conditions to start from; empty: none are known.
   virtual Eigen::VectorXd multipliers() const { return {}; }
   virtual bool value(const double *x, double &f) const = 0;
   virtual bool gradient(const double *x, double *f) const = 0;
   virtual bool conditions(const double *x, double *c) const = 0;
   virtual bool jacobian(const double *x, int *row, int *column, double *values) const = 0;
   /// The lower triangle, of the conditions alone: f is linear or no second derivatives are
   /// asked for.
   virtual bool hessian(const double *, const double *, int *, int *, double *) const
   {
      return true;
   }
   /// Called in every iteration.
   virtual bool goes_on(int) const { return true; }
};

/// Known properties of a programme, which the method may use.
struct ProgrammeSettings
{
   double tolerance = 1e-8; ///< of all conditions of optimality
   int max_iterations = 300;
   bool second_derivatives = true; ///< or estimates from the steps
   bool linear_equations = false;  ///< derivatives of equations are constant
   bool linear =
      false; ///< derivatives of all conditions are constant, and all conditions are equations
   bool convex = false; ///< needs no safeguard of the barrier parameter
};

enum class ProgrammeOutcome
{
   solved,
   infeasible, ///< no point was found that meets all conditions
   failed,
   stopped,
   unavailable ///< built without Ipopt
};

/// With ∇f + Σ λ ∇c - z_low + z_high = 0.
struct ProgrammeSolution
{
   ProgrammeOutcome outcome = ProgrammeOutcome::failed;
   std::string message; ///< why it was not solved
   Eigen::VectorXd x, z_low, z_high, lambda;
   int iterations = 0;
};

/// Solves by Ipopt, silently and without scaling, so everything should be of order one.
ProgrammeSolution solve(const NonlinearProgramme &programme, const ProgrammeSettings &settings);

} // namespace cattaneo
