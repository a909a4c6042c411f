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
   double weight = 0;  ///< consistent, ∫φ dA: they sum to the area
   double spacing = 0; ///< shortest distance to a node of the same face

   /// Into the body.
   Eigen::Vector3d normal() const { return frame.row(2); }
};

/** The trace of a body in space: its contact nodes and the faces between them. Plain data.

    The normal of a node is the mean of its faces' normals, by their share of the node's weight.
    Its first tangent is the axis that lies nearest to the surface (x before y before z), turned
    into it. Where supports hold components of a node, condense() turns its frame so that it has
    the held axes. */
struct ContactSurface
{
   std::vector<SurfaceNode> nodes; ///< each once
   /// Numbers of the nodes of each face, three or four in their order around it, so that seen
   /// from within the body they turn counter-clockwise.
   std::vector<std::vector<Eigen::Index>> faces;

   /// Number of contact nodes.
   Eigen::Index size() const { return static_cast<Eigen::Index>(nodes.size()); }
   /// n × 3, places of all nodes.
   Eigen::MatrixX3d positions() const;
   /// The weights of all nodes, n.
   Eigen::VectorXd weights() const;
   /// InputError that names the node or the face. There must be nodes, with finite places,
   /// right-handed frames of unit vectors, and positive weights and spacings.
   void validate() const;
};

/// A right-handed frame with this normal (a unit vector); rows as in SurfaceNode::frame.
Eigen::Matrix3d frame_of(const Eigen::Vector3d &normal);

/** The surface of faces of three or four nodes, whichever way they turn.
    @param faces   numbers of nodes around each face
    @param node returns dofs and position of a node; called once for each
    @param inside  a direction from the face of that number into the body, not along it
    InputError, which begins with `where`, for another number of nodes, for a face without area,
    or if there is none. */
ContactSurface surface_of(const std::vector<std::vector<int>> &faces,
                          const std::function<SurfaceNode(int)> &node,
                          const std::function<Eigen::Vector3d(std::size_t)> &inside,
                          const std::string &where);

} // namespace cattaneo
