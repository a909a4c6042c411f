#pragma once

#include <Eigen/Dense>
#include <array>
#include <cattaneo/condense/contact_surface.hpp>
#include <vector>

namespace cattaneo
{

/** The nodes of a surface whose unknown is not their displacement (ContactSurface), u = B ũ.
    Matrices have one row per node, or all nodes for one component after the other. */
class Middles
{
public:
   explicit Middles(const ContactSurface &surface) : nodes_(surface.size())
   {
      for (Eigen::Index i = 0; i < surface.size(); ++i)
      {
         const std::array<Eigen::Index, 2> &ends = surface.nodes[i].between;
         if (ends[0] >= 0) { all_.push_back({i, ends}); }
      }
   }
   bool none() const { return all_.empty(); }
   /// B U.
   void to_nodes(Eigen::MatrixXd &U) const
   {
      each(U.rows(), [&U](Eigen::Index middle, Eigen::Index one, Eigen::Index other)
           { U.row(middle) = 0.6 * U.row(middle) + 0.2 * (U.row(one) + U.row(other)); });
   }
   /// B⁻¹ U.
   void to_unknowns(Eigen::MatrixXd &U) const
   {
      each(U.rows(), [&U](Eigen::Index middle, Eigen::Index one, Eigen::Index other)
           { U.row(middle) = (5 * U.row(middle) - (U.row(one) + U.row(other))) / 3; });
   }
   /// Bᵀ F.
   void forces_to_unknowns(Eigen::MatrixXd &F) const
   {
      each(F.rows(),
           [&F](Eigen::Index middle, Eigen::Index one, Eigen::Index other)
           {
              F.row(one) += 0.2 * F.row(middle);
              F.row(other) += 0.2 * F.row(middle);
              F.row(middle) *= 0.6;
           });
   }
   /// B⁻ᵀ F.
   void forces_to_nodes(Eigen::MatrixXd &F) const
   {
      each(F.rows(),
           [&F](Eigen::Index middle, Eigen::Index one, Eigen::Index other)
           {
              F.row(middle) /= 0.6;
              F.row(one) -= 0.2 * F.row(middle);
              F.row(other) -= 0.2 * F.row(middle);
           });
   }
   /// Bᵀ S B, and B⁻ᵀ S B⁻¹, of a symmetric S.
   void stiffness_to_unknowns(Eigen::MatrixXd &S) const
   {
      if (none()) { return; }
      forces_to_unknowns(S);
      S.transposeInPlace();
      forces_to_unknowns(S);
   }
   /// See stiffness_to_unknowns().
   void stiffness_to_nodes(Eigen::MatrixXd &S) const
   {
      if (none()) { return; }
      forces_to_nodes(S);
      S.transposeInPlace();
      forces_to_nodes(S);
   }

private:
   struct Middle
   {
      Eigen::Index node;
      std::array<Eigen::Index, 2> ends;
   };
   /// Calls the function with the rows of each middle and of its ends, one component after the
   /// other.
   template <class Visitor>
   void each(Eigen::Index rows, Visitor visit) const
   {
      for (Eigen::Index first = 0; first < rows && nodes_ > 0; first += nodes_)
      {
         for (const Middle &own : all_)
         {
            visit(first + own.node, first + own.ends[0], first + own.ends[1]);
         }
      }
   }

   Eigen::Index nodes_;
   std::vector<Middle> all_;
};

} // namespace cattaneo
