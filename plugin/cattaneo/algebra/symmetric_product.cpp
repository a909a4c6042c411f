#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>

namespace cattaneo
{

SymmetricProduct::SymmetricProduct(const Eigen::Ref<const Eigen::MatrixXd> &K)
   : K_(K), half_(largest_skew(K, K) == 0)
{
}

Eigen::VectorXd SymmetricProduct::operator()(const Eigen::VectorXd &x) const
{
   if (half_) { return symmetric_times(K_, x); }
   return K_ * x;
}

} // namespace cattaneo
