#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <map>
#include <optional>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::Vector2d;

const double in_degrees = 180 / std::acos(-1.0);

/// Angle between a unit vector and the axis of a component, 0 to 90 degrees, in radians.
double off_axis(const Vector2d &unit, int component)
{
   return std::asin(std::min(std::abs(unit[1 - component]), 1.0));
}

/// Tangent, at the first of three points, of the circle (or straight line) through them.
Vector2d circle_tangent(const std::array<Vector2d, 3> &points)
{
   // Inversion about the first point makes a straight line along the tangent of the circle.
   const Vector2d one = points[1] - points[0], two = points[2] - points[0];
   return (one / one.squaredNorm() - two / two.squaredNorm()).normalized();
}

/// Angle by which the curve of a chain misses, at an end, the direction in which it would meet
/// its mirror image without a corner. None if the angle is more than a quarter of what the
/// curve turns between the end and the middle of the first chord: then a corner is meant.
/// `component` is that of the axis normal to the plane of symmetry.
std::optional<double> curves_into_symmetry(const LineChain &chain, bool last, int component)
{
   std::optional<double> least;
   const auto judge = [&](const Vector2d &tangent, double turn)
   {
      const double off = off_axis(tangent, component);
      // If the angles are round-off, there is no curve.
      if (turn > 1e-9 && off <= 0.25 * turn) { least = std::min(off, least.value_or(off)); }
   };
   // The smooth curve that the last element is a chord of.
   if (!chain.elements.empty())
   {
      const LineElement &element = last ? chain.elements.back() : chain.elements.front();
      const Eigen::Matrix2Xd &points = element.points;
      const Vector2d chord = (points.rightCols(1) - points.leftCols(1)).normalized();
      const EdgeBend bend = element.bend.value_or(EdgeBend());
      const double turn = last ? bend.end : -bend.begin;
      judge(Eigen::Rotation2Dd(turn) * chord, std::abs(turn));
   }
   // Circles through nodes, and through ends of elements.
   std::vector<Vector2d> nodes, ends; // from the end on
   const std::size_t count = chain.elements.size();
   for (std::size_t e = 0; e < std::min<std::size_t>(count, 2); ++e)
   {
      Eigen::Matrix2Xd points = chain.elements[last ? count - 1 - e : e].points;
      if (last) { points = points.rowwise().reverse().eval(); }
      for (Index a = e > 0 ? 1 : 0; a < points.cols(); ++a) { nodes.push_back(points.col(a)); }
      if (e == 0) { ends.push_back(points.col(0)); }
      ends.push_back(points.col(points.cols() - 1));
   }
   for (const std::vector<Vector2d> *from : {&nodes, &ends})
   {
      if (from->size() < 3) { continue; }
      const Vector2d tangent = circle_tangent({(*from)[0], (*from)[1], (*from)[2]}),
                     chord = ((*from)[1] - (*from)[0]).normalized();
      const double turn = std::abs(
         std::asin(std::clamp(tangent[0] * chord[1] - tangent[1] * chord[0], -1., 1.)));
      judge(tangent, turn);
   }
   return least;
}

} // namespace

void meet_supports(ContactLine &line, const HeldComponents &held, const HeldComponents &moved)
{
   for (Index i = 0; i < line.size(); ++i)
   {
      if (held(i, 0) == held(i, 1)) { continue; } // free, or clamped
      const int c = held(i, 0) ? 0 : 1;
      LineNode &node = line.nodes[i];
      const int axis = nearest_axis(node.tangent); // that is parallel to the line
      const double off = off_axis(node.tangent, axis), degrees = in_degrees * off;
      bool onto_axis = off <= 1e-9; // round-off of the coordinates
      // About an axis a held r is a cylinder, in which nothing has a mirror image.
      const bool mirrors =
         axis == c && !moved(i, c) && (line.formulation == Formulation::plane || c == 1);
      for (LineChain &chain : line.chains)
      {
         for (const bool last : {false, true})
         {
            const Index end = last ? chain.first + chain.nodes - 1 : chain.first;
            if (i != end || chain.loop || !mirrors) { continue; }
            const std::optional<double> curve = curves_into_symmetry(chain, last, axis);
            if (!curve && degrees > LineChain::symmetry_turn) { continue; }
            chain.ends[last ? 1 : 0] = LineEnd::symmetry;
            chain.off_symmetry[last ? 1 : 0] = onto_axis ? 0 : curve.value_or(off);
            onto_axis = onto_axis || curve;
         }
      }
      // The first chord of a coarse circle may miss 90 degrees by more than a straight line.
      require(onto_axis || degrees <= LineChain::smooth_turn, "condense: component ",
              component_name(line.formulation, c), " of the contact node at ", node.position,
              " is fixed, and the line meets it at ",
              0.1 * std::round(10 * (axis == c ? degrees : 90 - degrees)),
              " degrees, must be 0 or 90 within ", LineChain::smooth_turn, " degrees");
      if (!onto_axis) { continue; }
      const double sign = std::copysign(1.0, node.tangent[axis]);
      node.tangent.setZero();
      node.tangent[axis] = sign;
   }
}

