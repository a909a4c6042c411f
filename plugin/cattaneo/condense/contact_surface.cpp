#include <algorithm>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/contact_surface.hpp>
#include <cattaneo/condense/face_functions.hpp>
#include <cattaneo/condense/middles.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <map>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{

/// Contribution of a face to a node: the weight ∫φ dA, and ∫φ n dA with the normal by the order
/// of nodes.
struct FaceShare
{
   double weight = 0;
   Vector3d area{0, 0, 0};
};

/// Faces of order 3 have two nodes on each edge.
bool is_cubic(const std::size_t nodes)
{
   return nodes == 10 || nodes == 16;
}

/// Thirds (of each direction) at which the nodes of a face of order 3 lie.
std::vector<std::array<int, 2>> thirds_of(const std::size_t nodes)
{
   if (nodes == 10)
   {
      return {{0, 0}, {3, 0}, {0, 3}, {1, 0}, {2, 0}, {2, 1}, {1, 2}, {0, 2}, {0, 1}, {1, 1}};
   }
   return {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 0}, {2, 0}, {3, 1}, {3, 2},
           {2, 3}, {1, 3}, {0, 2}, {0, 1}, {1, 1}, {2, 1}, {2, 2}, {1, 2}};
}

/// The product t (t - 1) … of `factors` factors, t = 3 x, over its value at t = `factors`, and
/// its derivative by x: 1 at one third of a line and 0 at all before it.
std::array<double, 2> rising(int factors, double x)
{
   double value = 1, slope = 0;
   for (int k = 0; k < factors; ++k)
   {
      const double share = (3 * x - k) / (factors - k), by = 3.0 / (factors - k);
      slope = slope * share + value * by;
      value *= share;
   }
   return {value, slope};
}

/// Functions of a face of order 3 whose nodes lie at thirds.
FaceFunctions cubic_functions(std::size_t nodes, double s, double t)
{
   FaceFunctions of(static_cast<Index>(nodes), 3);
   Index a = 0;
   for (const auto &[i, j] : thirds_of(nodes))
   {
      if (nodes == 10)
      {
         // Products of three functions that rise from the sides.
         const auto one = rising(i, s), two = rising(j, t), rest = rising(3 - i - j, 1 - s - t);
         of.row(a++) << one[0] * two[0] * rest[0],
            (one[1] * rest[0] - one[0] * rest[1]) * two[0],
            (two[1] * rest[0] - two[0] * rest[1]) * one[0];
         continue;
      }
      // In each direction: the product of a function that rises from one end of the interval
      // and a function that rises from the other end.
      const auto along = rising(i, s), back = rising(3 - i, 1 - s), across = rising(j, t),
                 down = rising(3 - j, 1 - t);
      const double x = along[0] * back[0], y = across[0] * down[0];
      of.row(a++) << x * y, (along[1] * back[0] - along[0] * back[1]) * y,
         (across[1] * down[0] - across[0] * down[1]) * x;
   }
   return of;
}

FaceFunctions triangle_functions(std::size_t nodes, double s, double t)
{
   // Areas of the three parts, with their derivatives.
   const double L[3][3] = {{1 - s - t, -1, -1}, {s, 1, 0}, {t, 0, 1}};
   FaceFunctions of(static_cast<Index>(nodes), 3);
   for (int a = 0; a < 3; ++a)
   {
      const auto &own = L[a], &next = L[(a + 1) % 3];
      if (nodes == 3)
      {
         of.row(a) << own[0], own[1], own[2];
         continue;
      }
      const double slope = 4 * own[0] - 1;
      of.row(a) << own[0] * (2 * own[0] - 1), slope * own[1], slope * own[2];
      of.row(3 + a) << 4 * own[0] * next[0], 4 * (own[1] * next[0] + own[0] * next[1]),
         4 * (own[2] * next[0] + own[0] * next[2]);
   }
   return of;
}

