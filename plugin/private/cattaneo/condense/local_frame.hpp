#pragma once

#include <Eigen/Dense>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <cmath>

namespace cattaneo
{

/** Change of frame of the forces at every contact node: {q; p} = R {x; y} with

       q_i = a_i x_i + b_i y_i,    p_i = c_i x_i + d_i y_i,

    each 2 × 2 block orthogonal, so that displacements change in the same way. One component a
    node (b, c and d empty): q_i = a_i m_i, in torsion the circumferential force of a torque
    about the axis. In both, displacements change back with Rᵀ. */
struct FrameChange
{
   Eigen::VectorXd a, b, c, d;

   /// From global components to the frames of a contact line's nodes; of torsion, from torques
   /// about the axis to circumferential forces.
   static FrameChange of(const ContactLine &line)
   {
      if (line.formulation == Formulation::torsion)
      {
         return {line.each(&LineNode::position).col(0).cwiseInverse(), {}, {}, {}};
      }
      const auto tangent = line.each(&LineNode::tangent), normal = line.each(&LineNode::normal);
      return {tangent.col(0), tangent.col(1), normal.col(0), normal.col(1)};
   }
   FrameChange transposed() const { return {a, c, b, d}; }

   /// R M, for vectors and matrices of 2n (or n) rows.
   template <class Derived>
   Eigen::MatrixXd rows(const Eigen::MatrixBase<Derived> &M) const
   {
      const Eigen::Index n = a.size();
      if (b.size() == 0) { return a.asDiagonal() * M; }
      Eigen::MatrixXd result(M.rows(), M.cols());
      result.topRows(n) = a.asDiagonal() * M.topRows(n);
      result.topRows(n) += b.asDiagonal() * M.bottomRows(n);
      result.bottomRows(n) = c.asDiagonal() * M.topRows(n);
      result.bottomRows(n) += d.asDiagonal() * M.bottomRows(n);
      return result;
   }
   /// R M Rᵀ of a symmetric M, symmetric to the last bit.
   Eigen::MatrixXd both(Eigen::MatrixXd M) const
   {
      const Eigen::Index n = a.size();
      // Flat lines along the first axis, either way, have R = ±1.
      const bool flat = b.size() > 0 && b.isZero(0) && c.isZero(0) && std::abs(a[0]) == 1 &&
                        (a.array() == a[0]).all() && (d.array() == a[0]).all();
      if (b.size() == 0) { M = a.asDiagonal() * M * a.asDiagonal(); }
      for (Eigen::Index i = 0; i < n && b.size() > 0 && !flat; ++i) // two columns a node
      {
         const Eigen::VectorXd x = M.col(i), y = M.col(n + i);
         M.col(i) = rows(a[i] * x + b[i] * y);
         M.col(n + i) = rows(c[i] * x + d[i] * y);
      }
      mirror_lower(M);
      return M;
   }
};

} // namespace cattaneo
