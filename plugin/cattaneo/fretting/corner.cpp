#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <complex>

namespace cattaneo::fretting
{
namespace
{

/// Stress on the ray at `angle` from the bisector, over the stress on the bisector that
/// normalises the mode; both per r^{λ-1}. From Airy's function r^{λ+1} [A cos (λ+1)θ +
/// B cos (λ-1)θ], or sin for mode II, with σ_θθ = 0 on the free faces θ = ± half.
struct RayStress
{
   double normal, shear;
};

RayStress ray_stress(bool symmetric, double lambda, double half, double angle)
{
   const double up = lambda + 1, down = lambda - 1;
   if (symmetric)
   {
      const double A = -std::cos(down * half), B = std::cos(up * half);
      const double norm = up * (A + B);
      return {up * (A * std::cos(up * angle) + B * std::cos(down * angle)) / norm,
              (A * up * std::sin(up * angle) + B * down * std::sin(down * angle)) / norm};
   }
   const double A = -std::sin(down * half), B = std::sin(up * half);
   const double norm = -(A * up + B * down);
   return {up * (A * std::sin(up * angle) + B * std::sin(down * angle)) / norm,
           -(A * up * std::cos(up * angle) + B * down * std::cos(down * angle)) / norm};
}

/// Strength and relative error of each mode.
struct Solution
{
   std::vector<double> strength, error;
   double largest() const { return *std::max_element(error.begin(), error.end()); }
};

/// Fits the modes to the samples from `first` to `last`. Pressure and shear of the samples are
/// divided by r^{λ_I-1}.
Solution fit(const std::vector<EdgeSample> &samples, std::size_t first, std::size_t last,
             const std::vector<CornerMode> &modes)
{
   const Eigen::Index n = last - first, m = modes.size();
   const double scale = samples[last - 1].distance;
   Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(2 * n, m + 2);
   Eigen::VectorXd values(2 * n);
   for (Eigen::Index i = 0; i < n; i++)
   {
      const EdgeSample &sample = samples[first + i];
      const double r = sample.distance / scale;
      for (Eigen::Index k = 0; k < m; k++)
      {
         const double power = std::pow(r, modes[k].eigenvalue - modes[0].eigenvalue);
         terms(i, k) = modes[k].pressure * power;
         terms(n + i, k) = modes[k].shear * power;
      }
      terms(i, m) = terms(n + i, m + 1) = r;
      values[i] = sample.pressure;
      values[n + i] = sample.shear;
   }
   const Eigen::VectorXd plain = least_squares(terms.leftCols(m), values);
   const ScatteredFit more(terms, values);
   Solution solution;
   for (Eigen::Index k = 0; k < m; k++)
   {
      const double absolute =
         std::max(std::sqrt(more.covariance(k, k)), std::abs(more.x[k] - plain[k]));
      solution.strength.push_back(more.x[k] *
                                  std::pow(scale, modes[0].eigenvalue - modes[k].eigenvalue));
      solution.error.push_back(absolute > 0 ? absolute / std::abs(more.x[k]) : 0.0);
   }
   return solution;
}

} // namespace

CornerModes corner_modes(const Corner &corner)
{
   const double sum = corner.pad_angle + corner.body_angle;
   require(corner.pad_angle > 0 && corner.body_angle > 0 && sum > M_PI && sum <= 2 * M_PI,
           "the pad fills ", corner.pad_angle, " and the body ", corner.body_angle,
           " radians at the corner; both must be positive, and their sum above π, where the "
           "stress becomes singular, and at most 2π.");
   CornerMode one, two;
   const double half = 0.5 * sum;
   one.eigenvalue = find_root([&](double l) { return std::sin(l * sum) + l * std::sin(sum); },
                              0.5, M_PI / sum);
   // λ = 1, a rotation of the whole corner, is divided out.
   const auto remainder = [&](double l)
   {
      const double step = l - 1;
      if (std::abs(step) < 1e-7)
      {
         return sum * std::cos(sum) - std::sin(sum) - 0.5 * step * sum * sum * std::sin(sum);
      }
      return (std::sin(l * sum) - l * std::sin(sum)) / step;
   };
   two.eigenvalue = sum == 2 * M_PI ? 0.5 : find_root(remainder, M_PI / sum, 2 * M_PI / sum);

   // From the body's free face over the interface to the pad's: the bisector is at
   // (pad - body)/2 from the interface.
   const double interface = 0.5 * (corner.body_angle - corner.pad_angle);
   const RayStress symmetric = ray_stress(true, one.eigenvalue, half, interface);
   one.pressure = symmetric.normal; // K_I > 0 is compression
   one.shear = -symmetric.shear;
   const RayStress skew = ray_stress(false, two.eigenvalue, half, interface);
   two.pressure = -skew.normal;
   two.shear = skew.shear;
   return {one, two};
}

CornerModes corner_modes(const RigidCorner &corner)
{
   const double angle = corner.pad_angle, nu = corner.poisson;
   require(angle > 0 && angle < M_PI, "the pad fills ", angle,
           " radians at the corner on the rigid body; it must be above 0 and below π.");
   require(nu >= 0 && nu < 0.5, "Poisson's ratio is ", nu, "; it must be in [0, 0.5).");
   const double kappa = corner.plane_stress ? (3 - nu) / (1 + nu) : 3 - 4 * nu;
   const double sine = std::sin(angle);
   const auto residual = [&](double l)
   {
      const double s = std::sin(l * angle);
      return kappa * s * s + l * l * sine * sine - 0.25 * (kappa + 1) * (kappa + 1);
   };
   const auto slope = [&](double l)
   { return kappa * angle * std::sin(2 * l * angle) + 2 * l * sine * sine; };
   // Negative at 0, the residual rises to at most one maximum below 1, beyond λ = π/2α.
   const double top = slope(1) < 0 ? find_root(slope, 0.5 * M_PI / angle, 1) : 1.0;
   require(residual(top) > 0, "the corner of ", angle,
           " radians on a rigid body, Poisson's ratio ", nu,
           top < 1
              ? ": the eigenvalues are complex, the tractions oscillate towards the corner "
                "and have no intensity."
              : ": the stress is not singular.");
   // On the interface σ_yy - iσ_xy ~ A z^{λ-1}, and the free face makes
   // A (κ + e^{2iλα}) = λ conj(A) (1 - e^{2iα}).
   const auto mode = [&](double lambda)
   {
      const std::complex<double> i(0, 1);
      const double phase = 0.5 * std::arg((1.0 - std::exp(2.0 * angle * i)) /
                                          (kappa + std::exp(2 * lambda * angle * i)));
      return CornerMode{lambda, 1, std::tan(phase)};
   };
   CornerModes modes;
   modes.one = mode(find_root(residual, 0, top));
   if (residual(1) < 0) { modes.two = mode(find_root(residual, top, 1)); }
   return modes;
}

CornerFit fit_corner(const CornerModes &modes, const EdgeTractions &tractions,
                     const FitSettings &settings)
{
   CornerFit result;
   result.modes = modes;
   std::vector<CornerMode> fitted{modes.one};
   if (modes.two) { fitted.push_back(*modes.two); }
   auto [samples, first, last] = usable_samples(tractions, settings, false);
   for (EdgeSample &sample : samples)
   {
      const double weight = std::pow(sample.distance, 1 - modes.one.eigenvalue);
      sample.pressure *= weight;
      sample.shear *= weight;
   }
   const bool chosen = settings.window.farthest == 0;
   std::size_t to = chosen ? first + FitSettings::least_nodes : last;
   Solution best = fit(samples, first, to, fitted);
   for (std::size_t next = to + 1; chosen && next <= last; next++)
   {
      const Solution solution = fit(samples, first, next, fitted);
      if (solution.largest() < best.largest())
      {
         best = solution;
         to = next;
      }
   }
   const FitWindow window{samples[first].distance, samples[to - 1].distance};
   const int nodes = static_cast<int>(to - first);
   result.k_one = {best.strength[0], best.error[0], window, nodes};
   if (modes.two) { result.k_two = {best.strength[1], best.error[1], window, nodes}; }
   result.least_friction = std::abs(modes.one.traction_ratio());
   return result;
}

} // namespace cattaneo::fretting
