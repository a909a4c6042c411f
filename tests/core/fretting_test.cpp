#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "fretting_problems.hpp"

#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/edge_fit.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <tuple>

namespace
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using cattaneo::InputError;
using cattaneo_test::aluminium;
using cattaneo_test::infinity;
using cattaneo_test::measure;
using cattaneo_test::mentions;
using cattaneo_test::round_numbers;

FrettingProblem hertz_problem(double shear_ratio)
{
   const double a = 1, f = 0.6, load = 200;
   FrettingProblem problem;
   problem.crack.edge = {hertz_k_n(load, a),
                         shear_intensities(a, shear_ratio * f * load, 0).trailing, f};
   problem.material = aluminium();
   problem.half_width = problem.rounded_width = a;
   problem.bulk_known = true;
   return problem;
}

TEST(Fretting, RefusesBadInput)
{
   EXPECT_THROW(slip_zone({1, 1, 0}), InputError);
   EXPECT_THROW(slip_zone({1, 1, -0.3}), InputError);
   EXPECT_THROW(slip_zone({0, 1, 0.3}), InputError);
   EXPECT_THROW(slip_zone({1, nan_value, 0.3}), InputError);
   EXPECT_THROW(stress({1, 1, 0.3}, 0, -1), InputError);
   EXPECT_THROW(stress({1, 1, 0.3}, nan_value, 1), InputError);
   EXPECT_THROW(contact_modulus(0, 0.3), InputError);
   EXPECT_THROW(contact_modulus(1, 0.5), InputError);
   EXPECT_THROW(hertz_contact(-1, 1, 1), InputError);
   EXPECT_THROW(hertz_k_n(1, 0), InputError);
   EXPECT_THROW(flat_rounded_contact(1, 1, -1, 1), InputError);
   EXPECT_THROW(flat_rounded_contact(1, 0, 1, 1), InputError);
   EXPECT_THROW(rounded_edge(0, 1, 1), InputError);
   EXPECT_THROW(symmetric_k_n(1, -1), InputError);
   EXPECT_THROW(edge_gradient(0, 1), InputError);
   EXPECT_THROW(shear_intensities(1, infinity, 0), InputError);
   EXPECT_THROW(first_yield_load(0, 0.3), InputError);
   EXPECT_THROW(full_yield_load(0), InputError);
   EXPECT_THROW(hertz_transition_friction(0.3, 0), InputError);
   EXPECT_THROW(hertz_transition_friction(0.3, 1.1), InputError);
   EXPECT_THROW(power_law_factor(-1), InputError);
   EXPECT_THROW(crack_factor(-1), InputError);
   EXPECT_THROW(crack_factor(nan_value), InputError);
   EXPECT_THROW(crack_intensity({1, 1, 0.3}, -1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0, 1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 0), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 1, 1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 1, -2), InputError);
   EXPECT_THROW(assess_threshold({{1, 1, 0.3}}, 0, 1), InputError);
   EXPECT_THROW(slip_energy_max(-1, 1), InputError);
   EXPECT_THROW(reversed_slip_zone({1, 1, 0.3}, -1), InputError);
   EXPECT_THROW(reversed_slip_zone({1, 1, 0.3}, nan_value), InputError);
   EXPECT_THROW(mode_two_range(-1), InputError);
   EXPECT_THROW(slip_energy_max(1, 0), InputError);
   EXPECT_THROW(hertz_slip_energy(0.3, 1, 1.01, 1), InputError);
   expect_input_error([] { hertz_slip_energy(0, 1, 0.5, 1); },
                      "the friction coefficient is 0, must be");
   expect_input_error([] { hertz_slip_energy(0.3, 0, 0.5, 1); },
                      "the normal force is 0, must be");
}

TEST(Fretting, FrictionlessEdgeIsRefusedWithTheReason)
{
   expect_input_error([&] { slip_zone({1, 1, 0}); }, "without friction nothing sticks");
}

