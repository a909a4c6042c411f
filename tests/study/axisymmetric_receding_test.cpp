#include "run_miniapp.hpp"

#include <cmath>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using Result = cattaneo_test::Run;
using cattaneo_test::number;
using cattaneo_test::run_miniapp;

// The studies' notes, part D; sub-grid read-out ±0.001, and a tenth of the spacing, 0.02 t.
const double spread = 0.001, read_out = 0.002;

Result run(const std::string &options)
{
   return run_miniapp("axisymmetric_receding", options);
}

TEST(AxisymmetricReceding, LoadedTwistedAndBondedDiscMeetsTheReferences)
{
   const auto result = run("-torque '0.3 0.5 0.7' -bonded '2.1 3.75 4.25 4.7'");
   expect_values(result, {{"d/t, loaded, a = 2.5, f = 0.5", 3.728, spread, read_out},
                          {"c/t, loaded, a = 2.5, f = 0.5", 1.879, spread, read_out},
                          // Four digits, at nodes: no read-out.
                          {"bonded, a = 2.1: p/p0 at r/t = 0.5", 0.9088, 5e-5, 4e-4},
                          {"bonded, a = 2.1: p/p0 at r/t = 1", 0.8618, 5e-5, 4e-4},
                          {"bonded, a = 2.1: p/p0 at r/t = 2", 0.4829, 5e-5, 4e-4},
                          {"bonded, a = 2.1: p/p0 at r/t = 3", 0.07621, 5e-6, 4e-4},
                          {"bonded, a = 2.1: p/p0 at r/t = 4", 0.01505, 5e-6, 4e-4},
                          // A quotient at the rim, where both tractions are small.
                          {"f for full adhesion, a = 3.75", 1.69, 0.005, 0.01},
                          {"f for full adhesion, a = 4.25", 1.07, 0.005, 0.006},
                          {"f for full adhesion, a = 4.7", 0.600, 5e-4, 0.004},
                          {"T_s/(p0 t³)", 17.106, 0.001, 0.004},
                          {"d/t without friction", 3.1705, 5e-5, read_out},
                          // Of the first order in the steps, of which there are 80.
                          {"c/t at T/T_s = 0.3", 1.829, 0.003, read_out},
                          {"d/t at T/T_s = 0.3", 3.617, 0.003, read_out},
                          {"c/t at T/T_s = 0.7", 1.564, 0.003, read_out},
                          {"d/t at T/T_s = 0.7", 3.431, 0.003, read_out},
                          {"slip angle at 10 %, rate, °", 14, 1, 0},
                          {"slip angle at 10 %, total, °", 8, 1, 0},
                          {"slip angle at 50 %, rate, °", 49, 1, 0},
                          {"slip angle at 50 %, total, °", 13, 1, 0},
                          {"slip angle at 90 %, rate, °", 77, 1, 0},
                          {"slip angle at 90 %, total, °", 37, 1, 0},
                          {"T_max/T_s", 1.0037, 5e-5, 4e-4}});
   EXPECT_EQ(result.results["status"], "converged");
   EXPECT_GT(result.results["torque_max"], result.results["torque_limit"]);
   // Coupling: d recedes as the torque grows, and slip eats the stick zone.
   double d = result.results["separation"], c = result.results["stick"];
   for (const auto &row : result.results["torsion"])
   {
      EXPECT_LT(number(row["separation"]), d);
      EXPECT_LT(number(row["stick"]), c);
      d = row["separation"];
      c = row["stick"];
   }
}

TEST(AxisymmetricReceding, NarrowLoadMeetsTheReferences)
{
   expect_values(run("-load-radius 0.5 -friction 0.9"),
                 {{"d/t, loaded, a = 0.5, f = 0.9", 2.625, spread, read_out},
                  {"c/t, loaded, a = 0.5, f = 0.9", 0.849, 5e-4, read_out}});
}

