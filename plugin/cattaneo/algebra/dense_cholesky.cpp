#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::MatrixXd;

#ifdef CATTANEO_USE_LAPACK

bool DenseCholesky::compute(MatrixXd matrix)
{
   factor_ = std::move(matrix);
   const int n = static_cast<int>(factor_.rows());
   int info = 0;
   const OneThread alone(std::pow(n, 3) / 6);
   if (n > 0) { dpotrf_("L", &n, factor_.data(), &n, &info); }
   return info == 0 && factor_.diagonal().allFinite();
}

void DenseCholesky::solve(Eigen::VectorXd &x) const
{
   const int n = static_cast<int>(factor_.rows()), columns = 1;
   if (n == 0) { return; }
   int info = 0;
   const OneThread alone(OneThread::reads_once * n * n);
   dpotrs_("L", &n, &columns, factor_.data(), &n, x.data(), &n, &info);
}

/// OpenBLAS copies the factor for several columns, which does not pay for one.
void DenseCholesky::solve_triangle(const char *transposed, Eigen::Ref<MatrixXd> x) const
{
   if (x.size() == 0) { return; }
   const int n = static_cast<int>(factor_.rows()), columns = static_cast<int>(x.cols()),
             stride = columns > 1 ? static_cast<int>(x.outerStride()) : n, next = 1;
   const double one = 1;
   const OneThread alone((columns > 1 ? columns : OneThread::reads_once) * 0.5 * n * n);
   if (columns == 1)
   {
      dtrsv_("L", transposed, "N", &n, factor_.data(), &n, x.data(), &next);
      return;
   }
   dtrsm_("L", "L", transposed, "N", &n, &columns, &one, factor_.data(), &n, x.data(), &stride);
}

void DenseCholesky::solve_half(Eigen::Ref<MatrixXd> x) const
{
   solve_triangle("N", x);
}

void DenseCholesky::solve_other_half(Eigen::Ref<MatrixXd> x) const
{
   solve_triangle("T", x);
}

MatrixXd DenseCholesky::inverse() const
{
   MatrixXd result = factor_;
   const int n = static_cast<int>(factor_.rows());
   int info = 0;
   const OneThread alone(std::pow(n, 3) / 3);
   if (n > 0) { dpotri_("L", &n, result.data(), &n, &info); }
   mirror_lower(result);
   return result;
}

#else

bool DenseCholesky::compute(MatrixXd matrix)
{
   factor_ = std::move(matrix);
   const Eigen::LLT<Eigen::Ref<MatrixXd>> llt(factor_); // in place
   return llt.info() == Eigen::Success && factor_.diagonal().allFinite();
}

void DenseCholesky::solve(Eigen::VectorXd &x) const
{
   factor_.triangularView<Eigen::Lower>().solveInPlace(x);
   factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
}

void DenseCholesky::solve_half(Eigen::Ref<MatrixXd> x) const
{
   factor_.triangularView<Eigen::Lower>().solveInPlace(x);
}

void DenseCholesky::solve_other_half(Eigen::Ref<MatrixXd> x) const
{
   factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
}

MatrixXd DenseCholesky::inverse() const
{
   MatrixXd half = MatrixXd::Identity(factor_.rows(), factor_.cols());
   solve_half(half);
   return -minus_square(MatrixXd::Zero(half.rows(), half.cols()), half);
}

#endif

double DenseCholesky::smallest_pivot() const
{
   return factor_.rows() == 0 ? std::numeric_limits<double>::infinity()
                              : factor_.diagonal().cwiseAbs2().minCoeff();
}

MatrixXd DenseCholesky::solved(MatrixXd x) const
{
   solve_half(x);
   solve_other_half(x);
   return x;
}

MatrixXd minus_square(MatrixXd S, const Eigen::Ref<const MatrixXd> &Y)
{
#ifdef CATTANEO_USE_LAPACK
   const int n = static_cast<int>(S.rows()), inner = static_cast<int>(Y.rows()),
             stride = static_cast<int>(Y.outerStride());
   const double minus = -1, keep = 1;
   const OneThread alone(0.5 * n * n * inner);
   if (Y.size() > 0)
   {
      dsyrk_("L", "T", &n, &inner, &minus, Y.data(), &stride, &keep, S.data(), &n);
   }
#else
   S.selfadjointView<Eigen::Lower>().rankUpdate(Y.transpose(), -1.0);
#endif
   mirror_lower(S);
   return S;
}

void subtract_product(MatrixXd &C, const Eigen::Ref<const MatrixXd> &X,
                      const Eigen::Ref<const MatrixXd> &Y)
{
#ifdef CATTANEO_USE_LAPACK
   const int rows = static_cast<int>(C.rows()), columns = static_cast<int>(C.cols()),
             inner = static_cast<int>(X.rows()), X_stride = static_cast<int>(X.outerStride()),
             Y_stride = static_cast<int>(Y.outerStride());
   const double minus = -1, keep = 1;
   const OneThread alone(1.0 * rows * columns * inner);
   if (C.size() > 0 && inner > 0)
   {
      dgemm_("T", "N", &rows, &columns, &inner, &minus, X.data(), &X_stride, Y.data(),
             &Y_stride, &keep, C.data(), &rows);
   }
#else
   C.noalias() -= X.transpose() * Y;
#endif
}

} // namespace cattaneo
