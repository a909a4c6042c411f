#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "fretting_problems.hpp"

#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/edge_fit.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

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

/// A function of numbers, which it takes, and what each must be: positive (+), not negative (0)
/// or finite (f); infinity is a limit of (i).
struct Formula
{
   const char *name, *kinds;
   std::vector<double> good;
   std::function<void(const std::vector<double> &)> call;
};

TEST(Fretting, EachNumberOfEachFormulaIsChecked)
{
   using Numbers = const std::vector<double> &;
   const std::vector<Formula> formulas = {
      {"contact_modulus", "+", {1}, [](Numbers x) { contact_modulus(x[0], 0.3); }},
      {"hertz_contact", "+++", {1, 1, 1}, [](Numbers x) { hertz_contact(x[0], x[1], x[2]); }},
      {"hertz_k_n", "++", {1, 1}, [](Numbers x) { hertz_k_n(x[0], x[1]); }},
      {"flat_rounded_contact",
       "++0+",
       {1, 1, 1, 1},
       [](Numbers x) { flat_rounded_contact(x[0], x[1], x[2], x[3]); }},
      {"rounded_edge", "+++", {1, 1, 1}, [](Numbers x) { rounded_edge(x[0], x[1], x[2]); }},
      {"symmetric_k_n", "++", {1, 1}, [](Numbers x) { symmetric_k_n(x[0], x[1]); }},
      {"edge_gradient", "++", {1, 1}, [](Numbers x) { edge_gradient(x[0], x[1]); }},
      {"shear_intensities",
       "+ff",
       {1, 1, 1},
       [](Numbers x) { shear_intensities(x[0], x[1], x[2]); }},
      {"slip_zone",
       "+f+",
       {1, 1, 0.3},
       [](Numbers x) {
          slip_zone({x[0], x[1], x[2]});
       }},
      {"stress",
       "f0",
       {1, 1},
       [](Numbers x) {
          stress({1, 1, 0.3}, x[0], x[1]);
       }},
      {"crack_factor", "i", {1}, [](Numbers x) { crack_factor(x[0]); }},
      {"crack_intensity",
       "0",
       {1},
       [](Numbers x) {
          crack_intensity({1, 1, 0.3}, x[0]);
       }},
      {"crack_intensity_range",
       "00",
       {1, 1},
       [](Numbers x) {
          crack_intensity_range({1, 1, 0.3}, x[0], x[1]);
       }},
      {"reversed_slip_zone",
       "0",
       {1},
       [](Numbers x) {
          reversed_slip_zone({1, 1, 0.3}, x[0]);
       }},
      {"edge_stress_range",
       "0",
       {1},
       [](Numbers x) {
          edge_stress_range({1, 1, 0.3}, x[0]);
       }},
      {"mode_two_range", "0", {1}, [](Numbers x) { mode_two_range(x[0]); }},
      {"slip_energy_density",
       "0+",
       {1, 1},
       [](Numbers x) {
          slip_energy_density({1, 1, 0.3}, x[0], x[1], 0.1);
       }},
      {"slip_energy_max", "0+", {1, 1}, [](Numbers x) { slip_energy_max(x[0], x[1]); }},
      {"slip_energy_total",
       "0+",
       {1, 1},
       [](Numbers x) {
          slip_energy_total({1, 1, 0.3}, x[0], x[1]);
       }},
      {"hertz_slip_energy",
       "++0+",
       {0.3, 1, 0.5, 1},
       [](Numbers x) { hertz_slip_energy(x[0], x[1], x[2], x[3]); }},
      {"threshold_ordinate",
       "++f",
       {0.3, 1, 0},
       [](Numbers x) { threshold_ordinate(Criterion::open, x[0], x[1], x[2]); }},
      {"assess_threshold",
       "++",
       {1, 1},
       [](Numbers x) {
          assess_threshold({{1, 1, 0.3}}, x[0], x[1]);
       }},
      {"surface_von_mises", "+", {0.3}, [](Numbers x) { surface_von_mises(x[0], 0.3, 0.5); }},
      {"first_yield_load", "+", {0.3}, [](Numbers x) { first_yield_load(x[0], 0.3); }},
      {"full_yield_load", "+", {0.3}, [](Numbers x) { full_yield_load(x[0]); }},
      {"power_law_factor", "f", {0.5}, [](Numbers x) { power_law_factor(x[0]); }},
   };
   for (const Formula &formula : formulas)
   {
      EXPECT_NO_THROW(formula.call(formula.good)) << formula.name;
      for (std::size_t k = 0; k < formula.good.size(); ++k)
      {
         const char kind = formula.kinds[k];
         std::vector<double> bad = {nan_value, -infinity};
         if (kind != 'i') { bad.push_back(infinity); }
         if (kind != 'f') { bad.push_back(-1); }
         if (kind == '+') { bad.push_back(0); }
         else if (kind == '0')
         {
            std::vector<double> zero = formula.good;
            zero[k] = 0;
            EXPECT_NO_THROW(formula.call(zero)) << formula.name << " argument " << k;
         }
         for (double x : bad)
         {
            std::vector<double> numbers = formula.good;
            numbers[k] = x;
            EXPECT_THROW(formula.call(numbers), InputError)
               << formula.name << " argument " << k << " = " << x;
         }
      }
   }
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
   expect_input_error([&] { read(record("").insert(15, R"({"name": 3}, )")); }, "record 1");
   expect_input_error([&] { read(record(R"(, "shear_yield_MPa": 400}, {"name": 3)")); },
                      "record 2: \"name\" must be a text");
   expect_input_error([&] { read(record("")); }, "(mine) has no \"shear_yield_MPa\"");
   expect_input_error([&] { read(record(R"(, "shear_yield_MPa": 1, "poisson": 0.2)")); },
                      "key 'poisson' is there twice");
   std::remove(file.c_str());
   EXPECT_THROW(read_materials(file), InputError);
}

