#include "study/run_miniapp.hpp"

#include <algorithm>
#include <sstream>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using cattaneo_test::run_miniapp;

// The studies' notes, part A. The 201 contact nodes are graded to the corners, to 0.02 a apart
// in the middle: edges are read out to a tenth of that.
const double read_out = 0.002;

TEST(SquarePunch, RigidPlaneMeetsTheReferencesAtBothOrders)
{
   for (const char *order : {"1", "2"})
   {
      const auto run = run_miniapp("square_punch", std::string("-cycles 3 -order ") + order);
      SCOPED_TRACE(run.output);
      expect_values(run, {{"stick half-width, P only", 0.471, 0.003, read_out},
                          {"v(corner), P only", 0.0496, 5e-4, 0},
                          {"right end of stick, Q/fP = 0.25", 0.19, 0.005, read_out},
                          {"right end of stick, Q/fP = 0.5", -0.203, 0.005, read_out},
                          {"right end of stick, Q/fP = 0.75", -0.511, 0.005, read_out},
                          {"right end of stick, Q/fP = 0.9", -0.729, 0.005, read_out},
                          {"steady loss a cycle, Q = ±0.8 fP", 9.17e-4, 0.003 * 9.17e-4, 0}});
      EXPECT_EQ(run.results["status"], "converged");
      EXPECT_EQ(run.results["steady_cycle"], 2);
      EXPECT_LT(std::abs(run.results["energy_imbalance"].get<double>()), 1e-3); // increments
      // A rigid obstacle is no body: one operator, one factorisation, no union; no field was
      // asked.
      EXPECT_EQ(run.results["counters"]["assemblies"], 1);
      EXPECT_EQ(run.results["counters"]["factorisations"], 1);
      EXPECT_EQ(run.results["counters"]["unions"], 0);
      EXPECT_EQ(run.results["counters"]["field_recoveries"], 0);
   }
}

// What the last cycle loses is called steady where the march is: from the first cycle on below
// what friction bears without slip, not after one or two of a shear that turns all of the slip.
TEST(SquarePunch, OnlyASteadyLossIsCalledOne)
{
   const auto loss = [](const std::string &options, const char *key, const char *other)
   {
      const auto run = run_miniapp("square_punch", "-shear none " + options);
      SCOPED_TRACE(run.output);
      EXPECT_FALSE(run.results.contains(other));
      return run.results.at(key).get<double>();
   };
   const char *steady = "steady_loss", *last = "last_loss";
   EXPECT_EQ(loss("-friction 0.5 -amplitude 0.3 -cycles 2", steady, last), 0);
   EXPECT_GT(loss("-friction 0.5 -amplitude 0.7 -cycles 2", last, steady), 0);
   EXPECT_GT(loss("-cycles 1", last, steady), 9.17e-4); // the studies' notes, part A
}

TEST(SquarePunch, HalfPlaneMeetsTheReferencesAtBothOrders)
{
   for (const char *order : {"1", "2"})
   {
      const auto run = run_miniapp(
         "square_punch", std::string("-obstacle half-plane -cycles 3 -order ") + order);
      SCOPED_TRACE(run.output);
      // Slip is lost at the corners, where linear elements are first order in their size.
      const double corner = order[0] == '1' ? 0.008 : 0.003;
      expect_values(run, {{"stick half-width, P only", 0.909, 0.002, read_out},
                          {"right end of stick, Q/fP = 0.25", 0.737, 0.002, read_out},
                          {"right end of stick, Q/fP = 0.75", -0.526, 0.002, read_out},
                          {"steady loss a cycle, Q = ±0.8 fP", 3.377e-3, 0.003 * 3.377e-3,
                           corner * 3.377e-3}});
      EXPECT_EQ(run.results["counters"]["factorisations"], 1); // the half-plane has no mesh
      EXPECT_EQ(run.results["counters"]["unions"], 1);
   }
}

TEST(SquarePunch, NoLossBelowTheShakedownLoad)
{
   // Studies A: at ±0.6 fP nothing is lost from the second cycle on.
   const auto run = run_miniapp("square_punch", "-cycles 3 -amplitude 0.6 --shear ''");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_GT(run.results["dissipation"][0].get<double>(), 1e-6);
   EXPECT_LT(std::abs(run.results["dissipation"][1].get<double>()), 1e-14);
}

