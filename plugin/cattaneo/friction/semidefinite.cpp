#include <cattaneo/friction/semidefinite.hpp>

namespace cattaneo
{

SemidefiniteSolver::SemidefiniteSolver(const Eigen::MatrixXd &A)
   : ldlt_(A), inverse_pivots_(ldlt_.vectorD())
{
   // Rigid motions of a condensed body come out at 1e-15 to 1e-14 of the stiffness, the softest
   // elastic motion of a body a million times the contact's size at 1e-2.
   const double floor = 1e-11 * inverse_pivots_.cwiseAbs().maxCoeff();
   for (double &d : inverse_pivots_) { d = d > floor ? 1 / d : 0.0; }
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
   return Eigen::HouseholderQR<Eigen::MatrixXd>(Z).householderQ() *
          Eigen::MatrixXd::Identity(n, Z.cols());
}

} // namespace cattaneo
