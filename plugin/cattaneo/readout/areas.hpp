#pragma once

#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

/// A part of the contact surface: the nodes in one state.
struct SurfacePart
{
   double area = 0; ///< sum of their weights
   /// Estimated error because the outline consists of whole nodes, no bound: half an edge of a
   /// node along the circumference of a disc of this area. For slip it is the sum of those of
   /// stick and contact.
   double error = 0;
   Eigen::Index nodes = 0; ///< number of them
};

/// Parts of the contact surface in a state.
struct ContactAreas
{
   SurfacePart contact;    ///< stick and slip together
   SurfacePart stick;      ///< pressed, without slip
   SurfacePart slip;       ///< pressed, and slipping in any direction
   SurfacePart separation; ///< open, or touching without force
};

/// Areas from settled_states(), for a problem with two tangential components. InputError for
/// another problem, one without weights, or a state that does not fit.
ContactAreas contact_areas(const ReducedProblem &problem, const ContactState &state);

/// The radius of a circular edge, from nodes on its two sides.
struct RadialEdge
{
   double radius = 0; ///< radius of the circle that has the area of the nodes within
   /// All nodes nearer to the centre than radius - error are within the edge, and all nodes
   /// beyond radius + error are outside. At least half an edge of a node, as a node that the
   /// edge crosses may be on either side; large where the edge is no circle about that centre.
   /// An estimate, no bound.
   double error = 0;
};

/// Edges of a contact that is round.
struct RadialEdges
{
   RadialEdge contact; ///< between contact and separation
   RadialEdge stick;   ///< between stick and the annulus of slip around it
};

/// Edges of contact and of stick about a centre (x, y), from settled_states(), of a surface
/// (`position` n × 3) with weights. Without a node within, the radius is 0. InputError for
/// another problem, or a state that does not fit.
RadialEdges radial_edges(const ReducedProblem &problem, const ContactState &state,
                         const Eigen::Vector2d &centre = {0, 0});

} // namespace cattaneo