TEST(SquarePunch, InfinitesimalShearSticksTheBackwardSlip)
{
   const auto run = run_miniapp("square_punch", "--shear '1e-6'");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_NEAR(run.results["levels"][0]["stick_left"].get<double>(), -1, 1e-12);
}

/// What turned back has no reference of loading, and no closed form of it.
TEST(SquarePunch, ReferencesKnowThePath)
{
   const std::string name = "right end of stick, Q/fP = 0.25";
   for (const auto &[shear, compared] :
        {std::pair{"0.25 0.9", true}, {"0.9 0.25", false}, {"-0.5 0.25", false}})
   {
      const auto run = run_miniapp("square_punch", std::string("-shear '") + shear + "'");
      ASSERT_EQ(run.code, 0) << run.output;
      bool found = false;
      for (const auto &row : run.results["references"]) { found |= row["quantity"] == name; }
      EXPECT_EQ(found, compared) << shear;
      const auto back = run_miniapp("hertz", std::string("-shear '") + shear + "'");
      ASSERT_EQ(back.code, 0) << back.output;
      for (const auto &row : back.results["levels"])
      {
         if (row["shear"] == 0.25)
         {
            EXPECT_EQ(row["cattaneo_mindlin"].is_number(), compared) << row;
         }
      }
   }
   // The mirror image of a shear has the same stick, and is as far off the closed form.
   const auto one = run_miniapp("hertz", "-shear 0.5"),
              other = run_miniapp("hertz", "-shear -0.5");
   ASSERT_EQ(one.code + other.code, 0) << other.output;
   const auto &right = one.results["levels"][0], &left = other.results["levels"][0];
   EXPECT_NEAR(left["cattaneo_mindlin"].get<double>(), std::sqrt(0.5), 1e-15);
   for (const char *key : {"stick_half_width", "shear_deviation"})
   {
      EXPECT_NEAR(left[key].get<double>(), right[key].get<double>(), 1e-6) << key;
   }
}

TEST(SquarePunch, SlipUnderPressureAloneIsOdd)
{
   const auto run = run_miniapp("square_punch", "--shear ''");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_NEAR(run.results["stick_left"].get<double>(),
               -run.results["stick_right"].get<double>(), 1e-9);
   EXPECT_EQ(run.results["counters"]["increments"], 1); // self-similar: one increment is exact
}

/// The cycle begins where P alone left the punch, not where the levels of Q ended: the history
/// says so, and the area of the loop in it is what is printed.
TEST(SquarePunch, LoopOfTheHistoryIsThatOfTheCycle)
{
   const std::string prefix = testing::TempDir() + "loop";
   const auto run = run_miniapp("square_punch", "-nodes 41 -shear '0.5 0.9' -cycles 1 "
                                                "-amplitude 0.5 -events --csv '" +
                                                   prefix + "'");
   ASSERT_EQ(run.code, 0) << run.output;
   std::ifstream in(prefix + "_history.csv");
   std::string line, cell;
   std::vector<std::string> names;
   std::vector<std::vector<double>> rows;
   std::getline(in, line);
   for (std::istringstream cells(line); std::getline(cells, cell, ',');)
   {
      names.push_back(cell);
   }
   while (std::getline(in, line))
   {
      rows.emplace_back();
      for (std::istringstream cells(line); std::getline(cells, cell, ',');)
      {
         rows.back().push_back(std::stod(cell));
      }
   }
   const auto column = [&](const char *name)
   {
      const auto found = std::find(names.begin(), names.end(), name);
      return static_cast<std::size_t>(found - names.begin());
   };
   const std::size_t time = column("time"), cycle = column("cycle"), Q = column("load Q"),
                     moved = column("displacement Q");
   ASSERT_LT(moved, names.size());
   double work = 0;
   int jumps = 0;
   for (std::size_t k = 1; k < rows.size(); ++k)
   {
      const auto &before = rows[k - 1], &now = rows[k];
      if (now[time] == before[time])
      {
         EXPECT_EQ(now[Q], 0); // P alone
         ++jumps;
         work = 0;
         continue;
      }
      work += 0.5 * (now[Q] + before[Q]) * (now[moved] - before[moved]);
   }
   EXPECT_EQ(jumps, 1);
   EXPECT_EQ(rows.back()[cycle], 1);
   const double printed = run.results["cycles"][0]["work Q"];
   EXPECT_NEAR(work, printed, 1e-9 * printed);
   for (const char *table : {"cycles", "history", "levels", "loops", "slip", "tractions"})
   {
      std::remove((prefix + "_" + table + ".csv").c_str());
   }
}

