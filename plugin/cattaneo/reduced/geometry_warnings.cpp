#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/union.hpp>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

const double in_degrees = 180 / std::acos(-1.0);

template <class... Parts>
std::string sentence(const Parts &...parts)
{
   std::ostringstream text;
   text.precision(4);
   (text << ... << parts);
   return text.str();
}

/// A place of two coordinates or of three.
std::string at(const Eigen::VectorXd &place)
{
   std::string text = sentence("(", place[0]);
   for (Index c = 1; c < place.size(); ++c) { text += sentence(", ", place[c]); }
   return text + ")";
}

/// An end that is taken for a plane of symmetry although the line meets it at another angle
/// than 90 degrees.
void say_symmetry(const CondensedBody &body, const std::string &name,
                  std::vector<std::string> &said)
{
   for (const LineChain &chain : body.line.chains)
   {
      for (const std::size_t end : {0, 1})
      {
         const double off = chain.off_symmetry[end], degrees = in_degrees * off;
         const LineNode &node = body.line.nodes[chain.first + (end ? chain.nodes - 1 : 0)];
         const bool turned = node.tangent.cwiseAbs().minCoeff() == 0;
         if (turned && degrees > LineChain::symmetry_turn)
         {
            said.push_back(sentence(
               name, ": the end of its contact at ", at(node.position),
               ", where a support holds it, is taken for a plane of symmetry, because the side "
               "curves towards it; that curve is off it by ",
               degrees,
               " degrees, by which the normal there is turned: if the side ends there in a "
               "corner, the support must not hold its last node"));
         }
         else if (!turned && off > 1e-6)
         {
            said.push_back(sentence(
               name, ": the end of its contact at ", at(node.position),
               ", where a support holds it, is taken for a plane of symmetry, although the "
               "line "
               "is ",
               degrees, " degrees off it (from ", LineChain::symmetry_turn,
               " degrees on it would be none): coordinates of more digits would tell"));
         }
      }
   }
}

/// Nodes of an interface with contact forces at which the normals of both bodies differ.
void say_normals(const ReducedProblem &problem, const InterfaceReport &face,
                 const std::vector<bool> &bears, std::vector<std::string> &said)
{
   if (face.turn.size() != face.nodes) { return; }
   Index worst = -1, count = 0;
   double most = small_turn;
   for (Index i = 0; i < face.nodes; ++i)
   {
      const double f = problem.friction[face.first + i];
      if (!bears[face.first + i] || f <= 0 || face.turn[i] <= small_turn * f) { continue; }
      ++count;
      if (face.turn[i] > most * f)
      {
         worst = i;
         most = face.turn[i] / f;
      }
   }
   if (worst < 0) { return; }
   const double turn = face.turn[worst], f = problem.friction[face.first + worst];
   said.push_back(sentence(
      "interface '", face.name, "': at node ", face.first + worst, " at ",
      at(problem.position.row(face.first + worst)),
      ", which carries a force, the normals of both bodies differ by ", turn, " rad (",
      in_degrees * turn, " degrees), which is not small compared with the friction ", f,
      count > 1 ? sentence(" (also at ", count - 1, " more)") : "",
      ": the node has the mean of both. With the normal of either body alone its ratio of "
      "tangential to normal force would change by ",
      0.5 * turn,
      ", so stick, slip zones and loss depend on this. Sides that touch must face each other: "
      "move the one that is out of place, or let the contact end before it"));
}

/// Nodes with friction that supports hold along an axis which is oblique to their frames.
void say_held(const Reduction &reduction, const InterfaceReport &face,
              const std::vector<bool> &bears, std::vector<std::string> &said)
{
   const ReducedProblem &problem = reduction.problem;
   // In space frames are turned onto supports, and reports have no tangents of lines.
   for (Index i = 0; i < face.tangent.rows(); ++i)
   {
      const Index node = face.first + i;
      const Vector2d tangent = face.tangent.row(i);
      const double off = std::asin(std::min(tangent.cwiseAbs().minCoeff(), 1.0));
      const bool held =
         std::count(problem.held.begin(), problem.held.end(), node) > 0 && off > 1e-6;
      if (!held || !bears[node] || problem.friction[node] <= 0) { continue; }
      const Formulation formulation = reduction.bodies[face.bodies[0]].line.formulation;
      said.push_back(sentence(
         "interface '", face.name, "': supports hold node ", node, " at ",
         at(face.position.row(i)), ", which carries a force, along ",
         component_name(formulation, nearest_axis(tangent)), ", ", in_degrees * off,
         " degrees off the contact there. Its tangential force cannot be split into "
         "support and friction, and all of it counts as the support's. This changes "
         "the normal force by up to ",
         std::tan(off) * problem.friction[node],
         " of its value. Leave contact nodes free of supports to have friction there"));
   }
}

