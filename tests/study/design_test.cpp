#include "study/run_miniapp.hpp"
#include "two_lines.hpp"

#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

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
                                "--nodes 129 --increments 50",
                                "timeout --foreground --preserve-status -s INT 4");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["status"], "stopped");
   EXPECT_EQ(run.results["design"], "stopped");
   EXPECT_EQ(run.results["message"], "the design was asked to stop");
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
   refused("--choose 'P; Q'", "--choose does nothing in this run: it is of --reduced");
   refused(row + "--choose 'T; P' --coat '0.1 0.5'", "chooses one of them");
   refused("--coat '0.1 0.5' --profile crown", "--choose and --coat take its place");
   refused("--coat '0.5 0.1'", "must be the least friction and the most");
   refused("--coat '0.5 0.9'", "friction is from 0.3 to 0.3");
   refused("--coat '0.1 0.5' --zones 1000", "no node lies");
   refused("--zones 3", "--zones does nothing in this run: it is of --coat");
   refused("--powers 3", "--powers does nothing in this run: it is of --profile crown");
   refused("--profile crown --powers '2 2.5'", "must be whole numbers");
   refused("--profile crown --powers '2 2'", "each once");
   refused("--profile rounded --curvature 1", "--most is the limit of 1/R");
   refused("--lines 4", "--lines does nothing in this run: it is not of a free profile");
   refused("--goal energy", "needs a cycle");
   refused(row + "--choose T", "must be two loads at least");
   refused(row + "--choose 'T; T'", "names 'T' twice");
   refused(row + "--choose 'T; U'", "'U'");
   refused(
      "--reduced problems/lap_joint.json --history 'T=0; T=-1' --choose 'T; bolt 1, w = 1'",
      "must not be negative");
   refused("--reduced problems/lap_joint.json --history 'T=0; T=0' --choose 'T; bolt 1, w = 1'",
           "one must act");
}

/// Energy that each node loses per area from the third point of the history on: the work of its
/// traction by the trapezoidal rule over many increments, which is the law's but where slip
/// turns within one.
Eigen::VectorXd lost_per_area(const cattaneo::ReducedProblem &problem,
                              const std::string &history)
{
   using namespace cattaneo;
   const LoadHistory loads = load_history("history", history, problem);
   ContactState state = ContactState::virgin(problem), before = state;
   Eigen::VectorXd lost = Eigen::VectorXd::Zero(problem.nodes());
   MarchSettings settings;
   settings.increments = 200;
   settings.stepping = Stepping::fixed;
   const auto note = [&](const ContactState &now, const IncrementRecord &)
   {
      if (before.time >= 3) { lost -= 0.5 * (now.q + before.q).cwiseProduct(now.v - before.v); }
      before = now;
   };
   march(problem, loads, state, settings, note);
   return tractions(problem, lost);
}

// The criterion of fretting that asks for the largest energy per area of a cycle, on the flank
// of the shipped dovetail: friction of four zones is chosen so that it is least. What is
// printed is what the work of tractions in small increments comes to, and no coating that is
// drawn at random is better.
TEST(DesignStudy, CoatOfADovetailAgainstTheWorkOfItsTractions)
{
   using namespace cattaneo;
   const std::string file = testing::TempDir() + "dovetail_to_coat.json",
                     history = "P=0; P=1; P=0.6; P=1; P=0.6; P=1";
   ASSERT_EQ(
      run_miniapp("contact", "--case meshes/dovetail.json --cycles 1 --save '" + file + "'")
         .code,
      0);
   const std::string asked = "--reduced '" + file + "' --history '" + history +
                             "' --from 3 --goal energy --coat '0.1 0.6' --zones 2 --starts 2";
   const auto run = run_miniapp("design", asked);
   ASSERT_EQ(run.code, 0) << run.output;
   ASSERT_EQ(run.results["starts"].size(), 2u);
   const double objective = run.results["objective"];
   for (const auto &start : run.results["starts"])
   {
      EXPECT_GE(start["objective"], objective * (1 - 1e-12));
   }
   ReducedProblem problem = load_reduced_problem(file);
   const Eigen::VectorXd s = problem.arc_length;
   const double half = 0.5 * (s.minCoeff() + s.maxCoeff());
   const auto coated = [&](double first, double second)
   {
      ReducedProblem other = problem;
      for (Eigen::Index i = 0; i < s.size(); ++i)
      {
         other.friction[i] = s[i] < half ? first : second;
      }
      return lost_per_area(other, history).maxCoeff();
   };
   const double first = run.results["chosen"][0]["after"],
                second = run.results["chosen"][1]["after"];
   const double start = run.results["cases"][0]["density_before"],
                found = run.results["cases"][0]["density_after"];
   EXPECT_NEAR(found, objective, 1e-9 * objective);
   EXPECT_NEAR(coated(first, second), objective, 0.01 * objective);
   EXPECT_GT(start, 1.5 * objective);
   std::mt19937 random(5);
   for (int k = 0; k < 10; ++k)
   {
      const double one = 0.1 + 0.5 * (random() % 1000) / 1000,
                   other = 0.1 + 0.5 * (random() % 1000) / 1000;
      EXPECT_GT(coated(one, other), 0.99 * objective) << one << ' ' << other;
   }
}

