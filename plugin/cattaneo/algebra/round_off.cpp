#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cattaneo/algebra/round_off.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

static constexpr double eps = std::numeric_limits<double>::epsilon();

namespace
{

/// S x, in the time that reading S takes.
Eigen::VectorXf times(const Eigen::MatrixXf &S, const Eigen::VectorXf &x)
{
#ifdef CATTANEO_USE_LAPACK
   Eigen::VectorXf y(x.size());
   const int n = static_cast<int>(S.rows()), next = 1;
   const float once = 1, nothing = 0;
   const OneThread alone(OneThread::reads_once * n * n);
   ssymv_("L", &n, &once, S.data(), &n, x.data(), &next, &nothing, y.data(), &next);
   return y;
#else
   return S * x;
#endif
}

} // namespace

RoundOff::RoundOff(const Eigen::Ref<const MatrixXd> &K) : K_(K)
{
   VectorXd sums = VectorXd::Zero(K.rows()); // by columns: K is symmetric
   for (Index j = 0; j < K.cols(); ++j) { sums[j] = K.col(j).cwiseAbs().sum(); }
   norm_ = sums.maxCoeff();
   graded_ = K.diagonal().minCoeff() < 1e-4 * K.diagonal().maxCoeff();
}

double RoundOff::most(const VectorXd &u, const VectorXd &f) const
{
   return 4 * eps * (norm_ * u.cwiseAbs().maxCoeff() + f.cwiseAbs().maxCoeff());
}

VectorXd RoundOff::rows(const VectorXd &size, const VectorXd &f) const
{
   if (!graded_)
   {
      const double largest = f.cwiseAbs().maxCoeff(), all = norm_ * size.maxCoeff() + largest;
      // The cheap bound is enough if it is small. Else compute the better one.
      if (4 * eps * all <= 1e-11 * largest)
      {
         return VectorXd::Constant(K_.rows(), 4 * eps * all);
      }
   }
   if (size.isZero(0)) { return 4 * eps * f.cwiseAbs(); }
   return 4 * eps * (product(size) + f.cwiseAbs());
}

/// |K| size
VectorXd RoundOff::product(const VectorXd &size) const
{
   const Index rows = K_.rows();
   const double most = size.maxCoeff();
   // Keep |K| in single precision if it is small. A larger copy would fill memory and be no
   // faster to read.
   if (rows <= 2048 && norm_ > 0 && std::isfinite(most))
   {
      if (sizes_.size() == 0) { sizes_ = (K_.cwiseAbs() / norm_).cast<float>(); }
      return norm_ * most * times(sizes_, (size / most).cast<float>()).cast<double>();
   }
   VectorXd sum = VectorXd::Zero(rows);
   for (Index j = 0; j < rows; ++j) // half of K is read
   {
      const Index below = rows - j - 1;
      const auto column = K_.col(j).tail(below).cwiseAbs();
      sum[j] += std::abs(K_(j, j)) * size[j] + column.dot(size.tail(below));
      if (size[j] != 0) { sum.tail(below) += size[j] * column; }
   }
   return sum;
}

} // namespace cattaneo