TEST(FatigueMaterial, MixedRangeAndAmplitudeIsRefused)
{
   FatigueMaterial m = aluminium();
   EXPECT_NO_THROW(m.validate());
   m.fatigue_limit_basis = Basis::amplitude;
   EXPECT_THROW(critical_length(m), InputError);
   // Both as amplitudes: a0 is the same ratio.
   const double a0 = critical_length(aluminium());
   m.threshold_basis = Basis::amplitude;
   m.threshold *= 0.5;
   m.fatigue_limit = {62, 62};
   EXPECT_NEAR(critical_length(m), a0, 1e-15);
}

TEST(Assessment, SmallLoadIsTrustedAndArrests)
{
   const FrettingReport report = assess(hertz_problem(0.02));
   EXPECT_EQ(report.threshold.verdict, CrackVerdict::arrests);
   EXPECT_EQ(to_string(report.threshold.verdict), "arrests");
   EXPECT_NEAR(report.slip_zone, 0.01, 1e-12); // a Q/(2fP)
   EXPECT_TRUE(mentions(report, "slip zone is small against the contact"));
   EXPECT_TRUE(mentions(report, "mean bulk stress is included"));
}

TEST(Assessment, LargeSlipIsNotTrusted)
{
   const FrettingReport report = assess(hertz_problem(0.9));
   EXPECT_EQ(report.trust, Trust::poor);
   EXPECT_TRUE(mentions(report, "do not trust the near-edge field"));
}

TEST(Assessment, NegativeAndZeroShearAreAllowed)
{
   FrettingProblem problem = hertz_problem(0.1);
   const FrettingReport plus = assess(problem);
   problem.crack.edge.k_t *= -1;
   const FrettingReport minus = assess(problem);
   EXPECT_DOUBLE_EQ(minus.edge_stress, -plus.edge_stress);
   EXPECT_DOUBLE_EQ(minus.energy_total, plus.energy_total);
   // Fully reversed, both edges see the same worst crack.
   EXPECT_NEAR(minus.k_i_max, plus.k_i_max, 1e-12);
   problem.crack.edge.k_t = 0;
   const FrettingReport none = assess(problem);
   EXPECT_EQ(none.slip_zone, 0);
   EXPECT_EQ(none.energy_max, 0);
   EXPECT_LT(none.k_i_max, 0);
   EXPECT_EQ(none.threshold.verdict, CrackVerdict::arrests);
   EXPECT_EQ(none.threshold.arrest_depth, 0);
}

TEST(Assessment, LongCriticalLengthIsSaid)
{
   FrettingProblem problem = hertz_problem(0.02);
   problem.material.fatigue_limit = {20, 20};
   const FrettingReport report = assess(problem);
   EXPECT_GT(report.critical_length, 100 * report.slip_zone);
   EXPECT_TRUE(mentions(report, "much longer than the slip zone"));
   EXPECT_TRUE(mentions(report, "as long as the contact edge region"));
   EXPECT_TRUE(std::isfinite(report.k_i_max));
}

TEST(Assessment, PlaneStressChangesModulusAndYield)
{
   FrettingProblem problem = hertz_problem(0.3);
   const FrettingReport strain = assess(problem);
   problem.plane_stress = true;
   const FrettingReport stress = assess(problem);
   EXPECT_NEAR(stress.energy_max / strain.energy_max, 1 / (1 - 0.09), 1e-12);
   EXPECT_GT(stress.yield_ratio_first, strain.yield_ratio_first);
   EXPECT_EQ(stress.yield_ratio_full, strain.yield_ratio_full);
   EXPECT_EQ(stress.k_i_max, strain.k_i_max);
}

TEST(Assessment, SaysWhatIsOmittedAndWhatDiffers)
{
   FrettingProblem problem = hertz_problem(0.1);
   problem.half_width = problem.rounded_width = 0;
   problem.bulk_known = false;
   problem.crack.stress_ratio = 0;
   const FrettingReport report = assess(problem);
   EXPECT_TRUE(mentions(report, "size of the contact is not known"));
   EXPECT_TRUE(mentions(report, "unconservative"));
   EXPECT_TRUE(mentions(report, "another load ratio"));
   FrettingSettings settings;
   settings.mode_two_ratio = 0;
   EXPECT_THROW(assess(problem, settings), InputError);
   problem.half_width = -1;
   EXPECT_THROW(assess(problem), InputError);
}

