#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/residual_forces.hpp>
#include <cmath>

namespace cattaneo
{

ResidualForces residual_forces(const ReducedProblem &problem)
{
   problem.validate();
   require(
      problem.components() > 0,
      "shakedown: the problem was reduced without friction, must have tangential components");
   require(problem.gap.cwiseAbs().maxCoeff() == 0, "shakedown: the largest gap is ",
           problem.gap.cwiseAbs().maxCoeff(),
           ", must be zero (absorb_gap makes it a load pattern)");
   ResidualForces residual;
   residual.rigid = rigid_slips(problem);
   const SemidefiniteSolver A(problem.A(), residual.rigid);
   require(
      A.definite(),
      "reduced problem: A is not positive semidefinite, or more slips cause no forces than "
      "the rigid motions of the problem allow (",
      residual.rigid.cols(), ")");
   const Eigen::Index m = problem.slips();
   const Eigen::MatrixXd inverse = A.solve(Eigen::MatrixXd::Identity(m, m));
   residual.flexibility = 0.5 * (inverse + inverse.transpose());
   residual.uncoupled = !problem.coupled;
   residual.transfer = problem.B() * residual.flexibility;
   return residual;
}

double degree_of_coupling(const ReducedProblem &problem)
{
   problem.validate();
   if (!problem.coupled) { return 0; }
   const Eigen::MatrixXd slips = rigid_slips(problem);
   Eigen::MatrixXd openings = rigid_openings(problem);
   const Eigen::MatrixXd of_slip =
      problem.B() * SemidefiniteSolver(problem.A(), slips).solve(problem.B().transpose());
   // B A⁻¹ Bᵀ x = β² C x, with springs on the openings that C does not resist.
   const Eigen::VectorXd own = problem.C().diagonal().cwiseSqrt();
   DenseCholesky C;
   const auto factored = [&]
   {
      const Eigen::MatrixXd springs = own.asDiagonal() * openings;
      return C.compute(problem.C() + springs * springs.transpose());
   };
   if (!factored())
   {
      // A stiffness that no bodies have (with B transposed, for instance) need not be
      // semidefinite, and its rigid motions do not tell what C alone does not resist.
      openings = null_space(problem.C());
      require(factored(), "reduced problem: C is not positive semidefinite");
   }
   Eigen::MatrixXd half = of_slip;
   C.solve_half(half);
   Eigen::MatrixXd gram = half.transpose();
   C.solve_half(gram);
   // A rigid motion that both slips and opens (rotation of a curved contact) correlates
   // exactly.
   const Eigen::Index both =
      std::max<Eigen::Index>(0, problem.rigid_motions.cols() - slips.cols() - openings.cols());
   const Eigen::VectorXd values = symmetric_eigenvalues(0.5 * (gram + gram.transpose()));
   const Eigen::Index last = values.size() - 1 - both;
   return last < 0 ? 0 : std::sqrt(std::max(0.0, values[last]));
}

} // namespace cattaneo
