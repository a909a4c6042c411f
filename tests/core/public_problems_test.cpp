#include "lemke.hpp"

#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

/// The reduced problems and solutions that are shipped for others, in problems/.
namespace
{

using namespace cattaneo;

const std::string problems = std::string(CATTANEO_SOURCE_DIR) + "/problems/";

Eigen::VectorXd vector(const nlohmann::json &j)
{
   const auto values = j.get<std::vector<double>>();
   return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

struct Shipped
{
   const char *name;
   /// Solved by Lemke's method as well, which shares nothing with the other but the laws. Where
   /// a free body slides or opens it ends in a ray; near critical friction there are two
   /// answers.
   bool lemke;
};

class PublicProblem : public testing::TestWithParam<Shipped>
{
};

TEST_P(PublicProblem, HasTheSolutionThatIsStored)
{
   const std::string name = GetParam().name;
   const ReducedProblem problem = load_reduced_problem(problems + name + ".json");
   std::ifstream in(problems + name + ".solution.json");
   const nlohmann::json solution = nlohmann::json::parse(in);
   ASSERT_EQ(solution.at("format"), "cattaneo reduced solution 1");
   ASSERT_EQ(solution.at("problem"), name + ".json");
   const nlohmann::json &increments = solution.at("increments");
   ASSERT_GE(increments.size(), 20u);
   double length = 0, force = 0;
   for (const nlohmann::json &increment : increments)
   {
      for (const char *key : {"v", "w"})
      {
         length = std::max(length, vector(increment.at(key)).cwiseAbs().maxCoeff());
      }
      force = std::max(force, vector(increment.at("p")).cwiseAbs().maxCoeff());
   }
   for (const bool by_lemke : {false, true})
   {
      if (by_lemke && !GetParam().lemke) { continue; }
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      for (std::size_t k = 0; k < increments.size(); ++k)
      {
         const nlohmann::json &stored = increments[k];
         const Eigen::VectorXd loads = vector(stored.at("multipliers"));
         if (by_lemke)
         {
            const auto found = cattaneo_test::solve_by_lemke(problem, state, loads);
            ASSERT_TRUE(found) << "increment " << k;
            state = *found;
         }
         else
         {
            const IncrementReport report = solver.solve(state, loads);
            ASSERT_EQ(report.status, FrictionStatus::converged)
               << "increment " << k << ": " << report.message;
         }
         // Round-off, magnified by the condition of the equations.
         const auto near = [&](const char *key, const Eigen::VectorXd &x, double scale)
         {
            EXPECT_LE((x - vector(stored.at(key))).cwiseAbs().maxCoeff(), 1e-8 * scale)
               << key << " of increment " << k << (by_lemke ? " by Lemke" : "");
         };
         near("v", state.v, length);
         near("w", state.w, length);
         near("q", state.q, force);
         near("p", state.p, force);
      }
   }
}

INSTANTIATE_TEST_SUITE_P(
   All, PublicProblem,
   testing::Values(Shipped{"square_punch", true}, Shipped{"punch_on_half_plane", true},
                   Shipped{"hertz", false}, Shipped{"hertz_two_laws", false},
                   Shipped{"receding_strip", true}, Shipped{"lap_joint", false},
                   Shipped{"wedge", true}, Shipped{"random_near_critical", false}),
   [](const auto &problem) { return std::string(problem.param.name); });

/// A checker that knows the laws and not this library, with the reader that the documentation
/// prints.
TEST(PublicProblems, StoredSolutionsMeetTheLaws)
{
   for (const char *python : {"python3", "/usr/bin/python3"})
   {
      const std::string program = python;
      if (std::system((program + " -c 'import numpy' 2>/dev/null").c_str()) != 0) { continue; }
      EXPECT_EQ(std::system((program + " '" + problems + "check.py'").c_str()), 0);
      return;
   }
   GTEST_SKIP() << "there is no Python 3 with numpy to read them";
}

} // namespace
