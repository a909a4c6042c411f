#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/root.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

const double pi = std::acos(-1.0);

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

struct Sample
{
   double distance, pressure, shear; ///< both over r^{λ_I-1}
};

struct Solution
{
   double one, two, error_one, error_two; ///< errors relative
   double largest() const { return std::max(error_one, error_two); }
};

Solution fit(const std::vector<Sample> &samples, std::size_t first, std::size_t last,
             const CornerModes &modes)
{
   const Eigen::Index n = last - first;
   const double scale = samples[last - 1].distance;
   const double between = modes.two.eigenvalue - modes.one.eigenvalue;
   Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(2 * n, 4);
   Eigen::VectorXd values(2 * n);
   for (Eigen::Index i = 0; i < n; i++)
   {
      const Sample &sample = samples[first + i];
      const double r = sample.distance / scale;
      const double second = std::pow(r, between);
      terms.row(i) << modes.one.pressure, modes.two.pressure * second, r, 0;
      terms.row(n + i) << modes.one.shear, modes.two.shear * second, 0, r;
      values[i] = sample.pressure;
      values[n + i] = sample.shear;
   }
   const Eigen::MatrixXd modal = terms.leftCols(2);
   const Eigen::Vector2d plain = modal.colPivHouseholderQr().solve(values);
   const Eigen::VectorXd more = terms.colPivHouseholderQr().solve(values);
   const double variance = (values - terms * more).squaredNorm() / (2 * n - 4);
   const Eigen::MatrixXd inverse = (terms.transpose() * terms).inverse();
   const auto error = [&](int k)
   {
      const double absolute =
         std::max(std::sqrt(variance * inverse(k, k)), std::abs(more[k] - plain[k]));
      return absolute > 0 ? absolute / std::abs(more[k]) : 0.0;
   };
   return {more[0], more[1] * std::pow(scale, -between), error(0), error(1)};
}

} // namespace

CornerModes corner_modes(const Corner &corner)
{
   const double sum = corner.pad_angle + corner.body_angle;
   require(corner.pad_angle > 0 && corner.body_angle > 0 && sum > pi && sum <= 2 * pi,
           "the pad fills ", corner.pad_angle, " and the body ", corner.body_angle,
           " radians at the corner; both must be positive, and their sum above π, where the "
           "stress becomes singular, and at most 2π.");
   CornerModes modes;
   const double half = 0.5 * sum;
   modes.one.eigenvalue =
      find_root([&](double l) { return std::sin(l * sum) + l * std::sin(sum); }, 0.5, pi / sum);
   // λ = 1, a rotation of the whole corner, is divided out.
   const auto two = [&](double l)
   {
      const double step = l - 1;
      if (std::abs(step) < 1e-7)
      {
         return sum * std::cos(sum) - std::sin(sum) - 0.5 * step * sum * sum * std::sin(sum);
      }
      return (std::sin(l * sum) - l * std::sin(sum)) / step;
   };
   modes.two.eigenvalue = sum == 2 * pi ? 0.5 : find_root(two, pi / sum, 2 * pi / sum);

   // From the body's free face over the interface to the pad's: the bisector is at
   // (pad - body)/2 from the interface.
   const double interface = 0.5 * (corner.body_angle - corner.pad_angle);
   const RayStress one = ray_stress(true, modes.one.eigenvalue, half, interface);
   modes.one.pressure = one.normal; // K_I > 0 is compression
   modes.one.shear = -one.shear;
   const RayStress two_stress = ray_stress(false, modes.two.eigenvalue, half, interface);
   modes.two.pressure = -two_stress.normal;
   modes.two.shear = two_stress.shear;
   return modes;
}

CornerFit fit_corner(const Corner &corner, const EdgeTractions &tractions,
                     const FitSettings &settings)
{
   settings.validate();
   CornerFit result;
   result.modes = corner_modes(corner);
   require(result.modes.two.eigenvalue < 1, "the angles at the corner add up to ",
           corner.pad_angle + corner.body_angle,
           " radians: below 4.4934 mode II is not singular and regular terms hide it.");
   const std::size_t n = tractions.position.size();
   require(tractions.pressure.size() == n && tractions.shear.size() == n, "there are ", n,
           " positions, ", tractions.pressure.size(), " pressures and ", tractions.shear.size(),
           " shear tractions; the numbers must agree.");
   std::vector<Sample> samples;
   double side = 0;
   for (std::size_t i = 0; i < n; i++)
   {
      const double x = tractions.position[i] - tractions.edge;
      const double p = tractions.pressure[i], q = tractions.shear[i];
      require(std::isfinite(x) && std::isfinite(p) && std::isfinite(q), "node ", i,
              " has position ", tractions.position[i], ", pressure ", p, " and shear ", q,
              "; all must be finite.");
      if (x == 0) { continue; } // the traction there is infinite
      if (side == 0) { side = x > 0 ? 1 : -1; }
      require(x * side > 0, "node ", i, " at ", tractions.position[i],
              " is on the other side of the corner at ", tractions.edge, ".");
      const double weight = std::pow(std::abs(x), 1 - result.modes.one.eigenvalue);
      samples.push_back({std::abs(x), p * weight, side * q * weight});
   }
   std::sort(samples.begin(), samples.end(),
             [](const Sample &a, const Sample &b) { return a.distance < b.distance; });
   std::size_t first = settings.skip, last = samples.size();
   const bool chosen = settings.window.farthest == 0;
   if (!chosen)
   {
      first = last = 0;
      for (const Sample &sample : samples)
      {
         first += sample.distance < settings.window.nearest;
         last += sample.distance <= settings.window.farthest;
      }
   }
   constexpr std::size_t least_nodes = 4;
   require(last >= first + least_nodes, "there are ", last > first ? last - first : 0,
           " nodes in the window of the fit near the corner; it needs ", least_nodes, ".");
   std::size_t to = chosen ? first + least_nodes : last;
   Solution best = fit(samples, first, to, result.modes);
   for (std::size_t next = to + 1; chosen && next <= last; next++)
   {
      const Solution solution = fit(samples, first, next, result.modes);
      if (solution.largest() < best.largest())
      {
         best = solution;
         to = next;
      }
   }
   const FitWindow window{samples[first].distance, samples[to - 1].distance};
   const int nodes = static_cast<int>(to - first);
   result.k_one = {best.one, best.error_one, window, nodes};
   result.k_two = {best.two, best.error_two, window, nodes};
   const CornerMode &dominant = best.one != 0 ? result.modes.one : result.modes.two;
   result.least_friction = std::abs(dominant.traction_ratio());
   return result;
}

} // namespace cattaneo::fretting
