#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// Products K x. Half of K is read if it is symmetric to the last bit: these products take as
/// long as memory does.
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
