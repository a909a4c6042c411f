#include "run_miniapp.hpp"

#include <cmath>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using cattaneo_test::number;
using cattaneo_test::run_miniapp;

// The studies' notes, part B; ±0.003, and a tenth of the spacing, 0.02 t unless said, for the
// read-out of edges.
const double spread = 0.003, read_out = 0.002;

TEST(PlaneReceding, LoadingAndUnloadingMeetTheReferencesOnALargeBlock)
{
   const auto run =
      run_miniapp("plane_receding", "-domain 1e4 -unload '0.9 0.5 0.2 0.1' -steps 50");
   expect_values(run, {{"s/t, n = 4, f = 0.7", 1.406, spread, read_out},
                       {"e/t, n = 4, f = 0.7", -0.442, spread, read_out},
                       {"ξ/t of separation, unloaded to p/p0 = 0.9", -1.336, spread, read_out},
                       {"ξ/t of separation, unloaded to p/p0 = 0.2", -0.740, spread, read_out},
                       {"ξ/t of separation, unloaded to p/p0 = 0.1", -0.594, spread, read_out},
                       {"ξ/t of border 1 of 4, p/p0 = 0.5", -1.018, spread, read_out},
                       // To two digits, and read to half a spacing.
                       {"ξ/t of border 2 of 4, p/p0 = 0.5", -0.68, 0.005, 0.01},
                       {"ξ/t of border 3 of 4, p/p0 = 0.5", -0.12, 0.005, 0.01},
                       {"ξ/t of border 4 of 4, p/p0 = 0.5", 0.61, 0.005, 0.01},
                       {"v E'/(p0 t) at ξ/t = -0.5, full load", -0.8245, 5e-4, 5e-4},
                       // Levels are known to a step, 1/50 of what is left of the load.
                       {"p/p0 down to which ξ/t = -0.5 sticks", 0.41, 0.005, 0.02},
                       {"p/p0 at which ξ/t = -0.5 separates", 0.06, 0.005, 0.01}});
   // Separation recedes further during unloading, and a forward zone follows it.
   double before = run.results["separation"];
   for (const auto &level : run.results["levels"])
   {
      EXPECT_LT(number(level["separation"]), before);
      before = level["separation"];
      EXPECT_EQ(level["zones"].size(), 5u) << level;
   }
   EXPECT_EQ(run.results["counters"]["pivots"], 0);
}

TEST(PlaneReceding, FiniteBlockOfTheThesis)
{
   expect_values(run_miniapp("plane_receding", "-obstacle th0 -friction 0.3"),
                 {{"s/t, n = 4, f = 0.3", 0.910, spread, read_out},
                  {"e/t, n = 4, f = 0.3", -1.655, spread, read_out}});
   const auto run =
      run_miniapp("plane_receding", "-obstacle th0 -unload 0.5 -slip '' -lowest 0.4");
   ASSERT_EQ(run.code, 0) << run.output;
   // The notes' fourth border is 0.48 for n = 2, and 0.502 for n = 4.
   const double borders[] = {-1.053, -0.77, -0.18, 0.502};
   const auto &zones = run.results["levels"][0]["zones"];
   ASSERT_EQ(zones.size(), 5u);
   for (int k = 0; k < 4; ++k)
   {
      EXPECT_NEAR(zones[k]["to"].get<double>(), borders[k], k == 0 ? 0.005 : 0.015);
   }
   EXPECT_NEAR(number(run.results["separation"]), 1.382, spread + read_out);
   EXPECT_NEAR(number(run.results["stick_slip"]), -0.351, spread + read_out);
}

/// The half-plane without a mesh is what blocks tend to as they grow. (The references marked HP
/// are those of a block of 10⁴ t, whose remote tension, a hundredth of p0, still moves e by
/// 0.007 to 0.016.)
TEST(PlaneReceding, BlocksTendToTheHalfPlane)
{
   const std::string options = "-map '1.2 1.6 4' -unload '0.9 0.5 0.2'";
   const auto limit = run_miniapp("plane_receding", options),
              block = run_miniapp("plane_receding", options + " -domain 1e6");
   ASSERT_EQ(limit.code, 0) << limit.output;
   ASSERT_EQ(block.code, 0) << block.output;
   const double nothing = 1e300, tenth = 0.002; // where nothing separates; of the spacing
   const auto same = [&](const nlohmann::json &a, const nlohmann::json &b, double within)
   {
      EXPECT_NEAR(a.is_null() ? nothing : a.get<double>(),
                  b.is_null() ? nothing : b.get<double>(), within)
         << a << " " << b;
   };
   ASSERT_EQ(limit.results["map"].size(), 12u);
   for (int k = 0; k < 12; ++k)
   {
      const auto &a = limit.results["map"][k], &b = block.results["map"][k];
      same(a["separation"], b["separation"], tenth);
      same(a["stick_slip"], b["stick_slip"], tenth);
   }
   ASSERT_EQ(limit.results["levels"].size(), 3u);
   for (int level = 0; level < 3; ++level)
   {
      const auto &a = limit.results["levels"][level]["zones"],
                 &b = block.results["levels"][level]["zones"];
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k)
      {
         EXPECT_EQ(a[k]["state"], b[k]["state"]);
         // Where loading slip follows stick the edge is read to a node.
         same(a[k]["to"], b[k]["to"], k == 2 ? 10 * tenth : tenth);
      }
   }
   same(limit.results["slip_histories"][0]["slip_at_p0"],
        block.results["slip_histories"][0]["slip_at_p0"], 5e-4);
   // The references that the remote tension does not move.
   const double s[] = {0.903, 1.169, 1.406};
   for (int f = 0; f < 3; ++f)
   {
      same(limit.results["map"][3 * f + 2]["separation"], s[f], spread + tenth);
   }
}

