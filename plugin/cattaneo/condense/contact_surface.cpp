#include <algorithm>
#include <cattaneo/condense/contact_surface.hpp>
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

/// Of the nodes of a plane triangle, or of a bilinear quadrilateral by Gauss's rule.
std::vector<FaceShare> shares_of(const std::vector<Vector3d> &x)
{
   std::vector<FaceShare> shares(x.size());
   if (x.size() == 3)
   {
      const Vector3d area = (x[1] - x[0]).cross(x[2] - x[0]) / 6;
      for (FaceShare &each : shares) { each = {area.norm(), area}; }
      return shares;
   }
   // Three points along each side integrate φ times the area of a plane face exactly.
   const double off = std::sqrt(0.6), points[] = {-off, 0, off},
                weights[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
   const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
   for (int i = 0; i < 3; ++i)
   {
      for (int j = 0; j < 3; ++j)
      {
         const double s = points[i], t = points[j];
         Vector3d along(0, 0, 0), across(0, 0, 0);
         for (int a = 0; a < 4; ++a)
         {
            along += 0.25 * corner[a][0] * (1 + corner[a][1] * t) * x[a];
            across += 0.25 * corner[a][1] * (1 + corner[a][0] * s) * x[a];
         }
         const Vector3d area = weights[i] * weights[j] * along.cross(across);
         for (int a = 0; a < 4; ++a)
         {
            const double phi = 0.25 * (1 + corner[a][0] * s) * (1 + corner[a][1] * t);
            shares[a].weight += phi * area.norm();
            shares[a].area += phi * area;
         }
      }
   }
   return shares;
}

} // namespace

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
      // Nearer to the surface by more than round-off.
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
      require(face.size() == 3 || face.size() == 4, where, ": face ", f, " has ", face.size(),
              " nodes, must have 3 or 4");
      std::vector<Index> its;
      std::vector<Vector3d> corners;
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
         corners.push_back(surface.nodes[at->second].position);
      }
      const std::vector<FaceShare> shares = shares_of(corners);
      Vector3d whole(0, 0, 0);
      double size = 0;
      for (const FaceShare &each : shares) { whole += each.area; }
      for (const Vector3d &corner : corners)
      {
         size = std::max(size, (corner - corners[0]).squaredNorm());
      }
      require(whole.norm() > 1e-12 * size, where, ": face ", f, " of the node at ",
              place_text(corners[0], Formulation::space), " has no area");
      const bool turned = whole.dot(inside(f)) < 0;
      for (std::size_t a = 0; a < face.size(); ++a)
      {
         SurfaceNode &own = surface.nodes[its[a]];
         own.weight += shares[a].weight;
         area[its[a]] += turned ? Vector3d(-shares[a].area) : shares[a].area;
         for (std::size_t b = 0; b < face.size(); ++b)
         {
            const double apart = (corners[b] - corners[a]).norm();
            if (b != a) { own.spacing = std::min(own.spacing, apart); }
         }
      }
      if (turned) { std::reverse(its.begin(), its.end()); }
      surface.faces.push_back(std::move(its));
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

} // namespace cattaneo
