#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/condense/condensed_body.hpp>
#include <cmath>

namespace cattaneo
{

/// The component, 0: x or 1: y, whose axis is the nearest to a direction.
inline int nearest_axis(const Eigen::Vector2d &direction)
{
   return std::abs(direction[0]) >= std::abs(direction[1]) ? 0 : 1;
}

/** Displacements of a node in x and y, as columns, for v = 1 and for w = 1. They are its
    tangent and normal, unless supports hold one of its components. The held component then lies
    along the axis that is nearest to the tangent (or normal). The node moves only across that
    axis, by so much that its displacement along the frame's normal (or tangent) is 1. So w is
    the opening along the line's own normal, and p a force along it. */
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

/// Does a direction of a frame lie along the components that supports hold?
inline bool lies_in(const Eigen::Vector3d &direction, const std::array<bool, 3> &held)
{
   double part = 0;
   for (int c = 0; c < 3; ++c) { part += held[c] ? direction[c] * direction[c] : 0; }
   return part > 0.5;
}

/** Change of frame of the forces at every contact node: {q; p} = R {x; y}, in space {q₁; q₂; p}
    = R {x; y; z}, with blocks R_i of as many rows as a node has components. Displacements
    change back with Rᵀ. The rows of each block are perpendicular to each other, and of length 1
    except where supports hold one component of a node whose frame is oblique to the axes
    (directions()). One component a node: q_i = R_i m_i, in torsion the circumferential force of
    a torque about the axis. */
struct FrameChange
{
   int components = 0;
   Eigen::MatrixXd blocks; ///< n × components², the rows of each block one after the other

   /// From global components to the frames of a contact line's nodes; in torsion, from torques
   /// about the axis to circumferential forces. `held`: rows {v; w} that supports hold, sorted.
   static FrameChange of(const ContactLine &line, const std::vector<int> &held = {})
   {
      if (line.formulation == Formulation::torsion)
      {
         return {1, line.each(&LineNode::position).col(0).cwiseInverse()};
      }
      const auto n = static_cast<int>(line.size());
      FrameChange made{2, Eigen::MatrixXd(n, 4)};
      made.blocks << line.each(&LineNode::tangent), line.each(&LineNode::normal);
      const auto holds = [&](int row)
      { return std::binary_search(held.begin(), held.end(), row); };
      for (int row : held)
      {
         const int i = row % n;
         const Eigen::Matrix2d D = directions(line.nodes[i], holds(i), holds(n + i));
         made.blocks.row(i) << D(0, 0), D(1, 0), D(0, 1), D(1, 1);
      }
      return made;
   }
   /// The same for a surface, whose frames contain the axes that supports hold.
   static FrameChange of(const ContactSurface &surface)
   {
      FrameChange made{3, Eigen::MatrixXd(surface.size(), 9)};
      for (Eigen::Index i = 0; i < surface.size(); ++i)
      {
         const Eigen::Matrix3d &frame = surface.nodes[i].frame;
         made.blocks.row(i) << frame.row(0), frame.row(1), frame.row(2);
      }
      return made;
   }
   FrameChange transposed() const
   {
      FrameChange made = *this;
      for (int k = 0; k < components; ++k)
      {
         for (int l = 0; l < components; ++l)
         {
            made.blocks.col(k * components + l) = blocks.col(l * components + k);
         }
      }
      return made;
   }
   /// Squared lengths of the rows of each block, n × components.
   Eigen::MatrixXd squares() const
   {
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(blocks.rows(), components);
      for (int k = 0; k < components * components; ++k)
      {
         all.col(k / components) += blocks.col(k).cwiseAbs2();
      }
      return all;
   }
   /// R⁻¹: forces change back with it, displacements with R⁻ᵀ.
   FrameChange inverse() const
   {
      FrameChange made = transposed();
      const Eigen::MatrixXd lengths = squares();
      for (Eigen::Index i = 0; i < lengths.rows(); ++i)
      {
         // Are all of length 1, apart from rounding?
         if (components > 1 && turns(lengths.row(i))) { continue; }
         for (int k = 0; k < components * components; ++k)
         {
            made.blocks(i, k) /= lengths(i, k % components);
         }
      }
      return made;
   }
   /// Are all blocks rotations?
   bool rotates() const
   {
      const Eigen::MatrixXd lengths = squares();
      for (Eigen::Index i = 0; i < lengths.rows(); ++i)
      {
         if (!turns(lengths.row(i))) { return false; }
      }
      return true;
   }

   /// R M, for vectors and matrices of as many rows as all nodes have components.
   template <class Derived>
   Eigen::MatrixXd rows(const Eigen::MatrixBase<Derived> &M) const
   {
      const Eigen::Index n = blocks.rows();
      Eigen::MatrixXd result(M.rows(), M.cols());
      for (int k = 0; k < components; ++k)
      {
         auto part = result.middleRows(k * n, n);
         part = blocks.col(k * components).asDiagonal() * M.topRows(n);
         for (int l = 1; l < components; ++l)
         {
            part += blocks.col(k * components + l).asDiagonal() * M.middleRows(l * n, n);
         }
      }
      return result;
   }
   /// R M Rᵀ of a symmetric M, symmetric to the last bit.
   Eigen::MatrixXd both(Eigen::MatrixXd M) const
   {
      const Eigen::Index n = blocks.rows();
      Eigen::MatrixXd its(M.rows(), components); // the columns of a node
      const bool nothing = flat();
      for (Eigen::Index i = 0; i < n && !nothing; ++i)
      {
         for (int k = 0; k < components; ++k) { its.col(k) = M.col(k * n + i); }
         for (int k = 0; k < components; ++k)
         {
            Eigen::VectorXd column = blocks(i, k * components) * its.col(0);
            for (int l = 1; l < components; ++l)
            {
               column += blocks(i, k * components + l) * its.col(l);
            }
            M.col(k * n + i) = rows(column);
         }
      }
      mirror_lower(M);
      return M;
   }

private:
   /// Rows of equal length, or of length 1 apart from rounding.
   bool turns(const Eigen::RowVectorXd &squares) const
   {
      return components < 3 ? squares.minCoeff() == squares.maxCoeff()
                            : (squares.array() - 1).abs().maxCoeff() < 1e-12;
   }
   /// Flat traces along an axis, in either direction, have R = ±1.
   bool flat() const
   {
      for (int k = 0; k < components * components; ++k)
      {
         const double wanted = k % (components + 1) == 0 ? blocks(0, 0) : 0;
         if ((blocks.col(k).array() != wanted).any()) { return false; }
      }
      return std::abs(blocks(0, 0)) == 1;
   }
};

/// The change of frame of a body's trace.
inline FrameChange frames_of(const CondensedBody &body)
{
   return body.surface.size() > 0 ? FrameChange::of(body.surface)
                                  : FrameChange::of(body.line, body.held);
}

} // namespace cattaneo
