#pragma once

#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// A rotation at a point, radians: in the plane of the mesh from x to y (from r to z), in space
/// its size.
struct Rotation
{
   double angle = 0;               ///< radians, signed but in space
   Eigen::Vector3d place{0, 0, 0}; ///< where it is; z is 0 but in space
};

/// The largest rotation at the centre of an element, half of the curl of the displacements,
/// which are at the body's true dofs. Not for torsion. Collective.
Rotation largest_rotation(const ElasticBody &body, const Eigen::VectorXd &displacement);

} // namespace cattaneo