TEST(AxisymmetricReceding, CyclesOfTheLoadBeginAsUnloadingDoes)
{
   const std::string prefix = testing::TempDir() + "cattaneo_disc_cycles";
   const auto result =
      run("-cycle-to '0.5 0.9' -load-cycles 12 -steps 40 -spacing 0.04 -csv '" + prefix + "'");
   ASSERT_EQ(result.code, 0) << result.output;
   // Borders at half of the load, and the separation at all of it: studies' notes D.
   std::vector<double> half, full;
   std::ifstream in(prefix + "_load_cycle_zones.csv");
   for (std::string line; std::getline(in, line);)
   {
      const double time = std::atof(line.c_str()),
                   to = std::atof(line.substr(line.rfind(',') + 1).c_str());
      if (std::isdigit(static_cast<unsigned char>(line[0])) == 0) { continue; }
      if (std::abs(time - 1) < 1e-9) { half.push_back(to); }
      if (time == 0) { full.push_back(to); }
   }
   const double unloaded[] = {1.715, 2.415, 3.015, 3.402, 5}, loaded[] = {1.879, 3.728, 5};
   ASSERT_EQ(half.size(), 5u);
   ASSERT_EQ(full.size(), 3u);
   for (int k = 0; k < 5; ++k) { EXPECT_NEAR(half[k], unloaded[k], 0.01 + 2 * read_out) << k; }
   for (int k = 0; k < 3; ++k) { EXPECT_NEAR(full[k], loaded[k], spread + 2 * read_out) << k; }
   // Whatever makes the contact recede further makes its edge slip, the first time the most.
   const auto &cycles = result.results["load_cycles"];
   ASSERT_EQ(cycles.size(), 2u);
   for (const auto &row : cycles)
   {
      EXPECT_GT(row["opening"], 0);
      EXPECT_GT(row["last_loss"], 0);
      EXPECT_LT(row["last_loss"], row["first_loss"]);
   }
   EXPECT_LT(cycles[1]["last_loss"], cycles[0]["last_loss"]);
   for (const char *panel : {"zones", "tractions"})
   {
      std::remove((prefix + "_load_cycle_" + panel + ".csv").c_str());
   }
}

TEST(AxisymmetricReceding, UnloadingMeetsTheReferencesWhateverTheSteps)
{
   // 1 - 40/80 is not 0.5 to the last bit: that must not become a step of its own.
   for (const char *steps : {"40", "80"})
   {
      const auto result = run(std::string("-unload '0.9 0.5 0.3' -steps ") + steps);
      // Borders of unloading: ±0.01, separation to its digits.
      expect_values(result, {{"d/t, loaded, a = 2.5, f = 0.5", 3.728, spread, read_out},
                             {"c/t, loaded, a = 2.5, f = 0.5", 1.879, spread, read_out},
                             {"d/t at P/P0 = 0.9", 3.670, spread, read_out},
                             {"d/t at P/P0 = 0.3", 3.254, spread, read_out},
                             {"border 1 at P/P0 = 0.5", 1.715, 0.01, read_out},
                             {"border 2 at P/P0 = 0.5", 2.415, 0.01, read_out},
                             {"border 3 at P/P0 = 0.5", 3.015, 0.01, read_out},
                             {"border 4 at P/P0 = 0.5", 3.402, 0.01, read_out}});
      double d = result.results["separation"];
      for (const auto &row : result.results["unloading"])
      {
         EXPECT_EQ(row["zones"].size(), 5u) << row;
         EXPECT_LT(number(row["separation"]), d);
         d = row["separation"];
      }
   }
}

TEST(AxisymmetricReceding, WhatDoesNotTwistHasNoCircumferentialUnknowns)
{
   const std::string mesh = "-spacing 0.1 ";
   const auto smooth = run(mesh + "-friction 0"), rough = run(mesh),
              twisted = run(mesh + "-torque 0.5 -steps 10");
   for (const Result *one : {&smooth, &rough, &twisted})
   {
      ASSERT_EQ(one->code, 0) << one->output;
   }
   const long nodes = rough.results["contact_nodes"];
   auto count = [](const Result &one, const char *name)
   { return one.results["counters"][name].get<long>(); };
   EXPECT_EQ(count(smooth, "tangential_unknowns"), 0);
   EXPECT_EQ(count(rough, "tangential_unknowns"), nodes);
   EXPECT_EQ(count(twisted, "tangential_unknowns"), 2 * nodes);
   for (const Result *one : {&smooth, &rough})
   {
      EXPECT_EQ(count(*one, "assemblies"), 1); // the half-space has no mesh
      EXPECT_EQ(count(*one, "factorisations"), 1);
   }
   EXPECT_EQ(count(twisted, "assemblies"), 2);
   EXPECT_EQ(count(twisted, "factorisations"), 2);
}