TEST(FatigueMaterial, EveryFieldIsReadInItsUnit)
{
   const std::string file = testing::TempDir() + "cattaneo_material_fields.json";
   std::ofstream(file) << R"({"materials": [
      {"name": "first", "young_GPa": 100, "poisson": 0.25, "threshold_MPa_sqrt_m": 2,
       "fatigue_limit_MPa": [200, 250], "shear_yield_MPa": [300, 360], "friction": [0.5, 0.75],
       "stress_ratio": 0.1, "threshold_basis": "amplitude", "fatigue_limit_basis": "amplitude",
       "source": "made up"},
      {"name": "Second", "young_GPa": 70.5, "poisson": 0.3, "threshold_MPa_sqrt_m": 3,
       "fatigue_limit_MPa": 90, "shear_yield_MPa": 150}]})";
   const std::vector<FatigueMaterial> materials = read_materials(file);
   ASSERT_EQ(materials.size(), 2u);
   const FatigueMaterial &m = materials[0], &plain = find_material(materials, "SECOND");
   EXPECT_EQ(m.name, "first");
   EXPECT_DOUBLE_EQ(m.young, 100000);
   EXPECT_EQ(m.poisson, 0.25);
   EXPECT_NEAR(m.threshold, 2 * std::sqrt(1000.0), 1e-12); // 1 m = 1000 mm
   EXPECT_EQ(m.fatigue_limit.low, 200);
   EXPECT_EQ(m.fatigue_limit.high, 250);
   EXPECT_EQ(m.fatigue_limit.middle(), 225);
   EXPECT_EQ(m.shear_yield.low, 300);
   EXPECT_EQ(m.shear_yield.high, 360);
   EXPECT_EQ(m.friction.low, 0.5);
   EXPECT_EQ(m.friction.high, 0.75);
   EXPECT_EQ(m.threshold_ratio, 0.1);
   EXPECT_EQ(m.threshold_basis, Basis::amplitude);
   EXPECT_EQ(m.fatigue_limit_basis, Basis::amplitude);
   EXPECT_EQ(plain.name, "Second");
   EXPECT_DOUBLE_EQ(plain.young, 70500);
   EXPECT_EQ(plain.fatigue_limit.low, 90);
   EXPECT_EQ(plain.fatigue_limit.high, 90);
   EXPECT_EQ(plain.friction.high, 0);
   EXPECT_EQ(plain.threshold_ratio, -1);
   EXPECT_EQ(plain.threshold_basis, Basis::range);
   // The low end decides: (ΔK_th/σ_fl)²/π.
   EXPECT_NEAR(critical_length(m), 4000 / (200.0 * 200 * pi), 1e-15);
   std::remove(file.c_str());
   const auto refused =
      [](const std::string &said, const std::function<void(FatigueMaterial &)> &spoil)
   {
      FatigueMaterial bad = aluminium();
      spoil(bad);
      expect_input_error([&] { bad.validate(); }, said);
   };
   refused("Young's modulus is 0", [](auto &b) { b.young = 0; });
   refused("Young's modulus is inf", [](auto &b) { b.young = infinity; });
   refused("Poisson's ratio is 0.5", [](auto &b) { b.poisson = 0.5; });
   refused("ΔK_th is 0", [](auto &b) { b.threshold = 0; });
   refused("the fatigue limit is 0 to 1", [](auto &b) { b.fatigue_limit = {0, 1}; });
   refused("the fatigue limit is 2 to 1", [](auto &b) { b.fatigue_limit = {2, 1}; });
   refused("the shear yield stress is 2 to 1", [](auto &b) { b.shear_yield = {2, 1}; });
   refused("the friction coefficient is 0.75 to 0.5",
           [](auto &b) {
              b.friction = {0.75, 0.5};
           });
   refused("the friction coefficient is 0 to 0.5", [](auto &b) { b.friction = {0, 0.5}; });
   refused("load ratio of the threshold is -1.5", [](auto &b) { b.threshold_ratio = -1.5; });
   refused("load ratio of the threshold is 1;", [](auto &b) { b.threshold_ratio = 1; });
   refused("ΔK_th is given as an amplitude but the fatigue limit as a range",
           [](auto &b) { b.threshold_basis = Basis::amplitude; });
   refused("ΔK_th is given as a range but the fatigue limit as an amplitude",
           [](auto &b) { b.fatigue_limit_basis = Basis::amplitude; });
}