void meet_supports(ContactLine &line, const CondensedBody &body)
{
   if (line.formulation == Formulation::torsion || body.held.empty()) { return; }
   std::map<std::array<int, 2>, Index> number;
   for (Index k = 0; k < body.line.size(); ++k) { number[body.line.nodes[k].dofs] = k; }
   HeldComponents held = HeldComponents::Constant(line.size(), 2, false), moved = held;
   for (Index i = 0; i < line.size(); ++i)
   {
      const auto found = number.find(line.nodes[i].dofs);
      for (int c = 0; c < 2 && found != number.end(); ++c)
      {
         held(i, c) = body.holds(found->second, c);
         moved(i, c) = body.moves(found->second, c);
      }
   }
   // If an end of the body's line has no symmetry, the same node has none here.
   for (const LineChain &chain : body.line.chains)
   {
      for (const int end : {0, 1})
      {
         const Index last = end ? chain.first + chain.nodes - 1 : chain.first;
         if (chain.loop || chain.ends[end] == LineEnd::symmetry) { continue; }
         for (Index i = 0; i < line.size(); ++i)
         {
            if (line.nodes[i].dofs == body.line.nodes[last].dofs)
            {
               moved.row(i) = held.row(i);
            }
         }
      }
   }
   meet_supports(line, held, moved);
}

Eigen::Matrix3d on_supports(const Eigen::Matrix3d &frame, const std::array<bool, 3> &held,
                            const std::string &where)
{
   const auto count = std::count(held.begin(), held.end(), true);
   if (count == 0 || count == 3) { return frame; }
   const Eigen::Vector3d normal = frame.row(2);
   // The axis that is held alone, or that alone is free.
   const auto axis =
      static_cast<int>(std::find(held.begin(), held.end(), count == 1) - held.begin());
   const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis);
   const double along = normal.dot(e), most = std::sin(10 * std::acos(-1.0) / 180);
   const bool across = std::abs(along) <= most;
   require(across || normal.cross(e).norm() <= most, "condense: a support holds ",
           count == 1 ? "one component" : "two components", " of the contact node at ", where,
           ", and its angle to the surface must be within 10 degrees of 0 or 90");
   const Eigen::Vector3d n = across ? Eigen::Vector3d((normal - along * e).normalized())
                                    : Eigen::Vector3d(std::copysign(1.0, along) * e);
   // The support holds the normal, or all but the normal, so both tangents are equivalent.
   if (!across) { return frame_of(n); }
   Eigen::Matrix3d made;
   made << e.transpose(), n.cross(e).transpose(), n.transpose();
   return made;
}

Eigen::Matrix3d frame_between(const Eigen::Matrix3d &one, const Eigen::Matrix3d &other,
                              bool by_other)
{
   const Eigen::Vector3d normal = Eigen::Vector3d(one.row(2) - other.row(2)).normalized(),
                         along = (by_other ? other : one).row(0);
   Eigen::Matrix3d frame;
   frame.row(2) = normal;
   frame.row(0) = (along - normal.dot(along) * normal).normalized();
   frame.row(1) = normal.cross(Eigen::Vector3d(frame.row(0)));
   return frame;
}

void meet_supports(ContactSurface &surface, const CondensedBody &body)
{
   if (body.held.empty()) { return; }
   std::map<std::array<int, 3>, Index> number;
   for (Index k = 0; k < body.surface.size(); ++k) { number[body.surface.nodes[k].dofs] = k; }
   for (SurfaceNode &node : surface.nodes)
   {
      const auto found = number.find(node.dofs);
      if (found == number.end()) { continue; }
      const Index k = found->second;
      node.frame =
         on_supports(node.frame, {body.holds(k, 0), body.holds(k, 1), body.holds(k, 2)},
                     place_text(node.position, Formulation::space));
   }
}

} // namespace cattaneo
