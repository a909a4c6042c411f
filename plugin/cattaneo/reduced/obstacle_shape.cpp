#include <cattaneo/algebra/root.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace
{

/// The gap of each node, from its place and its outward normal.
template <class Distance>
VectorXd gaps(const InterfaceReport &nodes, Distance distance)
{
   VectorXd all(nodes.nodes);
   const Eigen::MatrixX2d &places =
      nodes.outline.rows() == nodes.nodes ? nodes.outline : nodes.position;
   for (Index i = 0; i < nodes.nodes; ++i)
   {
      const Vector2d x = places.row(i), t = nodes.tangent.row(i);
      all[i] = distance(x, Vector2d(t[1], -t[0]));
      require(std::isfinite(all[i]), "interface '", nodes.name, "': the node at (", x[0], ", ",
              x[1], ") does not face the obstacle, end the contact before it");
   }
   return all;
}

/// The same for the nodes of a surface.
template <class Distance>
VectorXd gaps(const ContactSurface &surface, Distance distance)
{
   VectorXd all(surface.size());
   for (Index i = 0; i < surface.size(); ++i)
   {
      const SurfaceNode &node = surface.nodes[i];
      all[i] = distance(node.position, Vector3d(-node.normal()));
      require(std::isfinite(all[i]), "obstacle: the node at ",
              place_text(node.position, Formulation::space),
              " does not face the obstacle, end the contact before it");
   }
   return all;
}

void require_radius(double radius)
{
   require(radius != 0 && std::isfinite(radius), "obstacle: its radius is ", radius,
           ", must not be zero (a hole's is negative)");
}

/// Distance g along `looks` from a place to a disc, a sphere or a cylinder (with components
/// across its axis only): |e + g looks| = |radius|, with the place at e relative to the centre.
/// The root on the side of the body is taken. A negative radius is that of a hole.
template <class Vector>
double to_ball(const Vector &e, const Vector &looks, double radius)
{
   const double along = e.dot(looks), near = e.squaredNorm() - radius * radius;
   // Computed without a difference of large numbers if the node is nearly on the circle.
   const double root = std::sqrt(along * along - looks.squaredNorm() * near);
   return radius > 0 ? near / (root - along) : -near / (root + along);
}

/// The sine of 5 degrees: the least angle between a node's normal and a straight obstacle at
/// which the normal counts as meeting it. With less it is parallel, within the accuracy of
/// normals on a curve.
const double least_sine = std::sin(5 * std::acos(-1.0) / 180);

/// A side of a polyline, of which the first and the last go on without end.
struct PolylineSide
{
   Vector2d from, along;
   bool first, last;

   bool has(double s) const
   {
      const double slack = 1e-12;
      return (s >= -slack || first) && (s <= 1 + slack || last);
   }
   double distance(const Vector2d &x) const
   {
      double s = along.dot(x - from) / along.squaredNorm();
      if (!first) { s = std::max(s, 0.0); }
      if (!last) { s = std::min(s, 1.0); }
      return (x - from - s * along).norm();
   }
};

} // namespace

VectorXd gaps_to_polyline(const InterfaceReport &nodes, const std::vector<Vector2d> &points)
{
   require(points.size() >= 2, "obstacle: the line has ", points.size(),
           " points, must have at least two");
   for (std::size_t k = 1; k < points.size(); ++k)
   {
      require(points[k] != points[k - 1], "obstacle: the point (", points[k][0], ", ",
              points[k][1], ") is there twice in a row");
   }
   std::vector<PolylineSide> sides;
   for (std::size_t k = 1; k < points.size(); ++k)
   {
      sides.push_back(
         {points[k - 1], points[k] - points[k - 1], k == 1, k + 1 == points.size()});
   }
   return gaps(nodes,
               [&](const Vector2d &x, const Vector2d &looks)
               {
                  const double unbounded = std::numeric_limits<double>::infinity();
                  double nearest = unbounded, beside = unbounded;
                  bool parallel = false;
                  for (const PolylineSide &side : sides)
                  {
                     // x + g looks = from + s along
                     const Vector2d &along = side.along, to = x - side.from;
                     const double det = along[0] * looks[1] - along[1] * looks[0];
                     beside = std::min(beside, side.distance(x));
                     if (std::abs(det) <= least_sine * along.norm())
                     {
                        parallel = true;
                        continue;
                     }
                     const double s = (to[0] * looks[1] - to[1] * looks[0]) / det,
                                  g = (to[0] * along[1] - to[1] * along[0]) / det;
                     if (side.has(s) && std::abs(g) < std::abs(nearest)) { nearest = g; }
                  }
                  // A node whose normal passes the obstacle gets the gap that it would have if
                  // the normal were turned towards it.
                  return std::isfinite(nearest) || !parallel ? nearest : beside / least_sine;
               });
}

