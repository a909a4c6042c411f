#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/edge_fit.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>

namespace
{

using namespace cattaneo::fretting;
using cattaneo::InputError;

const double pi = std::acos(-1.0);
const double nan = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

FatigueMaterial aluminium()
{
   FatigueMaterial m;
   m.name = "aluminium";
   m.young = 74000;
   m.poisson = 0.3;
   m.threshold = 66.4;
   m.fatigue_limit = {124, 124};
   m.shear_yield = {270, 270};
   return m;
}

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

bool mentions(const FrettingReport &report, const std::string &text)
{
   for (const Validity &item : report.validity)
   {
      if (item.text.find(text) != std::string::npos) { return true; }
   }
   return false;
}

TEST(Fretting, RefusesBadInput)
{
   EXPECT_THROW(slip_zone({1, 1, 0}), InputError);
   EXPECT_THROW(slip_zone({1, 1, -0.3}), InputError);
   EXPECT_THROW(slip_zone({0, 1, 0.3}), InputError);
   EXPECT_THROW(slip_zone({1, nan, 0.3}), InputError);
   EXPECT_THROW(stress({1, 1, 0.3}, 0, -1), InputError);
   EXPECT_THROW(stress({1, 1, 0.3}, nan, 1), InputError);
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
   EXPECT_THROW(crack_factor(nan), InputError);
   EXPECT_THROW(crack_intensity({1, 1, 0.3}, -1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0, 1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 0), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 1, 1), InputError);
   EXPECT_THROW(threshold_ordinate(Criterion::open, 0.3, 1, -2), InputError);
   EXPECT_THROW(assess_threshold({{1, 1, 0.3}}, 0, 1), InputError);
   EXPECT_THROW(slip_energy_max(-1, 1), InputError);
   EXPECT_THROW(slip_energy_max(1, 0), InputError);
   EXPECT_THROW(hertz_slip_energy(0.3, 1, 1.01, 1), InputError);
}

TEST(Fretting, FrictionlessEdgeIsRefusedWithTheReason)
{
   try
   {
      slip_zone({1, 1, 0});
      FAIL();
   }
   catch (const InputError &error)
   {
      EXPECT_NE(std::string(error.what()).find("without friction nothing sticks"),
                std::string::npos);
   }
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

TEST(FatigueMaterial, FilesAreReadOrRefusedWithTheKey)
{
   const std::string file = testing::TempDir() + "cattaneo_materials.json";
   const auto read = [&](const std::string &text)
   {
      std::ofstream(file) << text;
      return read_materials(file);
   };
   const auto record = [](const std::string &extra)
   {
      return R"({"materials": [{"name": "mine", "young_GPa": 100, "poisson": 0.3,
         "threshold_MPa_sqrt_m": 3, "fatigue_limit_MPa": [200, 250])" +
             extra + "}]}";
   };
   const auto materials = read(record(R"(, "shear_yield_MPa": 400)"));
   EXPECT_DOUBLE_EQ(find_material(materials, "MINE").young, 1e5);
   EXPECT_DOUBLE_EQ(find_material(materials, "mine").fatigue_limit.low, 200);
   EXPECT_DOUBLE_EQ(find_material(materials, "mine").shear_yield.high, 400);
   EXPECT_THROW(find_material(materials, "other"), InputError);
   for (const std::string &text :
        {std::string("not json"), std::string("{}"), std::string(R"({"materials": []})"),
         std::string(R"({"materials": [3]})"), record(""),
         record(R"(, "shear_yield_MPa": "high")"), record(R"(, "shear_yield_MPa": [500, 400])"),
         record(R"(, "shear_yield_MPa": [1, 2, 3])"), record(R"(, "shear_yield_MPa": -1)"),
         record(R"(, "shear_yield_MPa": 400, "threshold_basis": "amplitude")"),
         record(R"(, "shear_yield_MPa": 400, "threshold_basis": "peak")"),
         record(R"(, "shear_yield_MPa": 400, "stress_ratio": 1)")})
   {
      EXPECT_THROW(read(text), InputError) << text;
   }
   try
   {
      read(record(""));
   }
   catch (const InputError &error)
   {
      EXPECT_NE(std::string(error.what()).find("(mine) has no \"shear_yield_MPa\""),
                std::string::npos)
         << error.what();
   }
   std::remove(file.c_str());
   EXPECT_THROW(read_materials(file), InputError);
}

TEST(Assessment, SmallLoadIsTrustedAndArrests)
{
   const FrettingReport report = assess(hertz_problem(0.02));
   EXPECT_EQ(report.threshold.verdict, Verdict::arrests);
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
   EXPECT_EQ(none.threshold.verdict, Verdict::arrests);
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
   // Of 18 nodes every other one is a tenth too high.
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

TEST(EdgeFit, RefusesBadInput)
{
   const auto expect_refused =
      [](const EdgeTractions &tractions, const FitWindow &window, const std::string &part)
   {
      FitSettings settings;
      settings.window = window;
      try
      {
         fit_edge(tractions, settings);
         ADD_FAILURE() << "not refused: " << part;
      }
      catch (const InputError &error)
      {
         const std::string message = error.what();
         EXPECT_NE(message.find(part), std::string::npos) << message;
      }
   };
   EdgeTractions tractions = hertz_nodes(20, -1);
   EXPECT_NO_THROW(fit_edge(tractions));
   tractions.shear.pop_back();
   expect_refused(tractions, {}, "19 shear tractions");
   expect_refused(hertz_nodes(20, 0), {}, "on the other side of the edge"); // contact on both
   tractions = hertz_nodes(20, -1);
   tractions.pressure[3] = nan;
   expect_refused(tractions, {}, "node 3 has");
   expect_refused(hertz_nodes(5, -1), {}, "nodes");
   expect_refused(hertz_nodes(20, -1), {0.5, 0.25}, "the window of the fit is 0.5 to 0.25");
   expect_refused(hertz_nodes(20, -1), {0.01, 0.02}, "nodes");
}

} // namespace
