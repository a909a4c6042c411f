#include <algorithm>
#include <array>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// Compliance of both bodies together: relative displacement by tractions.
struct Compliance
{
   double direct = 0;   ///< Σ (1-ν)/2πG
   double poisson = 0;  ///< Σ ν/2πG
   double coupling = 0; ///< (1-2ν)/4πG of the body above minus that of the body below

   explicit Compliance(const HalfSpace &contact)
   {
      add(contact.material, 1);
      const double above = coupling;
      if (contact.other) { add(*contact.other, -1); }
      // Equal constants of unlike materials differ by their rounding.
      constexpr double round_off = 8 * std::numeric_limits<double>::epsilon();
      if (std::abs(coupling) <= round_off * std::abs(above)) { coupling = 0; }
   }
   void add(const Material &material, int side)
   {
      const double unit = 1 / (2 * M_PI * material.mu());
      direct += unit * (1 - material.poisson);
      poisson += unit * material.poisson;
      coupling += side * unit * (0.5 - material.poisson);
   }

   /// Displacements by uniform tractions on a cell.
   Eigen::Matrix3d of(const KernelIntegrals &I) const
   {
      const auto own = [&](MoreDigits tangential)
      { return static_cast<double>(direct * (I.xx + I.yy) + poisson * tangential); };
      const auto across = static_cast<double>(poisson * I.xy),
                 x = static_cast<double>(coupling * I.x),
                 y = static_cast<double>(coupling * I.y);
      Eigen::Matrix3d F;
      F << own(I.xx), across, -x, across, own(I.yy), -y, x, y, own(0);
      return F;
   }
};

/// Cell of each rectangle, in whole edges from the first one.
std::vector<std::array<long, 2>> cells_of(const HalfSpace &contact)
{
   std::vector<std::array<long, 2>> cells;
   std::set<std::array<long, 2>> known;
   for (Index i = 0; i < contact.centres.rows(); ++i)
   {
      const Vector2d way = contact.centres.row(i) - contact.centres.row(0),
                     edges = way.cwiseQuotient(contact.size), whole = edges.array().round();
      const Vector2d place = contact.centres.row(i);
      require((edges - whole).cwiseAbs().maxCoeff() <= 1e-9 &&
                 edges.cwiseAbs().maxCoeff() < 1e9,
              "half-space: the centre of rectangle ", i, " is ", place, ", ", edges,
              " edges from the first centre, must be whole numbers of edges");
      cells.push_back({std::lround(whole[0]), std::lround(whole[1])});
      require(known.insert(cells.back()).second, "half-space: the rectangle centred at ", place,
              " is there twice");
   }
   return cells;
}

/// The corners of one triangle, counter-clockwise.
Polygon triangle_of(const HalfSpace &contact, Index i)
{
   Polygon corners;
   for (const int vertex : contact.triangles.row(i))
   {
      corners.emplace_back(contact.vertices.row(vertex));
   }
   if (area(corners) < 0) { std::swap(corners[1], corners[2]); }
   return corners;
}

/** The third corner of each triangle lies on the left of its edges, so that two triangles that
    meet have their common edge once in each direction. The triangle of each directed edge. */
using DirectedEdges = std::map<std::pair<int, int>, Index>;

DirectedEdges edges_of(const HalfSpace &contact)
{
   DirectedEdges edges;
   for (Index i = 0; i < contact.triangles.rows(); ++i)
   {
      Eigen::RowVector3i corners = contact.triangles.row(i);
      Polygon polygon;
      for (const int vertex : corners)
      {
         require(vertex >= 0 && vertex < contact.vertices.rows(), "half-space: triangle ", i,
                 " has the vertex ", vertex, ", must be from 0 to ",
                 contact.vertices.rows() - 1);
         polygon.emplace_back(contact.vertices.row(vertex));
      }
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k)
      {
         longest = std::max(longest, (polygon[k] - polygon[(k + 1) % 3]).squaredNorm());
      }
      require(std::abs(area(polygon)) > 1e-12 * longest, "half-space: triangle ", i,
              " has no area, its corners lie on a line");
      if (area(polygon) < 0) { std::swap(corners[1], corners[2]); }
      for (Index k = 0; k < 3; ++k)
      {
         const auto [found, first] = edges.try_emplace({corners[k], corners[(k + 1) % 3]}, i);
         require(first, "half-space: the triangles ", found->second, " and ", i,
                 " lie on the same side of their common edge, must not overlap");
      }
   }
   return edges;
}

