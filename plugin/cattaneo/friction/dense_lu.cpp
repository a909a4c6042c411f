#include <cattaneo/friction/dense_lu.hpp>

#ifdef CATTANEO_USE_LAPACK
extern "C"
{
   void dgetrf_(const int *rows, const int *columns, double *A, const int *stride, int *pivots,
                int *info);
   void dgetrs_(const char *transposed, const int *n, const int *columns, const double *A,
                const int *stride, const int *pivots, double *x, const int *x_stride,
                int *info);
}
#endif

namespace cattaneo
{

static constexpr double singular = 1e-14;

double DenseLU::pivot_ratio() const
{
   if (rows() == 0) { return 1; }
   const auto pivots = factors_.diagonal().cwiseAbs();
   return pivots.allFinite() ? pivots.minCoeff() / pivots.maxCoeff() : 0;
}

#ifdef CATTANEO_USE_LAPACK

bool DenseLU::compute(Eigen::MatrixXd matrix)
{
   factors_ = std::move(matrix);
   const int n = static_cast<int>(factors_.rows());
   exchanges_.resize(n);
   int info = 0;
   if (n > 0) { dgetrf_(&n, &n, factors_.data(), &n, exchanges_.data(), &info); }
   return info == 0 && pivot_ratio() > singular;
}

void DenseLU::solve(Eigen::Ref<Eigen::MatrixXd> x) const
{
   const int n = static_cast<int>(rows()), columns = static_cast<int>(x.cols());
   if (n == 0 || columns == 0) { return; }
   const int stride = columns > 1 ? static_cast<int>(x.outerStride()) : n;
   int info = 0;
   dgetrs_("N", &n, &columns, factors_.data(), &n, exchanges_.data(), x.data(), &stride, &info);
}

#else

bool DenseLU::compute(Eigen::MatrixXd matrix)
{
   factors_ = std::move(matrix);
   exchanges_.resize(factors_.rows());
   if (factors_.rows() == 0) { return true; }
   Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu(factors_); // in place
   // As exchanges, so that nothing refers to the matrix where it was.
   const Eigen::VectorXi places =
      lu.permutationP() * Eigen::VectorXi::LinSpaced(rows(), 0, static_cast<int>(rows()) - 1);
   exchanges_.assign(places.data(), places.data() + places.size());
   return pivot_ratio() > singular;
}

void DenseLU::solve(Eigen::Ref<Eigen::MatrixXd> x) const
{
   Eigen::MatrixXd permuted = x(exchanges_, Eigen::all);
   factors_.triangularView<Eigen::UnitLower>().solveInPlace(permuted);
   factors_.triangularView<Eigen::Upper>().solveInPlace(permuted);
   x = permuted;
}

#endif

} // namespace cattaneo