TEST(Assessment, EveryNumberIsThatOfTheFormulaByHand)
{
   const FrettingProblem problem = round_numbers();
   FrettingReport report = assess(problem);
   const double range = 0.5 * 0.3, d_r = range / 1.2; // ΔK_T = (1 - R) K_T
   EXPECT_NEAR(report.k_t_range, range, 1e-15);
   EXPECT_NEAR(report.slip_zone, 0.5, 1e-15);
   EXPECT_NEAR(report.edge_stress, std::sqrt(8 * 1.2 * 0.3), 1e-14);
   EXPECT_NEAR(report.edge_stress_range, 4 * 1.2 * std::sqrt(d_r), 1e-14);
   // The low ends of the intervals decide: k = 2, σ_fl = 10.
   const double load = 2 * std::sqrt(0.5) / 2;
   EXPECT_NEAR(report.yield_ratio_first, load * std::sqrt((3 * 0.36 + 0.16) / 3), 1e-14);
   EXPECT_NEAR(report.yield_ratio_full, load * 0.6, 1e-14);
   EXPECT_NEAR(report.critical_length, 0.04, 1e-15);
   const double threshold = 10 * std::sqrt(0.04 * pi);
   EXPECT_NEAR(report.abscissa, 2 * 0.04 / threshold, 1e-15);
   EXPECT_NEAR(report.ordinate, range / threshold, 1e-15);
   EXPECT_NEAR(report.mode_two_range, std::sqrt(2 * pi) * range, 1e-15);
   EXPECT_NEAR(report.mode_two_utilisation, std::sqrt(2 * pi) * range / (0.8 * threshold),
               1e-15);
   EXPECT_NEAR(report.energy_max, std::sqrt(3.0) * range * range / 1000, 1e-18);
   EXPECT_NEAR(report.energy_total, pi / 3 * range * range * d_r / 1000, 1e-18);
   EXPECT_NEAR(measure(report, "d/a").value, 0.05, 1e-15);
   EXPECT_NEAR(measure(report, "d/(a-b)").value, 0.125, 1e-15);
   EXPECT_NEAR(measure(report, "a0/(a-b)").value, 0.01, 1e-15);
   EXPECT_NEAR(measure(report, "a0/d").value, 0.08, 1e-15);
   EXPECT_NEAR(measure(report, "load/first yield").value, report.yield_ratio_first, 1e-15);
   EXPECT_TRUE(mentions(report, "much shorter than the slip zone"));
   FrettingSettings settings;
   settings.mode_two_ratio = 0.4;
   settings.criterion = Criterion::half_range;
   const FrettingReport other = assess(problem, settings);
   EXPECT_NEAR(other.mode_two_utilisation, 2 * report.mode_two_utilisation, 1e-15);
   EXPECT_NEAR(other.threshold.drive, 0.5 * (report.k_i_max - report.k_i_min), 1e-15);
   EXPECT_NEAR(other.threshold_ordinate,
               threshold_ordinate(Criterion::half_range, 0.6, report.abscissa), 1e-15);
   settings.criterion = Criterion::range;
   EXPECT_NEAR(assess(problem, settings).threshold.drive, report.k_i_max - report.k_i_min,
               1e-15);
}

TEST(Threshold, UniformTensionGrowsACrackFromTheFatigueLimitOn)
{
   // Without shear and almost without pressure K_I = 1.12152 σ √(πc): in proportion to the
   // short-crack threshold ΔK_th √(c/a0), and beyond a0 above it for good.
   const double a0 = 0.05, limit = 100, threshold = limit * std::sqrt(pi * a0);
   const auto verdict = [&](double tension, double ratio, Criterion criterion) {
      return assess_threshold({{1e-9, 0, 0.5}, ratio, tension, 0}, threshold, a0, criterion);
   };
   for (const auto &[criterion, ratio, range] : {std::tuple(Criterion::open, -1.0, 1.0),
                                                 {Criterion::range, -1.0, 2.0},
                                                 {Criterion::half_range, -1.0, 1.0},
                                                 {Criterion::open, 0.5, 0.5},
                                                 {Criterion::range, 0.5, 0.5},
                                                 {Criterion::half_range, 0.5, 0.25}})
   {
      const double critical = limit / 1.12152 / range;
      const ThresholdReport below = verdict(0.999 * critical, ratio, criterion),
                            above = verdict(1.001 * critical, ratio, criterion);
      EXPECT_EQ(below.verdict, CrackVerdict::arrests);
      EXPECT_EQ(below.arrest_depth, 0);
      EXPECT_NEAR(below.drive, 0.999 * threshold, 1e-5 * threshold);
      EXPECT_EQ(above.verdict, CrackVerdict::propagates);
      EXPECT_TRUE(std::isinf(above.arrest_depth));
   }
   EXPECT_EQ(to_string(CrackVerdict::propagates), "propagates");
   EXPECT_EQ(to_string(CrackVerdict::arrests_beyond_a0), "arrests beyond a0");
   EXPECT_THROW(verdict(nan_value, -1, Criterion::open), InputError);
   EXPECT_THROW(verdict(1, 1, Criterion::open), InputError);
}