/// Refuses triangles that overlap, if the middle of one lies within another.
void refuse_overlap(const HalfSpace &contact)
{
   const std::vector<Polygon> triangles = polygons_of(contact);
   const Eigen::MatrixX2d middles = contact.middles();
   for (std::size_t i = 0; i < triangles.size(); ++i)
   {
      const Polygon &of = triangles[i];
      for (Index j = 0; j < middles.rows(); ++j)
      {
         const Vector2d middle = middles.row(j);
         bool within = j != static_cast<Index>(i);
         for (std::size_t k = 0; k < 3 && within; ++k)
         {
            const Vector2d edge = of[(k + 1) % 3] - of[k], way = middle - of[k];
            within = edge[0] * way[1] - edge[1] * way[0] > 0;
         }
         require(!within, "half-space: the triangles ", i, " and ", j,
                 " lie on each other, they must not overlap");
      }
   }
}

/// Triangles that have an edge which no other triangle has.
std::vector<Index> rim_of(const DirectedEdges &edges)
{
   std::set<Index> rim;
   for (const auto &[edge, triangle] : edges)
   {
      if (edges.count({edge.second, edge.first}) == 0) { rim.insert(triangle); }
   }
   return {rim.begin(), rim.end()};
}

/// Cells that lack one of their four neighbours.
std::vector<Index> rim_of(const std::vector<std::array<long, 2>> &cells)
{
   const std::set<std::array<long, 2>> all(cells.begin(), cells.end());
   std::vector<Index> rim;
   for (std::size_t i = 0; i < cells.size(); ++i)
   {
      const auto [x, y] = cells[i];
      const std::size_t neighbours = all.count({x - 1, y}) + all.count({x + 1, y}) +
                                     all.count({x, y - 1}) + all.count({x, y + 1});
      if (neighbours < 4) { rim.push_back(static_cast<Index>(i)); }
   }
   return rim;
}

/// Displacement in the mean over triangles: rows and columns as below.
MatrixXd flexibility_of_triangles(const HalfSpace &contact)
{
   const std::vector<Polygon> triangles = polygons_of(contact);
   const VectorXd areas = contact.areas();
   const Compliance compliance(contact);
   const Index n = areas.size();
   MatrixXd F(3 * n, 3 * n);
   for (Index i = 0; i < n; ++i)
   {
      for (Index j = 0; j <= i; ++j)
      {
         const Eigen::Matrix3d influence =
            compliance.of(integrals_over(triangles[i], triangles[j])) / (areas[i] * areas[j]);
         for (Index a = 0; a < 3; ++a)
         {
            for (Index b = 0; b < 3; ++b)
            {
               F(a * n + i, b * n + j) = F(b * n + j, a * n + i) = influence(a, b);
            }
         }
      }
   }
   return F;
}

/** Flexibility of nodal forces: rows and columns of the n first tangents, then of the second
    ones, then of the normals. Pairs of rectangles with the same distance vector have the same
    influence, which is integrated once. With the opposite vector it is the transposed one, so
    that the matrix is symmetric to the last bit. */
MatrixXd flexibility(const HalfSpace &contact)
{
   if (contact.triangles.rows() > 0) { return flexibility_of_triangles(contact); }
   const std::vector<std::array<long, 2>> cells = cells_of(contact);
   const Compliance compliance(contact);
   const auto n = static_cast<Index>(cells.size());
   MatrixXd F(3 * n, 3 * n);
   const Vector2d half = contact.size / 2;
   const Polygon cell{-half, {half[0], -half[1]}, half, {-half[0], half[1]}};
   std::unordered_map<unsigned long, Eigen::Matrix3d> known;
   for (Index i = 0; i < n; ++i)
   {
      for (Index j = 0; j <= i; ++j)
      {
         const long x = cells[i][0] - cells[j][0], y = cells[i][1] - cells[j][1];
         const auto key = (static_cast<unsigned long>(std::labs(x)) << 32) +
                          static_cast<unsigned long>(std::labs(y));
         const auto [found, first] = known.try_emplace(key);
         Eigen::Matrix3d &influence = found->second;
         if (first)
         {
            const Vector2d way(static_cast<double>(std::labs(x)) * contact.size[0],
                               static_cast<double>(std::labs(y)) * contact.size[1]);
            influence = compliance.of(integrals_at(way, cell)) / contact.size.prod();
         }
         // Mirrors the integrals into the quadrant of this vector. On an axis the odd ones are
         // zero.
         const Eigen::Vector3d sign((x > 0) - (x < 0), (y > 0) - (y < 0), 1);
         for (Index a = 0; a < 3; ++a)
         {
            for (Index b = 0; b < 3; ++b)
            {
               const double mirrored =
                  a == b ? influence(a, b) : sign[a] * sign[b] * influence(a, b);
               F(a * n + i, b * n + j) = F(b * n + j, a * n + i) = mirrored;
            }
         }
      }
   }
   return F;
}

