#pragma once

#include <Eigen/Sparse>
#include <cattaneo/condense/contact_line.hpp>
#include <string>

namespace cattaneo
{

/** Couples the nodes of a slave line to a master line with another mesh. Contact node i is a
    node of the slave, and its relative displacement

       u_i = T_i (Σ_j own_ij U_j - Σ_m other_im U_m)

    is the mean of the difference of both traces, weighted with the dual function ψ_i of the
    node: ∫ψ_i (U_s - U_m) / ∫ψ_i. On elements of the slave that the master faces everywhere,
    the dual functions are those of the element's functions, ψ = D M⁻¹ φ. Then `own` is the
    identity and `other` is P = D⁻¹ M, so that a constant pressure stays constant, whatever the
    meshes. Nodes that match have P = 1.

    If the neighbour of an element is shorter than a fifth of it, the function of their common
    node is only as wide on the long element as the short one is long. Both elements then use
    the same displacements of the master there.

    On an element that is faced in part, nodes with less than a quarter of their weight in that
    part have no function. The nodes within the part share it, with positive weights, and `own`
    has entries beside its diagonal. If no node of an element has a function, the faced part
    goes to the next rows along the line. */
struct Mortar
{
   /// By rows.
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

   /// Nodes of the slave line that are contact nodes, increasing; n of them.
   std::vector<int> nodes;
   /// n × nodes of the slave line, and n × nodes of the master line, for x and for y, which
   /// differ only at an axis. Rows of both sum to the same, in the plane to 1.
   std::array<Matrix, 2> own;   ///< coefficients of the slave's nodes, by component
   std::array<Matrix, 2> other; ///< coefficients of the master's nodes, by component
   /// n × 2: common tangent of both lines, a unit vector in the direction of the slave's. It
   /// and the gap do not depend on which of two matching lines is called the slave.
   Eigen::MatrixX2d tangent;
   Eigen::VectorXd gap; ///< across the common tangent, positive if apart
   /// ∫ψ_i in the plane, else ∫ψ_i 2πr: traction = force / weight.
   Eigen::VectorXd weights;
   Eigen::VectorXd size; ///< length of the longest slave element at each contact node
   /** Distance along the common tangent between a contact node and the points that it faces:
       the arm of the moment that a normal force of 1 leaves there. Zero on straight lines. On
       curved lines it is as large as the chordal error, or as the gap times the angle between
       both tangents. */
   Eigen::VectorXd arm;
   /** Growth of the gap if elements were the smooth curves that they are not taken for. For
       straight elements of a line that stays as meshed these are the curves of which they are
       chords (LineElement::bend), for elements of a polygon the curves that it may stand for
       (LineElement::possible). If no curve is known it is estimated: it goes through the nodes
       with the tangents of the line. At corners, where a line turns by more than 35 degrees,
       the estimate is zero. */
   Eigen::VectorXd chords;
   /// The angle between the normals of both lines, in radians; 0: they are opposite.
   Eigen::VectorXd turn;
   /// Growth of the gap because straight elements were taken for smooth curves.
   Eigen::VectorXd curved;
   std::vector<int> free_surface; ///< nodes of the slave that nothing faces
   /// Length (about an axis: area) that is faced but belongs to no contact node, for instance
   /// of a master that fits between two nodes of the slave, away from all rows.
   double left_out = 0;
};

/** Integrates the dual functions [Wohlmuth 2000] of the slave over the segments between nodes
    of either line, where the lines face each other (across the mean of both tangents). Elements
    are straight or curved, of orders 1 to 8 that may differ. In axisymmetry the weight is r. A
    node on the axis is no contact node: its displacement is that of the even (z) and odd (r)
    polynomials through the other nodes of its element.

    `without` are nodes of the slave that get no row; their neighbours share their part. `what`
    begins the messages. InputError for lines of different formulations, of torsion, without
    elements, that nowhere face each other, or for a slave element with a weight that is not
    positive. */
Mortar mortar(const ContactLine &slave, const ContactLine &master,
              const std::vector<int> &without = {}, const std::string &what = "mortar");

} // namespace cattaneo