FaceFunctions quadrilateral_functions(std::size_t nodes, double s, double t)
{
   // Functions of one direction, with derivatives: linear ones, or quadratic ones of both ends
   // and the middle.
   const auto line = [nodes](double x)
   {
      Eigen::Matrix<double, 3, 2> of;
      if (nodes == 4) { of << 1 - x, -1, x, 1, 0, 0; }
      else
      {
         of << (1 - x) * (1 - 2 * x), 4 * x - 3, x * (2 * x - 1), 4 * x - 1, 4 * x * (1 - x),
            4 - 8 * x;
      }
      return of;
   };
   const auto along = line(s), across = line(t);
   // The number of each node's function in either direction: corners, middles, middle of the
   // face.
   const int place[9][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0},
                            {1, 2}, {2, 1}, {0, 2}, {2, 2}};
   const std::size_t all = nodes == 4 ? 4 : 9;
   FaceFunctions of(static_cast<Index>(all), 3);
   for (std::size_t a = 0; a < all; ++a)
   {
      const int i = place[a][0], j = place[a][1];
      of.row(static_cast<Index>(a)) << along(i, 0) * across(j, 0), along(i, 1) * across(j, 0),
         along(i, 0) * across(j, 1);
   }
   if (nodes != 8) { return of; }
   // Leaves out the middle of the face, whose displacement follows from the eight nodes.
   FaceFunctions eight = of.topRows(8);
   eight.topRows(4).rowwise() -= 0.25 * of.row(8);
   eight.bottomRows(4).rowwise() += 0.5 * of.row(8);
   return eight;
}

/// Shares of the nodes of a face, by Gauss's rule: exact for plane faces with straight edges.
std::vector<FaceShare> shares_of(const std::vector<Vector3d> &x)
{
   std::vector<FaceShare> shares(x.size());
   const QuadratureRule &rule = gauss_rule(5);
   const bool triangle = corners_of(x.size()) == 3;
   for (Index i = 0; i < rule.points.size(); ++i)
   {
      for (Index j = 0; j < rule.points.size(); ++j)
      {
         // A triangle is a square of which one side is a point.
         const double s = rule.points[i], narrow = triangle ? 1 - s : 1,
                      t = narrow * rule.points[j],
                      weight = narrow * rule.weights[i] * rule.weights[j];
         const FaceFunctions of = face_functions(x.size(), s, t);
         Vector3d along(0, 0, 0), across(0, 0, 0);
         for (std::size_t a = 0; a < x.size(); ++a)
         {
            along += of(static_cast<Index>(a), 1) * x[a];
            across += of(static_cast<Index>(a), 2) * x[a];
         }
         const Vector3d area = weight * along.cross(across);
         for (std::size_t a = 0; a < x.size(); ++a)
         {
            const double phi = of(static_cast<Index>(a), 0);
            shares[a].weight += phi * area.norm();
            shares[a].area += phi * area;
         }
      }
   }
   return shares;
}

/// The number of the edge whose middle is the nearest to that of a face's edge; that edge
/// itself unless nodes are out of order.
std::size_t nearest_edge(const std::vector<Vector3d> &x, std::size_t edge)
{
   const std::size_t corners = corners_of(x.size());
   std::size_t nearest = edge;
   const auto off = [&](std::size_t e)
   { return (x[corners + edge] - 0.5 * (x[e] + x[(e + 1) % corners])).norm(); };
   for (std::size_t e = 0; e < corners; ++e)
   {
      if (off(e) < 0.999 * off(nearest)) { nearest = e; }
   }
   return nearest;
}