TEST(PlaneReceding, MapOverOverhangAndFrictionFromOneCondensation)
{
   const auto run = run_miniapp(
      "plane_receding",
      "-domain 1e4 -map '0.4 1.2 1.6 2 4' -spacing 0.04 -corner 0.01 -domain-study");
   const double coarse = 0.004; // a tenth of this spacing
   expect_values(run, {{"s/t, n = 4, f = 0.3", 0.903, spread, coarse},
                       {"e/t, n = 4, f = 0.3", -1.858, spread, coarse},
                       {"s/t, n = 4, f = 0.5", 1.169, spread, coarse},
                       {"e/t, n = 4, f = 0.5", -0.883, spread, coarse},
                       {"s/t, n = 4, f = 0.7", 1.406, spread, coarse},
                       {"e/t, n = 4, f = 0.7", -0.442, spread, coarse},
                       {"s/t, n = 4, f = 1", 1.730, spread, coarse},
                       {"e/t, n = 4, f = 1", -0.046, spread, coarse},
                       {"s/t, n = 1.6, f = 0.5", 1.169, spread, coarse},
                       {"e/t, n = 1.6, f = 0.5", -0.883, spread, coarse},
                       {"s/t, n = 1.2, f = 0.3", 0.906, spread, coarse},
                       {"e/t, n = 1.2, f = 0.3", -1.859, spread, coarse},
                       {"length separated, n = 1.2, f = 0.5", 0, 0, 0}});
   const auto &counters = run.results["counters"];
   // One pair for the map, one for each of the five domains, and a strip without a block.
   EXPECT_EQ(counters["factorisations"], 2 + 2 * 5 + 1);
   EXPECT_EQ(counters["unions"], 1 + 5 + 1);
   // Independent of n from n = 2 on, but for f = 1, where separation nears the strip's end.
   for (const auto &a : run.results["map"])
   {
      for (const auto &b : run.results["map"])
      {
         if (a["friction"] == 1 || a["friction"] != b["friction"] || a["overhang"] < 2 ||
             b["overhang"] < 2)
         {
            continue;
         }
         EXPECT_NEAR(number(a["separation"]), number(b["separation"]), 0.005);
         EXPECT_NEAR(number(a["stick_slip"]), number(b["stick_slip"]), 0.005);
      }
   }
   EXPECT_NE(run.output.find("Domain study"), std::string::npos);
}

TEST(PlaneReceding, LongFreeEndsThatCloseAtOnceNeedAPath)
{
   // Runs of penetrating nodes make the active set cycle.
   const auto run =
      run_miniapp("plane_receding", "-map '2 2.25 3.5' -map-friction 1 -spacing 0.05");
   ASSERT_EQ(run.code, 0) << run.output;
   ASSERT_EQ(run.results["map"].size(), 3u);
   EXPECT_GT(run.results["counters"]["pivots"], 0);
   const auto &longest = run.results["map"][2];
   for (const auto &state : run.results["map"]) // nearly independent of n
   {
      EXPECT_NEAR(number(state["separation"]), number(longest["separation"]), 0.01);
      EXPECT_NEAR(number(state["stick_slip"]), number(longest["stick_slip"]), 0.01);
   }
}

TEST(PlaneReceding, ABondedShortOverhangNeedsTheCornersFriction)
{
   // A short overhang needs no more than the corner itself.
   const auto run = run_miniapp("plane_receding", "-overhang 0.1 -friction 0.8");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_NEAR(run.results["adhesion_friction"], 0.543075578837, 1e-9);
   EXPECT_TRUE(run.results["separation"].is_null());
   EXPECT_TRUE(run.results["stick_slip"].is_null())
      << "the corner's nodes ask for 0.6 to 0.77, never converging";
}

