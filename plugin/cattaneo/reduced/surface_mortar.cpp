#include <algorithm>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/face_functions.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/surface_mortar.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Least share of a node's weight that must be covered for the node to have a row.
constexpr double least_covered = 0.25;
/// Least share of ∫φ_i over the covered part in the weight of a row.
constexpr double least_weight = 0.1;
/// Largest ratio of ∫|ψ_i| to ∫ψ_i. It is below 7 on faces that are covered, and below 20 where
/// a straight edge cuts them.
constexpr double most_waves = 50;
/// Cover of a face below this share is left out.
constexpr double least_overlap = 1e-4;
/// Least cosine of the angle between normals of one face that is no corner, 35 degrees.
constexpr double cos_of_corner = 0.819152;
/// Round-off of areas, in shares of a face.
constexpr double area_round_off = 1e-12;

/// A polygon in the plane of a face of the slave.
using Polygon = std::vector<Vector2d>;
/// The nodes of a face in that plane.
using FlatNodes = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 9>;
/// The functions of the nodes of a face at a point.
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1>;

/// Triangles and quadrilaterals between the nodes of a face, in its own numbers.
const std::vector<std::vector<Index>> &linear_parts(std::size_t nodes)
{
   static const std::map<std::size_t, std::vector<std::vector<Index>>> parts{
      {3, {{0, 1, 2}}},
      {4, {{0, 1, 2, 3}}},
      {6, {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}},
      {8, {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {7, 6, 3}, {4, 5, 6, 7}}},
      {9, {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}}};
   return parts.at(nodes);
}

double area_of(const Polygon &polygon)
{
   double area = 0;
   for (std::size_t k = 0; k < polygon.size(); ++k)
   {
      const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
   }
   return area;
}

/// The part of a polygon to the left of a line.
Polygon left_of(const Polygon &subject, const Vector2d &from, const Vector2d &to)
{
   const Vector2d along = to - from;
   const auto inside = [&](const Vector2d &x)
   { return along[0] * (x[1] - from[1]) - along[1] * (x[0] - from[0]); };
   Polygon kept;
   for (std::size_t i = 0; i < subject.size(); ++i)
   {
      const Vector2d &here = subject[i], &next = subject[(i + 1) % subject.size()];
      const double one = inside(here), other = inside(next);
      if (one >= 0) { kept.push_back(here); }
      if ((one > 0 && other < 0) || (one < 0 && other > 0))
      {
         kept.push_back(here + one / (one - other) * (next - here));
      }
   }
   return kept;
}

/// The part of a polygon that lies within a convex one, whose corners go counter-clockwise
/// [Sutherland 1974].
Polygon clipped(Polygon subject, const Polygon &convex)
{
   for (std::size_t k = 0; k < convex.size() && !subject.empty(); ++k)
   {
      subject = left_of(subject, convex[k], convex[(k + 1) % convex.size()]);
   }
   return subject;
}

/// Adds the parts of a polygon that lie outside a convex one, if they have more than an area.
void add_outside(Polygon subject, const Polygon &convex, double least,
                 std::vector<Polygon> &parts)
{
   for (std::size_t k = 0; k < convex.size() && subject.size() > 2; ++k)
   {
      const Vector2d &from = convex[k], &to = convex[(k + 1) % convex.size()];
      Polygon beyond = left_of(subject, to, from);
      if (beyond.size() > 2 && area_of(beyond) > least) { parts.push_back(std::move(beyond)); }
      subject = left_of(subject, from, to);
   }
}

/// A face of a surface.
struct MortarFace
{
   std::vector<Index> nodes;
   Eigen::Matrix3Xd x, normals; ///< of the nodes
   Vector3d middle, normal;     ///< the normal is the mean one, into the body
   double radius = 0;           ///< of a ball around the middle that contains it
   /// Of its functions as polynomials of the place on a plane face with straight edges, of
   /// which it is a triangle or a parallelogram; 0: it is none.
   int degree = 0;
   /// Along each side of a triangle, where its functions are no polynomials.
   int points = 8;
   bool curved = false; ///< follows_curve()

