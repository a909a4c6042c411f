#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

/** a² arccos(b/a) - b√(a²-b²) at a = b + s. */
double load_integral(double b, double s)
{
   const double a = b + s, B = std::sqrt(s * (s + 2 * b));
   if (B > 0.1 * b) { return a * a * std::atan2(B, b) - b * B; }
   // For a light load both terms are nearly b·B and would cancel. Then take the series of
   // b² ((1+τ²) arctan τ - τ) in τ = B/b.
   const double tau = B / b;
   double sum = 0, power = tau;
   for (int k = 1; k < 10; k++)
   {
      power *= tau * tau;
      sum += (k % 2 ? 2 : -2) * power / (4 * k * k - 1);
   }
   return b * b * sum;
}

} // namespace

double contact_modulus(double young, double poisson, bool plane_stress)
{
   require_positive("Young's modulus", young);
   out_of_plane_constraint(poisson, plane_stress);
   return plane_stress ? young / 2 : young / (2 * (1 - poisson * poisson));
}

HertzContact hertz_contact(double load, double radius, double modulus)
{
   require_positive("the normal force", load);
   require_positive("the radius", radius);
   require_positive("the contact modulus E*", modulus);
   HertzContact contact;
   contact.half_width = std::sqrt(4 * load * radius / (M_PI * modulus));
   contact.peak_pressure = 2 * load / (M_PI * contact.half_width);
   contact.k_n = hertz_k_n(load, contact.half_width);
   return contact;
}

double hertz_k_n(double load, double half_width)
{
   require_positive("the normal force", load);
   require_positive("the half width", half_width);
   return load / (M_PI * half_width) * std::sqrt(8 / half_width);
}

FlatRoundedContact flat_rounded_contact(double load, double radius, double flat, double modulus)
{
   require_positive("the normal force", load);
   require_positive("the edge radius", radius);
   require_positive("the contact modulus E*", modulus);
   require_at_least("the half width of the flat", flat, 0);
   const double target = 2 * radius * load / modulus;
   // The integral grows ever faster with s, so Newton from above cannot overshoot.
   double s = std::sqrt(target);
   while (load_integral(flat, s) < target) { s *= 2; }
   for (double step = s; step > 1e-16 * s;)
   {
      const double B = std::sqrt(s * (s + 2 * flat));
      step = (load_integral(flat, s) - target) / (2 * (flat + s) * std::atan2(B, flat));
      s -= step;
   }
   FlatRoundedContact contact{flat, radius, modulus, flat + s, 0};
   const double angle = std::atan2(std::sqrt(s * (s + 2 * flat)), flat);
   contact.k_n = modulus / (M_PI * radius) * std::sqrt(2 * contact.half_width) * angle;
   return contact;
}

double FlatRoundedContact::pressure(double x) const
{
   const double a = half_width, b = flat;
   x = std::abs(x);
   if (x >= a) { return 0.0; }
   const double A = std::sqrt((a - x) * (a + x)), B = std::sqrt((a - b) * (a + b));
   // Both logarithms of the formula contain ln|b²-x²|, which cancels where it is infinite.
   const double shared = x == b ? 0.0 : 0.5 * (b - x) * std::log(std::abs((b - x) * (b + x)));
   const double first = b > 0 ? -b * std::log(A + B) : 0.0;
   const double second = x > 0 ? x * std::log((b * A + x * B) / a) : 0.0;
   return modulus / (M_PI * radius) * (A * std::atan2(B, b) + first + second + shared);
}

RoundedEdge rounded_edge(double k_p, double radius, double modulus)
{
   require_positive("the far pressure intensity K_P", k_p);
   require_positive("the edge radius", radius);
   require_positive("the contact modulus E*", modulus);
   RoundedEdge edge;
   edge.rounded_width = std::pow(3 * M_PI * radius * k_p / (2 * modulus), 2.0 / 3.0);
   edge.k_p = k_p;
   edge.k_n = 3 * k_p / edge.rounded_width;
   return edge;
}

double RoundedEdge::pressure(double x) const
{
   if (x <= 0) { return 0.0; }
   const double r = std::sqrt(x / rounded_width);
   const double log = r == 1 ? 0.0 : (r * r - 1) * std::log(std::abs((1 - r) / (1 + r)));
   return 3 * k_p / (4 * std::sqrt(rounded_width)) * (2 * r + log);
}

double symmetric_k_n(double half_width, double load_rate)
{
   require_positive("the half width", half_width);
   require_positive("the growth dP/da of the load with the half width", load_rate);
   return std::sqrt(2 / half_width) / M_PI * load_rate;
}

double edge_gradient(double radius, double modulus)
{
   require_positive("the radius", radius);
   require_positive("the contact modulus E*", modulus);
   return modulus / radius;
}

ShearIntensities shear_intensities(double half_width, double shear, double bulk_difference)
{
   require_positive("the half width", half_width);
   require(std::isfinite(shear) && std::isfinite(bulk_difference), "the shear force ", shear,
           " and the difference in bulk stress ", bulk_difference, " must be finite.");
   const double from_shear = shear / (M_PI * std::sqrt(2 * half_width));
   const double from_bulk = 0.25 * bulk_difference * std::sqrt(half_width / 2);
   return {from_bulk + from_shear, from_bulk - from_shear};
}

} // namespace cattaneo::fretting
