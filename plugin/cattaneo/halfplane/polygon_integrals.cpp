#include <array>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cmath>

// The kernels are derivatives of r and of d (ln r)/2: x²/r³ = ∂²r/∂y², x y/r³ = -∂²r/∂x∂y and
// x/r² = ∂(ln r)/∂x, where ln r is the divergence of d (ln r)/2 except for a constant. Each
// derivative makes an integral over a polygon one along its edges (divergence theorem), where
// the outward normal times the length of an edge e is (e_y, -e_x). So integrals over two
// polygons become integrals over pairs of edges. The way from one to the other runs over a
// parallelogram, and the functions are homogeneous: from triangles between the origin and its
// sides, integrals along these sides remain.

namespace cattaneo
{

namespace
{

using Point = Eigen::Matrix<MoreDigits, 2, 1>;

MoreDigits cross(const Point &a, const Point &b)
{
   return a[0] * b[1] - a[1] * b[0];
}

/// The outward normal of an edge, as long as the edge.
Point normal_of(const Point &edge)
{
   return {edge[1], -edge[0]};
}

/// A line in the plane, by its distance h from the origin and the place l along it.
struct Place
{
   MoreDigits l, h, r, log_r, asinh, atan;
   Place(MoreDigits along, MoreDigits across)
      : l(along), h(across), r(std::hypot(along, across)), log_r(r == 0 ? 0 : std::log(r)),
        asinh(h == 0 ? 0 : std::asinh(l / std::abs(h))), atan(h == 0 ? 0 : std::atan(l / h))
   {
   }
};

/// ∫₀¹ of functions of u on the straight line from a point a to a point b.
struct WayIntegrals
{
   Point unit;      ///< u/r
   MoreDigits r;    ///< r
   MoreDigits log;  ///< ln r
   Point log_times; ///< u ln r

   WayIntegrals(const Point &a, const Point &b)
   {
      const MoreDigits length = (b - a).norm();
      const Point along = (b - a) / length, across(-along[1], along[0]);
      const MoreDigits h = a.dot(across);
      const Place from(a.dot(along), h), to(b.dot(along), h);
      const auto difference = [&](auto antiderivative)
      { return (antiderivative(to) - antiderivative(from)) / length; };
      unit = along * difference([](const Place &at) { return at.r; }) +
             across * difference([](const Place &at) { return at.h * at.asinh; });
      r =
         difference([](const Place &at) { return (at.l * at.r + at.h * at.h * at.asinh) / 2; });
      log = difference([](const Place &at) { return at.l * (at.log_r - 1) + at.h * at.atan; });
      log_times = along * difference([](const Place &at)
                                     { return at.r * at.r * (2 * at.log_r - 1) / 4; }) +
                  across * (h * log);
   }
};

/// Integrals over two edges of functions of the way d from the second one to the first one,
/// with the parameters of both from 0 to 1.
struct EdgeIntegrals
{
   MoreDigits r = 0;                ///< r
   Point log_times = Point::Zero(); ///< d (ln r)/2

   /// @a way: between the edges' first ends.
   EdgeIntegrals(const Point &way, const Point &first, const Point &second)
   {
      const MoreDigits area = -cross(first, second);
      // Below this angle edges are taken as parallel. The error is smaller than the round-off
      // of a flat parallelogram.
      constexpr MoreDigits least_angle = 1e-9;
      if (std::abs(area) <= least_angle * first.norm() * second.norm())
      {
         parallel(way + (first - second) / 2, first, second);
         return;
      }
      const std::array<Point, 4> corners{way, way + first, way + first - second, way - second};
      for (std::size_t k = 0; k < 4; ++k)
      {
         const Point &a = corners[k], &b = corners[(k + 1) % 4];
         const MoreDigits twice = cross(a, b);
         if (twice == 0) { continue; } // the origin lies on this side
         const WayIntegrals side(a, b);
         r += twice / 3 * side.r;
         // ∫₀¹ ρ² (ln r + ln ρ) dρ for u = ρ times a point of the side.
         log_times += twice / 6 * (side.log_times - (a + b) / 6);
      }
      r /= area;
      log_times /= area;
   }

private:
   /// @a way: between the edges' middles. Second antiderivatives along the edges.
   void parallel(const Point &way, const Point &first, const Point &second)
   {
      const MoreDigits length = first.norm(),
                       other = first.dot(second) < 0 ? -second.norm() : second.norm();
      const Point along = first / length, across(-along[1], along[0]);
      const MoreDigits h = way.dot(across), l = way.dot(along) - (length - other) / 2;
      const Place ends[] = {{l + length - other, h}, {l + length, h}, {l - other, h}, {l, h}};
      const auto difference = [&](auto antiderivative)
      {
         return -(antiderivative(ends[0]) - antiderivative(ends[1]) - antiderivative(ends[2]) +
                  antiderivative(ends[3])) /
                (length * other);
      };
      r = difference(
         [](const Place &at)
         {
            const MoreDigits h_h = at.h * at.h;
            return at.r * at.r * at.r / 6 + h_h * (at.l * at.asinh - at.r) / 2;
         });
      log_times = along * difference(
                             [](const Place &at)
                             {
                                const MoreDigits h_h = at.h * at.h, l_l = at.l * at.l;
                                return at.l * (l_l / 3 + h_h) * at.log_r / 4 +
                                       h_h * at.h * at.atan / 6 - 5 * l_l * at.l / 72;
                             }) +
                  across * difference(
                              [](const Place &at)
                              {
                                 const MoreDigits h_h = at.h * at.h, l_l = at.l * at.l;
                                 return at.h * ((l_l - h_h) * at.log_r / 4 +
                                                at.h * at.l * at.atan / 2 - 3 * l_l / 8);
                              });
   }
};

Point corner(const Polygon &polygon, std::size_t k)
{
   return polygon[k % polygon.size()].cast<MoreDigits>();
}

Eigen::Vector2d middle(const Polygon &triangle)
{
   return (triangle[0] + triangle[1] + triangle[2]) / 3;
}

double radius(const Polygon &triangle)
{
   double largest = 0;
   for (const Eigen::Vector2d &each : triangle)
   {
      largest = std::max(largest, (each - middle(triangle)).norm());
   }
   return largest;
}

/// Sixteen points of a triangle that integrate polynomials of degree eight [Dunavant 1985].
struct TriangleRule
{
   std::array<Eigen::Vector3d, 16> points; ///< shares of the three corners
   std::array<double, 16> weights;

