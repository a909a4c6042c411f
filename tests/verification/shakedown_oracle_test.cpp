#include <cstdio>
#include <cstdlib>
#include <extent.hpp>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <punch_problem.hpp>
#include <shakedown_problems.hpp>

// The limits against HiGHS, an independent solver, through a Python script. A sample of random
// ones; CATTANEO_STRESS=full before it: all of them. ./test brings it into build/deps/highs;
// CATTANEO_HIGHS names another folder.
namespace
{

using namespace cattaneo;
using namespace shakedown_test;
using cattaneo_test::cases;
using cattaneo_test::meshes;

std::vector<std::vector<double>> rows(const Eigen::MatrixXd &M)
{
   std::vector<std::vector<double>> result;
   for (Eigen::Index i = 0; i < M.rows(); ++i)
   {
      const Eigen::VectorXd row = M.row(i);
      result.emplace_back(row.begin(), row.end());
   }
   return result;
}

std::vector<double> list(const Eigen::VectorXd &x)
{
   return {x.begin(), x.end()};
}

std::string python()
{
   const char *highs = std::getenv("CATTANEO_HIGHS");
   const std::string path =
      highs ? highs : std::string(CATTANEO_SOURCE_DIR) + "/build/deps/highs";
   return "OPENBLAS_NUM_THREADS=1 PYTHONPATH='" + path + "' python3 ";
}

class Oracle : public ::testing::Test
{
protected:
   void SetUp() override
   {
      if (std::system("python3 -c '' 2>/dev/null") != 0)
      {
         GTEST_SKIP() << "there is no python3 to run HiGHS";
      }
      ASSERT_EQ(std::system((python() + "-c 'import highspy'").c_str()), 0)
         << "HiGHS is missing: ./test brings it, or pip install --target build/deps/highs "
            "highspy";
   }

   /// One question more: what is asked of this contact under these loads.
   static void add(nlohmann::json &questions, const std::string &what,
                   const ReducedProblem &problem, const LoadCycle &cycle, int sides = 0)
   {
      const StuckForces loads = stuck_forces(problem, cycle);
      nlohmann::json question = {{"ask", what},
                                 {"A", rows(problem.A())},
                                 {"B", rows(problem.B())},
                                 {"friction", list(problem.friction)}};
      for (Eigen::Index j = 0; j < loads.vertices(); ++j)
      {
         question["vertices"].push_back({{"q0", list(loads.q0.col(j))},
                                         {"q1", list(loads.q1.col(j))},
                                         {"p0", list(loads.p0.col(j))},
                                         {"p1", list(loads.p1.col(j))}});
      }
      if (sides > 0) { question["sides"] = sides; }
      questions.push_back(std::move(question));
   }

   /// HiGHS' answers (see the script).
   static nlohmann::json ask(const nlohmann::json &questions)
   {
      const std::string stem =
         ::testing::TempDir() + ::testing::UnitTest::GetInstance()->current_test_info()->name();
      const std::string in = stem + ".in.json", out = stem + ".out.json";
      std::ofstream(in) << questions;
      const std::string command =
         python() + "'" CATTANEO_SOURCE_DIR "/tests/verification/shakedown_oracle.py' '" + in +
         "' '" + out + "'";
      EXPECT_EQ(std::system(command.c_str()), 0) << command;
      nlohmann::json answers;
      std::ifstream(out) >> answers;
      std::remove(in.c_str());
      std::remove(out.c_str());
      EXPECT_EQ(answers.size(), questions.size());
      return answers;
   }

   /// The largest load factor according to HiGHS.
   static double ask(const ReducedProblem &problem, const LoadCycle &cycle)
   {
      nlohmann::json questions;
      add(questions, "load", problem, cycle);
      const nlohmann::json answer = ask(questions)[0];
      EXPECT_EQ(answer[0], "limited");
      return answer[1];
   }

