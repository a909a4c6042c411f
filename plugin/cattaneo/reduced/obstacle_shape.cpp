#include <cattaneo/algebra/root.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// Of each node, given its place and the direction in which it looks.
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
              x[1], ") does not face the obstacle, the contact must end before it");
   }
   return all;
}

} // namespace

VectorXd gaps_to_polyline(const InterfaceReport &nodes, const std::vector<Vector2d> &points)
{
   require(points.size() >= 2, "obstacle: a line through ", points.size(),
           " points, must be two at least");
   for (std::size_t k = 1; k < points.size(); ++k)
   {
      require(points[k] != points[k - 1], "obstacle: the point (", points[k][0], ", ",
              points[k][1], ") is there twice in a row");
   }
   const double unbounded = std::numeric_limits<double>::infinity();
   return gaps(nodes,
               [&](const Vector2d &x, const Vector2d &looks)
               {
                  double nearest = unbounded;
                  for (std::size_t k = 1; k < points.size(); ++k)
                  {
                     // x + g looks = from + s along
                     const Vector2d from = points[k - 1], along = points[k] - from;
                     const double det = along[0] * looks[1] - along[1] * looks[0];
                     if (std::abs(det) <= 1e-12 * along.norm()) { continue; }
                     const Vector2d to = x - from;
                     const double s = (to[0] * looks[1] - to[1] * looks[0]) / det,
                                  g = (to[0] * along[1] - to[1] * along[0]) / det;
                     const double slack = 1e-12;
                     const bool on =
                        (s >= -slack || k == 1) && (s <= 1 + slack || k + 1 == points.size());
                     if (on && std::abs(g) < std::abs(nearest)) { nearest = g; }
                  }
                  return nearest;
               });
}

VectorXd gaps_to_circle(const InterfaceReport &nodes, const Vector2d &centre, double radius)
{
   require(radius != 0 && std::isfinite(radius), "obstacle: its radius is ", radius,
           ", must not be zero (a hole's is negative)");
   return gaps(nodes,
               [&](const Vector2d &x, const Vector2d &looks)
               {
                  // |x + g looks - centre| = |radius|; of a disc the side towards the body.
                  const Vector2d e = x - centre;
                  const double along = e.dot(looks),
                               left = along * along - e.squaredNorm() + radius * radius;
                  // Without the difference of large numbers where the node is nearly on it.
                  const double root = std::sqrt(left), near = e.squaredNorm() - radius * radius;
                  return radius > 0 ? near / (root - along) : -near / (root + along);
               });
}

VectorXd gaps_to_curve(const InterfaceReport &nodes,
                       const std::function<double(double)> &height)
{
   require(nodes.spacing.size() == nodes.nodes,
           "obstacle: the distances of the nodes of "
           "interface '",
           nodes.name, "' are not known");
   const double step = nodes.spacing.size() > 0 ? nodes.spacing.minCoeff() : 0;
   return gaps(nodes,
               [&](const Vector2d &x, const Vector2d &looks)
               {
                  const auto above = [&](double g)
                  { return x[1] + g * looks[1] - height(x[0] + g * looks[0]); };
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
               });
}

} // namespace cattaneo
