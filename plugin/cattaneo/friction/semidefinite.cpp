#include <cattaneo/dense_algebra.hpp>
#include <cattaneo/friction/semidefinite.hpp>

namespace cattaneo
{

SemidefiniteSolver::SemidefiniteSolver(const Eigen::MatrixXd &A)
   : ldlt_(A), inverse_pivots_(ldlt_.vectorD())
{
   // Rigid motions of a condensed body come out at 1e-15 to 1e-14 of the stiffness, the softest
   // elastic motion of a body a million times the contact's size at 1e-2.
   const double largest = inverse_pivots_.cwiseAbs().maxCoeff();
   const double floor = 1e-11 * largest;
   for (Eigen::Index k = 0; k < inverse_pivots_.size(); ++k)
   {
      double &d = inverse_pivots_[k];
      double size = 1; // of the motion with the energy d, 1 at the pivot: a rotation's pivot
                       // can lie near the axis, where it hardly moves
      if (d > floor && d < 1e-5 * largest)
      {
         Eigen::VectorXd motion = Eigen::VectorXd::Unit(inverse_pivots_.size(), k);
         ldlt_.matrixU().solveInPlace(motion);
         size = motion.squaredNorm();
      }
      d = d > floor * size ? 1 / d : 0.0;
   }
}

Eigen::MatrixXd SemidefiniteSolver::solve(const Eigen::MatrixXd &rhs) const
{
   Eigen::MatrixXd x = ldlt_.transpositionsP() * rhs;
   ldlt_.matrixL().solveInPlace(x);
   x = (inverse_pivots_.asDiagonal() * x).eval();
   ldlt_.matrixU().solveInPlace(x);
   return ldlt_.transpositionsP().transpose() * x;
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
   Z = (ldlt_.transpositionsP().transpose() * Z).eval();
   return thin_qr(Z).Q;
}

} // namespace cattaneo
