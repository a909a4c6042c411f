#include "study/run_miniapp.hpp"
#include "two_lines.hpp"

#include <cattaneo/reduced/reduced_file.hpp>
#include <gtest/gtest.h>

namespace
{

using cattaneo_test::run_miniapp;

TEST(WearStudy, OptionsOfThePadAreNotForAReducedProblem)
{
   const std::string reduced =
      "--reduced problems/hertz.json --history 'P=0; P=1; Q=.2; Q=-.2; Q=.2' --cycle-start 2 "
      "--cycles 1 ";
   EXPECT_EQ(run_miniapp("wear", reduced).code, 0);
   for (const char *of_pad : {"--profile flat", "--flat 0.6", "--poisson 0.2", "--nodes 101",
                              "--order 1", "--shear 0.2"})
   {
      const auto refused = run_miniapp("wear", reduced + of_pad);
      EXPECT_EQ(refused.code, 1) << of_pad;
      EXPECT_NE(refused.output.find("of the pad"), std::string::npos) << refused.output;
   }
}

// Closed form by quadrature: contact of a flat with rounded edges grows as a row of flat
// punches, what wears is lifted as by the punch of the load that stick does not carry by
// itself.
TEST(WearStudy, FlatPadsOfAnyWidthWearWithinTheirLine)
{
   struct
   {
      double flat, stick, extent, volume, depth;
   } const closed_forms[] = {{0.5, 1.077145, 1.509827, 0.053944, 0.089260},
                             {0.9, 1.416307, 1.821895, 0.042860, 0.075610}};
   for (const auto &[flat, stick, extent, volume, depth] : closed_forms)
   {
      const auto run =
         run_miniapp("wear", "--profile flat --cycles 1 --flat " + std::to_string(flat));
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_NEAR(run.results["final_stick"], stick, 0.003 * stick);
      EXPECT_NEAR(run.results["final_extent"], extent, 0.003 * extent);
      EXPECT_NEAR(run.results["final_volume"], volume, 0.02 * volume);
      EXPECT_NEAR(run.results["final_depth"], depth, 0.01 * depth);
      EXPECT_EQ(run.results["warnings"].size(), 0u) << run.output;
   }
}

TEST(WearStudy, ThereIsNoWornOutStateOfAThresholdOrWithoutWear)
{
   for (const char *law : {"--threshold 0.4", "--wear 0"})
   {
      const auto run = run_miniapp("wear", std::string("--cycles 10 --nodes 49 ") + law);
      EXPECT_EQ(run.code, 0) << run.output;
      EXPECT_FALSE(run.results.contains("final_depth")) << run.output;
      EXPECT_FALSE(run.results.contains("worn_out")) << run.output;
   }
}

// Names that a study wrote are said in quotes; units t = p0 = E' = 1 make displacements large.
TEST(WearStudy, LoadsWithNamesOfStudiesAndDepthsThatAreNotSmall)
{
   const auto run =
      run_miniapp("wear", "--reduced problems/lap_joint.json --cycles 1e9 --wear 1e-9 "
                          "--history \"'bolt 1, w = 1'=0; 'bolt 1, w = 1'=1; T=0.01; T=0; "
                          "T=0.01\" --cycle-start 2");
   EXPECT_NE(run.code, 1) << run.output;
   EXPECT_EQ(run.results["cycles_worn"], 1e9) << run.output;
}

// Where shear moves the pressure, or the load that presses varies, slip bends on its way and
// one increment errs by more than the share of the depth that jumps may err by, 1e-3; twenty do
// not. A study that asks for none follows the exact path.
TEST(WearStudy, IncrementsWhereSlipBends)
{
   const std::string bent[] = {
      "--reduced problems/punch_on_half_plane.json --history 'P=0; P=1; Q=.3; Q=-.3; Q=.3' ",
      "--reduced problems/hertz.json --history 'P=0; P=1; P=1.3 Q=.3; P=1 Q=-.2; P=1.3 Q=.3' "};
   for (const std::string &problem : bent)
   {
      const std::string asked = problem + "--cycle-start 2 --cycles 1 --wear 1e-5 ";
      const auto exact = run_miniapp("wear", asked),
                 many = run_miniapp("wear", asked + "--stepping fixed --increments 20"),
                 one = run_miniapp("wear", asked + "--stepping fixed --increments 1");
      ASSERT_EQ(exact.code, 0) << exact.output;
      const double volume = exact.results["volume"];
      EXPECT_NEAR(many.results["volume"], volume, 1e-3 * volume) << problem;
      EXPECT_GT(std::abs(one.results["volume"].get<double>() - volume), 1e-3 * volume)
         << problem;
   }
}

// Two contacts side by side end as each does alone: what is printed is of one of them.
TEST(WearStudy, EndOfOneOfTwoLines)
{
   using namespace cattaneo;
   const std::string file = testing::TempDir() + "two_lines_to_wear.json",
                     asked = " --history 'P=0; P=1; Q=.2; Q=-.2; Q=.2' --cycle-start 2 "
                             "--cycles 1 --wear 1e-5";
   save(cattaneo_test::twice(load_reduced_problem(CATTANEO_SOURCE_DIR "/problems/hertz.json")),
        file);
   const auto one = run_miniapp("wear", "--reduced problems/hertz.json" + asked),
              two = run_miniapp("wear", "--reduced '" + file + "'" + asked);
   ASSERT_EQ(two.code, 0) << two.output;
   for (const char *value :
        {"final_stick", "final_extent", "final_pressure_centre", "final_depth"})
   {
      const double alone = one.results[value];
      EXPECT_NEAR(two.results[value], alone, 1e-6 * alone) << value;
   }
   const double volume = one.results["final_volume"];
   EXPECT_NEAR(two.results["final_volume"], 2 * volume, 1e-6 * volume);
}

// It slides where Q = f P, with the f = 0.4 of the file.
TEST(WearStudy, SlidingSaysAtWhichLoad)
{
   const auto run = run_miniapp("wear", "--reduced problems/hertz.json --history 'P=0; P=1; "
                                        "Q=0.5; Q=-0.5; Q=0.5' --cycle-start 2 --cycles 20");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_NEAR(run.results["event_loads"]["Q"], 0.4, 1e-6);
   EXPECT_NE(run.output.find("(P = 1, Q = 0.4)"), std::string::npos) << run.output;
}

// Two equal bodies that are pressed alone do not slip (B = 0), and what does not slip does not
// wear: neither where they part in the cycle, nor where only the edges of contact do.
TEST(WearStudy, NothingWearsWhereNothingSlips)
{
   for (const std::string least : {"0", "0.5"})
   {
      const auto run = run_miniapp("wear", "--reduced problems/hertz.json --history 'P=0; P=1; "
                                           "P=" +
                                              least +
                                              "; P=1' --cycle-start 1 --cycles 5 "
                                              "--wear 10");
      ASSERT_EQ(run.code, 0) << run.output;
      for (const char *none : {"volume", "depth", "energy", "final_volume", "final_depth"})
      {
         EXPECT_EQ(run.results[none], 0) << none << run.output;
      }
      EXPECT_EQ(run.results["worn_out"], "converged");
      EXPECT_TRUE(run.results["explicit_limit"].is_null());
      EXPECT_NE(run.output.find("nothing slips in a cycle, and nothing wears"),
                std::string::npos)
         << run.output;
   }
}

// What is left of the loss where a contact of equal bodies is worn out is round-off.
TEST(WearStudy, ACycleOfTheWornOutContactLosesNothing)
{
   const auto run = run_miniapp("wear", "--cycles 0 --nodes 97");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_GT(run.results["final_depth"], 0);
   EXPECT_EQ(run.results["final_loss"], 0);
}

// Ctrl-C: a cycle that is not whole is none, and the table goes up to the last one.
TEST(WearStudy, TheTableOfAnInterruptedRunHasItsLastState)
{
   const auto run = run_miniapp("wear", "--cycles 1e9 --tolerance 0 --wear 1e-6 --nodes 49",
                                "timeout --foreground --preserve-status -s INT 2");
   ASSERT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["status"], "stopped");
   EXPECT_EQ(run.results["event_loads"]["P"], 1); // within a cycle or between two
   EXPECT_GT(run.results["cycles_worn"], 1);
   EXPECT_EQ(run.results["cycles_marched"], run.results["cycles_worn"]);
   EXPECT_EQ(run.results["cycles"].back()["cycle"], run.results["cycles_worn"]);
   EXPECT_EQ(run.results["cycles"].back()["volume"], run.results["volume"]);
}

} // namespace
