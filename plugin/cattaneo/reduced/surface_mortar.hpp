#pragma once

#include <Eigen/SparseCore>
#include <cattaneo/condense/contact_surface.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/** Couples the nodes of a slave surface to a master surface with other faces, as Mortar does
    for lines. Contact node i is a node of the slave, and its relative displacement

       u_i = Σ_j own_ij U_j - Σ_m other_im U_m

    is the mean of the difference of both traces, weighted with the dual function ψ_i of the
    node: ∫ψ_i (U_s - U_m) dA / ∫ψ_i dA. U are the unknowns of the nodes (ContactSurface).

    On faces that the master covers, ψ = D M⁻¹ φ with the functions φ of the unknowns. `own` is
    then the identity and `other` is P = D⁻¹ M. On faces that it covers in part integrals are
    those over the covered part. A node has a row if at least a quarter of its weight is
    covered, the weight of linear functions on the triangles and quadrilaterals between the
    nodes. Other nodes give their share to the nodes of the same face that have one. `own` then
    has entries of these nodes. In each case all ψ sum to 1, so that a constant pressure stays
    constant on both sides.

    All integrals of a face use the same points: rows of `own` and `other` sum to 1, and on
   plane surfaces with straight edges both give the places of the nodes, however many points
   there are. */
struct SurfaceMortar
{
   /// By rows.
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

   /// Nodes of the slave that are contact nodes, increasing; n of them.
   std::vector<int> nodes;
   Matrix own;              ///< n × nodes of the slave
   Matrix other;            ///< n × nodes of the master
   Eigen::MatrixX3d normal; ///< n × 3: mean of both sides, unit vectors into the slave's body
   Eigen::VectorXd gap;     ///< n, across the mean normal, positive if apart
   Eigen::VectorXd weights; ///< n, ∫ψ_i dA: pressure = force / weight
   Eigen::VectorXd size;    ///< n, the longest edge of the slave's faces at each contact node
   Eigen::VectorXd turn;    ///< n, angle between the normals of both sides, in radians
   /** n, growth of the gap if faces of order 1, and those of order 2 with straight edges, were
       smooth surfaces with the normals of their nodes (Mortar::chords). 0 for faces of order 2
       that follow a curve, and where normals of the nodes of a face differ by more than 35
       degrees. */
   Eigen::VectorXd chords;
   std::vector<int> free_surface; ///< nodes of the slave at which no face has a master opposite
   /// Covered area that belongs to no contact node: less than 1e-4 of a face, or of a face none
   /// of whose nodes, nor of those of the faces around it, has a row.
   double left_out = 0;
   /// Covered area of nodes that would have a row, were they not among those that get none.
   /// Their share is given to other nodes.
   double given_away = 0;
};

/** Integrates the dual functions of the slave [Wohlmuth 2000] over the overlaps of both sides'
    faces. The faces of the master are projected onto the plane across the mean normal of each
    face of the slave, and clipped to it there [Puso 2004]. Faces have 3, 4, 6, 8 or 9 nodes.
    Those of the master whose normal is less than 120 degrees from the slave's do not face it.

    `without` are nodes of the slave that get no row. `what` begins the messages. InputError for
    surfaces without faces or with faces of order 3, for faces that are folded, if the surfaces
    do not face each other, or if no node of the slave has a row. */
SurfaceMortar mortar(const ContactSurface &slave, const ContactSurface &master,
                     const std::vector<int> &without = {}, const std::string &what = "mortar");

/// Does another surface cover each face of this one? InputError as of mortar().
bool is_within(const ContactSurface &surface, const ContactSurface &other,
               const std::string &what = "mortar");

} // namespace cattaneo
