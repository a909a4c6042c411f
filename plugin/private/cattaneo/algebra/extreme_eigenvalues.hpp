#pragma once

#include <Eigen/Core>

/// Ends of the spectrum of large matrices, by Lanczos' method and two or three Cholesky
/// factors. All eigenvalues would cost as much as about twenty factors.
namespace cattaneo
{

/// An upper bound of the largest eigenvalue of a symmetric positive semidefinite M, of which
/// the lower triangle is read. A Cholesky factor of bound - M proves it, apart from the
/// round-off of that factor. The bound is above the eigenvalue by about this round-off.
double largest_eigenvalue(const Eigen::MatrixXd &M);

/// A lower bound of the smallest eigenvalue, found in the same way; 0 if M is not positive
/// definite.
double smallest_eigenvalue(const Eigen::MatrixXd &M);

} // namespace cattaneo
