#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/** Change of frame at every contact node: {v; w} = R {x; y} with

       v_i = a_i x_i + b_i y_i,    w_i = c_i x_i + d_i y_i,

    each 2 × 2 block orthogonal. */
struct FrameChange
{
   Eigen::VectorXd a, b, c, d;

   /// From global components to the frames (tangent, normal), n × 2 each.
   static FrameChange to_local(const Eigen::MatrixXd &tangent, const Eigen::MatrixXd &normal)
   {
      return {tangent.col(0), tangent.col(1), normal.col(0), normal.col(1)};
   }
   FrameChange inverse() const { return {a, c, b, d}; }

   /// R M, for vectors and matrices of 2n rows.
   template <class Derived>
   Eigen::MatrixXd rows(const Eigen::MatrixBase<Derived> &M) const
   {
      const Eigen::Index n = a.size();
      Eigen::MatrixXd result(M.rows(), M.cols());
      result.topRows(n) = a.asDiagonal() * M.topRows(n);
      result.topRows(n) += b.asDiagonal() * M.bottomRows(n);
      result.bottomRows(n) = c.asDiagonal() * M.topRows(n);
      result.bottomRows(n) += d.asDiagonal() * M.bottomRows(n);
      return result;
   }
   /// R M Rᵀ of a symmetric M, symmetric to the last bit.
   Eigen::MatrixXd both(const Eigen::MatrixXd &M) const
   {
      Eigen::MatrixXd result = rows(rows(M).transpose());
      result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
      return result;
   }
};

} // namespace cattaneo