/// The first node that a load moves along an interface, and whose friction is left out.
void say_moved(const Reduction &reduction, const InterfaceReport &face,
               const std::vector<bool> &bears, std::vector<std::string> &said)
{
   const InterfaceReport::Moved *first = nullptr;
   std::set<Index> nodes;
   for (const InterfaceReport::Moved &one : face.moved)
   {
      if (!bears[one.node]) { continue; }
      if (!first) { first = &one; }
      nodes.insert(one.node);
   }
   if (!first) { return; }
   const ReducedProblem &problem = reduction.problem;
   said.push_back(sentence(
      "interface '", face.name, "': load '", problem.patterns[first->pattern].name,
      "' moves node ", first->node, " at ", at(problem.position.row(first->node)),
      ", which carries a force, along the contact",
      nodes.size() > 1 ? sentence(" (and ", nodes.size() - 1, " more)") : "",
      ", and the body opposite cannot follow: the law of friction is left out at that node, "
      "and results have neither its friction nor its slip. Both are there where the contact "
      "ends "
      "before the part that is moved"));
}

/// Sides in space that are tied although they are apart, or overlap.
void say_apart(const Reduction &reduction, const InterfaceReport &face,
               std::vector<std::string> &said)
{
   if (!face.tied || face.bodies[1] < 0 || face.places.rows() != face.nodes) { return; }
   Index ties = 0;
   for (const InterfaceReport &one : reduction.interfaces) { ties += one.tied ? one.nodes : 0; }
   const Eigen::VectorXd none = Eigen::VectorXd::Zero(reduction.problem.nodes());
   double most = 0, worst = 0; // in distances of nodes, and as a length, of an overlap negative
   Vector3d place(0, 0, 0);
   for (Index i = 0; i < face.nodes; ++i)
   {
      // The work of a unit force of the tie on the places of the nodes that it acts on, which
      // is the distance of the parts that it holds together.
      const Eigen::VectorXd force = Eigen::VectorXd::Unit(3 * ties, 2 * ties + face.first + i);
      double apart = 0;
      for (const int b : std::set<int>{face.bodies[0], face.bodies[1]})
      {
         const Eigen::MatrixXd forces = reduction.contact_forces(b, {}, none, force);
         for (Index k = 0; k < forces.rows(); ++k)
         {
            apart += forces.row(k).dot(reduction.bodies[b].surface.nodes[k].position);
         }
      }
      if (std::abs(apart) > most * face.spacing[i])
      {
         most = std::abs(apart) / face.spacing[i];
         worst = apart;
         place = face.places.row(i);
      }
   }
   if (most <= 0.02) { return; }
   said.push_back(sentence(
      "interface '", face.name, "': its sides are tied although they ",
      worst > 0 ? "are apart by up to " : "overlap by up to ", std::abs(worst), ", at ",
      at(place),
      ": their forces act on both sides of this distance, so that a shear leaves a moment "
      "behind. Move the bodies together, or fill the space between them"));
}

/// Distance of a place from the straight line between two others.
double distance_from(const Vector2d &place, const Vector2d &from, const Vector2d &to)
{
   const Vector2d along = to - from;
   const double share = (place - from).dot(along) / along.squaredNorm();
   return (place - from - std::clamp(share, 0.0, 1.0) * along).norm();
}

/// An element that is much shorter than one beside it.
struct ShortEdge
{
   int body = -1;
   Vector2d from, to;
   double ratio = 1; ///< its length over that of its longest neighbour
};

