#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <limits>

namespace cattaneo
{

SemidefiniteSolver::SemidefiniteSolver(const Eigen::MatrixXd &A)
{
   // Every row by its own stiffness, so that a soft node beside a stiff one is not taken for
   // one that nothing holds.
   const Eigen::VectorXd own = A.diagonal();
   scale_ = (own.array() > 0).select(own.cwiseSqrt().cwiseInverse(), 1.0);
   const Eigen::MatrixXd scaled = scale_.asDiagonal() * A * scale_.asDiagonal();
   ldlt_.compute(scaled);
   inverse_pivots_ = ldlt_.vectorD();
   // Candidates are motions of little energy; a pivot is the energy of the motion that is 1 at
   // the pivot, where a rotation about a point nearby hardly moves.
   const Eigen::Index n = inverse_pivots_.size();
   Eigen::MatrixXd Z(n, 0);
   for (Eigen::Index k = 0; k < n; ++k)
   {
      double &d = inverse_pivots_[k];
      bool free = d <= 1e-5;
      if (free)
      {
         Eigen::VectorXd motion = Eigen::VectorXd::Unit(n, k);
         ldlt_.matrixU().solveInPlace(motion);
         motion = (ldlt_.transpositionsP().transpose() * motion).eval();
         free = rests(scaled, motion);
      }
      d = free ? 0.0 : 1 / d;
   }
}

/// Does a motion meet no more energy than the rounding of the entries makes?
bool SemidefiniteSolver::rests(const Eigen::MatrixXd &A, const Eigen::VectorXd &motion)
{
   using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
   const Long x = motion.cast<long double>();
   long double energy = 0, round_off = 0;
   for (Eigen::Index j = 0; j < x.size(); ++j)
   {
      energy += x[j] * A.col(j).cast<long double>().dot(x);
      round_off += std::abs(x[j]) * A.col(j).cwiseAbs().cast<long double>().dot(x.cwiseAbs());
   }
   return energy <= 8 * std::numeric_limits<double>::epsilon() * round_off;
}

Eigen::MatrixXd SemidefiniteSolver::solve(const Eigen::MatrixXd &rhs) const
{
   Eigen::MatrixXd x = ldlt_.transpositionsP() * (scale_.asDiagonal() * rhs);
   ldlt_.matrixL().solveInPlace(x);
   x = (inverse_pivots_.asDiagonal() * x).eval();
   ldlt_.matrixU().solveInPlace(x);
   return scale_.asDiagonal() * (ldlt_.transpositionsP().transpose() * x);
}

Eigen::MatrixXd SemidefiniteSolver::null_space() const
{
   const Eigen::Index n = inverse_pivots_.size(), rank = (inverse_pivots_.array() != 0).count();
   Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(n, n - rank);
   for (Eigen::Index i = 0, k = 0; i < n; ++i)
   {
      if (inverse_pivots_[i] == 0) { Z(i, k++) = 1; }
   }
   if (Z.cols() == 0) { return Z; }
   ldlt_.matrixU().solveInPlace(Z);
   Z = (scale_.asDiagonal() * (ldlt_.transpositionsP().transpose() * Z)).eval();
   return thin_qr(Z).Q;
}

} // namespace cattaneo
