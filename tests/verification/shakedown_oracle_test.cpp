#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <punch_problem.hpp>
#include <shakedown_problems.hpp>
#include <unistd.h>

// The limits against HiGHS, an independent solver, through a Python script. ./test brings it
// into build/deps/highs; CATTANEO_HIGHS names another folder.
namespace
{

using namespace cattaneo;
using namespace shakedown_test;

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

   /// The largest load factor according to HiGHS.
   static double ask(const ReducedProblem &problem, const LoadCycle &cycle)
   {
      const StuckForces loads = stuck_forces(problem, cycle);
      nlohmann::json question = {
         {"A", rows(problem.A)}, {"B", rows(problem.B)}, {"friction", list(problem.friction)}};
      for (Eigen::Index j = 0; j < loads.vertices(); ++j)
      {
         question["vertices"].push_back({{"q0", list(loads.q0.col(j))},
                                         {"q1", list(loads.q1.col(j))},
                                         {"p0", list(loads.p0.col(j))},
                                         {"p1", list(loads.p1.col(j))}});
      }
      const std::string stem = ::testing::TempDir() +
                               ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                               std::to_string(getpid());
      std::ofstream(stem + ".in.json") << question;
      std::remove((stem + ".out.json").c_str());
      const std::string command =
         python() + "'" CATTANEO_SOURCE_DIR "/tests/verification/shakedown_oracle.py' '" +
         stem + ".in.json' '" + stem + ".out.json'";
      EXPECT_EQ(std::system(command.c_str()), 0) << command;
      nlohmann::json answer;
      std::ifstream(stem + ".out.json") >> answer;
      EXPECT_EQ(answer["status"], "Optimal");
      return answer["limit"];
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
   for (const int n : {33, 65, 129})
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

} // namespace
