#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace cattaneo
{

/** A smooth curve over a straight edge, through both of its ends. Seen along the edge with the
    body on the left, the curve leaves the chord to the right by the angle `begin` and comes
   back to it by the angle `end` (radians): both positive where the body is convex, negative in
    a hole, zero where the edge is straight. For an arc of a circle both are half of the
   angle that it spans, and the curve is that arc. */
struct EdgeBend
{
   double begin = 0;                                        ///< at the first vertex of the edge
   double end = 0;                                          ///< at the last one
   bool straight() const { return begin == 0 && end == 0; } ///< the curve is the chord
   /// Distance of the curve to the right of the chord at 0 <= s <= 1 along it, in lengths of
   /// the edge.
   double off(double s) const;
   /// Its derivative by s, the tangent of the angle between curve and chord there.
   double slope(double s) const;
   /// The same seen from the other end.
   EdgeBend reversed() const { return {end, begin}; }
};

/// An edge of a side, and the curve of which it is a chord.
struct SideChord
{
   Eigen::Vector2d from; ///< the body on the left
   Eigen::Vector2d to;   ///< the other end
   EdgeBend bend;        ///< of the curve against its chord
   EdgeBend possible;    ///< of possible_curve(), where the side is kept a polygon
};

/// A side with straight edges, whose vertices may lie on smooth curves.
struct SidePolygon
{
   std::vector<Eigen::Vector2d> vertices; ///< along the side, the body on the left
   bool loop = false;                     ///< the last vertex is followed by the first
   /// The curve of the file on which each edge is (an entity of Gmsh), -1: not known. Empty:
   /// not known for any edge.
   std::vector<int> curves = {};
   /// Directions in which the boundary goes on beyond the ends; zero if it is not known, or if
   /// the end is on no plane of symmetry. If the direction is nearly normal to the side, and
   /// the side meets its mirror image there as smoothly as its own edges meet, the curve goes
   /// on as that image.
   std::array<Eigen::Vector2d, 2> beyond{Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0)};

   static constexpr double corner = 31;        ///< degrees: a circle of twelve edges has 30
   static constexpr double corner_within = 46; ///< degrees: a circle of eight edges has 45
};

/** The smooth curve of which each edge of a side is a chord; straight edges if the side is a
    polygon. Three criteria decide, in this order.

    1. The file: vertices within one of its curves are smooth, its ends may be corners, and the
       curvature may jump there. If the curvature is the same on both sides of an end, and
       within one of the two curves, the arc goes on. If a curve has a corner inside, the curves
       of the file are not used.
    2. The run of turns. A vertex is a corner if it turns much more, or less, than the vertices
    beside it suggest, as at a chamfer with straight flanks. If no curve is known, an arc needs
    four turns in a row in one direction, or three equal ones; with less it is taken for a
    chamfer. If a third of the vertices around a vertex turn left and right alternately, it
    belongs to a measured profile, which stays a polygon.
    3. The angle: a turn of more than `corner` degrees (within one of the file's curves
       `corner_within`) is a corner.

    Between corners the curvature is that of circles through three vertices, linear within an
    edge; where it jumps (an arc that joins a straight flank) it is taken from the side on which
    it changes less, so that the flank stays straight. Circles are exact, whatever the distances
    of their vertices; other curves have an error of fourth order in the length of the edges. At
    open ends the curvature is one-sided, or mirrored (SidePolygon::beyond); in loops it is
    periodic. */
std::vector<EdgeBend> smooth_curve(const SidePolygon &side);

/** The arcs of which edges may be chords, although smooth_curve() keeps a polygon: the turns at
    the vertices are equal, but the vertices are too few, or lie among others that turn left and
    right alternately. Straight elsewhere, above all at corners and where the file says that
    edges are straight. Gaps are not measured on these curves, but the estimates of chordal
    errors use them. */
std::vector<EdgeBend> possible_curve(const SidePolygon &side);

} // namespace cattaneo