// A rounded punch: nothing presses less than the uniform pressure of a free profile, the flat
// punch more; on few nodes bests among their neighbours are a per cent apart, and the least of
// them is kept.
TEST(DesignStudy, FlatAndRadiusFromSeveralStarts)
{
   const auto run = run_miniapp("design", "--profile rounded --most 3 --starts 3 --nodes 33");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["design"], "optimal");
   const double objective = run.results["objective"];
   EXPECT_GT(objective, 0.5);
   EXPECT_LT(objective, 0.7);
   ASSERT_EQ(run.results["starts"].size(), 3u);
   for (const auto &start : run.results["starts"])
   {
      EXPECT_NEAR(start["objective"], objective, 0.03 * objective) << run.output;
      EXPECT_GE(start["objective"], objective);
      EXPECT_GT(start["before"], objective);
   }
   EXPECT_EQ(run.results["objective_at_start"], run.results["starts"][0]["before"]);
   // 1/R takes the flat punch away.
   const auto flat = run_miniapp("design", "--profile rounded --most 1e-9 --nodes 33");
   EXPECT_NEAR(flat.results["objective"], run.results["cases"][0]["peak_before"], 1e-5)
      << flat.output;
}

// From which point on a history counts is said by its time, and what lies between two points is
// the same as from the later one; before it begins, all of it.
TEST(DesignStudy, CountsFromAPointOfTheHistoryOn)
{
   const std::string hertz = "--reduced problems/hertz.json --profile crown --most 0.001 "
                             "--history 'P=0; P=1; Q=.24; Q=-.24; Q=.24' ";
   for (const std::string goal : {"loss", "energy"})
   {
      const char *column = goal == "loss" ? "lost" : "density";
      const auto run = run_miniapp("design", hertz + "--goal " + goal + " --from 2.5"),
                 point = run_miniapp("design", hertz + "--goal " + goal + " --from 3");
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_EQ(run.results["objective"], point.results["objective"]);
      for (const auto &[when, result] :
           {std::pair<const char *, const char *>{"_before", "objective_at_start"},
            {"_after", "objective"}})
      {
         const double printed = run.results["cases"][0][std::string(column) + when],
                      asked = run.results[result];
         EXPECT_NEAR(printed, asked, 1e-9 * asked) << goal << when;
      }
   }
   const auto all = run_miniapp("design", hertz + "--goal pressure --from 0"),
              before = run_miniapp("design", hertz + "--goal pressure --from -3");
   ASSERT_EQ(before.code, 0) << before.output;
   EXPECT_EQ(before.results["objective"], all.results["objective"]);
   const auto none = run_miniapp("design", hertz + "--goal loss --from 4");
   EXPECT_EQ(none.code, 1) << none.output;
   EXPECT_NE(none.output.find("must leave 2 points"), std::string::npos) << none.output;
}

// Points of a sweep that limits do not allow are no better designs; loads whose sum stays are
// not swept one by one.
TEST(DesignStudy, SweepsWhereLimitsHold)
{
   const auto run =
      run_miniapp("design", "--profile crown --curvature 0.3 --nodes 33 --lines 8");
   ASSERT_EQ(run.code, 0) << run.output;
   // Of all crowns α x² + β x⁴ of the curvature 2α + 12 β x² up to 0.3, the flatter presses
   // more at the ends: α is 0.15.
   EXPECT_NEAR(run.results["variables"][0], 0.15, 1e-6);
   EXPECT_LE(run.results["best_of_lines"], 1e-6);
   const auto sum = run_miniapp("design", "--case problems/bolt_row.case.json --lines 8");
   EXPECT_EQ(sum.code, 1) << sum.output;
   EXPECT_NE(sum.output.find("--lines does nothing in this run: it is not of --choose"),
             std::string::npos)
      << sum.output;
}

