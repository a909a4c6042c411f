#pragma once

#include <Eigen/Dense>
#include <cattaneo/reduced/reduction.hpp>
#include <functional>
#include <vector>

namespace cattaneo
{

// Gaps of contact nodes on a rigid obstacle: the distance of the obstacle from each node along
// its outward normal, negative where the body overlaps it. InputError for a node that does not
// face the obstacle, with its place, and for invalid points or an invalid radius.

/// A polyline through two points or more, whose first and last sides go on without end (two
/// points: a straight line). A node whose normal is parallel to a side within 5 degrees, and
/// meets no other side, stays open, however round-off turns its normal. Its gap is that of a
/// node at the same distance whose normal is turned towards the obstacle by those 5 degrees.
Eigen::VectorXd gaps_to_polyline(const InterfaceReport &nodes,
                                 const std::vector<Eigen::Vector2d> &points);

/// A disc, or with a negative radius a hole of that radius.
Eigen::VectorXd gaps_to_circle(const InterfaceReport &nodes, const Eigen::Vector2d &centre,
                               double radius);

/// In space a plane through a point; `normal` of any length and sign. A node whose normal is
/// parallel to the plane does not face it.
Eigen::VectorXd gaps_to_plane(const ContactSurface &surface, const Eigen::Vector3d &point,
                              const Eigen::Vector3d &normal);
/// In space a sphere, or with a negative radius a hollow of that radius. A node whose normal
/// passes a sphere stays open: its gap is that of a node at the same distance whose normal is
/// turned towards the sphere by 5 degrees. InputError if no node faces the sphere.
Eigen::VectorXd gaps_to_sphere(const ContactSurface &surface, const Eigen::Vector3d &centre,
                               double radius);
/// In space a cylinder about the axis through a point, without ends; with a negative radius a
/// bore of that radius. `axis` of any length and sense. A node whose normal passes a cylinder
/// stays open, as beside a sphere. One within the radius whose normal is parallel to the axis
/// does not face it.
Eigen::VectorXd gaps_to_cylinder(const ContactSurface &surface, const Eigen::Vector3d &point,
                                 const Eigen::Vector3d &axis, double radius);
/// In space the surface z = height(x, y), as gaps_to_curve(). InputError where the height is
/// not a number.
Eigen::VectorXd gaps_to_height(const ContactSurface &surface,
                               const std::function<double(double, double)> &height);

/// The curve y = height(x), with the obstacle on either side of it. The gap is the distance to
/// its nearest point along the node's normal, outwards or inwards, searched in steps of the
/// spacing of the nodes.
Eigen::VectorXd gaps_to_curve(const InterfaceReport &nodes,
                              const std::function<double(double)> &height);

} // namespace cattaneo
