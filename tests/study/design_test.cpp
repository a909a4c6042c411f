#include "study/run_miniapp.hpp"

#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
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

// Three bolts whose pretensions add up to 3, pulled and pushed: against marches over all shares
// in steps of 0.02. Pressures are convex along a load, nearly, so the best of the grid is
// within half a step's worth of the optimum. The row is its own mirror image.
TEST(DesignStudy, PretensionsOfARowOfBoltsAgainstASweep)
{
   using namespace cattaneo;
   const auto run = run_miniapp("design", "--case problems/bolt_row.case.json");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["design"], "optimal");
   const std::vector<double> x = run.results["variables"];
   ASSERT_EQ(x.size(), 3u);
   EXPECT_NEAR(x[0] + x[1] + x[2], 0, 1e-9);
   EXPECT_NEAR(x[0], x[2], 1e-6);
   const ReducedProblem problem =
      load_reduced_problem(CATTANEO_SOURCE_DIR "/problems/bolt_row.json");
   const auto peak = [&](double first, double second, double third)
   {
      char text[200];
      std::snprintf(text, sizeof text,
                    "T=0; 'bolt 1, w = 1'=%.17g 'bolt 2, w = 1'=%.17g 'bolt 3, w = 1'=%.17g; "
                    "T=0.1; T=-0.1",
                    first, second, third);
      const LoadHistory history = load_history("history", text, problem);
      ContactState state = ContactState::virgin(problem);
      double most = 0;
      const auto note = [&](const ContactState &now, const IncrementRecord &)
      {
         const double time = now.time;
         if (time == std::floor(time) && time > 0)
         {
            most = std::max(most, tractions(problem, now.p).maxCoeff());
         }
      };
      march(problem, history, state, {}, note);
      return most;
   };
   const double least = run.results["objective"];
   EXPECT_NEAR(peak(1 + x[0], 1 + x[1], 1 + x[2]), least, 1e-9);
   EXPECT_NEAR(peak(1, 1, 1), run.results["objective_at_start"], 1e-9);
   double best = 10;
   for (double second = 0.9; second < 1.15; second += 0.02)
   {
      for (double lean = -0.1; lean < 0.11; lean += 0.02)
      {
         const double rest = 0.5 * (3 - second);
         best = std::min(best, peak(rest + lean, second, rest - lean));
      }
   }
   EXPECT_GE(best, least - 1e-9);
   EXPECT_LE(best, least + 0.02);
}

// Where bolts are worth having: of seven places, three of which are tightened at first, the
// load is spread over all, and none is let go below zero.
TEST(DesignStudy, LoadsThatAreChosenKeepTheirSum)
{
   const auto refused = [](const std::string &options, const char *words)
   {
      const auto run = run_miniapp("design", options);
      EXPECT_EQ(run.code, 1) << run.output;
      EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
   };
   const std::string row = "--reduced problems/lap_joint.json --history 'T=0; T=0.02' ";
   refused("--choose 'P; Q'", "--choose is of --reduced");
   refused(row + "--choose T", "must be two loads at least");
   refused(row + "--choose 'T; T'", "names 'T' twice");
   refused(row + "--choose 'T; U'", "'U'");
   refused(
      "--reduced problems/lap_joint.json --history 'T=0; T=-1' --choose 'T; bolt 1, w = 1'",
      "must not be negative");
   refused("--reduced problems/lap_joint.json --history 'T=0; T=0' --choose 'T; bolt 1, w = 1'",
           "one must act");
}

} // namespace
