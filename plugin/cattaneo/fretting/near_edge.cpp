#include <cattaneo/fretting/near_edge.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

/// √w and its derivative, in the upper half-plane.
Traction root(double t, double y)
{
   // +0.0 turns a negative zero, which would pick the branch of the other body.
   const std::complex<double> value = std::sqrt(std::complex<double>(t, y + 0.0));
   return {value, 0.5 / value};
}

} // namespace

void Edge::validate() const
{
   require_positive("the pressure intensity K_N", k_n);
   require(std::isfinite(k_t), "the shear intensity K_T is ", k_t, "; it must be finite.");
   require(
      std::isfinite(friction) && friction > 0, "the friction coefficient is ", friction,
      "; it must be positive: without friction nothing sticks and there is no partial slip.");
}

double slip_zone(const Edge &edge)
{
   edge.validate();
   return 2 * std::abs(edge.k_t) / (edge.friction * edge.k_n);
}

double pressure(const Edge &edge, double t)
{
   edge.validate();
   return t > 0 ? edge.k_n * std::sqrt(t) : 0.0;
}

double shear_traction(const Edge &edge, double t)
{
   const double d = slip_zone(edge);
   if (t <= 0) { return 0.0; }
   const double limit = std::copysign(edge.friction * edge.k_n, edge.k_t);
   // √t - √(t-d) without the cancellation far inside the stick zone.
   return t <= d ? limit * std::sqrt(t) : limit * d / (std::sqrt(t) + std::sqrt(t - d));
}

InPlaneStress stress(const Edge &edge, double t, double y)
{
   const double d = slip_zone(edge);
   require(std::isfinite(t) && std::isfinite(y) && y >= 0, "the point (t, y) = (", t, ", ", y,
           ") must be finite and in the body, y >= 0.");
   const Traction near = root(t, y), far = root(t - d, y);
   const double limit = std::copysign(edge.friction * edge.k_n, edge.k_t);
   return half_plane_stress(edge.k_n * near, limit * (near - far), y);
}

double edge_stress(const Edge &edge)
{
   return std::copysign(2 * edge.friction * edge.k_n * std::sqrt(slip_zone(edge)), edge.k_t);
}

} // namespace cattaneo::fretting