   MortarFace(const ContactSurface &surface, const std::vector<Index> &its,
              const std::string &what)
      : nodes(its), x(3, static_cast<Index>(its.size())), normals(x), normal(0, 0, 0)
   {
      for (std::size_t a = 0; a < nodes.size(); ++a)
      {
         x.col(static_cast<Index>(a)) = surface.nodes[nodes[a]].position;
         normals.col(static_cast<Index>(a)) = surface.nodes[nodes[a]].normal();
      }
      middle = x.rowwise().mean();
      radius = (x.colwise() - middle).colwise().norm().maxCoeff();
      for (const std::vector<Index> &part : linear_parts(nodes.size()))
      {
         const Vector3d one = x.col(part[1]) - x.col(part[0]),
                        two = x.col(part[2]) - x.col(part[0]);
         normal += one.cross(two);
         if (part.size() == 4) { normal += two.cross(x.col(part[3]) - x.col(part[0])); }
      }
      require(normal.norm() > 1e-12 * radius * radius, what, ": the face at ",
              place_text(middle, Formulation::space), " has no area");
      normal.normalize();
      // Middles of edges must be at their places, and opposite edges parallel.
      const auto corners = static_cast<Index>(corners_of(nodes.size()));
      double off = corners == 4 ? (x.col(0) - x.col(1) + x.col(2) - x.col(3)).norm() : 0;
      for (Index a = corners; a < x.cols(); ++a)
      {
         const Index e = a - corners;
         const Vector3d between = e < corners
                                     ? Vector3d(0.5 * (x.col(e) + x.col((e + 1) % corners)))
                                     : Vector3d(0.5 * (x.col(0) + x.col(2)));
         off = std::max(off, (x.col(a) - between).norm());
      }
      static const std::map<std::size_t, int> degrees{{3, 1}, {4, 2}, {6, 2}, {8, 3}, {9, 4}};
      if (off <= 1e-13 * radius) { degree = degrees.at(nodes.size()); }
      curved = follows_curve();
      // The Jacobian of a quadrilateral has the variation r: between corners, over its mean
      // value. Gauss points converge as ρ^(-2n), ρ = 1/r + sqrt(1/r² - 1), because it vanishes
      // at 1/r half edges from the middle.
      double least = 0, most = 0;
      for (Index a = 0; corners == 4 && a < 4; ++a)
      {
         const Vector3d one = x.col((a + 1) % 4) - x.col(a),
                        two = x.col((a + 3) % 4) - x.col(a);
         const double J = one.cross(two).dot(normal);
         least = a == 0 ? J : std::min(least, J);
         most = a == 0 ? J : std::max(most, J);
      }
      const double r = most > least ? (most - least) / (most + std::max(least, 0.0)) : 0;
      if (r > 0.01)
      {
         const double rho = 1 / r + std::sqrt(std::max(1 / (r * r) - 1, 0.0));
         points = std::clamp(static_cast<int>(std::ceil(16 / std::log(rho))) + 2, 8, 40);
      }
   }

   /// Is it a face of order 2 whose edges follow the curve that the normals of their ends show?
   bool follows_curve() const
   {
      const auto corners = static_cast<Index>(corners_of(nodes.size()));
      double off = 0, expected = 0; // of the middles of edges, along the normal
      for (Index e = 0; e < corners && corners < x.cols(); ++e)
      {
         const Index next = (e + 1) % corners;
         const Vector3d edge = x.col(next) - x.col(e);
         off =
            std::max(off, std::abs((x.col(corners + e) - x.col(e) - 0.5 * edge).dot(normal)));
         expected =
            std::max(expected, std::abs(edge.dot(normals.col(next) - normals.col(e))) / 8);
      }
      return corners < x.cols() && off > 0.1 * expected;
   }

   /** How far into the body a smooth surface lies behind a face of order 1, or one of order 2
       with straight edges, at a point with these functions. A function with the second
       derivatives H differs from what the corners make of it by -1/2 Σ φ_a φ_b dᵀ H d over
       pairs of corners, d = x_b - x_a. Along the normal H d is the difference of their normals,
       with the opposite sign. */
   double behind(const NodeValues &functions) const
   {
      if (curved) { return 0; }
      const auto corners = static_cast<Index>(corners_of(nodes.size()));
      // Linear functions of the corners: 1/2 at the middles of edges, 1/4 at that of a face.
      NodeValues linear = functions;
      for (Index e = 0; e < corners && corners < x.cols(); ++e)
      {
         linear[e] += 0.5 * functions[corners + e];
         linear[(e + 1) % corners] += 0.5 * functions[corners + e];
         if (x.cols() == 9) { linear[e] += 0.25 * functions[8]; }
      }
      double sum = 0;
      for (Index a = 0; a < corners; ++a)
      {
         for (Index b = 0; b < a; ++b)
         {
            // At corners the faces are meant as they are.
            if (normals.col(a).dot(normals.col(b)) < cos_of_corner) { return 0; }
            sum += linear[a] * linear[b] *
                   (x.col(b) - x.col(a)).dot(normals.col(b) - normals.col(a));
         }
      }
      return sum / 2;
   }
};

