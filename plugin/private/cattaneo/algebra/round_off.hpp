#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/// Round-off of the sums K u + f, row by row: 4 ε (|K| |u| + |f|). If the bound by the largest
/// row sum, which is cheaper, is below 1e-11 of the largest f and the diagonal of K spans less
/// than four decades, all rows get that bound.
class RoundOff
{
public:
   /// Keeps a reference to K, symmetric.
   explicit RoundOff(const Eigen::Ref<const Eigen::MatrixXd> &K);
   /// `size`: bound of |u| entry by entry; f: forces with u = 0.
   Eigen::VectorXd rows(const Eigen::VectorXd &size, const Eigen::VectorXd &f) const;

   /// An upper bound for all rows, without reading K. u is the vector itself (not its bound), f
   /// as above.
   double most(const Eigen::VectorXd &u, const Eigen::VectorXd &f) const;

private:
   Eigen::VectorXd product(const Eigen::VectorXd &size) const;

   const Eigen::Ref<const Eigen::MatrixXd> K_;
   double norm_ = 0;
   bool graded_ = false;
   /// |K| over its norm, in single precision: an estimate needs few digits. Made when first
   /// needed, and only if K is not large.
   mutable Eigen::MatrixXf sizes_;
};

} // namespace cattaneo