TEST(Assessment, TrustTurnsWhereItIsSaidTo)
{
   const auto report = [](const std::function<void(FrettingProblem &)> &change)
   {
      FrettingProblem problem = round_numbers();
      change(problem);
      return assess(problem);
   };
   const auto whole = [&](double a)
   { return report([a](FrettingProblem &p) { p.half_width = p.rounded_width = a; }); };
   // d = 0.5: small below a tenth of the contact, no longer from a quarter on.
   EXPECT_EQ(measure(whole(5.1), "d/a").trust, Trust::good);
   EXPECT_EQ(measure(whole(4.9), "d/a").trust, Trust::caution);
   EXPECT_EQ(measure(whole(2.1), "d/a").trust, Trust::caution);
   EXPECT_EQ(measure(whole(1.9), "d/a").trust, Trust::poor);
   EXPECT_EQ(whole(5.1).trust, Trust::good);
   EXPECT_EQ(whole(4.9).trust, Trust::caution);
   EXPECT_EQ(whole(1.9).trust, Trust::poor);
   // a0 = 0.04, against the contact where no part of it is rounded, or that is not known.
   EXPECT_NEAR(measure(whole(8), "a0/a").value, 0.005, 1e-15);
   const FrettingReport flat = report([](FrettingProblem &p) { p.rounded_width = 0; });
   EXPECT_NEAR(measure(flat, "a0/a").value, 0.004, 1e-15);
   for (const Validity &item : flat.validity) { EXPECT_NE(item.measure, "d/(a-b)"); }
   const auto rounded = [&](double width)
   {
      return report(
         [width](FrettingProblem &p)
         {
            p.crack.edge.k_t = 0.006; // d = 0.01
            p.rounded_width = width;
         });
   };
   EXPECT_EQ(measure(rounded(0.41), "a0/(a-b)").trust, Trust::good);
   EXPECT_EQ(measure(rounded(0.39), "a0/(a-b)").trust, Trust::caution);
   EXPECT_EQ(measure(rounded(0.17), "a0/(a-b)").trust, Trust::caution);
   EXPECT_EQ(measure(rounded(0.15), "a0/(a-b)").trust, Trust::poor);
   EXPECT_EQ(measure(rounded(0.11), "d/(a-b)").trust, Trust::good);
   EXPECT_EQ(measure(rounded(0.09), "d/(a-b)").trust, Trust::caution);
   EXPECT_EQ(measure(rounded(0.039), "d/(a-b)").trust, Trust::poor);
   // K_N√d = √2; first yield at 1.5554 k, the whole zone at 1.6667 k.
   const auto yields = [&](double k) {
      return report([k](FrettingProblem &p) { p.material.shear_yield = {k, 100}; });
   };
   EXPECT_EQ(measure(yields(0.92), "load/first yield").trust, Trust::good);
   EXPECT_EQ(measure(yields(0.90), "load/first yield").trust, Trust::caution);
   EXPECT_EQ(measure(yields(0.86), "load/first yield").trust, Trust::caution);
   EXPECT_EQ(measure(yields(0.84), "load/first yield").trust, Trust::poor);
   EXPECT_TRUE(mentions(yields(0.90), "Part of the slip zone yields"));
   EXPECT_TRUE(mentions(yields(0.84), "The whole slip zone yields"));
   // a0/d: friction matters between a tenth and ten.
   const auto shear = [&](double k_t)
   { return report([k_t](FrettingProblem &p) { p.crack.edge.k_t = k_t; }); };
   EXPECT_TRUE(mentions(shear(0.25), "much shorter than the slip zone"));
   EXPECT_TRUE(mentions(shear(0.23), "of similar size: friction matters"));
   EXPECT_TRUE(mentions(shear(0.0025), "of similar size: friction matters"));
   EXPECT_TRUE(mentions(shear(0.0023), "much longer than the slip zone"));
   // Strengths of a load ratio of up to 0.1 more or less count as of this one.
   const auto measured = [&](double ratio)
   { return report([ratio](FrettingProblem &p) { p.material.threshold_ratio = ratio; }); };
   for (const double off : {-0.09, 0.0, 0.09})
   {
      EXPECT_FALSE(mentions(measured(0.5 + off), "another load ratio")) << off;
   }
   for (const double off : {-0.11, 0.11})
   {
      EXPECT_EQ(measure(measured(0.5 + off), "R").trust, Trust::caution) << off;
   }
   EXPECT_EQ(to_string(Trust::good), "good");
   EXPECT_EQ(to_string(Trust::caution), "caution");
   EXPECT_EQ(to_string(Trust::poor), "not to be trusted");
   // What is left out is said, what is included too.
   EXPECT_TRUE(
      mentions(assess(round_numbers()), "grows with depth below the edge is included"));
   EXPECT_TRUE(mentions(report([](FrettingProblem &p) { p.crack.stress_gradient = 0; }),
                        "is left out of K_I: unconservative, by"));
   for (double FrettingProblem::*size :
        {&FrettingProblem::half_width, &FrettingProblem::rounded_width})
   {
      for (const double bad : {-1.0, nan_value, infinity})
      {
         EXPECT_THROW(report([=](FrettingProblem &p) { p.*size = bad; }), InputError);
      }
   }
}

} // namespace
