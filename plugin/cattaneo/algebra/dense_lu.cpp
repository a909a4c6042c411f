#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cmath>

namespace cattaneo
{

static constexpr double singular = 1e-14;

double DenseLU::pivot_ratio() const
{
   if (rows() == 0) { return 1; }
   const auto pivots = factors_.diagonal().cwiseAbs();
   return pivots.allFinite() ? pivots.minCoeff() / pivots.maxCoeff() : 0;
}

void DenseLU::equilibrate()
{
   row_scale_.resize(0);
   column_scale_.resize(0);
   if (rows() == 0) { return; }
   const auto whole = [](double x) { return x > 0 ? std::exp2(-std::round(std::log2(x))) : 1; };
   Eigen::VectorXd largest = factors_.cwiseAbs().rowwise().maxCoeff();
   if (!largest.allFinite() || largest.minCoeff() > 1e-4 * largest.maxCoeff()) { return; }
   row_scale_ = largest.unaryExpr(whole);
   factors_ = row_scale_.asDiagonal() * factors_;
   largest = factors_.cwiseAbs().colwise().maxCoeff();
   column_scale_ = largest.unaryExpr(whole);
   factors_ *= column_scale_.asDiagonal();
}

#ifdef CATTANEO_USE_LAPACK

bool DenseLU::compute(Eigen::MatrixXd matrix)
{
   factors_ = std::move(matrix);
   equilibrate();
   const int n = static_cast<int>(factors_.rows());
   exchanges_.resize(n);
   int info = 0;
   const OneThread alone(std::pow(n, 3) / 3);
   if (n > 0) { dgetrf_(&n, &n, factors_.data(), &n, exchanges_.data(), &info); }
   return info == 0 && pivot_ratio() > singular;
}

void DenseLU::solve(Eigen::Ref<Eigen::MatrixXd> x) const
{
   const int n = static_cast<int>(rows()), columns = static_cast<int>(x.cols());
   if (n == 0 || columns == 0) { return; }
   if (row_scale_.size()) { x = row_scale_.asDiagonal() * x; }
   // OpenBLAS copies the factors if there are two columns or more, which pays only for several
   // columns.
   const int stride = columns > 1 ? static_cast<int>(x.outerStride()) : n,
             together = columns > 8 ? columns : 1;
   int info = 0;
   const OneThread alone((together > 1 ? columns : OneThread::reads_once) * n * n);
   for (int k = 0; k < columns; k += together)
   {
      dgetrs_("N", &n, &together, factors_.data(), &n, exchanges_.data(), x.col(k).data(),
              &stride, &info);
   }
   if (column_scale_.size()) { x = column_scale_.asDiagonal() * x; }
}

void DenseLU::solve_transposed(Eigen::Ref<Eigen::VectorXd> x) const
{
   const int n = static_cast<int>(rows()), one = 1;
   if (n == 0) { return; }
   if (column_scale_.size()) { x = column_scale_.asDiagonal() * x; }
   int info = 0;
   const OneThread alone(OneThread::reads_once * n * n);
   dgetrs_("T", &n, &one, factors_.data(), &n, exchanges_.data(), x.data(), &n, &info);
   if (row_scale_.size()) { x = row_scale_.asDiagonal() * x; }
}

#else

bool DenseLU::compute(Eigen::MatrixXd matrix)
{
   factors_ = std::move(matrix);
   equilibrate();
   exchanges_.resize(factors_.rows());
   if (factors_.rows() == 0) { return true; }
   Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu(factors_); // in place
   // Keep the row exchanges as numbers, so that nothing refers to memory that was moved.
   const Eigen::VectorXi places =
      lu.permutationP() * Eigen::VectorXi::LinSpaced(rows(), 0, static_cast<int>(rows()) - 1);
   exchanges_.assign(places.data(), places.data() + places.size());
   return pivot_ratio() > singular;
}

void DenseLU::solve(Eigen::Ref<Eigen::MatrixXd> x) const
{
   if (row_scale_.size()) { x = row_scale_.asDiagonal() * x; }
   Eigen::MatrixXd permuted = x(exchanges_, Eigen::all);
   factors_.triangularView<Eigen::UnitLower>().solveInPlace(permuted);
   factors_.triangularView<Eigen::Upper>().solveInPlace(permuted);
   x = permuted;
   if (column_scale_.size()) { x = column_scale_.asDiagonal() * x; }
}

void DenseLU::solve_transposed(Eigen::Ref<Eigen::VectorXd> x) const
{
   if (column_scale_.size()) { x = column_scale_.asDiagonal() * x; }
   factors_.triangularView<Eigen::Upper>().transpose().solveInPlace(x);
   factors_.triangularView<Eigen::UnitLower>().transpose().solveInPlace(x);
   const Eigen::VectorXd permuted = x;
   x(exchanges_) = permuted;
   if (row_scale_.size()) { x = row_scale_.asDiagonal() * x; }
}

#endif

} // namespace cattaneo
