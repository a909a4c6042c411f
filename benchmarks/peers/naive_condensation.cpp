//  naive_condensation: static condensation the usual way, beside this library's
//
//  The usual way factors the stiffness of the interior nodes and solves it once for each
//  contact unknown; ours factors the whole stiffness with the contact nodes last and reads the
//  answer off the factor. Same body, same matrix, same sparse solver, one thread; assembly is
//  left out of both. The two results must have the same norm (they differ in the frame of their
//  columns only).

#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>

using namespace cattaneo;
using Eigen::MatrixXd;

namespace
{

MatrixXd usual_way(const mfem::SparseMatrix &K, const ContactLine &line)
{
   std::vector<int> place(K.Height(), -1), contact, interior; // place in its list
   for (const auto &node : line.nodes)
   {
      for (const int dof : node.dofs)
      {
         place[dof] = static_cast<int>(contact.size());
         contact.push_back(dof);
      }
   }
   std::vector<bool> touches(K.Height(), false);
   for (const int dof : contact) { touches[dof] = true; }
   for (int dof = 0; dof < K.Height(); ++dof)
   {
      if (touches[dof]) { continue; }
      place[dof] = static_cast<int>(interior.size());
      interior.push_back(dof);
   }
   const auto ni = static_cast<Eigen::Index>(interior.size());
   const auto nc = static_cast<Eigen::Index>(contact.size());
   const SparseFactor factor(view(K), interior, 0, 0.0);
   MatrixXd coupling = MatrixXd::Zero(ni, nc), S = MatrixXd::Zero(nc, nc);
   for (Eigen::Index c = 0; c < nc; ++c)
   {
      const int row = contact[c];
      for (int k = K.GetI()[row]; k < K.GetI()[row + 1]; ++k)
      {
         const int other = K.GetJ()[k];
         if (touches[other]) { S(c, place[other]) += K.GetData()[k]; }
         else { coupling(place[other], c) += K.GetData()[k]; }
      }
   }
   // In blocks, which is faster than one right-hand side at a time.
   constexpr Eigen::Index block = 32;
   for (Eigen::Index first = 0; first < nc; first += block)
   {
      const Eigen::Index width = std::min(block, nc - first);
      const MatrixXd X = factor.solve(coupling.middleCols(first, width));
      for (Eigen::Index r = 0; r < nc; ++r)
      {
         const int row = contact[r];
         for (int k = K.GetI()[row]; k < K.GetI()[row + 1]; ++k)
         {
            const int other = K.GetJ()[k];
            if (touches[other]) { continue; }
            S.row(r).segment(first, width) -= K.GetData()[k] * X.row(place[other]);
         }
      }
   }
   return S;
}

} // namespace

int main()
{
   return miniapp::run(
      []
      {
         std::printf("%10s %8s %12s %12s %8s %12s\n", "dofs", "contact", "usual, s", "ours, s",
                     "ratio", "difference");
         for (const int columns : {50, 100, 200})
         {
            mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(
               columns, columns, mfem::Element::QUADRILATERAL, true, 2.0, 2.0);
            ElasticBody body(mesh, 1, Material{0.91, 0.3});
            const ContactLine line = contact_line(body, 1);
            const std::clock_t began = std::clock(); // of the processor: others may compute too
            const MatrixXd S = usual_way(body.stiffness(), line);
            const std::clock_t between = std::clock();
            const CondensedBody condensed = condense(body, line);
            const double usual_seconds = double(between - began) / CLOCKS_PER_SEC;
            const double our_seconds = double(std::clock() - between) / CLOCKS_PER_SEC;
            std::printf("%10d %8ld %12.3f %12.3f %8.1f %12.1e\n", body.dofs(),
                        static_cast<long>(S.rows()), usual_seconds, our_seconds,
                        usual_seconds / our_seconds,
                        std::abs(S.norm() / condensed.S.norm() - 1));
         }
         return 0;
      });
}