TEST(PlaneReceding, PoissonsRatioDoesNotMatter)
{
   const std::string options = "-friction 0.5 -spacing 0.05 -corner 0.01 -poisson ";
   const auto a = run_miniapp("plane_receding", options + "0");
   const auto b = run_miniapp("plane_receding", options + "0.4");
   ASSERT_EQ(a.code, 0) << a.output;
   ASSERT_EQ(b.code, 0) << b.output;
   // Discretisation errors do depend on it: a fiftieth of the spacing.
   EXPECT_NEAR(number(a.results["separation"]), number(b.results["separation"]), 1e-3);
   EXPECT_NEAR(number(a.results["stick_slip"]), number(b.results["stick_slip"]), 1e-3);
}

TEST(PlaneReceding, UnloadingHardlyDependsOnTheSteps)
{
   const std::string options = "-unload '0.8 0.5 0.2' -lowest 0.2 -overhang 2.5 -steps ";
   const auto coarse = run_miniapp("plane_receding", options + "25");
   const auto fine = run_miniapp("plane_receding", options + "100");
   ASSERT_EQ(coarse.code, 0) << coarse.output;
   ASSERT_EQ(fine.code, 0) << fine.output;
   for (int level = 0; level < 3; ++level)
   {
      const auto &a = coarse.results["levels"][level]["zones"];
      const auto &b = fine.results["levels"][level]["zones"];
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k)
      {
         EXPECT_EQ(a[k]["state"], b[k]["state"]);
         EXPECT_NEAR(a[k]["to"].get<double>(), b[k]["to"].get<double>(), 0.02);
      }
   }
}

/// The loss falls by one factor a cycle: cycles on, nothing is left of it. Where slip turns
/// over more of the contact, a part of it slips for ever.
TEST(PlaneReceding, CyclesWhoseLossFallsShakeDown)
{
   const std::string options = "-spacing 0.1 -length 40 -corner 0.01 -cycle-to '0.6 0.95'";
   const auto run = run_miniapp("plane_receding", options);
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &cycles = run.results["load_cycles"];
   EXPECT_EQ(cycles[0]["outcome"], "slips for ever") << cycles;
   EXPECT_EQ(cycles[1]["outcome"], "shaken down") << cycles;
   EXPECT_LE(number(cycles[1]["last_loss"]), 1e-9 * number(cycles[1]["first_loss"]));
   // On its way there it says by which factor.
   const auto last_loss = [&](int count, std::string &outcome)
   {
      const auto cut =
         run_miniapp("plane_receding", options + " -cycles " + std::to_string(count));
      EXPECT_EQ(cut.code, 0) << cut.output;
      outcome = cut.results["load_cycles"][1]["outcome"];
      return number(cut.results["load_cycles"][1]["last_loss"]);
   };
   std::string outcome;
   const double tenth = last_loss(10, outcome),
                factor = std::pow(last_loss(18, outcome) / tenth, 1.0 / 8);
   const std::string words = "still falls, by a factor ";
   ASSERT_EQ(outcome.rfind(words, 0), 0u) << outcome;
   EXPECT_NEAR(std::stod(outcome.substr(words.size())), factor, 0.01); // to two digits
}

/// Friction above its critical value has several answers: that is a row, and those after it are
/// what they are without it.
TEST(PlaneReceding, AMapGoesOnBeyondWhatIsNotUnique)
{
   const std::string options = "-spacing 0.05 -corner 0.01 -map '2 4' -map-friction ";
   const auto run = run_miniapp("plane_receding", options + "'0.3 50 0.5'"),
              good = run_miniapp("plane_receding", options + "'0.3 0.5'");
   EXPECT_EQ(run.code, 2) << run.output;
   ASSERT_EQ(good.code, 0) << good.output;
   const auto &map = run.results["map"], &known = good.results["map"];
   ASSERT_EQ(map.size(), 6u) << run.output;
   for (int k = 0; k < 6; ++k)
   {
      EXPECT_EQ(map[k]["status"], k / 2 == 1 ? "not unique" : "converged") << map[k];
      if (k / 2 == 1) { continue; }
      const auto &same = known[k / 4 * 2 + k % 2];
      EXPECT_NEAR(number(map[k]["separation"]), number(same["separation"]), 1e-9);
      EXPECT_NEAR(number(map[k]["stick_slip"]), number(same["stick_slip"]), 1e-9);
   }
   EXPECT_NE(run.output.find("2 of 6 states of the map"), std::string::npos) << run.output;
}

/// All of the strip may stick where friction is large: that state is shown.
TEST(PlaneReceding, OneOfSeveralStatesIsShown)
{
   const auto run = run_miniapp("plane_receding", "-friction 100 -spacing 0.05 -corner 0.01");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["status"], "not unique");
   EXPECT_NE(run.output.find("Loading, n = 4"), std::string::npos) << run.output;
   ASSERT_TRUE(run.results.contains("zones")) << run.output;
   EXPECT_EQ(run.results["zones"][0]["state"], "stick");
}

} // namespace
