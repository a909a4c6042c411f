#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

ThinQR thin_qr(const MatrixXd &matrix)
{
   const Eigen::HouseholderQR<MatrixXd> qr(matrix);
   const Eigen::Index rank = std::min(matrix.rows(), matrix.cols());
   return {qr.householderQ() * MatrixXd::Identity(matrix.rows(), rank),
           qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>()};
}

SymmetricModes symmetric_modes(const MatrixXd &matrix)
{
   const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
   return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd &matrix)
{
   return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

MatrixXd at_rest(const MatrixXd &Z, const MatrixXd &rows)
{
   if (Z.cols() == 0) { return Z; }
   const SymmetricModes modes = symmetric_modes(rows.transpose() * rows);
   return Z * modes.vectors.leftCols((modes.values.array() < 1e-14).count());
}

MatrixXd solve_square(const MatrixXd &A, const MatrixXd &B)
{
   return A.partialPivLu().solve(B);
}

MatrixXd solve_semidefinite(const MatrixXd &A, const MatrixXd &b)
{
   return A.ldlt().solve(b);
}

MatrixXd least_squares(const MatrixXd &A, const MatrixXd &b)
{
   return A.completeOrthogonalDecomposition().solve(b);
}

ScatteredFit::ScatteredFit(const MatrixXd &A, const VectorXd &b) : x(least_squares(A, b))
{
   const double spare = static_cast<double>(A.rows() - A.cols());
   const SymmetricModes modes = symmetric_modes(A.transpose() * A);
   covariance = (b - A * x).squaredNorm() / spare * modes.vectors *
                modes.values.cwiseInverse().asDiagonal() * modes.vectors.transpose();
}

double ScatteredFit::error(const VectorXd &at) const
{
   return std::sqrt(at.dot(covariance * at));
}

MatrixXd powers(const VectorXd &x, int degree)
{
   MatrixXd columns = MatrixXd::Ones(x.size(), degree + 1);
   for (int d = 1; d <= degree; ++d) { columns.col(d) = columns.col(d - 1).cwiseProduct(x); }
   return columns;
}

} // namespace cattaneo