TEST(SquarePunch, FrictionlessHasNoTangentialUnknowns)
{
   const auto run = run_miniapp("square_punch", "-friction 0 --shear ''");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["counters"]["tangential_unknowns"], 0);
   EXPECT_TRUE(run.results["stick_left"].is_null());
   // Q is in f P, which is none.
   const auto pressed = run_miniapp("square_punch", "-friction 0 -nodes 33");
   EXPECT_EQ(pressed.code, 0) << pressed.output;
   EXPECT_TRUE(pressed.results["levels"].empty()) << pressed.results["levels"];
   for (const char *options : {"-shear 0.5", "-cycles 2"})
   {
      const auto sheared = run_miniapp("square_punch", std::string("-friction 0 ") + options);
      EXPECT_EQ(sheared.code, 1) << sheared.output;
   }
}

TEST(SquarePunch, GrossSlidingIsAnAnswerWithItsLoad)
{
   const auto run = run_miniapp("square_punch", "--shear '0.5 1.2'");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["status"], "gross sliding");
   // Q = f P, whatever the elasticity.
   EXPECT_NEAR(run.results["event_loads"]["Q"].get<double>(), 0.2, 1e-8);
   EXPECT_NE(run.output.find("slides"), std::string::npos);
}

/// P in the first unit of time, Q/fP = 0.5 in the second, and of the way to 1.2 in the third
/// what is up to 1. All that is written has that time.
TEST(SquarePunch, AStudyHasOneClock)
{
   const std::string prefix = testing::TempDir() + "punch_clock", page = prefix + ".html";
   const auto run = run_miniapp("square_punch", "-shear '0.5 1.2' -nodes 41 --csv '" + prefix +
                                                   "' --html '" + page + "'");
   EXPECT_EQ(run.code, 2) << run.output;
   const double slides = 2 + (1 - 0.5) / (1.2 - 0.5);
   EXPECT_NEAR(run.results["event_time"].get<double>(), slides, 1e-6);
   EXPECT_NE(run.output.find("at time 2.714"), std::string::npos) << run.output;
   std::ifstream history(prefix + "_history.csv");
   std::string line, last;
   while (std::getline(history, line)) { last = line; }
   EXPECT_NEAR(std::stod(last), slides, 1e-6);
   std::ostringstream text;
   text << std::ifstream(page).rdbuf();
   EXPECT_NE(text.str().find("\"time\":2.714"), std::string::npos);
   for (const char *file : {"_history.csv", "_levels.csv", "_slip.csv", "_tractions.csv",
                            "_references.csv", ".html"})
   {
      std::remove((prefix + file).c_str());
   }
}

TEST(SquarePunch, BadOptionsAreOneSentenceAndExitCodeOne)
{
   for (const char *options :
        {"-friction -0.1", "-poisson 0.5", "-nodes 100", "-order 0", "-grading 0", "-domain 1",
         "-obstacle wall", "--shear '0.2 x'", "-cycles -1", "-increments 0", "-friction nan",
         "--no-such-option", "-order two"})
   {
      const auto run = run_miniapp("square_punch", options);
      EXPECT_EQ(run.code, 1) << options << "\n" << run.output;
      EXPECT_NE(run.output.find("error:"), std::string::npos) << options << "\n" << run.output;
      EXPECT_TRUE(run.results.is_null()) << options;
   }
   EXPECT_EQ(run_miniapp("square_punch", "-h").code, 0);
   const auto run = run_miniapp("square_punch", "-nodes 33 --json /nonexistent/folder/x.json");
   EXPECT_EQ(run.code, 1) << run.output;
}

} // namespace