std::vector<MortarFace> faces_of(const ContactSurface &surface, const std::string &what)
{
   surface.validate();
   require(!surface.faces.empty(), what,
           ": a contact surface has no faces, which surfaces need whose nodes do not match");
   std::vector<MortarFace> all;
   for (const std::vector<Index> &face : surface.faces)
   {
      require(is_face(face.size()) && face.size() <= 9, what, ": a face has ", face.size(),
              " nodes, must have 3, 4, 6, 8 or 9 where nodes of both sides do not match");
      all.emplace_back(surface, face, what);
   }
   return all;
}

/// The plane across the normal of a face of the slave.
struct FacePlane
{
   Vector3d from;
   Eigen::Matrix<double, 2, 3> along;

   explicit FacePlane(const MortarFace &face)
      : from(face.middle), along(frame_of(face.normal).topRows<2>())
   {
   }
   FlatNodes flat(const MortarFace &face) const { return along * (face.x.colwise() - from); }
};

/// The functions of a face at the point that lies at `place` of the plane.
FaceFunctions functions_at(const FlatNodes &nodes, const Vector2d &place,
                           const Vector3d &middle, const std::string &what)
{
   const auto count = static_cast<std::size_t>(nodes.cols());
   Vector2d at = Vector2d::Constant(corners_of(count) == 3 ? 1. / 3 : 0.5);
   FaceFunctions of = face_functions(count, at[0], at[1]);
   for (int step = 0; step < 30; ++step)
   {
      const Matrix2d slope = nodes * of.rightCols<2>();
      const Vector2d by = slope.inverse() * (place - nodes * of.col(0));
      if (!(by.norm() < 10)) { break; }
      at += by;
      of = face_functions(count, at[0], at[1]);
      // The next step would be the square of this one.
      if (by.norm() < 1e-9) { return of; }
   }
   require(false, what, ": the face at ", place_text(middle, Formulation::space),
           " is folded, or curved by more than a point can be found on it: use a finer mesh "
           "there");
   return of;
}

/// A part of a slave's face that a face of the master covers.
struct Overlap
{
   std::size_t part, master; ///< number of the linear part, and of the master's face
   Polygon polygon;
};

/// A point of integration on a face of the slave.
struct SurfacePoint
{
   std::size_t part, master;
   double weight;           ///< of the area on the slave
   NodeValues own, on_part; ///< functions of the face, and linear ones of its part
   NodeValues facing;       ///< functions of the master's face
   Vector3d apart;          ///< x_s - x_m
   double chords;           ///< by which smooth surfaces would be farther apart
};

class SurfaceAssembly
{
public:
   SurfaceAssembly(const ContactSurface &slave, const ContactSurface &master,
                   const std::vector<int> &without, const std::string &what);
   /// Nodes whose rows have a weight that is too small; none: the result is good.
   std::vector<int> integrate();
   void leave_out(const std::vector<int> &nodes)
   {
      for (int node : nodes) { has_row_[node] = false; }
   }
   SurfaceMortar result() const;
   bool any_faced() const
   {
      return std::any_of(overlaps_.begin(), overlaps_.end(),
                         [](const std::vector<Overlap> &its) { return !its.empty(); });
   }
   bool all_whole() const
   {
      for (std::size_t e = 0; e < faces_.size(); ++e)
      {
         if (!is_whole(e)) { return false; }
      }
      return true;
   }

private:
   void find_overlaps(std::size_t face);
   void find_shares();
   std::vector<SurfacePoint> points_of(std::size_t face) const;
   bool is_whole(std::size_t face) const;
   void add_face(std::size_t face);
   void add_rows(const std::vector<Index> &rows, const MatrixXd &psi,
                 const std::vector<SurfacePoint> &points);
   Index nearest_row(std::size_t face) const;

   using Entries = std::map<std::pair<Index, Index>, double>;
   SurfaceMortar::Matrix matrix(const Entries &entries, const std::vector<Index> &number,
                                Index columns) const;

