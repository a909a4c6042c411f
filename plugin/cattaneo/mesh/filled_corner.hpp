#pragma once

#include <Eigen/Dense>
#include <mfem.hpp>

namespace cattaneo
{

/// The angle that a body fills around one of the vertices of its mesh.
struct FilledCorner
{
   double angle = 0;  ///< radians; π on a smooth boundary
   int attribute = 0; ///< of the elements there
};

/// The corner at a point. InputError if the point is no vertex, or if elements of several
/// attributes meet there.
FilledCorner filled_corner(mfem::Mesh &mesh, const Eigen::Vector2d &point);

} // namespace cattaneo