/// Stiffness of some rows of a contact whose far body moves freely under far forces.
struct FreeStiffness
{
   MatrixXd K;
   MatrixXd clamped; ///< forces of these rows by each far force, if the rows do not move
   MatrixXd moved;   ///< the far body's motions by each far force then

   /** @a F: flexibility of these rows against a far body that is held. @a motions:
       displacements of these rows by a unit of each far motion, one column each. */
   FreeStiffness(MatrixXd F, const MatrixXd &motions)
   {
      DenseCholesky factor;
      require(factor.compute(std::move(F)),
              "half-space: its flexibility is not positive definite within round-off: use "
              "fewer cells, or cells with less unequal edges");
      K = factor.inverse();
      // Energy ½ (u - R y)ᵀ S (u - R y) - Gᵀ y of the far motions y, which nothing holds.
      const MatrixXd held_back = factor.solved(motions);
      DenseCholesky resistance;
      require(resistance.compute(motions.transpose() * held_back),
              "half-space: one of its motions meets no resistance: use more cells");
      moved = resistance.inverse();
      clamped = -held_back * moved;
      MatrixXd half = held_back.transpose();
      resistance.solve_half(half);
      K = minus_square(std::move(K), half);
   }
};

} // namespace

void HalfSpace::validate() const
{
   for (const Material *each : {&material, other ? &*other : nullptr})
   {
      if (each == nullptr) { continue; }
      each->validate();
      require(each->state == PlaneState::strain,
              "half-space: its material is one of plane stress, must be of plane strain");
   }
   require(centres.rows() > 0 || triangles.rows() > 0,
           "half-space: there are neither rectangles nor triangles, must be at least two");
   if (triangles.rows() > 0)
   {
      require(centres.rows() == 0, "half-space: there are ", centres.rows(), " rectangles and ",
              triangles.rows(), " triangles, must be only one of both kinds");
      require(vertices.allFinite(),
              "half-space: a vertex of the triangles has an entry that is not finite");
      edges_of(*this);
      refuse_overlap(*this);
      return;
   }
   require(size.allFinite() && size.minCoeff() > 0, "half-space: the edges of its rectangles ",
           "are ", size, ", must be positive");
   require(centres.allFinite(),
           "half-space: the centre of a rectangle has an entry that is not finite");
   cells_of(*this);
}

Index HalfSpace::nodes() const
{
   return std::max(centres.rows(), triangles.rows());
}

VectorXd HalfSpace::areas() const
{
   VectorXd areas = VectorXd::Constant(nodes(), size.prod());
   for (Index i = 0; i < triangles.rows(); ++i) { areas[i] = area(triangle_of(*this, i)); }
   return areas;
}

Eigen::MatrixX2d HalfSpace::middles() const
{
   Eigen::MatrixX2d middles = centres;
   middles.conservativeResize(nodes(), 2);
   for (Index i = 0; i < triangles.rows(); ++i)
   {
      middles.row(i) = vertices(triangles.row(i), Eigen::all).colwise().mean();
   }
   return middles;
}

std::vector<Polygon> polygons_of(const HalfSpace &contact)
{
   std::vector<Polygon> polygons;
   for (Index i = 0; i < contact.triangles.rows(); ++i)
   {
      polygons.push_back(triangle_of(contact, i));
   }
   const Vector2d half = contact.size / 2, other(half[0], -half[1]);
   for (const Vector2d centre : contact.centres.rowwise())
   {
      polygons.push_back({centre - half, centre + other, centre + half, centre - other});
   }
   return polygons;
}