std::vector<ShortEdge> short_edges(const CondensedBody &body, int number)
{
   std::vector<ShortEdge> found;
   for (const LineChain &chain : body.line.chains)
   {
      const std::size_t count = chain.elements.size();
      const auto length = [&](std::size_t k)
      {
         const Eigen::Matrix2Xd &points = chain.elements[k].points;
         return (points.rightCols(1) - points.leftCols(1)).norm();
      };
      for (std::size_t k = 0; k < count; ++k)
      {
         double longest = 0;
         if (k > 0 || chain.loop) { longest = length((k + count - 1) % count); }
         if (k + 1 < count || chain.loop)
         {
            longest = std::max(longest, length((k + 1) % count));
         }
         if (length(k) >= uneven_edges * longest) { continue; }
         const Eigen::Matrix2Xd &points = chain.elements[k].points;
         found.push_back({number, points.col(0), points.rightCols(1), length(k) / longest});
      }
   }
   return found;
}

/// Nodes at edges that are much shorter than those beside them, if their pressure exceeds that
/// of all other nodes of the interface.
void say_short_edges(const Reduction &reduction, const InterfaceReport &face,
                     const Eigen::VectorXd &p, std::vector<std::string> &said)
{
   std::vector<ShortEdge> edges;
   for (const int body : face.bodies)
   {
      if (body < 0) { continue; }
      for (const ShortEdge &edge : short_edges(reduction.bodies[body], body))
      {
         edges.push_back(edge);
      }
      if (face.bodies[0] == face.bodies[1]) { break; }
   }
   if (edges.empty()) { return; }
   double elsewhere = 0, most = 0;
   Index worst = -1;
   const ShortEdge *at_edge = nullptr;
   for (Index i = 0; i < face.nodes; ++i)
   {
      const double pressure = p[face.first + i] / face.weights[i];
      const Vector2d place = face.position.row(i);
      const auto edge =
         std::find_if(edges.begin(), edges.end(),
                      [&](const ShortEdge &short_edge) {
                         return distance_from(place, short_edge.from, short_edge.to) <=
                                0.5 * face.spacing[i];
                      });
      if (edge == edges.end()) { elsewhere = std::max(elsewhere, pressure); }
      else if (pressure > most)
      {
         most = pressure;
         worst = i;
         at_edge = &*edge;
      }
   }
   if (worst < 0 || most <= 1.25 * elsewhere) { return; }
   said.push_back(sentence(
      "interface '", face.name, "': node ", face.first + worst, " at ",
      at(face.position.row(worst)), " has ",
      elsewhere > 0 ? sentence(most / elsewhere, " times the largest pressure elsewhere")
                    : std::string("all of the pressure"),
      "; an edge of ", called(reduction.bodies, at_edge->body), " there has ", at_edge->ratio,
      " of the length of the edge beside it. On curved sides such a short edge takes pressure "
      "that its neighbours should: make the lengths of the edges change more slowly"));
}

/// An element of a line, with the curve of which it is a chord, and with its neighbours.
struct LineEdge
{
   const LineElement *element = nullptr;
   Vector2d from, to;
   /// Angle to the element before and to the element after, each over half of the sum of the
   /// two lengths: the curvature of a curve through its ends. Empty at ends of the line.
   std::array<std::optional<double>, 2> curvature;

   double length() const { return (to - from).norm(); }
   bool follows_curve() const { return element->bend && !element->bend->straight(); }
};

std::vector<LineEdge> edges_of(const ContactLine &line)
{
   std::vector<LineEdge> all;
   for (const LineChain &chain : line.chains)
   {
      const std::size_t first = all.size(), count = chain.elements.size();
      for (const LineElement &element : chain.elements)
      {
         all.push_back({&element, element.points.leftCols(1), element.points.rightCols(1), {}});
      }
      for (std::size_t k = 0;
           k < (chain.loop ? count : count - std::min<std::size_t>(count, 1)); ++k)
      {
         LineEdge &one = all[first + k], &next = all[first + (k + 1) % count];
         const Vector2d a = one.to - one.from, b = next.to - next.from;
         const double turn = std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
         one.curvature[1] = next.curvature[0] = 2 * turn / (one.length() + next.length());
      }
   }
   return all;
}