   const ContactSurface &slave_, &master_;
   const std::string what_;
   std::vector<MortarFace> faces_, opposite_;
   std::vector<std::vector<Overlap>> overlaps_;
   /// Of each linear part of each face: its area, and how much of it is covered.
   std::vector<std::vector<double>> area_, covered_;
   std::vector<bool> has_row_, faced_, taken_;
   std::vector<std::vector<std::size_t>> faces_at_; ///< of each node
   // Of each node of the slave; entries of functions of the unknowns.
   VectorXd weights_, waves_, within_, chords_;
   Eigen::MatrixX3d apart_;
   Entries own_, other_;
   double left_out_ = 0, given_away_ = 0;
};

SurfaceAssembly::SurfaceAssembly(const ContactSurface &slave, const ContactSurface &master,
                                 const std::vector<int> &without, const std::string &what)
   : slave_(slave), master_(master), what_(what), faces_(faces_of(slave, what)),
     opposite_(faces_of(master, what)), overlaps_(faces_.size()), area_(faces_.size()),
     covered_(faces_.size()), has_row_(slave.size(), true), faced_(slave.size(), false),
     taken_(slave.size(), false), faces_at_(slave.size())
{
   for (std::size_t e = 0; e < faces_.size(); ++e)
   {
      find_overlaps(e);
      for (Index node : faces_[e].nodes) { faces_at_[node].push_back(e); }
   }
   find_shares();
   for (int node : without)
   {
      require(node >= 0 && node < slave.size(), what, ": node ", node,
              " shall have no row, must be from 0 to ", slave.size() - 1);
      taken_[node] = has_row_[node];
      has_row_[node] = false;
   }
}

/// Clips the master's faces opposite a face of the slave to its linear parts.
void SurfaceAssembly::find_overlaps(std::size_t e)
{
   const MortarFace &face = faces_[e];
   const FacePlane plane(face);
   const FlatNodes nodes = plane.flat(face);
   const auto polygon = [](const FlatNodes &of, const std::vector<Index> &part)
   {
      Polygon made;
      for (Index a : part) { made.emplace_back(of.col(a)); }
      return made;
   };
   std::vector<Polygon> parts;
   double whole = 0;
   for (const std::vector<Index> &part : linear_parts(face.nodes.size()))
   {
      parts.push_back(polygon(nodes, part));
      area_[e].push_back(area_of(parts.back()));
      whole += area_[e].back();
      require(area_[e].back() > 0, what_, ": the face at ",
              place_text(face.middle, Formulation::space), " is folded");
   }
   covered_[e].assign(parts.size(), 0);
   // 1. Faces that look at this one and whose balls reach the prism over it.
   std::vector<std::size_t> found;
   std::vector<double> away;
   double nearest = std::numeric_limits<double>::infinity();
   for (std::size_t f = 0; f < opposite_.size(); ++f)
   {
      const MortarFace &other = opposite_[f];
      const Vector3d apart = other.middle - face.middle;
      const double across = apart.dot(face.normal), reach = face.radius + other.radius;
      if (apart.squaredNorm() - across * across > reach * reach ||
          face.normal.dot(other.normal) > -0.5)
      {
         continue;
      }
      found.push_back(f);
      away.push_back(std::abs(across) - 2 * reach);
      nearest = std::min(nearest, std::abs(across));
   }
   // 2. Faces that may hide others: of the master, and of the slave's own surface.
   struct Shade
   {
      const MortarFace *face;
      bool own;
      Polygon polygon;
   };
   std::vector<Shade> shades;
   const auto add_shade = [&](const MortarFace &other, bool own)
   {
      const FlatNodes its = plane.flat(other);
      for (const std::vector<Index> &piece : linear_parts(other.nodes.size()))
      {
         Polygon made = polygon(its, piece);
         if (!own) { std::reverse(made.begin(), made.end()); }
         shades.push_back({&other, own, std::move(made)});
      }
   };
   for (std::size_t k = 0; k < found.size(); ++k)
   {
      if (away[k] <= nearest) { add_shade(opposite_[found[k]], false); }
   }
   for (const MortarFace &other : faces_)
   {
      const Vector3d apart = other.middle - face.middle;
      const double across = apart.dot(face.normal), reach = face.radius + other.radius;
      const bool over = apart.squaredNorm() - across * across <= reach * reach;
      if (over && across < 0 && face.normal.dot(other.normal) > 0.5) { add_shade(other, true); }
   }
   // How far outside this face another one lies at a place of the plane. Faces of one layer do
   // not lie over each other, so that round-off and curvature alone are to be left aside.
   const auto outside = [&](const MortarFace &other, const Vector2d &place)
   {
      const Vector3d here = plane.from + plane.along.transpose() * place;
      return -(other.middle - here).dot(other.normal) / face.normal.dot(other.normal);
   };
   const double layer = 0.1 * face.radius;
   const auto hides = [&](const Shade &shade, const MortarFace &other, const Polygon &part)
   {
      Vector2d place(0, 0);
      for (const Vector2d &corner : part) { place += corner / double(part.size()); }
      const double its = outside(other, place), of_shade = outside(*shade.face, place);
      return shade.own ? of_shade > layer && its > 0.5 * of_shade
                       : std::abs(its) - std::abs(of_shade) > layer;
   };
   for (std::size_t k = 0; k < found.size(); ++k)
   {
      // 3. Of several layers only the nearest counts. Within a ball a surface that looks at the
      // face rises by no more than twice its size.
      if (away[k] > nearest) { continue; }
      const MortarFace &other = opposite_[found[k]];
      const FlatNodes its = plane.flat(other);
      for (const std::vector<Index> &piece : linear_parts(other.nodes.size()))
      {
         Polygon subject = polygon(its, piece);
         std::reverse(subject.begin(), subject.end());
         for (std::size_t p = 0; p < parts.size(); ++p)
         {
            Polygon overlap = clipped(subject, parts[p]);
            const double least = area_round_off * whole;
            if (overlap.size() < 3 || area_of(overlap) <= least) { continue; }
            std::vector<Polygon> seen{std::move(overlap)};
            for (const Shade &shade : shades)
            {
               std::vector<Polygon> left;
               for (Polygon &one : seen)
               {
                  const Polygon hidden =
                     hides(shade, other, one) ? clipped(one, shade.polygon) : Polygon();
                  if (hidden.size() < 3 || area_of(hidden) <= least)
                  {
                     left.push_back(std::move(one));
                  }
                  else { add_outside(std::move(one), shade.polygon, least, left); }
               }
               seen = std::move(left);
            }
            for (Polygon &one : seen)
            {
               covered_[e][p] += area_of(one);
               overlaps_[e].push_back({p, found[k], std::move(one)});
            }
         }
      }
   }
}

