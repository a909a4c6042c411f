#include <algorithm>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/threshold.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo::fretting
{
namespace
{

void require_ratio(double ratio)
{
   require(ratio >= -1 && ratio < 1, "the load ratio R is ", ratio,
           "; it must be at least -1 and below 1 (call the larger load the peak).");
}

/// The c at which κ(c)/c, which falls from infinity to zero, is @a value.
double invert_factor(double value)
{
   const auto above = [=](double log_c)
   {
      const double c = std::exp(log_c);
      return std::log(crack_factor(c) / (c * value));
   };
   double low = 0, high = 0;
   while (above(low) < 0) { low -= 1; }
   while (above(high) > 0) { high += 1; }
   return std::exp(find_root(above, low, high));
}

} // namespace

double CrackCycle::drive(Criterion criterion) const
{
   if (criterion == Criterion::open) { return std::max(max, 0.0) - std::max(min, 0.0); }
   return (criterion == Criterion::range ? 1.0 : 0.5) * (max - min);
}

void CrackedEdge::validate() const
{
   edge.validate();
   require_ratio(stress_ratio);
   require(std::isfinite(bulk_stress) && std::isfinite(stress_gradient), "the bulk stress ",
           bulk_stress, " and the stress gradient ", stress_gradient, " must be finite.");
}

CrackCycle crack_cycle(const CrackedEdge &crack, double depth)
{
   crack.validate();
   const double root = std::sqrt(M_PI * depth);
   const double bulk = crack.bulk_stress * power_law_factor(0) * root;
   const double peak = crack_intensity(crack.edge, depth) + bulk +
                       crack.stress_gradient * depth * power_law_factor(1) * root;
   const double swing = 1 - crack.stress_ratio;
   const double shear_range =
      crack_intensity_range(crack.edge, swing * std::abs(crack.edge.k_t), depth);
   const double valley = peak - std::copysign(shear_range, crack.edge.k_t) - swing * bulk;
   return {std::max(peak, valley), std::min(peak, valley)};
}

std::string to_string(CrackVerdict verdict)
{
   const char *const names[] = {"arrests", "propagates", "arrests beyond a0"};
   return names[static_cast<int>(verdict)];
}

ThresholdReport assess_threshold(const CrackedEdge &crack, double threshold, double critical,
                                 Criterion criterion)
{
   require_positive("the threshold ΔK_th", threshold);
   require_positive("the critical length a0", critical);
   const auto excess = [&](double depth)
   {
      return crack_cycle(crack, depth).drive(criterion) -
             threshold * std::sqrt(std::min(1.0, depth / critical));
   };
   ThresholdReport report;
   report.drive = crack_cycle(crack, critical).drive(criterion);
   const double ratio = 1.02;
   if (excess(critical) <= 0)
   {
      // The crack has stopped before the critical length. Go to shorter cracks until one grows:
      // growth stops between this length and the next one. If none grows, the depth is 0.
      double depth = critical;
      while (depth > 1e-6 * critical && excess(depth) <= 0) { depth /= ratio; }
      report.arrest_depth =
         excess(depth) > 0 ? find_root(excess, depth, std::min(critical, depth * ratio)) : 0.0;
      return report;
   }
   double depth = critical;
   double here = report.drive, next = 0;
   for (;; depth *= ratio, here = next)
   {
      next = crack_cycle(crack, depth * ratio).drive(criterion);
      if (next < threshold)
      {
         report.verdict = CrackVerdict::arrests_beyond_a0;
         report.arrest_depth = find_root(excess, depth, depth * ratio);
         return report;
      }
      if (next >= here) { break; }
   }
   report.verdict = CrackVerdict::propagates;
   report.arrest_depth = std::numeric_limits<double>::infinity();
   return report;
}

double threshold_ordinate(Criterion criterion, double friction, double abscissa,
                          double stress_ratio)
{
   require_positive("the friction coefficient", friction);
   require_positive("the abscissa X", abscissa);
   require_ratio(stress_ratio);
   const double fx = friction * abscissa;
   const auto range = [&](double level) { return fx / invert_factor(level / fx); };
   if (criterion == Criterion::range) { return range(0.5); }
   if (criterion == Criterion::half_range) { return range(1.0); }
   // Only the open part of the cycle drives the crack. It is the whole range if the crack never
   // closes, else the part above zero. The larger of both ordinates belongs to the smaller
   // drive.
   const double peak = 0.5 * (1 - stress_ratio) * range(1 + crack_closing_factor() * abscissa);
   return std::max(peak, range(0.5));
}

} // namespace cattaneo::fretting
