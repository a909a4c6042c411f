#pragma once

#include <Eigen/Core>
#include <vector>

namespace cattaneo
{

struct HalfSpace;

/// Corners of a plane polygon, counter-clockwise.
using Polygon = std::vector<Eigen::Vector2d>;

/// Polygons of the rectangles or triangles of a valid half-space.
std::vector<Polygon> polygons_of(const HalfSpace &contact);

double area(const Polygon &polygon);

/// More digits, because the edges of a polygon cancel far away from it.
using MoreDigits = long double;

/// Integrals over a polygon of functions of the vector d = (x, y) from its points to another
/// point.
struct KernelIntegrals
{
   MoreDigits xx = 0; ///< x²/r³
   MoreDigits yy = 0; ///< y²/r³; both together are 1/r
   MoreDigits xy = 0; ///< x y/r³
   MoreDigits x = 0;  ///< x/r²
   MoreDigits y = 0;  ///< y/r²
};

/// The integrals at a point of the plane, inside or outside, in closed form.
KernelIntegrals integrals_at(const Eigen::Vector2d &point, const Polygon &polygon);

/** Integrals over two polygons, of the way from points of the second one to points of the first
    one. In closed form, which keeps 1e-8 where edges of both are parallel to 1e-9 only, and
    1e-10 else. Triangles that are far from each other take a rule of 16 points in each, which
   is right to 2e-11. */
KernelIntegrals integrals_over(const Polygon &first, const Polygon &second);

} // namespace cattaneo
