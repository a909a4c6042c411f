#pragma once

#include <Eigen/SparseCore>
#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/// A node of a body's trace, over all bodies.
using NodeOfBody = std::pair<int, int>;

/// A block of a node.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// The share of a node of a body's trace in a contact node, for each global component.
struct TraceShare
{
   NodeOfBody of;
   double x = 0, y = 0, z = 0;
};

/// A contact node: its relative displacement is the sum of its shares in its frame.
struct ContactRow
{
   NodeOfBody slave;
   Eigen::Vector2d tangent{1, 0}; ///< of a line
   /// In space: rows are the tangents and the normal.
   Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
   /// For each tangent; false: supports hold the slave and the nodes opposite along this
   /// tangent.
   std::array<bool, 2> slides{true, true};
   std::vector<TraceShare> shares; ///< the slave's own among them
   /// The nodes whose components (along each tangent, and across) follow from relative
   /// displacements: the slave, or the one node that faces it. See choose_dependents().
   std::array<NodeOfBody, 3> dependent{slave, slave, slave};
   /// The component of each of these nodes, in the order of its own frame. In space the frames
   /// of both bodies may have their tangents in either order.
   std::array<int, 3> component{0, 1, 2};

   /// The axis along which a component of a node is determined; -1: none.
   int axis_of(const NodeOfBody &node, int of_node, int components) const
   {
      for (int b = 0; b < components; ++b)
      {
         if (dependent[b] == node && component[b] == of_node) { return b; }
      }
      return -1;
   }
   /// Rows: the tangents and the normal, in the components of the bodies. 2 × 2 for a line.
   SmallMatrix frame(Eigen::Index components) const;
   /// The facing node if the slave is paired with just one node, with weight 1; else null.
   const NodeOfBody *partner() const;
};

/// Do supports hold a component of a contact node, in the order of its frame?
bool holds(const CondensedBody &body, int node, int component);

/** Chooses the nodes that relative displacements determine. If two nodes face only each other,
    either may be chosen: the one without a support, else the softer one, because subtraction
    from its stiffness loses fewer digits. If one of them is held in a component, the other is
    determined there. Along a tangent in which both are held, a row does not slide. */
void choose_dependents(const std::vector<CondensedBody> &bodies, std::vector<ContactRow> &rows);

/** The maps between contact displacements of bodies and relative displacements of contact
    nodes: U = E {u; y} and u = G U, where U are all components of the bodies' traces that are
    not held, one body after the other, each {v; w} in its own frames; u the relative
    displacements {v; w} without those that do not slide; y are the independent components of U.
    Bodies that twist have one component, v, and the share of x counts. */
struct RelativeDisplacement
{
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
   Matrix E, G;
   std::vector<Eigen::Index> offsets;  ///< of each body in U
   std::vector<std::vector<int>> free; ///< rows of each body's S that U has
   std::vector<int> sliding;           ///< rows of u in {v; w} of all contact nodes
   std::vector<int> place;             ///< and those of {v; w} in u, -1: does not slide
   int components = 2;                 ///< of a node

   /// Number of tangents of a node.
   int tangents() const { return components == 3 ? 2 : 1; }
   /// Dependent displacements may depend on each other, such as those of faces that two
   /// interfaces share. InputError if these cannot be told apart.
   RelativeDisplacement(const std::vector<CondensedBody> &bodies,
                        const std::vector<ContactRow> &rows);
   Eigen::Index size() const { return E.rows(); }
   Eigen::Index relative() const { return G.rows(); }
   /// Bodies' matrices of as many rows as their S, stacked.
   Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd> &of_bodies) const;
   /// Rows of one body in a matrix or vector of U, in the rows of its S.
   Eigen::VectorXd of_body(int body, const Eigen::VectorXd &U, Eigen::Index rows) const;
};

} // namespace cattaneo
