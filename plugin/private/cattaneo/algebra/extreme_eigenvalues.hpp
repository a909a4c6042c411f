#pragma once

#include <Eigen/Core>

/// Ends of the spectrum of large matrices, by Lanczos' method and two or three Cholesky factors
/// where all eigenvalues would cost some twenty.
namespace cattaneo
{

/// A bound from above of the largest eigenvalue of a symmetric positive semidefinite M, of
/// which the lower triangle is read. A Cholesky factor of bound - M proves it, but for the
/// round-off of that factor, which is also about how far the bound lies above.
double largest_eigenvalue(const Eigen::MatrixXd &M);

/// A bound from below of the smallest eigenvalue, likewise; 0 if M is not positive definite.
double smallest_eigenvalue(const Eigen::MatrixXd &M);

} // namespace cattaneo
