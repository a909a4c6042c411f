#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
double reversed_slip_zone(const Edge &edge, double k_t_range)
{
   edge.validate();
   require_at_least("the range of K_T", k_t_range, 0);
   return k_t_range / (edge.friction * edge.k_n);
}

double edge_stress_range(const Edge &edge, double k_t_range)
{
   return 4 * edge.friction * edge.k_n * std::sqrt(reversed_slip_zone(edge, k_t_range));
}

double mode_two_range(double k_t_range)
{
   require_at_least("the range of K_T", k_t_range, 0);
   return std::sqrt(2 * M_PI) * k_t_range;
}

double slip_energy_density(const Edge &edge, double k_t_range, double modulus, double t)
{
   require_positive("the contact modulus E*", modulus);
   const double d = reversed_slip_zone(edge, k_t_range);
   if (t <= 0 || t >= d) { return 0.0; }
   return 16 * k_t_range * k_t_range / (3 * modulus) * std::sqrt(t / d) *
          std::pow(1 - t / d, 1.5);
}

double slip_energy_max(double k_t_range, double modulus)
{
   require_at_least("the range of K_T", k_t_range, 0);
   require_positive("the contact modulus E*", modulus);
   return std::sqrt(3.0) * k_t_range * k_t_range / modulus;
}

double slip_energy_total(const Edge &edge, double k_t_range, double modulus)
{
   require_positive("the contact modulus E*", modulus);
   return M_PI / 3 * k_t_range * k_t_range * reversed_slip_zone(edge, k_t_range) / modulus;
}

double hertz_slip_energy(double friction, double load, double load_ratio, double modulus)
{
   require_positive("the friction coefficient", friction);
   require_positive("the normal force", load);
   require_positive("the contact modulus E*", modulus);
   const double x = load_ratio;
   require(x >= 0 && x <= 1, "Q/(fP) is ", x, "; it must be between 0 and 1.");
   double sum = 0.5;
   if (x < 0.02)
   {
      // The closed form cancels to the third order: Σ x^k/(k(k-1)), k >= 3.
      sum = 0;
      for (int k = 12; k >= 3; k--) { sum = sum * x + 1.0 / (k * (k - 1)); }
      sum *= x * x * x;
   }
   else if (x < 1) { sum = (1 - x) * std::log1p(-x) + x - 0.5 * x * x; }
   return 4 * std::pow(friction * load, 2) / (M_PI * modulus) * sum;
}

} // namespace cattaneo::fretting
