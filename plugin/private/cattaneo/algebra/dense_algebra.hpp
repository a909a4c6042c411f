#pragma once

#include <Eigen/Core>
#include <cattaneo/algebra/least_squares.hpp>

/// Decompositions of dense matrices by Eigen, compiled once: its templates take long to
/// compile.
namespace cattaneo
{

struct ThinQR
{
   Eigen::MatrixXd Q; ///< orthonormal columns, as many as the smaller of rows and columns
   Eigen::MatrixXd R; ///< upper triangular, or trapezoidal
};
ThinQR thin_qr(const Eigen::MatrixXd &matrix);

struct SymmetricModes
{
   Eigen::VectorXd values;  ///< ascending
   Eigen::MatrixXd vectors; ///< orthonormal columns
};
SymmetricModes symmetric_modes(const Eigen::MatrixXd &matrix);
/// Only the values.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd &matrix);

/// Combinations of the orthonormal columns of Z that are zero in these rows. Values below 1e-7
/// of the rest count as zero, because with a stiffness of 1 their squares are below round-off.
Eigen::MatrixXd at_rest(const Eigen::MatrixXd &Z, const Eigen::MatrixXd &rows);

/// A⁻¹ B of a square A that is not singular, by LU with row pivoting.
Eigen::MatrixXd solve_square(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B);

/// A⁻¹ b of a symmetric positive semidefinite A by pivoted LDLᵀ, where b lies in its range.
Eigen::MatrixXd solve_semidefinite(const Eigen::MatrixXd &A, const Eigen::MatrixXd &b);

/// least_squares() for more values than unknowns, with the errors that follow from the scatter
/// of the values.
struct ScatteredFit
{
   Eigen::VectorXd x;
   Eigen::MatrixXd covariance;

   ScatteredFit(const Eigen::MatrixXd &A, const Eigen::VectorXd &b);
   /// Standard error of at·x.
   double error(const Eigen::VectorXd &at) const;
};

/// 1, x, x², … up to the degree, as columns.
Eigen::MatrixXd powers(const Eigen::VectorXd &x, int degree);

} // namespace cattaneo