bool SurfaceAssembly::is_whole(std::size_t face) const
{
   for (std::size_t p = 0; p < area_[face].size(); ++p)
   {
      if (covered_[face][p] < (1 - 1e-9) * area_[face][p]) { return false; }
   }
   return true;
}

/// Nodes of which too little is covered have no row. Weights are here those of the linear
/// functions.
void SurfaceAssembly::find_shares()
{
   within_ = VectorXd::Zero(slave_.size());
   VectorXd all = within_;
   for (std::size_t e = 0; e < faces_.size(); ++e)
   {
      const MortarFace &face = faces_[e];
      const FlatNodes nodes = FacePlane(face).flat(face);
      const std::vector<std::vector<Index>> &parts = linear_parts(face.nodes.size());
      for (const std::vector<Index> &part : parts)
      {
         const FlatNodes corners = nodes(Eigen::all, part);
         const QuadratureRule &rule = gauss_rule(2);
         for (int k = 0; k < 4; ++k)
         {
            const double s = rule.points[k / 2],
                         t = rule.points[k % 2] * (part.size() == 3 ? 1 - s : 1);
            const FaceFunctions of = face_functions(part.size(), s, t);
            const double weight = rule.weights[k / 2] * rule.weights[k % 2] *
                                  (part.size() == 3 ? 1 - s : 1) *
                                  Matrix2d(corners * of.rightCols<2>()).determinant();
            for (std::size_t a = 0; a < part.size(); ++a)
            {
               const Index node = face.nodes[part[a]];
               const double value = weight * of(static_cast<Index>(a), 0);
               all[node] += value;
               if (is_whole(e)) { within_[node] += value; }
            }
         }
      }
      for (const SurfacePoint &point : is_whole(e) ? std::vector<SurfacePoint>() : points_of(e))
      {
         const std::vector<Index> &part = parts[point.part];
         for (std::size_t a = 0; a < part.size(); ++a)
         {
            within_[face.nodes[part[a]]] += point.weight * point.on_part[static_cast<Index>(a)];
         }
      }
   }
   for (Index i = 0; i < slave_.size(); ++i)
   {
      faced_[i] = within_[i] > 0;
      has_row_[i] = within_[i] >= least_covered * all[i] && all[i] > 0;
   }
}

