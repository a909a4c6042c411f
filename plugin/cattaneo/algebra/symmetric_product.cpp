#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>

namespace cattaneo
{

SymmetricProduct::SymmetricProduct(const Eigen::Ref<const Eigen::MatrixXd> &K) : K_(K)
{
#ifdef CATTANEO_USE_LAPACK
   half_ = K == K.transpose();
#endif
}

Eigen::VectorXd SymmetricProduct::operator()(const Eigen::VectorXd &x) const
{
#ifdef CATTANEO_USE_LAPACK
   if (half_)
   {
      Eigen::VectorXd y(x.size());
      const int n = static_cast<int>(K_.rows()), stride = static_cast<int>(K_.outerStride()),
                next = 1;
      const double once = 1, nothing = 0;
      dsymv_("L", &n, &once, K_.data(), &stride, x.data(), &next, &nothing, y.data(), &next);
      return y;
   }
#endif
   return K_ * x;
}

} // namespace cattaneo