ReducedProblem HalfSpace::problem(const VectorXd &gap) const
{
   validate();
   const Index n = nodes(), slips = 2 * n, rows = 3 * n;
   const std::string kind = triangles.rows() > 0 ? "triangle" : "rectangle";
   require(gap.size() == n, "half-space: ", gap.size(), " gaps, must be ", n, ", one for each ",
           kind);
   require(n > 1, "half-space: there is one ", kind, ", must be at least two");

   // Motions of the far body, one along each force. Those within the plane come first.
   const std::vector<std::string> names = turns ? std::vector<std::string>{"Q1", "Q2", "T", "P"}
                                                : std::vector<std::string>{"Q1", "Q2", "P"};
   const auto count = static_cast<Index>(names.size());
   MatrixXd motions = MatrixXd::Zero(rows, count);
   const Eigen::MatrixX2d places = middles();
   motions.col(0).head(n).setOnes();
   motions.col(1).segment(n, n).setOnes();
   if (turns)
   {
      motions.col(2).head(n) = -places.col(1);
      motions.col(2).segment(n, n) = places.col(0);
   }
   motions.col(count - 1).tail(n).setConstant(-1);

   ReducedProblem result;
   MatrixXd clamped = MatrixXd::Zero(rows, count);
   MatrixXd F = flexibility(*this);
   if (Compliance(*this).coupling != 0)
   {
      FreeStiffness all(std::move(F), motions);
      result.K = std::move(all.K);
      clamped = std::move(all.clamped);
      result.H = std::move(all.moved);
   }
   else
   {
      const FreeStiffness tangential(F.topLeftCorner(slips, slips),
                                     motions.topLeftCorner(slips, count - 1)),
         normal(F.bottomRightCorner(n, n), motions.bottomRightCorner(n, 1));
      result.K = std::move(F);
      result.K.setZero();
      result.K.topLeftCorner(slips, slips) = tangential.K;
      result.K.bottomRightCorner(n, n) = normal.K;
      clamped.topLeftCorner(slips, count - 1) = tangential.clamped;
      clamped.bottomRightCorner(n, 1) = normal.clamped;
      result.H = MatrixXd::Zero(count, count);
      result.H.topLeftCorner(count - 1, count - 1) = tangential.moved;
      result.H(count - 1, count - 1) = normal.moved(0, 0);
   }
   for (Index k = 0; k < count; ++k)
   {
      result.patterns.push_back({names[static_cast<std::size_t>(k)], Control::force,
                                 clamped.col(k).head(slips), clamped.col(k).tail(n)});
   }
   result.gap = gap;
   result.friction = VectorXd::Zero(n);
   result.weights = areas();
   result.position = MatrixXd::Zero(n, 3);
   result.position.leftCols(2) = places;
   if (!ends)
   {
      result.rim = triangles.rows() > 0 ? rim_of(edges_of(*this)) : rim_of(cells_of(*this));
   }
   result.rigid_motions = thin_qr(motions).Q;
   join_coupling(result);
   result.validate();
   return result;
}

Eigen::Matrix<double, 6, 1> HalfSpace::resultant(const VectorXd &forces) const
{
   validate();
   const Index n = nodes();
   require(forces.size() == 3 * n, "half-space: ", forces.size(), " nodal forces, must be ",
           3 * n, ", three for each cell");
   const auto q1 = forces.head(n), q2 = forces.segment(n, n), p = forces.tail(n);
   const VectorXd x = middles().col(0), y = middles().col(1);
   Eigen::Matrix<double, 6, 1> sum;
   sum << q1.sum(), q2.sum(), p.sum(), y.dot(p), -x.dot(p), x.dot(q2) - y.dot(q1);
   return sum;
}

Eigen::MatrixX3d HalfSpace::displacements(const Eigen::MatrixX2d &points,
                                          const VectorXd &forces) const
{
   validate();
   const Index n = nodes();
   require(forces.size() == 3 * n, "half-space: ", forces.size(), " nodal forces, must be ",
           3 * n, ", three for each cell");
   require(forces.allFinite(), "half-space: a nodal force is not finite");
   require(points.allFinite(), "half-space: a point of the surface has an entry that is not "
                               "finite");
   const Compliance compliance(*this);
   const std::vector<Polygon> cells = polygons_of(*this);
   const Eigen::MatrixX3d tractions = areas().cwiseInverse().asDiagonal() *
                                      Eigen::Map<const Eigen::MatrixX3d>(forces.data(), n, 3);
   Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(points.rows(), 3);
   for (Index i = 0; i < points.rows(); ++i)
   {
      for (Index j = 0; j < n; ++j)
      {
         result.row(i) +=
            tractions.row(j) *
            compliance.of(integrals_at(points.row(i), cells[static_cast<std::size_t>(j)]))
               .transpose();
      }
   }
   return result;
}

} // namespace cattaneo