   static void compare(const ReducedProblem &reduced, const LoadCycle &cycle)
   {
      LimitProblem problem = limit_problem(reduced, cycle);
      const LimitReport load = load_limit(problem);
      ASSERT_EQ(load.status, LimitStatus::certified) << load.message;
      const double expected = ask(reduced, cycle);
      EXPECT_NEAR(load.limit, expected, 1e-7 * expected);
      EXPECT_LE(load.lower, expected * (1 + 1e-9));
      EXPECT_GE(load.upper, expected * (1 - 1e-9));

      // Smallest friction at 80 % of that load: both of its bounds, put to the oracle.
      const double load_factor = 0.8 * expected;
      const LimitReport friction = friction_limit(problem, load_factor);
      ASSERT_EQ(friction.status, LimitStatus::certified) << friction.message;
      set_friction(problem.reduced, friction.upper);
      EXPECT_GE(ask(problem.reduced, cycle), load_factor * (1 - 1e-9));
      set_friction(problem.reduced, friction.lower);
      EXPECT_LE(ask(problem.reduced, cycle), load_factor * (1 + 1e-9));
   }
};

TEST_F(Oracle, AgreesOnRandomContacts)
{
   for (unsigned seed = 0; seed < 6; ++seed)
   {
      SCOPED_TRACE(seed);
      compare(random_contact(seed, 5 + 7 * seed, 1, seed % 2 == 1),
              random_cycle(seed, 3, 2 + seed));
   }
}

TEST_F(Oracle, AgreesOnFrictionDiscs)
{
   for (unsigned seed = 0; seed < 4; ++seed)
   {
      SCOPED_TRACE(seed);
      compare(random_contact(seed, 3 + 4 * seed, 2, seed % 2 == 1),
              random_cycle(seed, 3, 2 + seed));
   }
}

TEST_F(Oracle, AgreesOnPunches)
{
   for (const int n : meshes({33, 65}, {129}))
   {
      for (const bool half_plane : {false, true})
      {
         SCOPED_TRACE(n);
         ReducedProblem problem = cattaneo_test::punch_problem(n, half_plane);
         set_friction(problem, 0.85);
         compare(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
      }
   }
}

TEST_F(Oracle, AgreesOnThePunchOf257Nodes)
{
   ReducedProblem problem = cattaneo_test::punch_problem(257, true);
   set_friction(problem, 0.85);
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", -1);
   const LimitReport load = load_limit(limit_problem(problem, cycle));
   ASSERT_EQ(load.status, LimitStatus::certified) << load.message;
   const double expected = ask(problem, cycle);
   EXPECT_NEAR(load.limit, expected, 1e-7 * expected);
   // Independent reference, graded quadratic meshes: 0.8040 ± 3e-4.
   EXPECT_NEAR(load.limit / 0.85, 0.8040, 8e-4);
}

/// The same words for both.
std::string kind(const LimitReport &report)
{
   return report.status == LimitStatus::certified ? "limited" : name(report.status);
}

/// What the statuses claim, from the figures of the report alone.
void expect_proof(const LimitProblem &limit, const LimitReport &report)
{
   if (report.status == LimitStatus::certified || report.status == LimitStatus::bracketed)
   {
      EXPECT_TRUE(std::isfinite(report.lower));
      EXPECT_LE(report.lower, report.upper);
   }
   if (report.status != LimitStatus::unlimited) { return; }
   // Far beyond any limit: |q| ≤ f p with the slip that the ray gives, but for round-off.
   ASSERT_EQ(report.ray.size(), limit.reduced.slips());
   const StuckForces loads = stuck_forces(limit.reduced, limit.cycle);
   const Eigen::Index n = limit.reduced.nodes(), c = limit.reduced.components();
   const double varying =
      std::max(loads.q1.cwiseAbs().maxCoeff(), loads.p1.cwiseAbs().maxCoeff());
   const double constant =
      std::max(loads.q0.cwiseAbs().maxCoeff(), loads.p0.cwiseAbs().maxCoeff());
   const double factor = varying > 0 ? 1e6 * constant / varying : 1.0;
   const Eigen::VectorXd slip = report.slip + factor * report.ray;
   const Eigen::MatrixXd q =
      loads.q(factor).colwise() + Eigen::VectorXd(limit.reduced.A() * slip);
   const Eigen::MatrixXd p =
      loads.p(factor).colwise() + Eigen::VectorXd(limit.reduced.B() * slip);
   const double largest =
      std::max(loads.q(factor).cwiseAbs().maxCoeff(), loads.p(factor).cwiseAbs().maxCoeff());
   for (Eigen::Index j = 0; j < loads.vertices(); ++j)
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double shear = c == 1 ? std::abs(q(i, j)) : std::hypot(q(i, j), q(n + i, j));
         EXPECT_LE(shear, limit.reduced.friction[i] * p(i, j) + 1e-12 * largest) << i;
      }
   }
}

TEST_F(Oracle, AgreesOnRandomLoadLimitsLimitedOrNot)
{
   std::vector<LimitReport> reports;
   std::vector<double> units; // load factors at which varying forces are as large as constant
   nlohmann::json questions = nlohmann::json::array();
   for (unsigned seed = 0; seed < unsigned(cases(60, 1000)); ++seed)
   {
      SCOPED_TRACE(seed);
      const RandomLimit random = random_limit(seed, 1);
      const LimitProblem limit = limit_problem(random.problem, random.cycle);
      reports.push_back(load_limit(limit));
      expect_proof(limit, reports.back());
      add(questions, "load", random.problem, random.cycle);
      const StuckForces loads = stuck_forces(random.problem, random.cycle);
      const double constant =
         std::max(loads.q0.cwiseAbs().maxCoeff(), loads.p0.cwiseAbs().maxCoeff());
      const double varying =
         std::max(loads.q1.cwiseAbs().maxCoeff(), loads.p1.cwiseAbs().maxCoeff());
      units.push_back(constant > 0 && varying > 0 ? constant / varying : 1);
   }
   const nlohmann::json answers = ask(questions);
   std::map<std::string, int> count;
   for (std::size_t k = 0; k < reports.size(); ++k)
   {
      SCOPED_TRACE(k);
      const std::string expected = answers[k][0];
      ++count[expected];
      EXPECT_EQ(kind(reports[k]), expected) << reports[k].message;
      if (expected != "limited") { continue; }
      // The tolerance of the certificate, and that of HiGHS' rows in terms of the load.
      const double limit = answers[k][1];
      EXPECT_NEAR(reports[k].limit, limit, 2e-6 * limit + 1e-9 * units[k]);
   }
   // The sample has enough of each kind.
   const int all = int(reports.size());
   EXPECT_GE(2 * count["limited"], all);
   EXPECT_GE(15 * count["unlimited"], all);
   EXPECT_GE(15 * count["no solution"], all);
   for (const auto &[status, number] : count)
   {
      std::printf("%5d load limits: %s\n", number, status.c_str());
   }
}