   TriangleRule()
   {
      std::size_t k = 0;
      const auto add = [&](double weight, double a, double b, double c)
      {
         points[k] = {a, b, c};
         weights[k++] = weight;
      };
      add(0.144315607677787, 1.0 / 3, 1.0 / 3, 1.0 / 3);
      for (const auto &[weight, a, b] :
           {std::array{0.095091634267285, 0.081414823414554, 0.459292588292723},
            {0.103217370534718, 0.658861384496480, 0.170569307751760},
            {0.032458497623198, 0.898905543365938, 0.050547228317031}})
      {
         add(weight, a, b, b);
         add(weight, b, a, b);
         add(weight, b, b, a);
      }
      const double a = 0.008394777409958, b = 0.263112829634638, c = 0.728492392955404;
      for (const auto &[x, y, z] :
           {std::array{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}, {c, b, a}, {b, a, c}})
      {
         add(0.027230314174435, x, y, z);
      }
   }
};

KernelIntegrals by_rule(const Polygon &first, const Polygon &second)
{
   static const TriangleRule rule;
   const auto points = [](const Polygon &triangle)
   {
      Eigen::Matrix<double, 2, 16> places;
      for (std::size_t k = 0; k < 16; ++k)
      {
         const Eigen::Vector3d &share = rule.points[k];
         places.col(static_cast<Eigen::Index>(k)) =
            share[0] * triangle[0] + share[1] * triangle[1] + share[2] * triangle[2];
      }
      return places;
   };
   const Eigen::Matrix<double, 2, 16> to = points(first), from = points(second);
   double xx = 0, yy = 0, xy = 0, x = 0, y = 0;
   for (Eigen::Index i = 0; i < 16; ++i)
   {
      for (Eigen::Index j = 0; j < 16; ++j)
      {
         const double dx = to(0, i) - from(0, j), dy = to(1, i) - from(1, j),
                      weight = rule.weights[static_cast<std::size_t>(i)] *
                               rule.weights[static_cast<std::size_t>(j)],
                      two = weight / (dx * dx + dy * dy),
                      three = two / std::sqrt(dx * dx + dy * dy);
         xx += three * dx * dx;
         yy += three * dy * dy;
         xy += three * dx * dy;
         x += two * dx;
         y += two * dy;
      }
   }
   const MoreDigits areas = area(first) * area(second);
   return {areas * xx, areas * yy, areas * xy, areas * x, areas * y};
}

} // namespace

double area(const Polygon &polygon)
{
   MoreDigits twice = 0;
   for (std::size_t k = 2; k < polygon.size(); ++k)
   {
      twice += cross(corner(polygon, k - 1) - corner(polygon, 0),
                     corner(polygon, k) - corner(polygon, 0));
   }
   return static_cast<double>(twice / 2);
}

KernelIntegrals integrals_at(const Eigen::Vector2d &point, const Polygon &polygon)
{
   KernelIntegrals sum;
   for (std::size_t k = 0; k < polygon.size(); ++k)
   {
      const Point at = point.cast<MoreDigits>();
      const Point from = at - corner(polygon, k), to = at - corner(polygon, k + 1);
      const Point N = normal_of(from - to);
      const WayIntegrals edge(from, to);
      sum.xx -= N[1] * edge.unit[1];
      sum.yy -= N[0] * edge.unit[0];
      sum.xy += N[0] * edge.unit[1];
      sum.x -= N[0] * edge.log;
      sum.y -= N[1] * edge.log;
   }
   return sum;
}

KernelIntegrals integrals_over(const Polygon &first, const Polygon &second)
{
   // At this distance the error of the rule is less than 2e-11 of the integrals.
   constexpr double far = 4;
   if (first.size() == 3 && second.size() == 3 &&
       (middle(first) - middle(second)).norm() > far * (radius(first) + radius(second)))
   {
      return by_rule(first, second);
   }
   KernelIntegrals sum;
   for (std::size_t i = 0; i < first.size(); ++i)
   {
      const Point edge = corner(first, i + 1) - corner(first, i), N = normal_of(edge);
      for (std::size_t j = 0; j < second.size(); ++j)
      {
         const Point other = corner(second, j + 1) - corner(second, j), M = normal_of(other);
         const EdgeIntegrals both(corner(first, i) - corner(second, j), edge, other);
         sum.xx -= N[1] * M[1] * both.r;
         sum.yy -= N[0] * M[0] * both.r;
         sum.xy += (N[0] * M[1] + N[1] * M[0]) / 2 * both.r;
         sum.x -= edge.dot(other) * both.log_times[0];
         sum.y -= edge.dot(other) * both.log_times[1];
      }
   }
   return sum;
}

} // namespace cattaneo
