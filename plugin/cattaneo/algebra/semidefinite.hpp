#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/** Pivoted LDLᵀ of a symmetric positive *semi*definite matrix. Pivots at round-off belong to
   rigid motions: solve() adds no motion along them, null_space() returns them. */
class SemidefiniteSolver
{
public:
   explicit SemidefiniteSolver(const Eigen::MatrixXd &A);

   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const;
   /// Orthonormal basis of the null space, one column a rigid motion.
   Eigen::MatrixXd null_space() const;

private:
   static bool rests(const Eigen::MatrixXd &A, const Eigen::VectorXd &motion);

   Eigen::VectorXd scale_; ///< of the rows, unit diagonal
   Eigen::LDLT<Eigen::MatrixXd> ldlt_;
   Eigen::VectorXd inverse_pivots_; ///< zero where the pivot is
};

} // namespace cattaneo
