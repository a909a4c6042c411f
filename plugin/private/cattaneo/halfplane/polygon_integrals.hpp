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

/// More digits than a double, because far from a polygon the contributions of its edges cancel.
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

/** Integrals over two polygons, of the vector from points of the second one to points of the
    first one. They are in closed form, with an error of 1e-8 if edges of both are parallel only
    within 1e-9, else 1e-10. For triangles that are far from each other a rule of 16 points in
    each is used, with an error of 2e-11. */
KernelIntegrals integrals_over(const Polygon &first, const Polygon &second);

} // namespace cattaneo