/// Hertz pressure and stuck shear of a = p0 = 1, Q = 1 at n nodes.
EdgeTractions hertz_nodes(int n, double edge)
{
   EdgeTractions tractions;
   tractions.edge = edge;
   for (int i = 0; i < n; i++)
   {
      const double x = -1 + (i + 0.5) * 2 / n;
      tractions.position.push_back(x);
      tractions.pressure.push_back(std::sqrt(1 - x * x));
      tractions.shear.push_back(1 / (pi * std::sqrt(1 - x * x)));
   }
   return tractions;
}

TEST(EdgeFit, FindsTheHertzIntensitiesAtBothEdges)
{
   const double k_n = std::sqrt(2.0), k_t = 1 / (pi * std::sqrt(2.0));
   for (const double edge : {-1.0, 1.0})
   {
      const EdgeFit fit = fit_edge(hertz_nodes(200, edge));
      EXPECT_NEAR(fit.k_n.value, k_n, 1e-3 * k_n);
      EXPECT_NEAR(fit.k_t.value, -edge * k_t, 1e-3 * k_t);
      // The reported error bounds the true one.
      EXPECT_LT(std::abs(fit.k_n.value / k_n - 1), fit.k_n.relative_error);
      EXPECT_LT(std::abs(-edge * fit.k_t.value / k_t - 1), fit.k_t.relative_error);
      EXPECT_LT(fit.k_n.relative_error, 1e-3);
      EXPECT_LT(fit.k_t.relative_error, 1e-3);
      EXPECT_GE(fit.k_n.nodes, 4);
   }
}

// With the other edge known both tractions are K √(t (1 - t/width)) to the power 1 and -1: few
// nodes far from the edge give K to round-off.
TEST(EdgeFit, TheOtherEdgeIsPartOfTheExpansion)
{
   FitSettings coarse;
   coarse.window = {0.2, 1};
   for (const double edge : {-1.0, 1.0})
   {
      EdgeTractions tractions = hertz_nodes(20, edge);
      tractions.width = 2;
      for (const FitSettings &settings : {coarse, FitSettings()})
      {
         const EdgeFit fit = fit_edge(tractions, settings);
         EXPECT_NEAR(fit.k_n.value, std::sqrt(2.0), 1e-12);
         EXPECT_NEAR(fit.k_t.value, -edge / (pi * std::sqrt(2.0)), 1e-12);
      }
      tractions.width = 1;
      expect_input_error([&] { fit_edge(tractions, coarse); }, "beyond the width");
      tractions.width = 0;
      expect_input_error([&] { fit_edge(tractions, coarse); }, "must be positive");
   }
}

TEST(EdgeFit, UsesTheWindowItIsGiven)
{
   FitSettings settings;
   settings.window = {0.02, 0.2};
   const EdgeFit fit = fit_edge(hertz_nodes(200, -1), settings);
   EXPECT_EQ(fit.k_n.nodes, 18);
   EXPECT_GE(fit.k_n.window.nearest, 0.02);
   EXPECT_LE(fit.k_n.window.farthest, 0.2);
   EXPECT_NEAR(fit.k_n.value, std::sqrt(2.0), 2e-3);
}

