#include <study/run_miniapp.hpp>

namespace
{

using cattaneo_test::expect_references_met;
using Outcome = cattaneo_test::Run; // Run is a member of testing::Test
using cattaneo_test::run_miniapp;

TEST(ShakedownStudy, MeetsItsReferences)
{
   const Outcome run = run_miniapp("shakedown", "-march -cycles 140");
   expect_references_met(run, 16);
   const auto &results = run.results;
   EXPECT_EQ(results["status"], "certified");
   EXPECT_LE(results["bound_lower"], results["friction_limit"]);
   EXPECT_LE(results["friction_limit"], results["bound_upper"]);
   EXPECT_LE(results["bound_upper"].get<double>() - results["bound_lower"].get<double>(), 1e-6);
   EXPECT_LE(results["violation"].get<double>(), 0);
   EXPECT_LE(results["method2_low"], results["method2_high"]);
   for (const auto &march : results["marches"])
   {
      EXPECT_TRUE(march["shaken_down"].get<bool>()) << march["start"];
      if (march["start"] != "optimal")
      {
         // The resolved mesh's rate, 0.83 a cycle, with what corner nodes add.
         EXPECT_NEAR(march["decay"].get<double>(), 0.83, 0.05);
      }
   }
}

TEST(ShakedownStudy, ConvergesWithTheMesh)
{
   const Outcome run =
      run_miniapp("shakedown", "-find friction -nodes 65 -mesh-study \"65 129 257\"");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &study = run.results["mesh_study"];
   // Second order in the size of the elements: differences fall by about four.
   const auto value = [&](int k) { return study[k]["load_limit_reversed"].get<double>(); };
   const double ratio = (value(1) - value(0)) / (value(2) - value(1));
   EXPECT_GT(ratio, 3) << run.output;
   EXPECT_LT(ratio, 5) << run.output;
   const double limit = (value(2) + (value(2) - value(1)) / 3) / 0.85;
   EXPECT_NEAR(limit, 0.8040, 3e-4);
   // The degree of coupling does not follow the number of nodes.
   EXPECT_NEAR(study[0]["coupling"].get<double>(), study[2]["coupling"].get<double>(), 0.01);
}

TEST(ShakedownStudy, ReadsWhatItSaves)
{
   const std::string file = testing::TempDir() + "shakedown_study.json";
   const Outcome punch = run_miniapp("shakedown", "-nodes 33 -save '" + file + "'");
   const Outcome saved = run_miniapp("shakedown", "-reduced '" + file + "'");
   ASSERT_EQ(punch.code, 0) << punch.output;
   ASSERT_EQ(saved.code, 0) << saved.output;
   EXPECT_EQ(punch.results["friction_limit"], saved.results["friction_limit"]);
   EXPECT_EQ(punch.results["load_limit"], saved.results["load_limit"]);
   // A contact that stays closed everywhere is its own closed part.
   const Outcome closed = run_miniapp(
      "shakedown", "-reduced '" + file + "' -closed -lambda-max 0.2 -reversal -0.5");
   EXPECT_EQ(closed.results["closed_nodes"], 33) << closed.output;
   EXPECT_EQ(closed.results["load_limit"], saved.results["load_limit"]);
   std::remove(file.c_str());
}

TEST(ShakedownStudy, RefusesBadOptions)
{
   for (const char *options : {"-friction 0", "-lambda-max -1", "-reversal 2", "-find all",
                               "-corner 0.7", "-held X -nodes 9", "-reduced missing.json"})
   {
      const Outcome run = run_miniapp("shakedown", options);
      EXPECT_EQ(run.code, 1) << options;
      EXPECT_NE(run.output.find("error:"), std::string::npos) << options;
   }
   // Nothing sticks under a pull: an outcome, not an error.
   const Outcome run = run_miniapp("shakedown", "-nodes 9 -held Q -cycled P");
   EXPECT_EQ(run.code, 2) << run.output;
}

} // namespace
