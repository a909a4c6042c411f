#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// Products K x. If K is symmetric to the last bit only half of it is read, because reading
/// memory takes most of the time.
class SymmetricProduct
{
public:
   /// Keeps a reference to K, square.
   explicit SymmetricProduct(const Eigen::Ref<const Eigen::MatrixXd> &K);
   Eigen::VectorXd operator()(const Eigen::VectorXd &x) const;

private:
   const Eigen::Ref<const Eigen::MatrixXd> K_;
   const bool half_;
};

} // namespace cattaneo
