#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace cattaneo
{

namespace
{

/// Every row by its own stiffness, so that a soft node beside a stiff one is not taken for one
/// that nothing holds.
Eigen::VectorXd scale_of(const Eigen::MatrixXd &A)
{
   const Eigen::VectorXd own = A.diagonal();
   return (own.array() > 0).select(own.cwiseSqrt().cwiseInverse(), 1.0);
}

/// Does a motion meet no more energy than the rounding of the entries makes? Those of a
/// condensed matrix are sums of about as many terms as it has rows, which round in all
/// directions: as their square root.
bool rests(const Eigen::MatrixXd &A, const Eigen::VectorXd &motion)
{
   using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
   const Long x = motion.cast<long double>();
   long double energy = 0, round_off = 0;
   for (Eigen::Index j = 0; j < x.size(); ++j)
   {
      energy += x[j] * A.col(j).cast<long double>().dot(x);
      round_off += std::abs(x[j]) * A.col(j).cwiseAbs().cast<long double>().dot(x.cwiseAbs());
   }
   // Energy below zero is no rest: the matrix is not semidefinite then.
   return std::abs(energy) <= 8 * std::sqrt(static_cast<long double>(x.size())) *
                                 std::numeric_limits<double>::epsilon() * round_off;
}

} // namespace

SemidefiniteSolver::SemidefiniteSolver(const Eigen::MatrixXd &A,
                                       const Eigen::MatrixXd &null_space)
   : scale_(scale_of(A)), null_(scale_.cwiseInverse().asDiagonal() * null_space)
{
   Eigen::MatrixXd scaled = scale_.asDiagonal() * A * scale_.asDiagonal();
   if (null_.cols() > 0)
   {
      null_ = thin_qr(null_).Q;
      scaled += null_ * null_.transpose();
   }
   ldlt_.compute(scaled);
}

bool SemidefiniteSolver::definite() const
{
   return ldlt_.vectorD().minCoeff() > 1e-13;
}

Eigen::MatrixXd SemidefiniteSolver::solve(const Eigen::MatrixXd &rhs) const
{
   Eigen::MatrixXd x = ldlt_.solve(scale_.asDiagonal() * rhs);
   x -= null_ * (null_.transpose() * x);
   return scale_.asDiagonal() * x;
}

Eigen::MatrixXd null_space(const Eigen::MatrixXd &A)
{
   const Eigen::Index n = A.rows();
   const Eigen::VectorXd scale = scale_of(A);
   const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
   const Eigen::LDLT<Eigen::MatrixXd> ldlt(scaled);
   Eigen::MatrixXd soft(n, 0);
   for (Eigen::Index k = 0; k < n; ++k)
   {
      // Candidates are motions of little energy; a pivot is the energy of the motion that is 1
      // at the pivot, where a rotation about a point nearby hardly moves.
      if (ldlt.vectorD()[k] > 1e-5) { continue; }
      Eigen::VectorXd motion = Eigen::VectorXd::Unit(n, k);
      ldlt.matrixU().solveInPlace(motion);
      soft.conservativeResize(Eigen::NoChange, soft.cols() + 1);
      soft.rightCols(1) = ldlt.transpositionsP().transpose() * motion.normalized();
   }
   if (soft.cols() == 0) { return soft; }
   // They are as exact as what was eliminated before their pivots. A motion z that meets
   // nothing has (A + Q Qᵀ) z = Q Qᵀ z: one solution leaves round-off of it.
   Eigen::MatrixXd Q = thin_qr(soft).Q;
   Q = thin_qr((scaled + Q * Q.transpose()).ldlt().solve(Q)).Q;
   Q *= symmetric_modes(Q.transpose() * scaled * Q).vectors;
   std::vector<Eigen::Index> resting;
   for (Eigen::Index k = 0; k < Q.cols(); ++k)
   {
      if (rests(scaled, Q.col(k))) { resting.push_back(k); }
   }
   if (resting.empty()) { return Eigen::MatrixXd(n, 0); }
   return thin_qr(scale.asDiagonal() * Q(Eigen::all, resting)).Q;
}

} // namespace cattaneo