/// The node of a face of order 3 that is farthest from its third of the straight face between
/// the corners, if that is more than 0.05 of the shortest edge; else the number of all nodes.
/// (Gauss–Lobatto points of order 3 are off by 0.057 of an edge.)
std::size_t off_thirds(const std::vector<Vector3d> &x)
{
   double shortest = std::numeric_limits<double>::infinity(), most = 0;
   const std::size_t corners = corners_of(x.size());
   for (std::size_t e = 0; e < corners; ++e)
   {
      shortest = std::min(shortest, (x[(e + 1) % corners] - x[e]).norm());
   }
   const auto thirds = thirds_of(x.size());
   std::size_t farthest = x.size();
   for (std::size_t a = corners; a < x.size(); ++a)
   {
      const double s = thirds[a][0] / 3., t = thirds[a][1] / 3.;
      Vector3d at = (1 - s - t) * x[0] + s * x[1] + t * x[2];
      if (corners == 4)
      {
         at = (1 - s) * ((1 - t) * x[0] + t * x[3]) + s * ((1 - t) * x[1] + t * x[2]);
      }
      const double off = (x[a] - at).norm();
      if (off > std::max(most, 0.05 * shortest))
      {
         most = off;
         farthest = a;
      }
   }
   return farthest;
}

/// Nodes of a face in the opposite sense.
void turn_round(std::vector<Index> &face)
{
   const auto corners = static_cast<Index>(corners_of(face.size()));
   std::reverse(face.begin(), face.begin() + corners);
   if (is_cubic(face.size()))
   {
      // The last edge stays the last, the two nodes of each edge change places, and those
      // inside go with their corners.
      std::reverse(face.begin() + corners, face.begin() + 3 * corners - 2);
      std::swap(face[3 * corners - 2], face[3 * corners - 1]);
      std::reverse(face.begin() + 3 * corners, face.end());
      return;
   }
   // The edge from the last corner to the first stays the last.
   if (face.size() > 4)
   {
      std::reverse(face.begin() + corners, face.begin() + 2 * corners - 1);
   }
}

} // namespace

std::size_t corners_of(const std::size_t nodes)
{
   return nodes == 3 || nodes == 6 || nodes == 10 ? 3 : 4;
}

FaceFunctions face_functions(const std::size_t nodes, double s, double t)
{
   return is_cubic(nodes)          ? cubic_functions(nodes, s, t)
          : corners_of(nodes) == 3 ? triangle_functions(nodes, s, t)
                                   : quadrilateral_functions(nodes, s, t);
}

bool is_face(std::size_t nodes)
{
   return nodes == 3 || nodes == 4 || nodes == 6 || nodes == 8 || nodes == 9 || is_cubic(nodes);
}

Eigen::MatrixX3d ContactSurface::positions() const
{
   Eigen::MatrixX3d all(size(), 3);
   for (Index i = 0; i < size(); ++i) { all.row(i) = nodes[i].position; }
   return all;
}

Eigen::VectorXd ContactSurface::weights() const
{
   Eigen::VectorXd all(size());
   for (Index i = 0; i < size(); ++i) { all[i] = nodes[i].weight; }
   return all;
}

Eigen::MatrixX3d ContactSurface::points() const
{
   return of_nodes(positions());
}

bool ContactSurface::has_middles() const
{
   return std::any_of(nodes.begin(), nodes.end(),
                      [](const SurfaceNode &node) { return node.between[0] >= 0; });
}

Eigen::MatrixXd ContactSurface::at_nodes(Eigen::MatrixXd unknowns) const
{
   Middles(*this).to_nodes(unknowns);
   return unknowns;
}

Eigen::MatrixXd ContactSurface::of_nodes(Eigen::MatrixXd values) const
{
   Middles(*this).to_unknowns(values);
   return values;
}

Eigen::MatrixXd ContactSurface::forces_at_nodes(Eigen::MatrixXd on_unknowns) const
{
   Middles(*this).forces_to_nodes(on_unknowns);
   return on_unknowns;
}

Eigen::MatrixXd ContactSurface::forces_of_nodes(Eigen::MatrixXd on_nodes) const
{
   Middles(*this).forces_to_unknowns(on_nodes);
   return on_nodes;
}

