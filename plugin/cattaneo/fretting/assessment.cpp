#include <algorithm>
#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{
namespace
{

/// How small a ratio of lengths is. At a ratio of 0.1 the slip zone of a Hertz contact is 5 %
/// longer than the near-edge field predicts, at 0.25 it is 15 % longer.
Trust smallness(double ratio)
{
   return ratio < 0.1 ? Trust::good : ratio < 0.25 ? Trust::caution : Trust::poor;
}

std::string by_trust(Trust trust, const char *good, const char *caution, const char *poor)
{
   return trust == Trust::good ? good : trust == Trust::caution ? caution : poor;
}

void judge_slip_zone(const FrettingProblem &problem, FrettingReport &report)
{
   if (problem.half_width == 0)
   {
      report.validity.push_back(
         {"", 0, Trust::caution,
          "The size of the contact is not known; the slip zone and a0 must "
          "both be small against it."});
      return;
   }
   const double ratio = report.slip_zone / problem.half_width;
   const Trust trust = smallness(ratio);
   report.validity.push_back(
      {"d/a", ratio, trust,
       by_trust(
          trust, "The slip zone is small against the contact; the near-edge field holds.",
          "The slip zone is not very small against the contact: it is underestimated by "
          "about 5 to 15 %.",
          "The slip zone is a large part of the contact: do not trust the near-edge field; "
          "solve the whole contact.")});
   const bool flat = problem.rounded_width > 0 && problem.rounded_width < problem.half_width;
   if (flat)
   {
      const double rounded = report.slip_zone / problem.rounded_width;
      const Trust t = smallness(rounded);
      report.validity.push_back(
         {"d/(a-b)", rounded, t,
          by_trust(
             t, "The slip zone stays on the outer part of the rounded edge.",
             "The slip zone reaches well into the rounded edge; pressure there is no longer "
             "K_N√t.",
             "The slip zone is a large part of the rounded edge: do not trust K_N; solve the "
             "whole "
             "contact.")});
   }
   const double width = problem.rounded_width > 0 ? problem.rounded_width : problem.half_width;
   const double depth = report.critical_length / width;
   const Trust t = smallness(depth);
   report.validity.push_back(
      {flat ? "a0/(a-b)" : "a0/a", depth, t,
       by_trust(
          t, "The critical crack is small against the contact edge region.",
          "The critical crack is not very small against the contact edge region.",
          "The critical crack is as long as the contact edge region: its stress intensity "
          "needs the whole field.")});
}

void judge_crack(FrettingReport &report)
{
   if (report.slip_zone == 0) { return; }
   const double ratio = report.critical_length / report.slip_zone;
   const char *text =
      "The critical crack and the slip zone are of similar size: friction matters.";
   if (ratio > 10)
   {
      text =
         "The critical crack is much longer than the slip zone: only K_T and K_N matter, not "
         "friction.";
   }
   if (ratio < 0.1)
   {
      text = "The critical crack is much shorter than the slip zone: the edge stress alone "
             "decides, "
             "as in plain fatigue.";
   }
   report.validity.push_back({"a0/d", ratio, Trust::good, text});
}

void judge_yield(FrettingReport &report)
{
   const Trust trust = report.yield_ratio_full > 1    ? Trust::poor
                       : report.yield_ratio_first > 1 ? Trust::caution
                                                      : Trust::good;
   report.validity.push_back(
      {"load/first yield", report.yield_ratio_first, trust,
       by_trust(trust, "The slip zone stays elastic.", "Part of the slip zone yields.",
                "The whole slip zone yields: elastic stresses and the verdict on the crack are "
                "not to be trusted; the mode II measure is the one meant for this case.")});
}

void judge_omissions(const FrettingProblem &problem, FrettingReport &report)
{
   report.validity.push_back(
      {"", 0, problem.bulk_known ? Trust::good : Trust::caution,
       problem.bulk_known ? "The mean bulk stress is included in K_I (it is not part of K_T)."
                          : "The mean bulk stress is left out of K_I: unconservative if there "
                            "is bulk tension."});
   const bool gradient = problem.crack.stress_gradient != 0;
   report.validity.push_back(
      {"", 0, gradient ? Trust::good : Trust::caution,
       gradient
          ? "The tension that grows with depth below the edge is included in K_I."
          : "The tension that grows with depth below the edge (E* y/R for a rounded edge) is "
            "left out of K_I: unconservative, by about a fifth at a depth of a/20."});
   const double ratio = problem.crack.stress_ratio, measured = problem.material.threshold_ratio;
   if (std::abs(ratio - measured) > 0.1)
   {
      report.validity.push_back(
         {"R", ratio, Trust::caution,
          "The threshold and fatigue limit were measured at another load "
          "ratio; use values for this one (they fall as R rises)."});
   }
}

} // namespace

void FrettingSettings::validate() const
{
   require_positive("the mode II threshold ratio", mode_two_ratio);
}

std::string to_string(Trust trust)
{
   return by_trust(trust, "good", "caution", "not to be trusted");
}

FrettingReport assess(const FrettingProblem &problem, const FrettingSettings &settings)
{
   settings.validate();
   problem.crack.validate();
   problem.material.validate();
   // 0 if unknown.
   require_at_least("the half width of the contact", problem.half_width, 0);
   require_at_least("the rounded part of the half width", problem.rounded_width, 0);
   const FatigueMaterial &material = problem.material;
   const Edge &edge = problem.crack.edge;
   const double modulus =
      contact_modulus(material.young, material.poisson, problem.plane_stress);
   const double constraint = out_of_plane_constraint(material.poisson, problem.plane_stress);

   FrettingReport report;
   report.k_t_range = (1 - problem.crack.stress_ratio) * std::abs(edge.k_t);
   report.slip_zone = slip_zone(edge);
   report.edge_stress = edge_stress(edge);
   report.edge_stress_range = edge_stress_range(edge, report.k_t_range);
   const double load = edge.k_n * std::sqrt(report.slip_zone) / material.shear_yield.low;
   report.yield_ratio_first = load / first_yield_load(edge.friction, constraint);
   report.yield_ratio_full = load / full_yield_load(edge.friction);

   report.critical_length = critical_length(material);
   const CrackCycle cycle = crack_cycle(problem.crack, report.critical_length);
   report.k_i_max = cycle.max;
   report.k_i_min = cycle.min;
   report.abscissa = edge.k_n * report.critical_length / material.threshold;
   report.ordinate = report.k_t_range / material.threshold;
   report.threshold_ordinate = threshold_ordinate(settings.criterion, edge.friction,
                                                  report.abscissa, problem.crack.stress_ratio);
   report.threshold = assess_threshold(problem.crack, material.threshold,
                                       report.critical_length, settings.criterion);
   report.mode_two_range = mode_two_range(report.k_t_range);
   report.mode_two_utilisation =
      report.mode_two_range / (settings.mode_two_ratio * material.threshold);
   report.energy_max = slip_energy_max(report.k_t_range, modulus);
   report.energy_total = slip_energy_total(edge, report.k_t_range, modulus);

   judge_slip_zone(problem, report);
   judge_crack(report);
   judge_yield(report);
   judge_omissions(problem, report);
   for (const Validity &item : report.validity)
   {
      report.trust = std::max(report.trust, item.trust);
   }
   return report;
}

} // namespace cattaneo::fretting
