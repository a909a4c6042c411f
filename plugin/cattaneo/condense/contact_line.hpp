#pragma once

#include <Eigen/Dense>
#include <array>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <vector>

namespace cattaneo
{

/// Nodes that follow each other along the boundary.
struct LineChain
{
   Eigen::Index first = 0, nodes = 0;
   bool loop = false; ///< the last node is followed by the first
   /** How the boundary of the body goes on beyond the first and the last node, whatever it is
       called there: smoothly if it turns by less than smooth_turn, or than 1.5 times as much
       as the line itself between its last two elements (a polygon stands for a curve), up to
       corner_turn; else at a corner. Of a loop: smoothly. Unknown where no outer edge goes on.
    */
   std::array<LineEnd, 2> ends{LineEnd::unknown, LineEnd::unknown};
   static constexpr double smooth_turn = 10, corner_turn = 45; ///< degrees
};

/** The ordered contact nodes of one body.

    Nodes run along the boundary with the body on the left. Each node has a right-handed local
    frame (tangent, normal) with the normal *into* the body (thesis 3.2.1); at a node between
   two boundary elements the normals are averaged with the elements' consistent weights. A
   straight line of a body above y = 0 has tangent (1, 0) and normal (0, 1); of a body below,
   (-1, 0) and (0, -1). Of a
   mesh, all of this comes from the elements that the boundary elements are edges of, not from
   the order or the orientation of the boundary elements.

    Several separate chains are allowed; they follow each other in the order of their first
   nodes (lowest x, then y), and the arc length continues from one to the next. A closed loop
   starts at its lowest vertex (x, then y) and does not repeat it.

    In axisymmetry and torsion x = r, weights are areas of the whole circumference, ∫φ_i 2πr ds,
   and a node on the axis is left out: its weight is exactly zero from order 2 on (that of order
   1, πh²/3, is added to its neighbour's), so that it carries no pressure that could be told,
   and its tangential displacements are zero by symmetry. In the reduced problem it moves
   freely,   which opens it or lets it overlap by O(h³) of the indentation (order 1, whose first
   node then shows 7 % too little pressure on any mesh, is better avoided there). Pressures,
   force over weight, are right from the first node on; tractions that grow with r are not: a
   shear c r reads 1.2 and 0.9 times as large at the first two nodes of quadratic elements, a
   torsional one 1.6 and 0.7 times, an error of 0.3 c h that dies out as 1/r². Resultants and
   torques of nodal forces are exact. */
struct ContactLine
{
   /// Of the body's stiffness, for each component of a node: x and y (twist, -1). Of a body on
   /// several ranks they are numbers that all ranks share.
   std::vector<std::array<int, 2>> dofs;
   std::vector<int> chain;          ///< number of the chain each node belongs to
   std::vector<LineChain> chains;   ///< in the order of the nodes
   Eigen::MatrixXd position;        ///< n × 2
   Eigen::MatrixXd tangent, normal; ///< n × 2, unit vectors
   Eigen::VectorXd arc_length;      ///< n
   Eigen::VectorXd weights;        ///< consistent: ∫φ_i ds (sums to the length; or the area)
   Eigen::VectorXd lumped_weights; ///< tributary length: half the distance to each neighbour
   Eigen::VectorXd spacing;        ///< shortest distance to a neighbour, the local edge length

   Eigen::Index size() const { return position.rows(); }
};

} // namespace cattaneo
