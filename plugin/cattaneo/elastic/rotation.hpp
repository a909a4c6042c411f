#pragma once

#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// A rotation in the plane of the mesh at a point, radians, from x to y (from r to z).
struct Rotation
{
   double angle = 0;            ///< radians, signed
   Eigen::Vector2d place{0, 0}; ///< where it is
};

/// The largest rotation at the centre of an element, ½ (∂u_y/∂x - ∂u_x/∂y), of displacements at
/// the body's true dofs. Not for torsion. Collective.
Rotation largest_rotation(const ElasticBody &body, const Eigen::VectorXd &displacement);

} // namespace cattaneo
