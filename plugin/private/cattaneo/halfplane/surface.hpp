#pragma once

#include <algorithm>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/halfplane/surface_trace.hpp>
#include <cmath>

namespace cattaneo
{

/// Unit vector along the surface, with the half-plane on the left.
inline Eigen::Vector2d tangent(const HalfPlane &body)
{
   return {body.normal[1], -body.normal[0]};
}

/// Coordinates along the surface: from the axis outwards, or along the tangent.
struct Surface
{
   const HalfPlane &body;
   bool plane;
   double nothing; ///< smaller distances are round-off

   Surface(const HalfPlane &of, const ContactLine &line)
      : body(of), plane(line.formulation == Formulation::plane), nothing(0)
   {
      for (const LineNode &node : line.nodes)
      {
         nothing = std::max(nothing, 1e-14 * std::abs(along(node.position)));
      }
   }
   double along(const Eigen::Vector2d &position) const
   {
      if (!plane) { return position[0]; }
      const double x = (position - body.point).dot(tangent(body));
      return std::abs(x) > nothing ? x : 0.0; // on the plane of symmetry, if there is one
   }
   Eigen::Vector2d place(double x) const
   {
      if (!plane) { return {x, body.point[1]}; }
      return body.point + x * tangent(body);
   }
};

/// The trace of a line. Nodes keep their numbers, and a node on the axis comes last.
SurfaceTrace trace_of(const ContactLine &line, const Surface &surface);

} // namespace cattaneo
