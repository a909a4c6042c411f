#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/residual_forces.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

/// Eigenvalues below this share of the largest, after scaling to a unit diagonal, are rigid
/// motions: they come out of a condensation at 1e-15, the softest elastic one at 1e-4 or above.
constexpr double rigid_share = 1e-10;

/// A symmetric positive semidefinite matrix K = scale⁻¹ U Λ Uᵀ scale⁻¹, scale = diag(K)^(-1/2).
struct Spectrum
{
   Eigen::VectorXd scale;
   Eigen::VectorXd values; ///< ascending, of the matrix scaled to a unit diagonal
   Eigen::MatrixXd vectors;
   Eigen::Index rigid = 0; ///< number of leading values that are zero to round-off

   Spectrum(const char *name, const Eigen::MatrixXd &K)
      : scale(K.diagonal().cwiseSqrt().cwiseInverse())
   {
      const SymmetricModes modes = symmetric_modes(scale.asDiagonal() * K * scale.asDiagonal());
      values = modes.values;
      vectors = modes.vectors;
      const double zero = rigid_share * values[values.size() - 1];
      require(values[0] > -zero, "reduced problem: ", name,
              " is not positive semidefinite: smallest eigenvalue ", values[0],
              " after scaling to a unit diagonal");
      while (rigid < values.size() && values[rigid] <= zero) { ++rigid; }
   }

   /// F with F Fᵀ a generalised inverse of K.
   Eigen::MatrixXd inverse_root() const
   {
      const Eigen::Index elastic = values.size() - rigid;
      return scale.asDiagonal() * vectors.rightCols(elastic) *
             values.tail(elastic).cwiseSqrt().cwiseInverse().asDiagonal();
   }
};

} // namespace

ResidualForces residual_forces(const ReducedProblem &problem)
{
   problem.validate();
   require(problem.components() > 0, "shakedown: the problem was reduced without friction");
   require(problem.gap.cwiseAbs().maxCoeff() == 0, "shakedown: the largest gap is ",
           problem.gap.cwiseAbs().maxCoeff(),
           ", must be zero (absorb_gap makes it a load pattern)");
   const Spectrum spectrum("A", problem.A());
   ResidualForces residual;
   const Eigen::MatrixXd root = spectrum.inverse_root();
   residual.flexibility = root * root.transpose();
   residual.rigid = spectrum.scale.asDiagonal() * spectrum.vectors.leftCols(spectrum.rigid);
   residual.rigid.colwise().normalize();

   residual.uncoupled = !problem.coupled;
   if (residual.uncoupled)
   {
      residual.transfer = Eigen::MatrixXd::Zero(problem.nodes(), problem.slips());
   }
   else
   {
      residual.transfer = problem.B() * residual.flexibility;
      const double leak =
         residual.rigid.cols() ? (problem.B() * residual.rigid).cwiseAbs().maxCoeff() : 0.0;
      // A coupling near round-off leaks round-off of the stiffnesses.
      const double round_off = 1e-13 * std::sqrt(problem.A().diagonal().maxCoeff() *
                                                 problem.C().diagonal().maxCoeff());
      require(leak <= std::max(1e-6 * problem.B().cwiseAbs().maxCoeff(), round_off),
              "reduced problem: stiffness is not positive semidefinite: a slip without "
              "tangential forces causes normal forces, largest ",
              leak);
   }
   return residual;
}

double degree_of_coupling(const ReducedProblem &problem)
{
   problem.validate();
   if (problem.components() == 0 || !problem.coupled) { return 0; }
   const Eigen::MatrixXd N = Spectrum("C", problem.C()).inverse_root().transpose() *
                             problem.B() * Spectrum("A", problem.A()).inverse_root();
   const Eigen::MatrixXd gram = N * N.transpose();
   // A rigid motion that both slips and opens (rotation of a curved contact) correlates
   // exactly.
   double largest = 0;
   for (const double value : symmetric_eigenvalues(gram))
   {
      if (value < 1 - 1e-9) { largest = std::max(largest, value); }
   }
   return std::sqrt(largest);
}

} // namespace cattaneo