std::vector<SurfacePoint> SurfaceAssembly::points_of(std::size_t e) const
{
   const MortarFace &face = faces_[e];
   const FacePlane plane(face);
   const FlatNodes nodes = plane.flat(face);
   const std::vector<std::vector<Index>> &parts = linear_parts(face.nodes.size());
   std::vector<SurfacePoint> points;
   for (const Overlap &overlap : overlaps_[e])
   {
      const MortarFace &other = opposite_[overlap.master];
      const FlatNodes its = plane.flat(other), corners = nodes(Eigen::all, parts[overlap.part]);
      // Exact for products of functions of triangles and parallelograms.
      const bool exact = face.degree > 0 && other.degree > 0;
      const QuadratureRule &rule =
         gauss_rule(exact ? (face.degree + std::max(face.degree, other.degree) + 3) / 2
                          : std::max(face.points, other.points));
      const Polygon &polygon = overlap.polygon;
      for (std::size_t k = 2; k < polygon.size(); ++k)
      {
         const Vector2d one = polygon[k - 1] - polygon[0], two = polygon[k] - polygon[0];
         const double area = one[0] * two[1] - one[1] * two[0];
         if (area <= 0) { continue; } // round-off
         for (Index i = 0; i < rule.points.size(); ++i)
         {
            for (Index j = 0; j < rule.points.size(); ++j)
            {
               const double s = rule.points[i], t = (1 - s) * rule.points[j];
               const Vector2d place = polygon[0] + s * one + t * two;
               const FaceFunctions of = functions_at(nodes, place, face.middle, what_),
                                   facing = functions_at(its, place, other.middle, what_);
               const double flat = Matrix2d(nodes * of.rightCols<2>()).determinant();
               const Vector3d along = face.x * of.col(1), across = face.x * of.col(2);
               SurfacePoint point{overlap.part,
                                  overlap.master,
                                  0,
                                  of.col(0),
                                  {},
                                  facing.col(0),
                                  face.x * of.col(0) - other.x * facing.col(0),
                                  face.behind(of.col(0)) + other.behind(facing.col(0))};
               point.weight = area * (1 - s) * rule.weights[i] * rule.weights[j] *
                              along.cross(across).norm() / std::abs(flat);
               point.on_part =
                  parts.size() == 1
                     ? point.own
                     : NodeValues(functions_at(corners, place, face.middle, what_).col(0));
               points.push_back(std::move(point));
            }
         }
      }
   }
   return points;
}

std::vector<int> SurfaceAssembly::integrate()
{
   const Index n = slave_.size();
   weights_ = waves_ = chords_ = VectorXd::Zero(n);
   apart_ = Eigen::MatrixX3d::Zero(n, 3);
   own_.clear();
   other_.clear();
   left_out_ = given_away_ = 0;
   for (std::size_t e = 0; e < faces_.size(); ++e)
   {
      const double covered = std::accumulate(covered_[e].begin(), covered_[e].end(), 0.0),
                   area = std::accumulate(area_[e].begin(), area_[e].end(), 0.0);
      if (covered >= least_overlap * area) { add_face(e); }
      else { left_out_ += covered; }
   }
   std::vector<int> bad;
   for (Index i = 0; i < n; ++i)
   {
      const bool good =
         weights_[i] > least_weight * within_[i] && waves_[i] <= most_waves * weights_[i];
      if (has_row_[i] && !good) { bad.push_back(static_cast<int>(i)); }
   }
   return bad;
}

/** The dual functions of a face, over its covered part. With φ of the unknowns of its nodes,
    those without a row share theirs among the others, φ', and ψ = D (∫ φ' φᵀ)⁻¹ φ' is dual to
    the functions of the nodes with rows, D = diag ∫ φ. They sum to 1, as the φ' do. A face
    without any such node goes to the nearest row of a face beside it. */
