#pragma once

#include <Eigen/Dense>
#include <array>
#include <cattaneo/condense/smooth_side.hpp>
#include <cattaneo/formulation.hpp>
#include <cattaneo/line_end.hpp>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace cattaneo
{

/// A contact node of one body.
struct LineNode
{
   /// Dofs of the body's stiffness for x and y; in torsion the twist and -1. For a body on
   /// several ranks these numbers are the same on all ranks.
   std::array<int, 2> dofs{-1, -1};
   Eigen::Vector2d position{0, 0}; ///< (x, y), or (r, z)
   Eigen::Vector2d tangent{1, 0};  ///< unit vector along the line, the body on its left
   /// Consistent weight: ∫φ ds in the plane (the sum is the length), else ∫φ 2πr ds (the sum is
   /// the area).
   double weight = 0;
   double arc_length = 0; ///< from the line's beginning
   double spacing = 0;    ///< shortest distance to a neighbour, the local edge length

   /// Into the body: the tangent turned to the left.
   Eigen::Vector2d normal() const { return {-tangent[1], tangent[0]}; }
};

/** A boundary element of order k on the line. Displacements on it are polynomials of degree k
    through its k + 1 nodes. These lie at the Gauss–Lobatto points of order k on 0 <= s <= 1
    (MFEM's nodal basis of a segment; order 1: the ends, order 2: the middle as well). The
    element itself, x(s), is such a polynomial too. Where the mesh's geometry is of higher
    order, x(s) interpolates it, and weights and arc lengths are those of the mesh's own curve.
    */
struct LineElement
{
   /// Numbers of its nodes in the line, in their order along it; -1 of a node on the axis,
   /// which is not a contact node.
   std::vector<Eigen::Index> nodes;
   Eigen::Matrix2Xd points; ///< places of all of them, one per column
   /// The smooth curve of which the line between its ends is a chord; straight if the side is a
   /// polygon. Empty means not known: for elements that are curved in the mesh, and in a script
   /// that does not set it (see smooth_curve()).
   std::optional<EdgeBend> bend = std::nullopt;
   /// The curve to which the element may belong, although its side is treated as a polygon
   /// (possible_curve()). Gaps are not measured on it, but estimates of errors use it.
   EdgeBend possible = {};

   /// Degree of the polynomials: one less than its nodes.
   Eigen::Index order() const { return points.cols() - 1; }
   /// Distance of a node to the right of the chord between the ends, over the chord's length.
   double off_chord(Eigen::Index node) const;
   /// Distance of its smooth curve from the element at 0 <= s <= 1; zero if no curve is known.
   Eigen::Vector2d off_curve(double s) const;
   /// The same for the curve that it may belong to.
   Eigen::Vector2d off_possible(double s) const;
   /// The direction of its smooth curve there, a unit vector; that of the chord if no curve is
   /// known.
   Eigen::Vector2d curve_tangent(double s) const;
};

/// Nodes that follow each other along the boundary.
struct LineChain
{
   Eigen::Index first = 0; ///< of ContactLine::nodes
   Eigen::Index nodes = 0; ///< how many of them follow
   bool loop = false;      ///< the last node is followed by the first
   /** How the boundary of the body goes on beyond the first and the last node, under any
       attribute. It goes on smoothly if it turns by less than smooth_turn. It also does so, as
       a polygon that stands for a curve, if it turns by less than corner_turn and by at most
       1.5 times the turn of the line itself between its last two elements. Otherwise there is a
       corner. A loop goes on smoothly. Unknown if there is no next outer edge. */
   std::array<LineEnd, 2> ends{LineEnd::unknown, LineEnd::unknown};
   /// Elements in their order along the chain. Without them it is not known whether the
   /// elements of two lines match, and nodes are paired by places and weights only.
   std::vector<LineElement> elements = {};
   /// At ends on a plane of symmetry that is a support: the angle in radians between the line
   /// and the normal of that plane. For a straight line its own tangent counts, else that of
   /// the curve through its last nodes. Set when the body is condensed.
   std::array<double, 2> off_symmetry{0, 0};
   /// Degrees. A line that meets a support at 90 degrees within this angle ends at a plane of
   /// symmetry. (Coordinates of six digits may cause such an error.) With a larger deviation it
   /// does so only if it curves such that it meets its own mirror image without a corner.
   static constexpr double symmetry_turn = 0.01;
   /// Turn of the tangent between elements in degrees; less is smooth
   static constexpr double smooth_turn = 10;
   static constexpr double corner_turn = 45; ///< degrees: more is a corner
};

/** The trace of a body on an interface: its ordered contact nodes and the boundary elements
    between them. Plain data: contact_line() makes it for an MFEM body, a script for any other
    body.

    Nodes run along the boundary with the body on the left. Each node has a right-handed local
    frame (tangent, normal) with the normal *into* the body (thesis 3.2.1); at a node between
    two boundary elements the normals are averaged with the elements' consistent weights. A
    straight line of a body above y = 0 has tangent (1, 0) and normal (0, 1); of a body below,
    (-1, 0) and (0, -1). For a mesh all of this comes from the elements with these edges, not
    from the order or the orientation of the boundary elements.

    Several separate chains are allowed; they follow each other in the order of their first
    nodes (lowest x, then y), and the arc length continues from one to the next. A closed loop
    starts at its lowest vertex (x, then y) and does not repeat it.

    In axisymmetry and torsion x = r, weights are areas of the whole circumference, ∫φ_i 2πr ds,
    and a node on the axis is left out: its weight is exactly zero from order 2 on (with order 1
    its weight, πh²/3, is added to its neighbour's), so that it has no pressure, and its
    tangential displacements are zero by symmetry. In the reduced problem it moves freely, so
    that it may open or overlap by O(h³) of the indentation. (Avoid order 1 there: the pressure
    of the first node is then 7 % too small on any mesh.) Pressures, force over weight, are
    correct from the first node on. Tractions that grow with r are not: a shear c r comes out
    1.2 and 0.9 times as large at the first two nodes of quadratic elements, a torsional one 1.6
    and 0.7 times. This error of 0.3 c h falls as 1/r². Resultants and torques of nodal forces
    are exact. */
struct ContactLine
{
   Formulation formulation = Formulation::plane; ///< determines the meaning of dofs and weights
   std::vector<LineNode> nodes;                  ///< along the boundary, chain after chain
   std::vector<LineChain> chains; ///< in the order of the nodes, each node on one
   /// True: gaps are those of the elements themselves, not of the smooth curves of which they
   /// may be chords (LineElement::bend).
   bool as_meshed = false;

   /// Number of contact nodes.
   Eigen::Index size() const { return static_cast<Eigen::Index>(nodes.size()); }
   /// n × 2: distances of the nodes from the smooth curves of which elements are chords
   /// (LineElement::bend). Zero at the ends of elements, and for nodes that were moved onto the
   /// curves.
   Eigen::MatrixX2d off_curves() const;
   /// n × 2: points from which gaps are measured, on those curves; if `as_meshed`, the nodes
   /// themselves.
   Eigen::MatrixX2d outline() const;
   /// n × 2: distances of the nodes from curves on which gaps are not measured. If `as_meshed`,
   /// these are all curves, else those to which elements may belong (LineElement::possible).
   Eigen::MatrixX2d off_unmeasured() const;
   /// n × 2: distances of the outline from the chords that were taken for smooth curves.
   Eigen::MatrixX2d bulges() const;
   /// The chain that a node is on.
   const LineChain &chain_of(Eigen::Index node) const;

   /// One quantity of all nodes: each(&LineNode::weight) has n entries, each of
   /// &LineNode::position, tangent or normal n × 2.
   template <class Kind>
   auto each(Kind kind) const
   {
      using Value = std::decay_t<std::invoke_result_t<Kind, const LineNode &>>;
      constexpr bool number = std::is_arithmetic_v<Value>;
      Eigen::Matrix<double, Eigen::Dynamic, number ? 1 : 2> all(size(), number ? 1 : 2);
      for (Eigen::Index i = 0; i < size(); ++i)
      {
         if constexpr (number) { all[i] = std::invoke(kind, nodes[i]); }
         else { all.row(i) = std::invoke(kind, nodes[i]).transpose(); }
      }
      return all;
   }

   /// Smallest allowed ratio of the distances of a node to its two neighbours. At this ratio
   /// the traction at the middle node of a short quadratic element has three correct digits.
   /// Each further decade costs two.
   static constexpr double least_ratio = 1e-6;

   /// InputError that names the node or the element. There must be nodes, with finite places
   /// (beyond the axis, if there is one), unit tangents, and positive weights and spacings.
   /// Distances between neighbours must not jump by more than least_ratio. Chains and elements
   /// must follow the nodes.
   void validate() const;
};

/// The angle between two directions, 0 to π.
double angle_between(const Eigen::Vector2d &one, const Eigen::Vector2d &other);

/** The trace of a body with several interfaces, for one condensation: the nodes of all lines,
    one after the other, each once. A node that two lines share (the end of one is the beginning
    of the other) has the frame of the first line, and is removed from the chains of later ones.
    The result is as_meshed if all lines are. InputError if the lines are of different
    formulations, or if there is no line. */
ContactLine joined(const std::vector<ContactLine> &lines);

/// Gives the elements of a line the known curves of its side (SmoothSides::chords of a mesh,
/// whose file may tell more than the line's vertices).
void bend_elements(ContactLine &line, const std::vector<SideChord> &chords);

} // namespace cattaneo
