#include <algorithm>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

using Complex = std::complex<double>;

/// Complex extension of √(c² - x²) on |x| < c that vanishes at infinity.
Traction semi_ellipse(double c, Complex z)
{
   const Complex i(0, 1), root = std::sqrt(z - c) * std::sqrt(z + c);
   return {-i * (root - z), -i * (z / root - 1.0)};
}

/// Compass search in two variables from a point; returns the largest value found.
template <class Function>
double climb(const Function &value, double x, double y, double step)
{
   double best = value(x, y);
   while (step > 1e-8)
   {
      const double fresh[4][2] = {{x + step, y}, {x - step, y}, {x, y + step}, {x, y - step}};
      bool moved = false;
      for (const auto &point : fresh)
      {
         const double v = value(point[0], point[1]);
         if (v > best)
         {
            best = v;
            x = point[0];
            y = point[1];
            moved = true;
         }
      }
      if (!moved) { step *= 0.5; }
   }
   return best;
}

} // namespace

InPlaneStress hertz_stress(double friction, double load_ratio, double x, double y)
{
   const Complex z(x, y + 0.0);
   const Traction pressure = semi_ellipse(1, z);
   Traction shear = pressure;
   const double c = std::sqrt(std::max(0.0, 1 - load_ratio));
   if (c > 0) { shear -= semi_ellipse(c, z); }
   return half_plane_stress(pressure, friction * shear, y);
}

double hertz_transition_friction(double constraint, double load_ratio)
{
   require(load_ratio > 0 && load_ratio <= 1, "Q/(fP) is ", load_ratio,
           "; it must be above 0 and at most 1.");
   // The maximum on the surface less the maximum below it; these are two separate peaks.
   const auto excess = [&](double f)
   {
      const auto surface = [&](double x, double)
      { return von_mises(hertz_stress(f, load_ratio, x, 0), constraint); };
      const auto inside = [&](double x, double y)
      { return y < 0.1 ? 0.0 : von_mises(hertz_stress(f, load_ratio, x, y), constraint); };
      double at_surface = 0, below = 0, x0 = 0, x1 = 0, y1 = 0.1;
      for (double x = -2; x <= 2; x += 0.01)
      {
         if (const double v = surface(x, 0); v > at_surface)
         {
            at_surface = v;
            x0 = x;
         }
      }
      for (double x = -1.2; x <= 1.2; x += 0.1)
      {
         for (double y = 0.1; y < 1.5; y += 0.1)
         {
            if (const double v = inside(x, y); v > below)
            {
               below = v;
               x1 = x;
               y1 = y;
            }
         }
      }
      return climb(surface, x0, 0, 0.01) - climb(inside, x1, y1, 0.1);
   };
   if (excess(0) >= 0) { return 0.0; }
   double low = 0, high = 0.1;
   while (excess(high) < 0)
   {
      low = high;
      high *= 2;
      require(high < 100,
              "no friction coefficient brings the largest stress to the surface at "
              "Q/(fP) = ",
              load_ratio, ".");
   }
   return find_root(excess, low, high);
}

} // namespace cattaneo::fretting
