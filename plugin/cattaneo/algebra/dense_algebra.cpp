#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cattaneo/algebra/dense_algebra.hpp>

namespace cattaneo
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

ThinQR thin_qr(const MatrixXd &matrix)
{
   const Eigen::HouseholderQR<MatrixXd> qr(matrix);
   const Eigen::Index columns = matrix.cols();
   return {qr.householderQ() * MatrixXd::Identity(matrix.rows(), columns),
           qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>()};
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

VectorXd least_squares(const MatrixXd &A, const VectorXd &b)
{
   return A.colPivHouseholderQr().solve(b);
}

} // namespace cattaneo
