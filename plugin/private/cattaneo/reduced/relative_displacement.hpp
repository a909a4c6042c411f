#pragma once

#include <Eigen/Sparse>
#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/// What a contact node sees of a node of a body's trace: in global components, x and y apart.
struct TraceShare
{
   int body = 0, node = 0;
   double x = 0, y = 0;
};

/// A contact node: its relative displacement is the sum of its shares in the frame of a
/// tangent.
struct ContactRow
{
   int body = 0, node = 0; ///< of the slave
   Eigen::Vector2d tangent{1, 0};
   bool slides = true; ///< false: the slave is held along the tangent, and so is what it faces
   std::vector<TraceShare> shares; ///< the slave's own among them
};

/** How contact displacements of bodies and relative displacements of contact nodes make each
    other: U = E {u; y} and u = G U, where U are all components of the bodies' traces that are
    not held, one body after the other, each {v; w} in its own frames; u the relative
    displacements {v; w} without those that do not slide; y the components of U that are no
    slave's. Of bodies that twist there is one component, v, and the share of x counts. */
struct RelativeDisplacement
{
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
   Matrix E, G;
   std::vector<Eigen::Index> offsets;  ///< of each body in U
   std::vector<std::vector<int>> free; ///< rows of each body's S that U has
   std::vector<int> sliding;           ///< rows of u in {v; w} of all contact nodes
   int components = 2;                 ///< of a node

   /// No slave's displacement may depend on itself.
   RelativeDisplacement(const std::vector<CondensedBody> &bodies,
                        const std::vector<ContactRow> &rows);
   Eigen::Index size() const { return E.rows(); }
   Eigen::Index relative() const { return G.rows(); }
   /// Bodies' matrices of as many rows as their S, stacked.
   Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd> &of_bodies) const;
};

} // namespace cattaneo