VectorXd gaps_to_circle(const InterfaceReport &nodes, const Vector2d &centre, double radius)
{
   require_radius(radius);
   return gaps(nodes, [&](const Vector2d &x, const Vector2d &looks)
               { return to_ball(Vector2d(x - centre), looks, radius); });
}

VectorXd gaps_to_plane(const ContactSurface &surface, const Vector3d &point,
                       const Vector3d &normal)
{
   require(point.allFinite() && normal.allFinite() && normal.norm() > 0,
           "obstacle: a plane must have a finite point and a finite normal that is not zero");
   const Vector3d across = normal.normalized();
   return gaps(surface,
               [&](const Vector3d &x, const Vector3d &looks)
               {
                  const double slope = across.dot(looks);
                  return std::abs(slope) <= least_sine ? std::nan("")
                                                       : across.dot(point - x) / slope;
               });
}

namespace
{

/// The same, where a node whose normal passes a ball gets the gap that it would have at its
/// distance if the normal were turned towards the ball. It counts those that do not.
class BesideBalls
{
public:
   template <class Vector>
   double operator()(const Vector &e, const Vector &looks, double radius)
   {
      const double gap = to_ball(e, looks, radius);
      if (std::isfinite(gap)) { ++facing_; }
      return std::isfinite(gap) || radius < 0 ? gap : (e.norm() - radius) / least_sine;
   }
   /// InputError unless a node faces the obstacle.
   void check(const char *obstacle) const
   {
      require(facing_ > 0, "obstacle: no node of the side faces the ", obstacle,
              ", which must lie over the side: move it, or choose another side");
   }

private:
   int facing_ = 0;
};

} // namespace

VectorXd gaps_to_sphere(const ContactSurface &surface, const Vector3d &centre, double radius)
{
   require_radius(radius);
   BesideBalls distance;
   VectorXd all = gaps(surface, [&](const Vector3d &x, const Vector3d &looks)
                       { return distance(Vector3d(x - centre), looks, radius); });
   distance.check("sphere");
   return all;
}

VectorXd gaps_to_cylinder(const ContactSurface &surface, const Vector3d &point,
                          const Vector3d &axis, double radius)
{
   require_radius(radius);
   require(point.allFinite() && axis.allFinite() && axis.norm() > 0,
           "obstacle: a cylinder has no finite point or no axis, must have both");
   const Vector3d along = axis.normalized();
   const auto across = [&along](const Vector3d &way) -> Vector3d
   { return way - along.dot(way) * along; };
   BesideBalls distance;
   VectorXd all = gaps(surface,
                       [&](const Vector3d &x, const Vector3d &looks)
                       {
                          const Vector3d its = across(looks), e = across(x - point);
                          // A normal along the axis passes a cylinder, and leaves no bore.
                          const bool along_axis = its.norm() <= least_sine;
                          if (along_axis && e.norm() <= std::abs(radius))
                          {
                             return std::nan("");
                          }
                          return distance(e, along_axis ? Vector3d(0, 0, 0) : its, radius);
                       });
   distance.check("cylinder");
   return all;
}

namespace
{

/// The distance at which a function of it is zero, sought outwards and inwards in steps that
/// double; NaN if there is none within 1e6 steps.
template <class Function>
double first_zero(const Function &above, double step)
{
   const double here = above(0);
   if (here == 0) { return 0.0; }
   for (double reach = step; reach < 1e6 * step; reach *= 2)
   {
      for (double g : {reach, -reach})
      {
         const double there = above(g);
         if (there == 0) { return g; }
         if (there * here < 0) { return find_root(above, 0.0, g); }
      }
   }
   return std::nan("");
}

} // namespace

VectorXd gaps_to_height(const ContactSurface &surface,
                        const std::function<double(double, double)> &height)
{
   double step = std::numeric_limits<double>::infinity();
   for (const SurfaceNode &node : surface.nodes) { step = std::min(step, node.spacing); }
   return gaps(surface,
               [&](const Vector3d &x, const Vector3d &looks)
               {
                  const auto above = [&](double g)
                  {
                     const Vector3d at = x + g * looks;
                     return at[2] - height(at[0], at[1]);
                  };
                  require(std::isfinite(above(0)), "obstacle: its height at (", x[0], ", ",
                          x[1],
                          "), where the side has a node, is not a finite number: give one "
                          "there, or end the contact before it");
                  return first_zero(above, step);
               });
}

VectorXd gaps_to_curve(const InterfaceReport &nodes,
                       const std::function<double(double)> &height)
{
   require(nodes.spacing.size() == nodes.nodes,
           "obstacle: the nodes of "
           "interface '",
           nodes.name, "' have no spacing, which this obstacle needs");
   const double step = nodes.spacing.size() > 0 ? nodes.spacing.minCoeff() : 0;
   return gaps(nodes,
               [&](const Vector2d &x, const Vector2d &looks)
               {
                  const auto above = [&](double g)
                  { return x[1] + g * looks[1] - height(x[0] + g * looks[0]); };
                  return first_zero(above, step);
               });
}

} // namespace cattaneo
