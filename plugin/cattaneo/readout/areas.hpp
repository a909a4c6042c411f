#pragma once

#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

/// A part of the contact surface: the nodes in one state.
struct SurfacePart
{
   double area = 0; ///< sum of their weights
   /// Estimate of what whole nodes leave of its outline, no bound: half an edge of a node
   /// along the circumference of a disc of this area; of slip that of stick and of contact
   /// together.
   double error = 0;
   Eigen::Index nodes = 0; ///< number of them
};

/// Parts of the contact surface in a state.
struct ContactAreas
{
   SurfacePart contact;    ///< stick and slip together
   SurfacePart stick;      ///< pressed, and at rest
   SurfacePart slip;       ///< pressed, and slipping in whatever direction
   SurfacePart separation; ///< open, or touching without force
};

/// Areas from settled_states(), of a problem with two tangential components. InputError for
/// another one, one without weights, or a state that does not fit.
ContactAreas contact_areas(const ReducedProblem &problem, const ContactState &state);

} // namespace cattaneo
