#include "study/run_miniapp.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace
{

using cattaneo_test::run_miniapp;

// A parabola presses less where its middle is taken off. No profile presses less than the mean
// over what touches; that a node that stays open does not add to.
TEST(DesignStudy, AGapThatIsTooRoundIsMadeFlatter)
{
   const std::string hertz = "--reduced problems/hertz.json --history 'P=0; P=1' --profile ";
   const double P = 0.00392699, length = 3.34, a = 1; // of the file
   const auto free = run_miniapp("design", hertz + "free"),
              crown = run_miniapp("design", hertz + "crown");
   for (const auto &run : {free, crown})
   {
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_EQ(run.results["design"], "optimal");
      EXPECT_NEAR(run.results["objective_at_start"], 2 * P / (M_PI * a), 1e-5);
      EXPECT_GT(run.results["objective"], P / length);
   }
   // Uniform over |x| < a and half an element on either side.
   EXPECT_NEAR(free.results["objective"], P / (2 * a), 0.05 * P / (2 * a));
   EXPECT_LT(crown.results["objective"], 1.1 * P / length);
}

// The closed form is that of a gap without bounds.
TEST(DesignStudy, ComparesWithTheUniformPressureWhereTheGapMayHaveItsProfile)
{
   const auto run = run_miniapp("design", "--most 0.05 --nodes 17");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_FALSE(run.results.contains("profile_error")) << run.output;
   EXPECT_TRUE(run_miniapp("design", "--nodes 17").results.contains("profile_error"));
}

// Where responses bend at the optimum the search ends, and a sweep finds nothing better.
TEST(DesignStudy, EndsWhereDerivativesJump)
{
   const auto run = run_miniapp("design", "--goal loss --shear 0.5 --scene punch --profile "
                                          "crown --nodes 17 --lines 16");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_LE(run.results["best_of_lines"], 1e-4) << run.output;
   EXPECT_TRUE(run.results["design"] == "optimal" || run.results["stationarity"].is_null());
   EXPECT_EQ(run.output.find("return status"), std::string::npos) << run.output;
}

// Ctrl-C, long before it would be done.
TEST(DesignStudy, SaysThatItWasStopped)
{
   // Otherwise timeout also signals its group: a second Ctrl-C, which ends a program at once.
   const auto run = run_miniapp("design",
                                "--goal loss --shear 0.5 --scene punch --profile free "
                                "--nodes 65 --increments 50",
                                "timeout --foreground --preserve-status -s INT 4");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["status"], "stopped");
   EXPECT_EQ(run.results["design"], "stopped");
   EXPECT_NE(run.output.find("asked to stop"), std::string::npos) << run.output;
}

} // namespace