/// Edges that stay a polygon although their vertices lie on the smooth curve of the other side.
void say_polygon(const Reduction &reduction, const InterfaceReport &face,
                 const std::vector<bool> &bears, std::vector<std::string> &said)
{
   const bool any =
      std::any_of(bears.begin() + face.first, bears.begin() + face.first + face.nodes,
                  [](bool one) { return one; });
   if (face.bodies[1] < 0 || face.bodies[0] == face.bodies[1] || !any) { return; }
   for (const std::size_t k : {0, 1})
   {
      const CondensedBody &body = reduction.bodies[face.bodies[k]],
                          &other = reduction.bodies[face.bodies[1 - k]];
      if (body.line.as_meshed || other.line.as_meshed) { continue; }
      const std::vector<LineEdge> own = edges_of(body.line), facing = edges_of(other.line);
      int count = 0;
      double most = 0, gap = 0;
      Vector2d place(0, 0);
      for (const LineEdge &edge : own)
      {
         if (!edge.element->bend || edge.follows_curve()) { continue; }
         const Vector2d middle = 0.5 * (edge.from + edge.to);
         // The curve opposite to its middle.
         const LineEdge *nearest = nullptr;
         double away = 0.5 * edge.length();
         for (const LineEdge &curve : facing)
         {
            if (!curve.follows_curve() || (curve.to - curve.from).dot(edge.to - edge.from) >= 0)
            {
               continue;
            }
            const double distance = distance_from(middle, curve.from, curve.to);
            if (distance >= away) { continue; }
            away = distance;
            nearest = &curve;
         }
         if (!nearest) { continue; }
         const EdgeBend &bend = *nearest->element->bend;
         const double its = 2 * std::sin(0.5 * (bend.begin + bend.end)) / nearest->length();
         // Seen from the other side the curve turns in the other direction. Without a turn at
         // either end it is not a polygon.
         bool fits = edge.curvature[0] || edge.curvature[1];
         for (const std::optional<double> &turns : edge.curvature)
         {
            fits = fits && (!turns || std::abs(*turns + its) <= 0.3 * std::abs(its));
         }
         const double off = std::abs(its) * edge.length() * edge.length() / 8;
         if (!fits || off <= 1e-6 * edge.length()) { continue; }
         // The gap of the nodes beside it, which may be large compared with that distance.
         double least = std::numeric_limits<double>::infinity();
         for (Index i = 0; i < face.nodes; ++i)
         {
            const Vector2d node = face.position.row(i);
            if (distance_from(node, edge.from, edge.to) > edge.length()) { continue; }
            least = std::min(least, std::abs(reduction.problem.gap[face.first + i]));
         }
         if (least > 20 * off) { continue; }
         ++count;
         if (off <= most) { continue; }
         most = off;
         gap = least;
         place = middle;
      }
      if (count == 0) { continue; }
      said.push_back(
         sentence("interface '", face.name, "': ", count, " straight edges of ",
                  called(reduction.bodies, face.bodies[k]), ", most at ", at(place),
                  ", stay a polygon, but their vertices fit the smooth curve of "
                  "the other side: the gap between them is wrong by up to ",
                  most, " where it is ", gap,
                  " (the least beside it), and nodes that should carry a force may not. "
                  "Give the side more edges (an arc has five or more), one curve "
                  "of its file, or curved elements, or take both as meshed"));
   }
}

} // namespace

std::vector<std::string> geometry_warnings(const Reduction &reduction, const Eigen::VectorXd &p)
{
   const ReducedProblem &problem = reduction.problem;
   require(p.size() == problem.nodes(), "geometry warnings: ", p.size(),
           " normal forces, must be ", problem.nodes());
   std::vector<std::string> said;
   for (const InterfaceReport &face : reduction.interfaces)
   {
      if (!face.differing) { continue; }
      said.push_back(sentence(
         "interface '", face.name,
         "': its nodes are paired one to one, but elements of the bodies differ there, at ",
         at(*face.differing),
         " for instance: tractions of single nodes are wrong there, even under a uniform "
         "pressure; without a pairing nodes need not match"));
   }
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      say_symmetry(reduction.bodies[b], called(reduction.bodies, static_cast<int>(b)), said);
   }
   std::vector<bool> bears;
   for (const double force : p) { bears.push_back(force > 1e-6 * p.maxCoeff() && force > 0); }
   for (const InterfaceReport &face : reduction.interfaces)
   {
      say_apart(reduction, face, said);
      if (face.tied) { continue; }
      say_normals(problem, face, bears, said);
      say_held(reduction, face, bears, said);
      say_moved(reduction, face, bears, said);
      say_polygon(reduction, face, bears, said);
      say_short_edges(reduction, face, p, said);
   }
   return said;
}

} // namespace cattaneo