TEST(EdgeFit, ReportsTheNoise)
{
   EdgeTractions noisy = hertz_nodes(200, -1);
   for (std::size_t i = 0; i < noisy.pressure.size(); i += 2) { noisy.pressure[i] *= 1.1; }
   FitSettings settings;
   settings.window = {0.02, 0.2};
   const EdgeFit fit = fit_edge(noisy, settings);
   EXPECT_GT(fit.k_n.relative_error, 1e-2);
   // Every other one of the 18 nodes is a tenth too high, so the mean is 1.05 times as high.
   EXPECT_NEAR(fit.k_n.value, 1.05 * std::sqrt(2.0), 0.02 * std::sqrt(2.0));
   EXPECT_LT(std::abs(fit.k_n.value / (1.05 * std::sqrt(2.0)) - 1), fit.k_n.relative_error);
   EXPECT_LT(fit.k_n.relative_error, 0.05);
}

TEST(EdgeFit, ShearFreeEdgeHasNoShearIntensity)
{
   EdgeTractions tractions = hertz_nodes(100, -1);
   std::fill(tractions.shear.begin(), tractions.shear.end(), 0.0);
   EXPECT_EQ(fit_edge(tractions).k_t.value, 0);
}

/// p = √t (K_N + 0.7 t) and q = (K_T + 0.4 t)/√t at t = 1, 2, … n hundredths, far ones first.
EdgeTractions exact_tractions(double side, int n = 12)
{
   EdgeTractions tractions;
   tractions.edge = 5;
   for (int i = n; i > 0; i--)
   {
      const double t = 0.01 * i;
      tractions.position.push_back(5 + side * t);
      tractions.pressure.push_back(std::sqrt(t) * (3 + 0.7 * t));
      tractions.shear.push_back(side * (-2 + 0.4 * t) / std::sqrt(t));
   }
   return tractions;
}

TEST(EdgeFit, RecoversWhatItsExpansionIsMadeOf)
{
   for (const double side : {1.0, -1.0})
   {
      EdgeTractions tractions = exact_tractions(side);
      // Nodes without pressure and the one at the edge do not count, wherever they are.
      tractions.position.insert(tractions.position.end(), {5.0, 5 - side, 5 + side});
      tractions.pressure.insert(tractions.pressure.end(), {9.0, 0.0, -1.0});
      tractions.shear.insert(tractions.shear.end(), {9.0, 9.0, 9.0});
      const EdgeFit fit = fit_edge(tractions);
      EXPECT_NEAR(fit.k_n.value, 3, 1e-12);
      EXPECT_NEAR(fit.k_t.value, -2, 1e-12);
      EXPECT_LT(fit.k_n.relative_error, 1e-11);
   }
}

TEST(EdgeFit, WindowsBeginAndEndAtTheirNodesAndTheFirstAreSkipped)
{
   EdgeTractions tractions = exact_tractions(1);
   FitSettings settings;
   const auto fit = [&](double nearest, double farthest)
   {
      settings.window = {nearest, farthest};
      return fit_edge(tractions, settings).k_n;
   };
   EXPECT_EQ(fit(0.0295, 0.0805).nodes, 6); // 3 … 8 hundredths
   EXPECT_EQ(fit(0.0305, 0.0805).nodes, 5);
   EXPECT_EQ(fit(0.0295, 0.0795).nodes, 5);
   EXPECT_NEAR(fit(0.0295, 0.0805).window.nearest, 0.03, 1e-15);
   EXPECT_NEAR(fit(0.0295, 0.0805).window.farthest, 0.08, 1e-15);
   EXPECT_EQ(fit(0, 0.0405).nodes, 4);
   EXPECT_THROW(fit(0, 0.0395), InputError); // three are too few
   EXPECT_THROW(fit(-0.01, 0.1), InputError);
   EXPECT_THROW(fit(0.1, 0.1), InputError);
   EXPECT_THROW(fit(0.1, 0), InputError);
   EXPECT_THROW(fit(0.1, infinity), InputError);
   // A window of its own choice leaves out the first two, or as many as it is told.
   for (const std::size_t nearest : {11, 10}) { tractions.pressure[nearest] *= 2; }
   EXPECT_NEAR(fit(0, 0).value, 3, 1e-12);
   EXPECT_NEAR(fit(0, 0).window.nearest, 0.03, 1e-15);
   settings.skip = 1;
   EXPECT_GT(std::abs(fit(0, 0).value - 3), 1e-3);
   EXPECT_NEAR(fit(0, 0).window.nearest, 0.02, 1e-15);
   settings.skip = 8;
   EXPECT_EQ(fit(0, 0).nodes, 4);
   settings.skip = 9;
   EXPECT_THROW(fit(0, 0), InputError);
   settings.skip = -1;
   EXPECT_THROW(fit(0, 0), InputError);
}

