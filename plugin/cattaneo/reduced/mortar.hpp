#pragma once

#include <Eigen/Sparse>
#include <cattaneo/condense/contact_line.hpp>
#include <string>

namespace cattaneo
{

/** How the nodes of a slave line meet a master line whose nodes are its own. Contact node i is
    a node of the slave, and its relative displacement

       u_i = T_i (Σ_j own_ij U_j - Σ_m other_im U_m)

    is what the dual function ψ_i of its node sees of the difference of both traces,
    ∫ψ_i (U_s - U_m) / ∫ψ_i. On elements of the slave that the master faces everywhere the dual
    functions are those of the element's own ones, ψ = D M⁻¹ φ, so that own is the identity and
    other is P = D⁻¹ M: a constant pressure is a constant, whatever the meshes. Nodes that match
    have P = 1.

    Where an element ends at one of less than a fifth of its length its end sees what faces it
    as near as that one is long, and not all along the element: what both see must agree over
   the short one.

    On an element that is faced in part, nodes that are left less than a quarter of their weight
    there have no function on it: those within the part share it, with positive weights, and
    own has entries beside its diagonal. What is faced of an element whose nodes have none goes
    to the rows beside it along the line. */
struct Mortar
{
   /// By rows.
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

   /// Nodes of the slave line that are contact nodes, increasing; n of them.
   std::vector<int> nodes;
   /// n × nodes of the slave line, n × nodes of the master line; of x and of y, which differ on
   /// an axis only. Rows of each sum to the same, in the plane to 1.
   std::array<Matrix, 2> own;   ///< of each component: of the nodes of the slave
   std::array<Matrix, 2> other; ///< of the nodes of the other body
   /// n × 2: common tangent of both lines, a unit vector in the direction of the slave's. It
   /// and the gap do not depend on which of two matching lines is called the slave.
   Eigen::MatrixX2d tangent;
   Eigen::VectorXd gap; ///< across the common tangent, positive if apart
   /// ∫ψ_i in the plane, else ∫ψ_i 2πr: traction = force / weight.
   Eigen::VectorXd weights;
   Eigen::VectorXd size; ///< length of the longest slave element at each contact node
   /** Along the common tangent, the distance from a contact node of what it faces: the arm of
       the moment that a normal force of 1 there leaves. Zero on straight lines; of the size of
       the chordal error on curved ones, and of a gap times the angle between both tangents. */
   Eigen::VectorXd arm;
   /** What the gap would grow by if elements were smooth curves that they are not taken for:
       those that a straight element of a line that is as meshed is a chord of
       (LineElement::bend), those that elements of a polygon may belong to
       (LineElement::possible), and where none is known curves through its nodes with the
      tangents of the line, an estimate that is none at corners, where a line turns by more than
      35 degrees. */
   Eigen::VectorXd chords;
   /// The angle between the normals of both lines, in radians; 0: they are opposite.
   Eigen::VectorXd turn;
   /// By how much the gap has grown since straight elements were taken for smooth curves.
   Eigen::VectorXd curved;
   std::vector<int> free_surface; ///< nodes of the slave that nothing faces
   /// Length (area, about an axis) that is faced but that no contact node stands for: a master
   /// between two nodes of the slave, beside no row.
   double left_out = 0;
};

/** Integrates the dual functions [Wohlmuth 2000] of the slave over the segments that nodes of
    both lines cut, each where it faces the other (facing each other across the mean of both
    tangents), straight or curved, of orders 1 to 8 that may differ. In axisymmetry with the
    weight r; a node on the axis, which is no contact node, moves with the even (z) and odd (r)
    polynomials through the other nodes of its element.

    `without`: nodes of the slave that are to carry no row; their neighbours share their part.
    `what` begins the sentences of InputError: lines of another formulation, of torsion, without
    elements, that nowhere face each other, or a whole slave element with a weight that is not
    positive. */
Mortar mortar(const ContactLine &slave, const ContactLine &master,
              const std::vector<int> &without = {}, const std::string &what = "mortar");

} // namespace cattaneo