void SurfaceAssembly::add_face(std::size_t e)
{
   const std::vector<SurfacePoint> points = points_of(e);
   const std::vector<Index> &nodes = faces_[e].nodes;
   const auto count = static_cast<Index>(nodes.size()),
              last = static_cast<Index>(points.size());
   // 1. φ of the unknowns: those of the nodes, unless it is in the middle of an edge.
   MatrixXd B = MatrixXd::Identity(count, count);
   for (Index a = 0; a < count; ++a)
   {
      for (Index end : slave_.nodes[nodes[a]].between)
      {
         if (end < 0) { continue; }
         B(a, a) = 0.6;
         B(a, std::find(nodes.begin(), nodes.end(), end) - nodes.begin()) = 0.2;
      }
   }
   MatrixXd phi(count, last);
   VectorXd weights(last);
   for (Index p = 0; p < last; ++p)
   {
      phi.col(p) = B.transpose() * points[p].own;
      weights[p] = points[p].weight;
   }
   // 2. Nodes with a row, and without.
   std::vector<Index> kept, lost, rows;
   for (Index a = 0; a < count; ++a)
   {
      (has_row_[nodes[a]] ? kept : lost).push_back(a);
      if (has_row_[nodes[a]]) { rows.push_back(nodes[a]); }
      if (taken_[nodes[a]]) { given_away_ += phi.row(a).dot(weights); }
   }
   if (rows.empty()) { rows = {nearest_row(e)}; }
   if (rows[0] < 0)
   {
      left_out_ += weights.sum();
      return;
   }
   // 3. ψ times the weights of the points. A single one is 1.
   MatrixXd psi = weights.transpose();
   if (kept.size() > 1)
   {
      const MatrixXd of_kept = phi(kept, Eigen::all);
      MatrixXd shared = of_kept;
      for (Index a : lost)
      {
         shared.rowwise() += phi.row(a) / static_cast<double>(kept.size());
      }
      shared = shared * weights.asDiagonal();
      const MatrixXd M = shared * of_kept.transpose();
      psi = (of_kept * weights).asDiagonal() * M.fullPivLu().solve(shared);
   }
   add_rows(rows, psi, points);
   // 4. ∫ψ φᵀ, which is D among nodes with rows.
   for (Index a : kept) { own_[{nodes[a], nodes[a]}] += phi.row(a).dot(weights); }
   for (std::size_t i = 0; i < rows.size(); ++i)
   {
      for (Index a : lost)
      {
         own_[{rows[i], nodes[a]}] += psi.row(static_cast<Index>(i)).dot(phi.row(a));
      }
   }
}

/// The nearest node with a row, of the faces that share a node with a face; -1: none.
Index SurfaceAssembly::nearest_row(std::size_t e) const
{
   Index nearest = -1;
   double least = std::numeric_limits<double>::infinity();
   for (Index corner : faces_[e].nodes)
   {
      for (std::size_t beside : faces_at_[corner])
      {
         for (Index node : faces_[beside].nodes)
         {
            const double away = (slave_.nodes[node].position - faces_[e].middle).norm();
            if (has_row_[node] && away < least)
            {
               nearest = node;
               least = away;
            }
         }
      }
   }
   return nearest;
}

/// Adds all but the slave's own part to rows. `psi` has their functions times the weights of
/// the points.
void SurfaceAssembly::add_rows(const std::vector<Index> &rows, const MatrixXd &psi,
                               const std::vector<SurfacePoint> &points)
{
   // Points of one face of the master follow one another.
   for (std::size_t first = 0, next = 0; first < points.size(); first = next)
   {
      const std::size_t master = points[first].master;
      const std::vector<Index> &nodes = opposite_[master].nodes;
      MatrixXd sums = MatrixXd::Zero(psi.rows(), static_cast<Index>(nodes.size()));
      for (next = first; next < points.size() && points[next].master == master; ++next)
      {
         sums += psi.col(static_cast<Index>(next)) * points[next].facing.transpose();
      }
      for (std::size_t m = 0; m < nodes.size(); ++m)
      {
         const std::array<Index, 2> &ends = master_.nodes[nodes[m]].between;
         for (std::size_t i = 0; i < rows.size(); ++i)
         {
            // Coefficients of the unknowns.
            const double value = sums(static_cast<Index>(i), static_cast<Index>(m));
            other_[{rows[i], nodes[m]}] += (ends[0] < 0 ? 1 : 0.6) * value;
            for (Index end : ends)
            {
               if (end >= 0) { other_[{rows[i], end}] += 0.2 * value; }
            }
         }
      }
   }
   for (std::size_t i = 0; i < rows.size(); ++i)
   {
      for (std::size_t p = 0; p < points.size(); ++p)
      {
         const double value = psi(static_cast<Index>(i), static_cast<Index>(p));
         weights_[rows[i]] += value;
         waves_[rows[i]] += std::abs(value);
         apart_.row(rows[i]) += value * points[p].apart;
         chords_[rows[i]] += value * points[p].chords;
      }
   }
}