void ContactSurface::validate() const
{
   require(!nodes.empty(), "contact surface: it has no nodes, must have at least one");
   for (Index i = 0; i < size(); ++i)
   {
      const SurfaceNode &node = nodes[i];
      const std::string where = "contact surface: node " + std::to_string(i) + " at " +
                                place_text(node.position, Formulation::space);
      require(node.position.allFinite(), where, " must be at a finite place");
      const double off =
         (node.frame * node.frame.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff();
      require(off < 1e-9 && node.frame.determinant() > 0, where,
              " has a frame that must be right-handed, of three orthogonal unit vectors");
      require(node.weight > 0 && std::isfinite(node.weight) && node.spacing > 0 &&
                 std::isfinite(node.spacing),
              where, " has the weight ", node.weight, " and the spacing ", node.spacing,
              ", both must be positive");
      for (Index end : node.between)
      {
         require(end == node.between[0] || node.between[0] >= 0, where,
                 " is in the middle of an edge with one end, must have two or none");
         require(end >= -1 && end < size() && (end < 0 || nodes[end].between[0] < 0), where,
                 " is in the middle of an edge that ends at node ", end,
                 ", must end at corners from 0 to ", size() - 1);
      }
   }
   for (const std::vector<Index> &face : faces)
   {
      for (Index node : face)
      {
         require(node >= 0 && node < size(), "contact surface: a face has node ", node,
                 ", must be from 0 to ", size() - 1);
      }
   }
}

Matrix3d frame_of(const Vector3d &normal)
{
   int axis = 0;
   for (int c : {1, 2})
   {
      // This axis is closer to the tangent plane than the best so far, by more than round-off.
      if (std::abs(normal[c]) < std::abs(normal[axis]) - 1e-9) { axis = c; }
   }
   Matrix3d frame;
   const Vector3d first = (Vector3d::Unit(axis) - normal[axis] * normal).normalized();
   frame.row(0) = first;
   frame.row(1) = normal.cross(first);
   frame.row(2) = normal;
   return frame;
}

ContactSurface surface_of(const std::vector<std::vector<int>> &faces,
                          const std::function<SurfaceNode(int)> &node,
                          const std::function<Vector3d(std::size_t)> &inside,
                          const std::string &where)
{
   require(!faces.empty(), where, ": it has no face, must have at least one");
   ContactSurface surface;
   std::map<int, Index> number;
   std::vector<Vector3d> area;
   for (std::size_t f = 0; f < faces.size(); ++f)
   {
      const std::vector<int> &face = faces[f];
      const std::size_t count = face.size(), corners = corners_of(count);
      require(is_face(count), where, ": face ", f, " has ", count, " nodes, must have ",
              nodes_of_faces);
      // 1. Its nodes, those that are new among them.
      std::vector<Index> its;
      std::vector<Vector3d> x;
      for (int id : face)
      {
         const auto [at, is_new] = number.emplace(id, surface.size());
         if (is_new)
         {
            surface.nodes.push_back(node(id));
            surface.nodes.back().weight = 0;
            surface.nodes.back().spacing = std::numeric_limits<double>::infinity();
            area.emplace_back(0, 0, 0);
         }
         its.push_back(at->second);
         x.push_back(surface.nodes[at->second].position);
      }
      // 2. Its area, and its sense.
      const std::vector<FaceShare> shares = shares_of(x);
      Vector3d whole(0, 0, 0);
      double size = 0;
      for (const FaceShare &each : shares) { whole += each.area; }
      for (const Vector3d &place : x) { size = std::max(size, (place - x[0]).squaredNorm()); }
      require(whole.norm() > 1e-12 * size, where, ": face ", f, " of the node at ",
              place_text(x[0], Formulation::space), " has no area");
      const bool turned = whole.dot(inside(f)) < 0;
      for (std::size_t a = 0; a < count; ++a)
      {
         SurfaceNode &own = surface.nodes[its[a]];
         own.weight += shares[a].weight;
         area[its[a]] += turned ? Vector3d(-shares[a].area) : shares[a].area;
         for (std::size_t b = 0; b < count; ++b)
         {
            const double apart = (x[b] - x[a]).norm();
            if (b != a) { own.spacing = std::min(own.spacing, apart); }
         }
      }
      // 3. Nodes between corners; middles of edges may have functions that are not positive in
      // the mean.
      const std::size_t off = is_cubic(count) ? off_thirds(x) : count;
      require(
         off == count, where, ": node ", face[std::min(off, count - 1)], " of face ", f,
         " must be at thirds of the face, to 0.05 of an edge: corners come first, then two "
         "nodes of each edge from the first on, then those inside");
      for (std::size_t e = 0; e < corners && count > 4 && !is_cubic(count); ++e)
      {
         const std::size_t next = (e + 1) % corners, nearest = nearest_edge(x, e);
         require(nearest == e, where, ": node ", face[corners + e], " of face ", f,
                 " is not between its corners ", face[e], " and ", face[next],
                 ", but nearest to the middle of ", face[nearest], " and ",
                 face[(nearest + 1) % corners],
                 ": corners come first, then the middle of each edge from the first on");
         if (count != 9) { surface.nodes[its[corners + e]].between = {its[e], its[next]}; }
      }
      if (turned) { turn_round(its); }
      surface.faces.push_back(std::move(its));
   }
   // 4. Weights and normals of the unknowns.
   Eigen::MatrixXd sums(surface.size(), 4);
   for (Index i = 0; i < surface.size(); ++i)
   {
      sums.row(i) << surface.nodes[i].weight, area[i].transpose();
   }
   sums = surface.forces_of_nodes(std::move(sums));
   for (Index i = 0; i < surface.size(); ++i)
   {
      surface.nodes[i].weight = sums(i, 0);
      area[i] = sums.row(i).tail(3);
   }
   for (Index i = 0; i < surface.size(); ++i)
   {
      SurfaceNode &own = surface.nodes[i];
      require(area[i].norm() > 0.1 * own.weight, where, ": the faces at the node ",
              place_text(own.position, Formulation::space),
              " have opposite normals: number the nodes of all faces in the same sense");
      own.frame = frame_of(area[i].normalized());
   }
   surface.validate();
   return surface;
}

ContactSurface joined(const std::vector<ContactSurface> &surfaces)
{
   require(!surfaces.empty(), "joined: there is no contact surface, must be one at least");
   ContactSurface made;
   std::map<std::array<int, 3>, Index> number;
   for (const ContactSurface &surface : surfaces)
   {
      surface.validate();
      const Eigen::VectorXd areas = surface.forces_at_nodes(surface.weights()); // ∫N dA
      std::vector<Index> its;
      for (Index i = 0; i < surface.size(); ++i)
      {
         const SurfaceNode &node = surface.nodes[i];
         const auto [at, is_new] = number.emplace(node.dofs, made.size());
         its.push_back(at->second);
         if (is_new)
         {
            made.nodes.push_back(node);
            made.nodes.back().weight = 0;
            made.nodes.back().between = {-1, -1};
         }
         SurfaceNode &own = made.nodes[at->second];
         own.weight += areas[i];
         own.spacing = std::min(own.spacing, node.spacing);
      }
      for (Index i = 0; i < surface.size(); ++i)
      {
         const std::array<Index, 2> &ends = surface.nodes[i].between;
         if (ends[0] >= 0) { made.nodes[its[i]].between = {its[ends[0]], its[ends[1]]}; }
      }
      for (std::vector<Index> face : surface.faces)
      {
         for (Index &node : face) { node = its[node]; }
         made.faces.push_back(std::move(face));
      }
   }
   const Eigen::VectorXd weights = made.forces_of_nodes(made.weights());
   for (Index i = 0; i < made.size(); ++i) { made.nodes[i].weight = weights[i]; }
   made.validate();
   return made;
}

} // namespace cattaneo