TEST(AxisymmetricReceding, MapsCondenseOncePerDisc)
{
   const auto result = run("-map '0.5 1.5 2.5 3.5' -critical '3 5'");
   ASSERT_EQ(result.code, 0) << result.output;
   EXPECT_EQ(result.results["counters"]["factorisations"], 3);
   EXPECT_EQ(result.results["map"].size(), 8u);
   EXPECT_EQ(result.results["critical_load_radius"].size(), 6u);
   // The rim's node tells: of the first order in the spacing.
   const double rim = 0.004;
   expect_values(result, {{"d/t, loaded, a = 2.5, f = 0.5", 3.728, spread, read_out},
                          {"c/t, loaded, a = 2.5, f = 0.5", 1.879, spread, read_out},
                          {"d/t, loaded, a = 2.5, f = 0.8", 4.046, spread, read_out},
                          {"c/t, loaded, a = 2.5, f = 0.8", 2.384, spread, read_out},
                          {"critical a/t, b = 3, f = 0", 2.367, 0.002, rim},
                          {"critical a/t, b = 3, f = 0.5", 1.733, 0.002, rim},
                          {"critical a/t, b = 3, f = 0.8", 1.341, 0.002, rim},
                          {"critical a/t, b = 5, f = 0", 4.415, 0.002, rim},
                          {"critical a/t, b = 5, f = 0.5", 3.793, 0.002, rim},
                          {"critical a/t, b = 5, f = 0.8", 3.458, 0.002, rim}});
}

TEST(AxisymmetricReceding, CyclesBalanceTheirEnergy)
{
   for (const char *twist : {"top", "traction"})
   {
      const auto result =
         run(std::string("-spacing 0.1 -steps 20 -cycles 3 -amplitude 0.6 -twist ") + twist);
      ASSERT_EQ(result.code, 0) << result.output;
      EXPECT_LT(std::abs(number(result.results["energy_imbalance"])), 0.01)
         << twist; // 20 steps
      ASSERT_EQ(result.results["cycles"].size(), 3u);
      double d = result.results["separation"];
      for (const auto &cycle : result.results["cycles"])
      {
         EXPECT_GT(number(cycle["dissipation"]), 0);
         // Ratchetting: the contact shrinks from cycle to cycle.
         EXPECT_LT(number(cycle["separation_back"]), d);
         d = cycle["separation_back"];
      }
   }
}

TEST(AxisymmetricReceding, NoTorqueBeyondTheSpinningLimit)
{
   const auto result = run("-spacing 0.1 -steps 40 -twist traction -torque '0.5 1.1'");
   EXPECT_EQ(result.code, 2) << result.output;
   EXPECT_EQ(result.results["status"], "gross sliding");
   EXPECT_EQ(result.results["torsion"].size(), 1u);
   EXPECT_EQ(result.results["event_loads"]["a = 2.5"], 1);
   EXPECT_NEAR(number(result.results["event_loads"]["twist"]) /
                  number(result.results["torque_limit"]),
               1.0, 0.01);
}

TEST(AxisymmetricReceding, EveryWayOfTwistingMeetsTheSameLimit)
{
   for (const char *twist : {"top", "loaded", "rim"})
   {
      const auto result =
         run(std::string("-spacing 0.1 -steps 20 -torque 0.5 -twist ") + twist);
      ASSERT_EQ(result.code, 0) << result.output;
      EXPECT_NEAR(number(result.results["torsion"][0]["torque"]), 0.5, 2e-6) << twist;
      EXPECT_NEAR(number(result.results["torque_max"]) / number(result.results["torque_limit"]),
                  1.0, 0.01)
         << twist;
   }
   const auto turned = run("-spacing 0.1 -steps 20 -rotation '1 20'");
   ASSERT_EQ(turned.code, 0) << turned.output;
   EXPECT_EQ(turned.results["torsion"][1]["rotation"], 20);
}

TEST(AxisymmetricReceding, BadOptionsAreOneSentence)
{
   for (const char *options : {"-torque 0.5 -rotation 1", "-friction -1", "-load-radius 6",
                               "-twist sideways", "-rotation 1 -twist traction", "-amplitude 2",
                               "-unload 1.5", "-map 7", "-friction 0 -torque 0.5", "-domain 3",
                               "-steps 1", "-critical -1", "-map 2 -map-friction ''"})
   {
      const auto result = run(options);
      EXPECT_EQ(result.code, 1) << options;
      const auto at = result.output.find("error: ");
      ASSERT_NE(at, std::string::npos) << options;
      EXPECT_EQ(result.output.find('\n', at), result.output.size() - 1) << result.output;
   }
}

} // namespace