// Friction of 0.4 does not hold Q = 0.5 P, friction of another start does: it is found, and
// nothing is said of a start that has no equilibrium.
TEST(DesignStudy, FirstStartWithoutEquilibrium)
{
   const auto run = run_miniapp(
      "design",
      "--reduced problems/hertz.json --history 'P=0; P=1; Q=.5; Q=-.5; Q=.5' --from 2 "
      "--goal loss --coat '0.3 0.8' --starts 3 --lines 2");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["starts"][0]["design"], "no equilibrium");
   EXPECT_TRUE(run.results["starts"][0]["objective"].is_null());
   EXPECT_TRUE(run.results["objective_at_start"].is_null());
   EXPECT_TRUE(run.results["cases"][0]["lost_before"].is_null());
   const double objective = run.results["objective"];
   EXPECT_NEAR(run.results["cases"][0]["lost_after"], objective, 1e-9 * objective);
}

// Two contacts side by side, each with a line of its own: each has its own zones, flat and
// crown, which are those that it has alone.
TEST(DesignStudy, EachLineHasVariablesOfItsOwn)
{
   using namespace cattaneo;
   const std::string file = testing::TempDir() + "two_lines_to_design.json",
                     history = " --history 'P=0; P=1; Q=.24; Q=-.24; Q=.24' --from 2 ";
   save(cattaneo_test::twice(load_reduced_problem(CATTANEO_SOURCE_DIR "/problems/hertz.json")),
        file);
   for (const std::string choice : {"--goal energy --coat '0.3 0.6' --zones 3",
                                    "--profile crown --powers '2 4' --most 0.01",
                                    "--goal energy --profile rounded --most 0.01"})
   {
      const auto one =
                    run_miniapp("design", "--reduced problems/hertz.json" + history + choice),
                 two = run_miniapp("design", "--reduced '" + file + "'" + history + choice);
      ASSERT_EQ(one.code, 0) << one.output;
      ASSERT_EQ(two.code, 0) << two.output;
      const double objective = one.results["objective"];
      EXPECT_NEAR(two.results["objective_at_start"], one.results["objective_at_start"],
                  1e-9 * objective);
      EXPECT_NEAR(two.results["objective"], objective, 1e-3 * objective) << two.output;
      const std::size_t count = one.results["variables"].size();
      ASSERT_EQ(two.results["variables"].size(), 2 * count) << two.output;
      const std::string name = two.results["chosen"][count]["variable"];
      EXPECT_EQ(name.find("line 2 (\"other\"), "), 0u) << name;
   }
   // Names with commas and quotes are one field of a table, and of the lines of a figure.
   const std::string prefix = testing::TempDir() + "two_lines";
   const auto run =
      run_miniapp("design", "--reduced '" + file +
                               "' --history 'P=0; P=1' --profile crown --powers 2 "
                               "--most 0.001 --lines 1 --csv '" +
                               prefix + "'");
   ASSERT_EQ(run.code, 0) << run.output;
   for (const char *table : {"_chosen.csv", "_lines.csv"})
   {
      std::ifstream in(prefix + table);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      EXPECT_NE(text.find("\n\"line 2 (\"\"other\"\"), of power 2\","), std::string::npos)
         << table << '\n'
         << text;
   }
}

// Half of a contact has its middle on the plane of symmetry: of a crown x² it is the end that
// stays, whichever that is.
TEST(DesignStudy, MiddleOfHalfALine)
{
   using namespace cattaneo;
   ReducedProblem problem = load_reduced_problem(CATTANEO_SOURCE_DIR "/problems/hertz.json");
   problem.gap.setZero();
   const std::string file = testing::TempDir() + "half_a_line.json";
   const Eigen::Index last = problem.nodes() - 1;
   for (const std::size_t end : {0, 1})
   {
      ContactChain &chain = problem.chains[0];
      chain.ends = chain.other_ends = {LineEnd::smooth, LineEnd::smooth};
      chain.ends[end] = chain.other_ends[end] = LineEnd::symmetry;
      save(problem, file);
      for (const std::string profile :
           {"--profile crown --powers 2 --most 0.001", "--profile rounded --most 1e-4"})
      {
         const auto run =
            run_miniapp("design", "--reduced '" + file + "' --history 'P=0; P=1' " + profile);
         ASSERT_EQ(run.code, 0) << run.output;
         const std::vector<double> chosen = run.results["gap"];
         EXPECT_EQ(chosen[end == 0 ? 0 : last], 0) << profile;
         EXPECT_GT(chosen[end == 0 ? last : 0], 1e-5) << profile;
      }
   }
}

// It slides where Q = f P, with the f = 0.4 of the file.
TEST(DesignStudy, SlidingSaysAtWhichLoad)
{
   const auto run =
      run_miniapp("design", "--reduced problems/hertz.json --history 'P=0; P=1; Q=0.5'");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_NEAR(run.results["event_loads"]["Q"], 0.4, 1e-6);
   EXPECT_NEAR(run.results["event_time"], 1.8, 1e-5);
   EXPECT_NE(run.output.find("(P = 1, Q = 0.4)"), std::string::npos) << run.output;
}

} // namespace
