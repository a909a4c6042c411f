#pragma once

#include "common/scene.hpp"

#include <cattaneo/reduced/interfaces.hpp>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/// Marks the contact nodes of bodies in space at which an interface ends although the
/// boundaries of both sides go on beyond it (ReducedProblem::rim). A march warns if they bear
/// forces. `given`: the interfaces of the reduction.
void mark_rims(Scene &scene, const std::vector<cattaneo::Interface> &given);

/// A contact node of the problem at which the side of a body turns by more than 30 degrees, or
/// on a plane obstacle one whose normal is more than 15 degrees off that of the plane.
struct NodeAtCorner
{
   Eigen::Index node = 0;
   double degrees = 0;
   Eigen::Vector3d place{0, 0, 0}; ///< of the corner
   std::string interface;
   bool off_plane = false;
};

/// `planes`: of each interface the normal of its plane obstacle; none: it has another one.
std::vector<NodeAtCorner>
nodes_at_corners(const Scene &scene, const std::vector<cattaneo::Interface> &given,
                 const std::vector<std::optional<Eigen::Vector3d>> &planes);

/// Warns of interfaces that end within faces of the slave, where other interfaces have more
/// than a tenth of its area.
void warn_of_seams(const Scene &scene, const std::vector<cattaneo::Interface> &given);

/// Warns of parts of a body that face the other sides of two interfaces, because the bodies
/// opposite overlap each other.
void warn_of_faces_covered_twice(const Scene &scene,
                                 const std::vector<cattaneo::Interface> &given);

/// Warns of the sharpest one that bears in a march; p: the largest force of each node.
void warn_of_corners(const std::vector<NodeAtCorner> &corners, const Eigen::VectorXd &p);

} // namespace miniapp
