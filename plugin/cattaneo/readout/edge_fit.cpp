#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/edge_fit.hpp>
#include <cmath>
#include <utility>

namespace cattaneo
{
namespace
{

/// Distance from the edge and the quantity whose limit there is sought, sorted by distance.
using Samples = std::vector<std::pair<double, double>>;

constexpr int least_nodes = FitSettings::least_nodes;

FittedIntensity fit(const Samples &samples, std::size_t first, std::size_t last)
{
   const Eigen::Index n = last - first;
   const double scale = samples[last - 1].first;
   Eigen::MatrixXd terms(n, 3);
   Eigen::VectorXd values(n);
   for (Eigen::Index i = 0; i < n; i++)
   {
      const double t = samples[first + i].first / scale;
      terms.row(i) << 1, t, t * t;
      values[i] = samples[first + i].second;
   }
   const Eigen::MatrixXd linear = terms.leftCols(2);
   const Eigen::VectorXd solution = least_squares(linear, values);
   const double variance = (values - linear * solution).squaredNorm() / (n - 2);
   const double standard = std::sqrt(variance * (linear.transpose() * linear).inverse()(0, 0));
   const double one_more = least_squares(terms, values)[0];

   FittedIntensity result;
   result.value = solution[0];
   const double error = std::max(standard, std::abs(one_more - solution[0]));
   result.relative_error = error > 0 ? error / std::abs(solution[0]) : 0.0;
   result.window = {samples[first].first, scale};
   result.nodes = int(n);
   return result;
}

FittedIntensity fit_in_window(const Samples &samples, const FitSettings &settings)
{
   if (settings.window.farthest > 0)
   {
      const auto beyond = [](double t, const auto &sample) { return t < sample.first; };
      const auto before = [](const auto &sample, double t) { return sample.first < t; };
      const std::size_t first =
         std::lower_bound(samples.begin(), samples.end(), settings.window.nearest, before) -
         samples.begin();
      const std::size_t last =
         std::upper_bound(samples.begin(), samples.end(), settings.window.farthest, beyond) -
         samples.begin();
      require(last >= first + least_nodes, "between ", settings.window.nearest, " and ",
              settings.window.farthest, " from the contact edge there are ", last - first,
              " nodes in contact; the fit needs ", least_nodes, ".");
      return fit(samples, first, last);
   }
   const std::size_t first = settings.skip;
   require(samples.size() >= first + least_nodes, "there are ", samples.size(),
           " nodes in contact near the edge; the fit needs ", first + least_nodes, ".");
   std::vector<FittedIntensity> fits;
   for (std::size_t last = first + least_nodes; last <= samples.size(); last++)
   {
      fits.push_back(fit(samples, first, last));
   }
   const auto error = [](const FittedIntensity &x)
   { return x.relative_error * std::abs(x.value); };
   FittedIntensity best =
      *std::min_element(fits.begin(), fits.end(),
                        [&](const auto &a, const auto &b) { return error(a) < error(b); });
   // The least of many errors is small by luck too: windows that are nearly as good must agree.
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
   require(skip >= 0, "the number of skipped nodes is ", skip, "; it must not be negative.");
}

EdgeFit fit_edge(const EdgeTractions &tractions, const FitSettings &settings)
{
   settings.validate();
   tractions.validate();
   Samples normal, tangential;
   double side = 0;
   for (std::size_t i = 0; i < tractions.position.size(); i++)
   {
      const double x = tractions.position[i] - tractions.edge;
      const double p = tractions.pressure[i], q = tractions.shear[i];
      if (p <= 0 || x == 0) { continue; }
      if (side == 0) { side = x > 0 ? 1 : -1; }
      require(x * side > 0, "node ", i, " at ", tractions.position[i],
              " is in contact on the other side of the edge at ", tractions.edge, ".");
      const double root = std::sqrt(std::abs(x));
      normal.push_back({std::abs(x), p / root});
      tangential.push_back({std::abs(x), side * q * root});
   }
   std::sort(normal.begin(), normal.end());
   std::sort(tangential.begin(), tangential.end());
   return {fit_in_window(normal, settings), fit_in_window(tangential, settings)};
}

} // namespace cattaneo
