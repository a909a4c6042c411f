#include "run_miniapp.hpp"
#include <extent.hpp>

#include <cmath>
#include <cstdlib>

namespace
{

using Result = cattaneo_test::Run;
using cattaneo_test::extent;
using cattaneo_test::Extent;
using cattaneo_test::meshes;
using cattaneo_test::number;
using cattaneo_test::run_miniapp;

/// A steady cycle of the lap joint: border of the nodes that slip at all within it, from an
/// independent program with a far finer mesh (the studies' notes, C).
struct SteadyBorder
{
   const char *load;
   double c, spread;
};

/// At a reload peak the nodes between the first and the steady border lie on the friction limit
/// and do not slip: their states are ties, which once made c/t 0.6308 with 40 increments and
/// 0.6501 with 41.
TEST(ReadOut, SteadyStickOfTheLapJointDependsOnMechanicsAlone)
{
   for (const SteadyBorder &reference : {SteadyBorder{"-friction 0.2 -load 0.04", 0.5809, 5e-5},
                                         {"-friction 0.5 -load -0.04", 0.6685, 5e-5},
                                         {"-friction 0.8 -load 0.01", 0.685, 5e-4},
                                         {"-friction 0.8 -load 0.03", 0.6605, 5e-5},
                                         {"-friction 0.8 -load 0.04", 0.650, 5e-4}})
   {
      for (const double spacing : meshes({0.02, 0.01}, {0.005}))
      {
         double first = std::nan("");
         for (const char *increments : {"20", "", "40", "41", "80"})
         {
            const bool exact = increments[0] == 0;
            // The finer meshes take most of the time: all of them in ./test --all.
            if (extent() != Extent::full && spacing < 0.02 && increments[0] > '2') { continue; }
            const std::string options =
               std::string(reference.load) + " -spacing " + std::to_string(spacing) +
               (exact ? "" : std::string(" -stepping fixed -increments ") + increments);
            SCOPED_TRACE(options);
            const Result run = run_miniapp("lap_joint", options);
            ASSERT_EQ(run.code, 0) << run.output;
            const double c = run.results["c_steady"],
                         error = run.results["c_steady_error_estimate"];
            // The error that is printed bounds the difference, and is no more than a spacing.
            EXPECT_LE(std::abs(c - reference.c), error + reference.spread);
            EXPECT_LE(error, spacing * (1 + 1e-9));
            if (std::isnan(first)) { first = c; }
            EXPECT_NEAR(c, first, 0.01 * spacing) << "whatever the increments";
         }
      }
   }
}

TEST(ReadOut, EdgesOfTheLapJointAreWithinTheirErrors)
{
   // Frictionless extents and the first stick zone: the notes' values.
   for (const char *spacing : meshes({"0.04", "0.02", "0.01"}, {"0.005"}))
   {
      const double h = std::stod(spacing);
      for (const bool pulled : {true, false})
      {
         const Result run = run_miniapp("lap_joint", std::string(pulled ? "" : "-load -0.04 ") +
                                                        "-increments 20 -spacing " + spacing);
         ASSERT_EQ(run.code, 0) << run.output;
         const auto check = [&](const char *key, double value, double spread)
         {
            const double error = run.results[std::string(key) + "_error_estimate"];
            EXPECT_LE(std::abs(run.results[key].get<double>() - value), error + spread)
               << key << " at spacing " << spacing;
            EXPECT_LE(error, h * (1 + 1e-9)) << key << " at spacing " << spacing;
         };
         check("a0", 0.7011, 0.0005);
         check("a", pulled ? 0.6596 : 0.763, pulled ? 0.0005 : 0.001);
         if (pulled) { check("c_first", 0.760 * 0.6596, 0.0005); }
      }
   }
}

/// Intensities at the edges, fitted over a window that is chosen, against the finest mesh's.
TEST(ReadOut, IntensitiesOfTheLapJointAreWithinTheirErrors)
{
   const auto intensities = [](const char *spacing)
   {
      const Result run =
         run_miniapp("lap_joint", std::string("-friction 0.4 -spacing ") + spacing);
      EXPECT_EQ(run.code, 0) << run.output;
      return run.results["edges"].back();
   };
   const auto finest = intensities(extent() == Extent::full ? "0.0025" : "0.005");
   for (const char *spacing : meshes({"0.04", "0.02", "0.01"}, {"0.005"}))
   {
      const auto edge = intensities(spacing);
      for (const char *key : {"k_n", "k_t"})
      {
         const double value = edge[key]["value"], best = finest[key]["value"],
                      error = edge[key]["relative_error_estimate"],
                      left = finest[key]["relative_error_estimate"];
         EXPECT_LE(std::abs(value - best), error * std::abs(value) + left * std::abs(best))
            << key << " at spacing " << spacing;
      }
   }
}

TEST(ReadOut, EdgesOfTheStripAreWithinTheirErrors)
{
   // On a block of 1e4 t, n = 4 (± 0.003).
   struct
   {
      const char *friction;
      double s, e;
   } const references[] = {{"0.3", 0.903, -1.858},
                           {"0.5", 1.169, -0.883},
                           {"0.7", 1.406, -0.442},
                           {"1", 1.730, -0.046}};
   for (const auto &row : references)
   {
      for (const char *spacing : meshes({"0.08", "0.04"}, {"0.02"}))
      {
         const Result run =
            run_miniapp("plane_receding", std::string("-domain 1e4 -corner 0.005 -friction ") +
                                             row.friction + " -spacing " + spacing);
         ASSERT_EQ(run.code, 0) << run.output;
         SCOPED_TRACE(run.output);
         const double h = std::stod(spacing),
                      s_error = run.results["separation_error_estimate"],
                      e_error = run.results["stick_slip_error_estimate"];
         EXPECT_LE(std::abs(number(run.results["separation"]) - row.s), s_error + 0.003);
         EXPECT_LE(std::abs(number(run.results["stick_slip"]) - row.e), e_error + 0.003);
         EXPECT_LE(std::max(s_error, e_error), h * (1 + 1e-9));
      }
   }
}

TEST(ReadOut, EdgesOfTheDiscAreWithinTheirErrors)
{
   struct
   {
      const char *load;
      double d, c;
   } const references[] = {{"-load-radius 0.5 -friction 0.9", 2.625, 0.849},
                           {"-load-radius 2.5 -friction 0.5", 3.728, 1.879},
                           {"-load-radius 2.5 -friction 0.8", 4.046, 2.384}};
   for (const auto &row : references)
   {
      for (const char *spacing : meshes({"0.1", "0.05"}, {"0.025"}))
      {
         const Result run =
            run_miniapp("axisymmetric_receding",
                        std::string(row.load) + " -domain 100 -spacing " + spacing);
         ASSERT_EQ(run.code, 0) << run.output;
         SCOPED_TRACE(run.output);
         const double h = std::stod(spacing),
                      d_error = run.results["separation_error_estimate"],
                      c_error = run.results["stick_error_estimate"];
         EXPECT_LE(std::abs(number(run.results["separation"]) - row.d), d_error + 0.001);
         EXPECT_LE(std::abs(number(run.results["stick"]) - row.c), c_error + 0.001);
         EXPECT_LE(std::max(d_error, c_error), h * (1 + 1e-9));
      }
   }
}

TEST(ReadOut, HalfWidthsOfHertzAreWithinTheirErrors)
{
   for (const char *nodes : meshes({"41", "65", "101"}, {"161"}))
   {
      const Result run = run_miniapp("hertz", std::string("-nodes ") + nodes);
      ASSERT_EQ(run.code, 0) << run.output;
      const double error = run.results["half_width_error_estimate"],
                   h = 3.34 / (std::stod(nodes) - 1);
      EXPECT_LE(std::abs(run.results["half_width"].get<double>() - 1), error) << nodes;
      EXPECT_LE(error, h);
   }
}

/// Loads whose numbers look alike in six digits are two loads, each of its own size.
TEST(ReadOut, LoadsThatLookAlikeAreNotAdded)
{
   const Result disc =
      run_miniapp("axisymmetric_receding", "-spacing 0.1 -bonded '2.1 2.1000001 4.2'");
   ASSERT_EQ(disc.code, 0) << disc.output;
   const auto &bonded = disc.results["bonded"];
   ASSERT_EQ(bonded.size(), 3u);
   const double alone = run_miniapp("axisymmetric_receding", "-spacing 0.1 -bonded 2.1")
                           .results["bonded"][0]["lowest_pressure"];
   for (int k : {0, 1})
   {
      EXPECT_NEAR(bonded[k]["lowest_pressure"].get<double>(), alone, 1e-4 * alone);
   }
   const Result strip = run_miniapp(
      "plane_receding", "-map '4 4.0000001' -map-friction 0.7 -spacing 0.1 -corner 0.02");
   ASSERT_EQ(strip.code, 0) << strip.output;
   // The bonded ratio does not depend on the size of the load, its strength does.
   EXPECT_NEAR(strip.results["lowest_bonded_pressure"].get<double>(),
               run_miniapp("plane_receding", "-spacing 0.1 -corner 0.02")
                  .results["lowest_bonded_pressure"]
                  .get<double>(),
               1e-9);
   const Result joint = run_miniapp(
      "lap_joint", "-sweep-load 0.02 -sweep-width '1 1.0000001' -spacing 0.05 -increments 10");
   ASSERT_EQ(joint.code, 0) << joint.output;
   for (const auto &row : joint.results["sweep"])
   {
      EXPECT_NEAR(row["a0"].get<double>(), joint.results["a0"].get<double>(), 1e-5);
   }
   EXPECT_NEAR(joint.results["peak_pressure"].get<double>(), 1.0468, 0.01);
}

/// What a study did, whatever it is: tangential unknowns are one a contact node and component
/// with friction, none without; the friction solver worked.
TEST(ReadOut, EveryStudyCountsItsFrictionProblem)
{
   struct
   {
      const char *name, *options;
      int components;
      bool meshed = true;
   } const studies[] = {
      {"lap_joint", "-spacing 0.05 -increments 5", 1},
      {"lap_joint", "-spacing 0.05 -increments 5 -bolts '-1.2 0 1.2' -touch", 1},
      {"lap_joint", "-spacing 0.05 -increments 5 -sweep-load 0.02 -sweep-friction '0.2 0.4'",
       1},
      {"plane_receding", "-spacing 0.1 -corner 0.02", 1},
      {"plane_receding", "-spacing 0.1 -corner 0.02 -map '2 3' -unload 0.5 -steps 5", 1},
      {"axisymmetric_receding", "-spacing 0.1 -map '1 2'", 1},
      {"axisymmetric_receding", "-spacing 0.1 -friction 0", 0},
      {"axisymmetric_receding", "-spacing 0.1 -steps 10 -torque 0.3", 2},
      {"square_punch", "-nodes 33", 1},
      {"square_punch", "-nodes 33 -friction 0 -shear none", 0},
      {"hertz", "-nodes 33", 1, false},
      {"contact", "-case meshes/rounded_punch.json --cycles 1", 1}};
   for (const auto &study : studies)
   {
      const Result run = run_miniapp(study.name, study.options);
      SCOPED_TRACE(std::string(study.name) + " " + study.options);
      ASSERT_EQ(run.code, 0) << run.output;
      const auto &counters = run.results["counters"];
      EXPECT_EQ(counters["tangential_unknowns"].get<long>(),
                study.components * run.results["contact_nodes"].get<long>());
      EXPECT_GT(counters["increments"].get<long>(), 0);
      EXPECT_GT(counters["newton_steps"].get<long>(), 0);
      EXPECT_GT(counters["dense_factorisations"].get<long>(), 0);
      // Half-planes without a mesh have nothing to solve for.
      EXPECT_EQ(counters["back_substitutions"].get<long>() > 0, study.meshed);
   }
   const Result fretting = run_miniapp("fretting", "-p fe -f 0.6 -m Ti6Al4V -nodes 41");
   ASSERT_EQ(fretting.code, 0) << fretting.output;
   EXPECT_EQ(fretting.results["fe"]["counters"]["tangential_unknowns"], 41);
}

} // namespace
