#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/edge_fit.hpp>
#include <cmath>

namespace cattaneo
{
namespace
{

/// Fits values, whose limit at the edge is sought, at the nodes of the samples first … last
/// - 1.
FittedIntensity fit(const std::vector<EdgeSample> &samples, const std::vector<double> &value,
                    std::size_t first, std::size_t last)
{
   const Eigen::Index n = last - first;
   const double scale = samples[last - 1].distance;
   Eigen::VectorXd t(n);
   for (Eigen::Index i = 0; i < n; i++) { t[i] = samples[first + i].distance / scale; }
   const Eigen::Map<const Eigen::VectorXd> values(value.data() + first, n);
   // Fits a straight line in the distance t. Its value at t = 0 is the intensity.
   const ScatteredFit linear(powers(t, 1), values);
   const double standard = linear.error(Eigen::Vector2d(1, 0));
   // The error is the scatter of the fit, or the change by a parabola if that is larger.
   const double one_more = least_squares(powers(t, 2), values)(0);

   FittedIntensity result;
   result.value = linear.x[0];
   const double error = std::max(standard, std::abs(one_more - linear.x[0]));
   result.relative_error = error > 0 ? error / std::abs(linear.x[0]) : 0.0;
   result.window = {samples[first].distance, scale};
   result.nodes = int(n);
   return result;
}

FittedIntensity fit_in_window(const UsableSamples &usable, const std::vector<double> &value,
                              bool chosen)
{
   if (!chosen) { return fit(usable.samples, value, usable.first, usable.last); }
   // Tries all windows from the first node on, and takes the one with the smallest error.
   std::vector<FittedIntensity> fits;
   for (std::size_t last = usable.first + FitSettings::least_nodes; last <= usable.last; last++)
   {
      fits.push_back(fit(usable.samples, value, usable.first, last));
   }
   const auto error = [](const FittedIntensity &x)
   { return x.relative_error * std::abs(x.value); };
   FittedIntensity best =
      *std::min_element(fits.begin(), fits.end(),
                        [&](const auto &a, const auto &b) { return error(a) < error(b); });
   // The smallest of many errors may be small by chance, so windows with almost the same error
   // must agree.
   double spread = error(best);
   for (const FittedIntensity &other : fits)
   {
      if (error(other) > 3 * error(best)) { continue; }
      spread = std::max(spread, std::abs(other.value - best.value));
   }
   if (best.value != 0) { best.relative_error = spread / std::abs(best.value); }
   return best;
}

} // namespace

void EdgeTractions::validate() const
{
   const std::size_t n = position.size();
   require(pressure.size() == n && shear.size() == n, "there are ", n, " positions, ",
           pressure.size(), " pressures and ", shear.size(),
           " shear tractions; the numbers must agree.");
   require(std::isfinite(edge), "the position of the edge is ", edge, "; it must be finite.");
   require(width > 0, "the width of the contact is ", width, "; it must be positive.");
   for (std::size_t i = 0; i < n; i++)
   {
      require(std::isfinite(position[i]) && std::isfinite(pressure[i]) &&
                 std::isfinite(shear[i]),
              "node ", i, " has position ", position[i], ", pressure ", pressure[i],
              " and shear ", shear[i], "; all must be finite.");
   }
}

void FitSettings::validate() const
{
   const bool chosen = window.nearest == 0 && window.farthest == 0;
   require(
      chosen || (window.nearest >= 0 && window.farthest > window.nearest &&
                 std::isfinite(window.farthest)),
      "the window of the fit is ", window.nearest, " to ", window.farthest,
      "; it must be two increasing distances from the edge, or 0 and 0 to have it chosen.");
   require_at_least("the number of skipped nodes", skip, 0);
}

UsableSamples usable_samples(const EdgeTractions &tractions, const FitSettings &settings,
                             bool pressed)
{
   settings.validate();
   tractions.validate();
   UsableSamples usable;
   double side = 0;
   for (std::size_t i = 0; i < tractions.position.size(); i++)
   {
      const double x = tractions.position[i] - tractions.edge, p = tractions.pressure[i];
      // A node at the edge, or without pressure, gives no information about the field.
      if (x == 0 || (pressed && p <= 0)) { continue; }
      if (side == 0) { side = x > 0 ? 1 : -1; }
      require(x * side > 0, "node ", i, " at ", tractions.position[i],
              " is on the other side of the edge at ", tractions.edge, ".");
      usable.samples.push_back({std::abs(x), p, side * tractions.shear[i]});
   }
   std::sort(usable.samples.begin(), usable.samples.end(),
             [](const auto &a, const auto &b) { return a.distance < b.distance; });
   usable.first = settings.skip;
   usable.last = usable.samples.size();
   if (settings.window.farthest > 0)
   {
      usable.first = usable.last = 0;
      for (const EdgeSample &sample : usable.samples)
      {
         usable.first += sample.distance < settings.window.nearest;
         usable.last += sample.distance <= settings.window.farthest;
      }
   }
   const std::size_t left = usable.last > usable.first ? usable.last - usable.first : 0;
   require(left >= FitSettings::least_nodes, "there are ", left,
           " nodes in the window of the fit near the edge at ", tractions.edge, "; it needs ",
           FitSettings::least_nodes, ".");
   return usable;
}

EdgeFit fit_edge(const EdgeTractions &tractions, const FitSettings &settings)
{
   const UsableSamples usable = usable_samples(tractions, settings, true);
   std::vector<double> normal, tangential;
   for (const EdgeSample &sample : usable.samples)
   {
      const double t = sample.distance;
      require(t < tractions.width, "a node in contact is ", t, " from the edge at ",
              tractions.edge, ", beyond the width of the contact, ", tractions.width, ".");
      // The factor (1 - t/width) is zero at the other edge, so that a Hertz contact is fitted
      // exactly.
      const double root = std::sqrt(t * (1 - t / tractions.width));
      normal.push_back(sample.pressure / root);
      tangential.push_back(sample.shear * root);
   }
   const bool chosen = settings.window.farthest == 0;
   return {fit_in_window(usable, normal, chosen), fit_in_window(usable, tangential, chosen)};
}

} // namespace cattaneo
