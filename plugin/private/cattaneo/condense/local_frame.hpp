#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <cmath>

namespace cattaneo
{

/// The component, 0: x or 1: y, whose axis is the nearest to a direction.
inline int nearest_axis(const Eigen::Vector2d &direction)
{
   return std::abs(direction[0]) >= std::abs(direction[1]) ? 0 : 1;
}

/** Displacements of a node in x and y, as columns, that are v = 1 and w = 1 in its frame. They
    are its tangent and normal, unless supports hold one of its components: that one lies along
    the axis that is the nearest to the tangent (or normal). The node moves across that axis
    alone, and as much of it as makes its displacement along the frame's normal (or tangent) 1.
    So w is the opening along the line's own normal, and p a force along it. */
inline Eigen::Matrix2d directions(const LineNode &node, bool v_held, bool w_held)
{
   const Eigen::Vector2d tangent = node.tangent, normal = node.normal();
   Eigen::Matrix2d columns;
   columns << tangent, normal;
   if (v_held == w_held) { return columns; }
   const int c = nearest_axis(tangent);
   Eigen::Vector2d along(0, 0);
   along[c] = std::copysign(1.0, tangent[c]);
   const Eigen::Vector2d across(-along[1], along[0]);
   columns << along, across;
   if (v_held) { columns.col(1) /= normal.dot(across); }
   else { columns.col(0) /= tangent.dot(along); }
   return columns;
}

/** Change of frame of the forces at every contact node: {q; p} = R {x; y} with

       q_i = a_i x_i + b_i y_i,    p_i = c_i x_i + d_i y_i.

    Displacements change back with Rᵀ. The rows of each 2 × 2 block are across each other, and
    of length 1 but where supports hold one component of a node whose frame leans on the axes
    (directions()). One component a node (b, c and d empty): q_i = a_i m_i, in torsion the
    circumferential force of a torque about the axis. */
struct FrameChange
{
   Eigen::VectorXd a, b, c, d;

   /// From global components to the frames of a contact line's nodes; of torsion, from torques
   /// about the axis to circumferential forces. `held`: rows {v; w} that supports hold, sorted.
   static FrameChange of(const ContactLine &line, const std::vector<int> &held = {})
   {
      if (line.formulation == Formulation::torsion)
      {
         return {line.each(&LineNode::position).col(0).cwiseInverse(), {}, {}, {}};
      }
      const auto tangent = line.each(&LineNode::tangent), normal = line.each(&LineNode::normal);
      FrameChange made{tangent.col(0), tangent.col(1), normal.col(0), normal.col(1)};
      const auto n = static_cast<int>(line.size());
      const auto holds = [&](int row)
      { return std::binary_search(held.begin(), held.end(), row); };
      for (int row : held)
      {
         const int i = row % n;
         const Eigen::Matrix2d D = directions(line.nodes[i], holds(i), holds(n + i));
         made.a[i] = D(0, 0);
         made.b[i] = D(1, 0);
         made.c[i] = D(0, 1);
         made.d[i] = D(1, 1);
      }
      return made;
   }
   FrameChange transposed() const { return {a, c, b, d}; }
   /// R⁻¹, of two components a node: forces change back with it, displacements with R⁻ᵀ.
   FrameChange inverse() const
   {
      FrameChange made = transposed();
      for (Eigen::Index i = 0; i < a.size(); ++i)
      {
         const double along = a[i] * a[i] + b[i] * b[i], across = c[i] * c[i] + d[i] * d[i];
         if (along == across) { continue; } // both 1, but for rounding
         made.a[i] /= along;
         made.c[i] /= along;
         made.b[i] /= across;
         made.d[i] /= across;
      }
      return made;
   }
   /// Are all blocks rotations?
   bool rotates() const
   {
      return (a.array().square() + b.array().square() ==
              c.array().square() + d.array().square())
         .all();
   }

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
