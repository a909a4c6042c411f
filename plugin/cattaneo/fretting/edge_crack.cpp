#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <vector>

namespace cattaneo::fretting
{
namespace
{

using Complex = std::complex<double>;
// The trapezoidal rule converges as exp(-2π δ/step), δ being the distance of the nearest pole
// to the line of integration, here at least 1/4: this step is far below round-off.
constexpr double step = 0.04;

/// ln Γ(z) up to multiples of 2πi (Stirling's series after shifting z to the right).
Complex log_gamma(Complex z)
{
   Complex shift = 0;
   for (; z.real() < 12; z += 1) { shift += std::log(z); }
   const Complex r = 1.0 / (z * z);
   const Complex series =
      (1.0 / 12 + r * (-1.0 / 360 + r * (1.0 / 1260 + r * (-1.0 / 1680 + r / 1188.0)))) / z;
   return (z - 0.5) * std::log(z) - z + 0.5 * std::log(2 * M_PI) + series - shift;
}

/// ln(1 - u²/sinh²(πu/2)) at u = 0, step, 2 step, …; the first is halved for the rule.
const std::vector<double> &kernel()
{
   static const std::vector<double> values = []
   {
      std::vector<double> v{0.5 * std::log1p(-4 / (M_PI * M_PI))};
      for (double u = step; u < 13; u = step * v.size())
      {
         v.push_back(std::log1p(-std::pow(u / std::sinh(0.5 * M_PI * u), 2)));
      }
      return v;
   }();
   return values;
}

/// h(λ) for Re λ > -1.
Complex mellin_factor(Complex exponent)
{
   const Complex s = 1.0 + exponent, square = s * s;
   Complex sum = 0;
   for (std::size_t k = 0; k < kernel().size(); k++)
   {
      const double u = step * k;
      sum += kernel()[k] / (square + u * u);
   }
   return std::exp(log_gamma(0.5 * s) - log_gamma(0.5 * s + 0.5) - s / M_PI * step * sum) /
          std::sqrt(M_PI);
}

/** Transform ∫ S(y) y^{z-1} dy of the line stress of the shear part,

       S = 2 Im √(iy-1) + (y/2) Re (iy-1)^{-1/2} - (5/(2√2)) √y

    (in f K_N √d, y over d), defined in 0 < Re z < 1/2 and continued from there:
    cos(πz/2) Γ(z) Γ(½-z) (1 - z/2)/(√π (½ + z)). */
Complex line_stress_transform(Complex z)
{
   return std::cos(0.5 * M_PI * z) * std::exp(log_gamma(z) + log_gamma(0.5 - z)) *
          (1.0 - 0.5 * z) / (std::sqrt(M_PI) * (0.5 + z));
}

/// (1/2πi) ∫ S̃(z) h(-z) c^{-z} dz along Re z = const.
class InverseMellin
{
public:
   explicit InverseMellin(double abscissa) : abscissa_(abscissa)
   {
      // S̃ decays as exp(-π|Im z|/2).
      for (double tau = 0; tau < 26; tau = step * weights_.size())
      {
         const Complex z(abscissa, tau);
         weights_.push_back((tau > 0 ? 1.0 : 0.5) * step / M_PI * line_stress_transform(z) *
                            mellin_factor(-z));
      }
   }

   double operator()(double c) const
   {
      Complex sum = 0;
      const double log_c = std::log(c);
      for (std::size_t k = 0; k < weights_.size(); k++)
      {
         sum += weights_[k] * std::polar(1.0, -step * k * log_c);
      }
      return std::pow(c, -abscissa_) * sum.real();
   }

private:
   double abscissa_;
   std::vector<Complex> weights_;
};

double short_crack()
{
   static const double value = 2 * power_law_factor(0);
   return value;
}

double long_crack()
{
   static const double value = 3 / (4 * std::sqrt(2.0)) * power_law_factor(-0.5);
   return value;
}

/// κ of a ratio c that is neither zero nor infinite.
double crack_integral(double c)
{
   // The line is moved across the poles that carry the two leading terms for short or for long
   // cracks, so that the integrand is small compared with these terms.
   if (c < 1)
   {
      static const InverseMellin rest(-1.25);
      static const double root_term = 2.5 / std::sqrt(2.0) * power_law_factor(0.5);
      return std::sqrt(M_PI * c) * (short_crack() - root_term * std::sqrt(c) + rest(c));
   }
   static const InverseMellin rest(0.75);
   return std::sqrt(M_PI) * (long_crack() + std::sqrt(c) * rest(c));
}

} // namespace

double power_law_factor(double exponent)
{
   require(std::isfinite(exponent) && exponent > -1, "the exponent of the line stress is ",
           exponent, "; it must be above -1.");
   return mellin_factor(exponent).real();
}

double crack_factor(double ratio)
{
   require(ratio >= 0, "the crack depth over the slip zone is ", ratio,
           "; it must not be negative.");
   if (ratio == 0) { return 0.0; }
   return std::isinf(ratio) ? std::sqrt(M_PI) * long_crack() : crack_integral(ratio);
}

double crack_closing_factor()
{
   static const double value = 1.5 * std::sqrt(M_PI / 2) * power_law_factor(0.5);
   return value;
}

double crack_intensity(const Edge &edge, double depth)
{
   const double d = slip_zone(edge);
   require_at_least("the crack depth", depth, 0);
   const double shear = edge.k_t != 0 ? 2 * edge.k_t * crack_factor(depth / d) : 0.0;
   return shear - crack_closing_factor() * edge.k_n * depth;
}

double crack_intensity_range(const Edge &edge, double k_t_range, double depth)
{
   edge.validate();
   require_at_least("the range of K_T", k_t_range, 0);
   require_at_least("the crack depth", depth, 0);
   if (k_t_range == 0) { return 0.0; }
   return 2 * k_t_range * crack_factor(depth * edge.friction * edge.k_n / k_t_range);
}

} // namespace cattaneo::fretting