TEST(EdgeFit, AChosenWindowOfScatteredNodesHasThemAll)
{
   // Scatter of ±1e-3 from node to node: the more of them, the smaller the error (of 4 to 10
   // nodes by numpy: 5.2, 6.7, 3.6, 3.8, 2.9, 2.7, 2.5 times 1e-4).
   EdgeTractions tractions = exact_tractions(1, 10);
   for (int i = 0; i < 10; i++)
   {
      const double t = tractions.position[i] - 5;
      tractions.pressure[i] += std::sqrt(t) * (i % 2 ? 1e-3 : -1e-3);
   }
   FitSettings settings;
   settings.skip = 0;
   const FittedIntensity fit = fit_edge(tractions, settings).k_n;
   EXPECT_EQ(fit.nodes, 10);
   EXPECT_NEAR(fit.relative_error, 2.51e-4, 1e-6);
}

TEST(EdgeFit, ErrorsAreThoseOfLeastSquaresByHand)
{
   // Four nodes t = 1 … 4. Residuals (1, -1, -1, 1) e are orthogonal to a line; the parabola
   // that they are, ((t - 2.5)² - 1.25) e, is 5 e at t = 0, and more than the standard error
   // √(4 e²/2 · 30/20). Residuals (-1, 3, -3, 1) e are orthogonal to a parabola as well: the
   // standard error √(20 e²/2 · 30/20) is all.
   const double e = 1e-3, contrast[2][4] = {{1, -1, -1, 1}, {-1, 3, -3, 1}};
   FitSettings settings;
   settings.window = {1, 4}; // its ends are nodes, and in it
   for (int kind : {0, 1})
   {
      EdgeTractions tractions;
      for (int i = 0; i < 4; i++)
      {
         const double t = i + 1;
         tractions.position.push_back(t);
         tractions.pressure.push_back(std::sqrt(t) * (2 + 0.1 * t + contrast[kind][i] * e));
         tractions.shear.push_back((-4 + 0.1 * t + contrast[1 - kind][i] * e) / std::sqrt(t));
      }
      const EdgeFit fit = fit_edge(tractions, settings);
      const double error[] = {5 * e, std::sqrt(15.0) * e};
      EXPECT_NEAR(fit.k_n.value, 2, 1e-12);
      EXPECT_NEAR(fit.k_n.relative_error, error[kind] / 2, 1e-12);
      EXPECT_NEAR(fit.k_t.value, -4, 1e-12);
      EXPECT_NEAR(fit.k_t.relative_error, error[1 - kind] / 4, 1e-12);
   }
}

TEST(EdgeFit, RefusesBadInput)
{
   const auto expect_refused =
      [](const EdgeTractions &tractions, const FitWindow &window, const std::string &part)
   {
      FitSettings settings;
      settings.window = window;
      expect_input_error([&] { fit_edge(tractions, settings); }, part);
   };
   EdgeTractions tractions = hertz_nodes(20, -1);
   EXPECT_NO_THROW(fit_edge(tractions));
   tractions.shear.pop_back();
   expect_refused(tractions, {}, "19 shear tractions");
   expect_refused(hertz_nodes(20, 0), {}, "on the other side of the edge"); // contact on both
   tractions = hertz_nodes(20, -1);
   tractions.pressure[3] = nan_value;
   expect_refused(tractions, {}, "node 3 has");
   expect_refused(hertz_nodes(5, -1), {}, "nodes");
   expect_refused(hertz_nodes(20, -1), {0.5, 0.25}, "the window of the fit is 0.5 to 0.25");
   expect_refused(hertz_nodes(20, -1), {0.01, 0.02}, "nodes");
}

} // namespace
