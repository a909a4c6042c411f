#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/// Solves with a symmetric positive *semi*definite matrix whose null space is known.
class SemidefiniteSolver
{
public:
   /// null_space: orthonormal columns, none if A is definite.
   SemidefiniteSolver(const Eigen::MatrixXd &A, const Eigen::MatrixXd &null_space);

   /// False if A is not semidefinite, or if it has null vectors outside the given null space.
   bool definite() const;
   /// x with A x = rhs, for a rhs orthogonal to the null space N; its part along diag(A) N is
   /// left out. Of all such x it is the one with Nᵀ diag(A) x = 0.
   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const;

private:
   Eigen::VectorXd scale_;             ///< of the rows, unit diagonal
   Eigen::MatrixXd null_;              ///< of the scaled matrix
   Eigen::LDLT<Eigen::MatrixXd> ldlt_; ///< with springs on the null space
};

/** Orthonormal basis of the vectors that a symmetric positive semidefinite matrix resists by no
    more than the rounding of its entries, for callers that know only the matrix. Costs two
    Cholesky factors; for a small matrix, or one with many soft motions, a pivoted LDLᵀ. */
Eigen::MatrixXd null_space(const Eigen::MatrixXd &A);

/// Does a symmetric positive semidefinite matrix clearly resist all other motions than these
/// (orthonormal columns)? Costs a Cholesky factor. If false, it is not clear, and null_space()
/// decides.
bool resists_all_but(const Eigen::MatrixXd &A, const Eigen::MatrixXd &motions);

} // namespace cattaneo
