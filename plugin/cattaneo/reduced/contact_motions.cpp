#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/contact_motions.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

using Eigen::Index;

ContactMotions contact_motions(const Reduction &reduction)
{
   require(reduction.torsion.empty(),
           "contact motions: the reduction has bodies that twist, must have none");
   const UnionRows &rows = *reduction.rows_;
   const RelativeDisplacement map(reduction.bodies, rows.rows);
   ContactMotions made;
   made.coordinates = static_cast<int>(map.size());

   // 1. Local components of a body's nodes, turned to global ones.
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      const CondensedBody &body = reduction.bodies[b];
      const auto n = static_cast<int>(body.nodes());
      std::vector<Eigen::Triplet<double>> entries;
      for (std::size_t k = 0; k < map.free[b].size(); ++k)
      {
         const int node = map.free[b][k] % n, component = map.free[b][k] / n;
         const Eigen::MatrixXd directions = body.directions(node);
         const Index row = map.offsets[b] + static_cast<Index>(k);
         for (RelativeDisplacement::Matrix::InnerIterator it(map.E, row); it; ++it)
         {
            for (Index c = 0; c < directions.rows(); ++c)
            {
               const double share = directions(c, component) * it.value();
               if (share == 0) { continue; }
               entries.emplace_back(static_cast<int>(c) * n + node, static_cast<int>(it.col()),
                                    share);
            }
         }
      }
      made.of_body.emplace_back(body.S.rows(), map.size());
      made.of_body.back().setFromTriplets(entries.begin(), entries.end());
      if (body.surface.size() == 0 || !body.surface.has_middles()) { continue; }
      // Unknowns of nodes in the middle of edges are not their displacements.
      const Eigen::MatrixXd at_nodes = body.surface.at_nodes(Eigen::MatrixXd::Identity(n, n));
      entries.clear();
      for (int i = 0; i < n; ++i)
      {
         for (int k = 0; k < n; ++k)
         {
            if (at_nodes(i, k) == 0) { continue; }
            for (int c = 0; c < 3; ++c)
            {
               entries.emplace_back(c * n + i, c * n + k, at_nodes(i, k));
            }
         }
      }
      Eigen::SparseMatrix<double> of_nodes(3 * n, 3 * n);
      of_nodes.setFromTriplets(entries.begin(), entries.end());
      made.of_body.back() = Eigen::SparseMatrix<double>(of_nodes * made.of_body.back());
   }

   // 2. Which coordinates are the problem's, and which are those of ties.
   const auto all = static_cast<int>(rows.rows.size());
   for (int c = 0; c < map.components; ++c)
   {
      for (int node : rows.free) { made.relative.push_back(map.place[c * all + node]); }
      for (int node : rows.tied)
      {
         const int place = map.place[c * all + node];
         if (place >= 0) { made.tied.push_back(place); }
      }
   }
   return made;
}

} // namespace cattaneo
