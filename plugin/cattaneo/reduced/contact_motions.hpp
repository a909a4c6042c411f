#pragma once

#include <Eigen/SparseCore>
#include <cattaneo/reduced/reduction.hpp>
#include <vector>

namespace cattaneo
{

/** How the contact nodes of all bodies move, by coordinates that are independent of each other:
    the relative displacements of the contact nodes, those of tied nodes, and what these leave
    free. Where a coordinate of the second kind is kept at 0 the bodies are tied there, and
    where one of the first kind is kept at 0 the node is glued. */
struct ContactMotions
{
   /// Of each body: {x; y} of the nodes of its line (in space {x; y; z} of those of its
   /// surface) × coordinates. Nothing for components that supports hold.
   std::vector<Eigen::SparseMatrix<double>> of_body;
   /// Coordinate of each row {v; w} of the problem, -1: held.
   std::vector<int> relative;
   std::vector<int> tied; ///< coordinates of tied nodes
   int coordinates = 0;   ///< number of them
};

/// InputError for a reduction with bodies that twist.
ContactMotions contact_motions(const Reduction &reduction);

} // namespace cattaneo