/// The entries of rows, each divided by their sum.
SurfaceMortar::Matrix SurfaceAssembly::matrix(const Entries &entries,
                                              const std::vector<Index> &number,
                                              Index columns) const
{
   VectorXd whole = VectorXd::Zero(slave_.size());
   for (const auto &[at, value] : entries) { whole[at.first] += value; }
   std::vector<Eigen::Triplet<double>> list;
   for (const auto &[at, value] : entries)
   {
      list.emplace_back(static_cast<int>(number[at.first]), static_cast<int>(at.second),
                        value / whole[at.first]);
   }
   SurfaceMortar::Matrix made(
      static_cast<Index>(std::count(has_row_.begin(), has_row_.end(), true)), columns);
   made.setFromTriplets(list.begin(), list.end());
   return made;
}

SurfaceMortar SurfaceAssembly::result() const
{
   SurfaceMortar made;
   std::vector<Index> number(slave_.size(), -1);
   for (Index i = 0; i < slave_.size(); ++i)
   {
      if (has_row_[i])
      {
         number[i] = static_cast<Index>(made.nodes.size());
         made.nodes.push_back(static_cast<int>(i));
      }
      else if (!faced_[i]) { made.free_surface.push_back(static_cast<int>(i)); }
   }
   const auto n = static_cast<Index>(made.nodes.size());
   made.own = matrix(own_, number, slave_.size());
   made.other = matrix(other_, number, master_.size());
   made.weights = weights_(made.nodes);
   made.chords = chords_(made.nodes).cwiseQuotient(made.weights);
   made.left_out = left_out_;
   made.given_away = given_away_;
   made.size = VectorXd::Zero(n);
   for (std::size_t e = 0; e < faces_.size(); ++e)
   {
      const auto corners = static_cast<Index>(corners_of(faces_[e].nodes.size()));
      double longest = 0;
      for (Index a = 0; a < corners; ++a)
      {
         longest =
            std::max(longest, (faces_[e].x.col(a) - faces_[e].x.col((a + 1) % corners)).norm());
      }
      for (Index node : faces_[e].nodes)
      {
         const Index i = number[node];
         if (i >= 0) { made.size[i] = std::max(made.size[i], longest); }
      }
   }
   const auto normals = [](const ContactSurface &surface)
   {
      Eigen::MatrixX3d all(surface.size(), 3);
      for (Index i = 0; i < surface.size(); ++i) { all.row(i) = surface.nodes[i].normal(); }
      return all;
   };
   const Eigen::MatrixX3d own = made.own * normals(slave_),
                          other = made.other * normals(master_);
   made.normal = (own - other).rowwise().normalized();
   made.turn.resize(n);
   made.gap.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      const Vector3d one = own.row(i), its = -other.row(i);
      made.turn[i] = std::atan2(one.cross(its).norm(), one.dot(its));
      const SurfaceNode &node = slave_.nodes[made.nodes[i]];
      made.gap[i] = made.normal.row(i).dot(apart_.row(made.nodes[i])) / made.weights[i];
      if (std::abs(made.gap[i]) <= 1e-9 * node.spacing) { made.gap[i] = 0; } // round-off
   }
   return made;
}

} // namespace

SurfaceMortar mortar(const ContactSurface &slave, const ContactSurface &master,
                     const std::vector<int> &without, const std::string &what)
{
   SurfaceAssembly assembly(slave, master, without, what);
   for (std::vector<int> bad = assembly.integrate(); !bad.empty(); bad = assembly.integrate())
   {
      assembly.leave_out(bad);
   }
   SurfaceMortar found = assembly.result();
   require(assembly.any_faced(), what,
           ": the sides do not face each other, each must lie over the other and look at it: "
           "check which parts of the boundaries they are, and where the bodies are");
   require(!found.nodes.empty(), what, ": no node of the slave ",
           without.empty() ? "lies over the master"
                           : "that lies over the master is free of other interfaces",
           ": make the other side the slave (slave: first or second), or mesh the slave with "
           "finer elements");
   return found;
}

bool is_within(const ContactSurface &surface, const ContactSurface &other,
               const std::string &what)
{
   return SurfaceAssembly(surface, other, {}, what).all_whole();
}

} // namespace cattaneo