TEST_F(Oracle, AgreesOnRandomFrictionLimits)
{
   std::vector<LimitReport> reports;
   nlohmann::json questions = nlohmann::json::array();
   for (unsigned seed = 0; seed < unsigned(cases(10, 300)); ++seed)
   {
      const RandomLimit random = random_limit(seed, 1);
      reports.push_back(friction_limit(limit_problem(random.problem, random.cycle), 1));
      add(questions, "friction", random.problem, random.cycle);
   }
   const nlohmann::json answers = ask(questions);
   for (std::size_t k = 0; k < reports.size(); ++k)
   {
      SCOPED_TRACE(k);
      const LimitReport &report = reports[k];
      if (answers[k][0] == "no solution")
      {
         EXPECT_EQ(report.status, LimitStatus::no_solution) << report.message;
         continue;
      }
      // Whatever the gap, the bounds are on their sides. 1e-7: friction that counts as none.
      const double low = answers[k][1], high = answers[k][2];
      EXPECT_LE(report.lower, high * (1 + 1e-7) + 1e-7);
      EXPECT_GE(report.upper, low * (1 - 1e-7));
      EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   }
}

/// The kind and the figure of the discs lie between those of the polygons within and around.
TEST_F(Oracle, RandomDiscsLieBetweenTheirPolygons)
{
   std::vector<LimitReport> loads, frictions;
   nlohmann::json questions = nlohmann::json::array();
   for (unsigned seed = 0; seed < unsigned(cases(4, 200)); ++seed)
   {
      SCOPED_TRACE(seed);
      const RandomLimit random = random_limit(seed, 2);
      const LimitProblem limit = limit_problem(random.problem, random.cycle);
      loads.push_back(load_limit(limit));
      expect_proof(limit, loads.back());
      frictions.push_back(friction_limit(limit, 1));
      add(questions, "load", random.problem, random.cycle, 64);
      add(questions, "friction", random.problem, random.cycle, 64);
   }
   const nlohmann::json answers = ask(questions);
   int certified = 0, limited = 0; // friction limits
   const std::map<std::string, int> order = {
      {"no solution", 0}, {"limited", 1}, {"unlimited", 2}};
   for (std::size_t k = 0; k < loads.size(); ++k)
   {
      SCOPED_TRACE(k);
      const auto &load = answers[2 * k], &friction = answers[2 * k + 1];
      ASSERT_TRUE(order.count(kind(loads[k]))) << loads[k].message;
      const int rank = order.at(kind(loads[k]));
      EXPECT_GE(rank, order.at(load[0][0]));
      EXPECT_LE(rank, order.at(load[1][0]));
      if (rank == 1 && load[0][0] == "limited")
      {
         EXPECT_GE(loads[k].upper, load[0][1].get<double>() * (1 - 1e-7));
      }
      if (rank == 1 && load[1][0] == "limited")
      {
         EXPECT_LE(loads[k].lower, load[1][1].get<double>() * (1 + 1e-7));
      }
      if (frictions[k].status == LimitStatus::no_solution)
      {
         EXPECT_EQ(friction[0][0], "no solution");
         continue;
      }
      if (friction[1][0] == "no solution")
      {
         // On the edge: no pressure anywhere, and a slip that takes all shear.
         EXPECT_EQ(frictions[k].upper, std::numeric_limits<double>::infinity());
         EXPECT_NE(frictions[k].status, LimitStatus::certified);
         continue;
      }
      EXPECT_GE(frictions[k].upper, friction[1][1].get<double>() * (1 - 1e-7));
      if (friction[0][0] == "limited")
      {
         EXPECT_LE(frictions[k].lower, friction[0][2].get<double>() * (1 + 1e-7) + 1e-7);
      }
      // Where discs wedge, at slips of 1e6 times the others', the solver may leave a gap, and
      // says so.
      EXPECT_LE(frictions[k].upper - frictions[k].lower, 1e-2 * frictions[k].upper + 1e-7);
      certified += frictions[k].status == LimitStatus::certified;
      ++limited;
   }
   EXPECT_GE(certified, 0.95 * limited);
}

} // namespace
