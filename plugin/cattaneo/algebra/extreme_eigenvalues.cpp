#include <Eigen/Eigenvalues>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/extreme_eigenvalues.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <limits>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// First estimate of the error of the Cholesky factor of M.
double first_slack(const MatrixXd &M)
{
   return 4 * std::numeric_limits<double>::epsilon() * static_cast<double>(M.rows()) *
          M.diagonal().maxCoeff();
}

/// Unit vector with a share of every eigenvector, the same with every library.
VectorXd start(Index n)
{
   std::mt19937 random(1);
   VectorXd v(n);
   for (double &x : v) { x = random() / 4294967296.0 - 0.5; }
   return v.normalized();
}

/// Largest eigenvalue of the symmetric operator, from below (Lanczos, each vector made
/// orthogonal to all before).
template <class Operator>
double lanczos(Index n, Operator times)
{
   MatrixXd V(n, std::min<Index>(n, 32));
   VectorXd diagonal(n), below(n), v = start(n);
   for (Index k = 0;; ++k)
   {
      if (k == V.cols()) { V.conservativeResize(n, std::min(n, 2 * k)); }
      V.col(k) = v;
      v = times(v);
      diagonal[k] = V.col(k).dot(v);
      const auto basis = V.leftCols(k + 1);
      for (int twice = 0; twice < 2; ++twice) { v -= basis * (basis.transpose() * v); }
      below[k] = v.norm();
      // If the vector lies in the span of those before, the rest is round-off and no new
      // direction.
      const double round_off = 1e-12 * diagonal.head(k + 1).cwiseAbs().maxCoeff();
      const bool last = k + 1 == n || !(below[k] > round_off);
      if (last || (k >= 7 && (k & (k + 1)) == 0)) // after 8, 16, 32, … vectors
      {
         Eigen::SelfAdjointEigenSolver<MatrixXd> ritz;
         ritz.computeFromTridiagonal(diagonal.head(k + 1), below.head(k));
         const double largest = ritz.eigenvalues()[k],
                      residual = below[k] * std::abs(ritz.eigenvectors()(k, k));
         // The error of the value is less than the square of the residual.
         if (last || !(residual > 1e-8 * std::abs(largest))) { return largest; }
      }
      v /= below[k];
   }
}

/// Is factor · M + shift positive definite?
bool definite(const MatrixXd &M, double factor, double shift)
{
   MatrixXd shifted = factor * M;
   shifted.diagonal().array() += shift;
   return DenseCholesky().compute(std::move(shifted));
}

} // namespace

double largest_eigenvalue(const MatrixXd &M)
{
   const Index n = M.rows();
   if (n == 0) { return 0; }
   const double found =
      lanczos(n, [&](const VectorXd &x) -> VectorXd { return symmetric_times(M, x); });
   double slack = first_slack(M);
   while (slack > 0 && std::isfinite(slack) && !definite(M, -1, found + slack)) { slack *= 8; }
   return found + slack;
}

double smallest_eigenvalue(const MatrixXd &M)
{
   const Index n = M.rows();
   DenseCholesky factor;
   if (n == 0 || !factor.compute(M)) { return 0; }
   const double found = 1 / lanczos(n,
                                    [&](VectorXd x)
                                    {
                                       factor.solve(x);
                                       return x;
                                    });
   double slack = first_slack(M);
   while (slack < found && !definite(M, 1, slack - found)) { slack *= 8; }
   return slack < found ? found - slack : 0;
}

} // namespace cattaneo
