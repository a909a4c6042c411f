#pragma once

#include <Eigen/Dense>
#include <vector>

namespace cattaneo
{

/** LU factors of a dense square matrix, with row pivoting: LAPACK's, or Eigen's if built
    without it. Rows and columns of very different size (1e4) are scaled to size one, by powers
    of two, before a pivot is chosen. */
class DenseLU
{
public:
   /// Replaces the factors. False if the matrix is singular: pivot_ratio() is not above 1e-14.
   bool compute(Eigen::MatrixXd matrix);
   /// Magnitude of the smallest pivot over that of the largest; 1 without rows.
   double pivot_ratio() const;
   /// Solves in place, one right-hand side a column; after a compute() that succeeded.
   void solve(Eigen::Ref<Eigen::MatrixXd> x) const;
   /// The same with the transposed matrix, one right-hand side.
   void solve_transposed(Eigen::Ref<Eigen::VectorXd> x) const;
   Eigen::Index rows() const { return factors_.rows(); }

private:
   void equilibrate();

   Eigen::MatrixXd factors_;
   Eigen::VectorXd row_scale_, column_scale_; // empty: not scaled
   std::vector<int> exchanges_;               // of rows, LAPACK's; counted from 1
};

} // namespace cattaneo
