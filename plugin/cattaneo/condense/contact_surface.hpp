#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace cattaneo
{

/// A contact node of a body in space.
struct SurfaceNode
{
   std::array<int, 3> dofs{-1, -1, -1}; ///< rows of the body's stiffness along x, y and z
   Eigen::Vector3d position{0, 0, 0};   ///< (x, y, z)
   /// Rows: the first tangent, the second one, and the normal into the body. Right-handed.
   Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
   double weight = 0;  ///< of the node's unknown, ∫φ dA: they sum to the area
   double spacing = 0; ///< shortest distance to a node of the same face
   /// Of a node in the middle of an edge of a face of order 2: the numbers of the nodes at its
   /// ends; see ContactSurface. -1: the unknown of the node is its displacement.
   std::array<Eigen::Index, 2> between{-1, -1};

   /// Into the body.
   Eigen::Vector3d normal() const { return frame.row(2); }
};

/** The trace of a body in space: its contact nodes and the faces between them. Plain data.

    On triangles of 6 nodes and quadrilaterals of 8 the consistent weights of the corners are
    zero or negative, so that signs of nodal forces say nothing about the contact. Their
    unknowns are those of other functions of the same space, all of which have positive weights:

       corners: N + (N of the middles of the adjacent edges)/5,    middles: 3/5 N.

    The displacement of a middle is 3/5 of its unknown and 1/5 of each end's; that of a corner
    is its unknown. Displacements, gaps and forces of the reduced problem are those of the
    unknowns. at_nodes() and forces_at_nodes() convert them to those of the nodes. All other
    faces have positive weights, and their unknowns are those of the nodes.

    The normal of a node is the mean of its faces' normals, by their share of the node's weight.
    Its first tangent is the axis that lies nearest to the surface (x before y before z), turned
    into it. Where supports hold components of a node, condense() turns its frame so that the
    held axes are among its axes. */
struct ContactSurface
{
   std::vector<SurfaceNode> nodes; ///< each once
   /// Numbers of the nodes of each face: three or four corners in their order around it, so
   /// that seen from within the body they turn counter-clockwise; of order 2 then the middles
   /// of the edges, first that between the first two corners, and of nine nodes the middle of
   /// the face. Of order 3 (10 and 16 nodes) each edge has two nodes, at its thirds, in the
   /// sense of the face; then come the middle of the triangle, or four nodes inside the
   /// quadrilateral, each beside the corner of the same number.
   std::vector<std::vector<Eigen::Index>> faces;

   /// Number of contact nodes.
   Eigen::Index size() const { return static_cast<Eigen::Index>(nodes.size()); }
   /// n × 3, places of all nodes.
   Eigen::MatrixX3d positions() const;
   /// n × 3, places of the unknowns: forces on the unknowns there have the moments of the
   /// forces on the nodes. They are the places of the nodes, except in the middle of curved
   /// edges.
   Eigen::MatrixX3d points() const;
   /// The weights of all nodes, n.
   Eigen::VectorXd weights() const;

   /// Does it have nodes whose unknown is not their displacement?
   bool has_middles() const;
   /// Converts values of the unknowns (displacements, gaps; n rows) to those at the nodes.
   Eigen::MatrixXd at_nodes(Eigen::MatrixXd unknowns) const;
   /// The other way round.
   Eigen::MatrixXd of_nodes(Eigen::MatrixXd values) const;
   /// Converts forces on the unknowns to those on the nodes that do the same work (n rows).
   Eigen::MatrixXd forces_at_nodes(Eigen::MatrixXd on_unknowns) const;
   /// The other way round.
   Eigen::MatrixXd forces_of_nodes(Eigen::MatrixXd on_nodes) const;

   /// InputError that names the node or the face. There must be nodes, with finite places,
   /// right-handed frames of unit vectors, and positive weights and spacings. The ends of an
   /// edge must be corners.
   void validate() const;
};

/// A right-handed frame with this normal (a unit vector); rows as in SurfaceNode::frame.
Eigen::Matrix3d frame_of(const Eigen::Vector3d &normal);

/// How many nodes a face has, in words.
constexpr const char *nodes_of_faces = "3, 4, 6, 8, 9, 10 or 16";
/// Is there a face with this number of nodes?
bool is_face(std::size_t nodes);

/** The surface of faces of 3, 4, 6, 8, 9, 10 or 16 nodes, in either sense around each face.
    @param faces   numbers of nodes around each face, in the order of ContactSurface::faces
    @param node    returns dofs and position of a node; called once for each
    @param inside  a direction from the face of that number into the body, not along it
    InputError, which begins with `where`, for another number of nodes, for a face without area,
    a node that is nearer to the middle of another edge than to that of its own, a node of a
    face of 10 or 16 nodes that is not at its place, or if there is no face. */
ContactSurface surface_of(const std::vector<std::vector<int>> &faces,
                          const std::function<SurfaceNode(int)> &node,
                          const std::function<Eigen::Vector3d(std::size_t)> &inside,
                          const std::string &where);

/** The trace of a body with several interfaces, for one condensation: the nodes of all
    surfaces, each once, and all faces. A node that several surfaces share has the frame of the
    first, and the weight of all. InputError if there is no surface. */
ContactSurface joined(const std::vector<ContactSurface> &surfaces);

} // namespace cattaneo
