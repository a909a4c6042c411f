#include "expect_input_error.hpp"

#include <cattaneo/design/limit_gradient.hpp>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

using namespace cattaneo;
using namespace shakedown_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Springs of their own: 2 f p = λ (1 - R) q at the weakest of them, here node 1, with p = 2 P.
TEST(LimitGradient, OfTheWeakestSpringInClosedForm)
{
   const Index n = 3;
   ReducedProblem problem;
   const MatrixXd I = MatrixXd::Identity(n, n);
   problem.set_stiffness(I, 0 * I, I);
   problem.patterns = {{"P", Control::force, VectorXd::Zero(n), Eigen::Vector3d(1, 2, 3)},
                       {"Q", Control::force, Eigen::Vector3d(1, 3, 2), VectorXd::Zero(n)}};
   problem.gap = VectorXd::Zero(n);
   set_friction(problem, 0.5);
   const double P = 2, R = -0.5, limit = 2 * 0.5 * (2 * P) / ((1 - R) * 3);
   const LimitProblem given = limit_problem(problem, held_and_cycled(problem, "P", P, "Q", R));
   const LimitGradient by = load_limit_gradient(given, load_limit(given));
   ASSERT_TRUE(by.found) << by.message;
   EXPECT_NEAR(by.friction[1], limit / 0.5, 1e-6);
   EXPECT_NEAR(by.friction[0], 0, 1e-6);
   EXPECT_NEAR(by.friction[2], 0, 1e-6);
   EXPECT_NEAR(by.constant[0], limit / P, 1e-6);
   // Q of 1 and of R at its vertices: λ falls with their difference.
   EXPECT_NEAR(by.varying(1, 0), -limit / (1 - R), 1e-6);
   EXPECT_NEAR(by.varying(1, 1), limit / (1 - R), 1e-6);
   // A gap that node 1 has bridged takes off 1 of its pressure 2 P a unit.
   EXPECT_NEAR(by.gap[1], -limit / (2 * P), 1e-6);
   // The other way round: f = λ (1 - R) 3/(2 · 2 P).
   const LimitReport least = friction_limit(given, 0.7);
   const LimitGradient of_friction = friction_limit_gradient(given, 0.7, least);
   ASSERT_TRUE(of_friction.found) << of_friction.message;
   EXPECT_NEAR(of_friction.load_factor, least.limit / 0.7, 1e-5);
   EXPECT_NEAR(of_friction.constant[0], -least.limit / P, 1e-5);
}

namespace
{

/// A random contact whose normal displacements have a pattern of their own, "gap".
struct LimitCase
{
   ReducedProblem problem;
   LoadCycle cycle;
   MatrixXd dK; ///< a change of the stiffness

   explicit LimitCase(unsigned seed, Index components)
      : problem(random_contact(seed, 2 + seed % 2, components, false)),
        cycle(random_cycle(seed, 3, 2 + seed % 3))
   {
      std::mt19937 random(seed + 77);
      dK = random_matrix(random, problem.K.rows(), problem.K.cols());
      dK = (dK + dK.transpose()).eval();
   }
   void change_gap(Index i, double by)
   {
      const VectorXd forces = -by * problem.K.col(problem.slips() + i);
      problem.patterns.push_back(
         {"gap", Control::force, forces.head(problem.slips()), forces.tail(problem.nodes())});
      const Index count = cycle.constant.size() + 1;
      cycle.constant.conservativeResize(count);
      cycle.constant[count - 1] = 1;
      cycle.varying.conservativeResize(count, Eigen::NoChange);
      cycle.varying.row(count - 1).setZero();
      problem.H = MatrixXd::Zero(count, count);
   }
   void change_stiffness(double by)
   {
      const MatrixXd K = problem.K + by * dK;
      const Index m = problem.slips(), n = problem.nodes();
      problem.set_stiffness(K.topLeftCorner(m, m), K.bottomLeftCorner(n, m),
                            K.bottomRightCorner(n, n));
   }
};

} // namespace

// Every datum changed on its own, with the limit found by trying all corners of what is
// admissible.
TEST(LimitGradient, IsThatOfLimitsFoundByBruteForce)
{
   int compared = 0, bends = 0;
   for (unsigned seed = 0; seed < 10; ++seed)
   {
      const LimitCase at(seed, 1);
      const LimitProblem given = limit_problem(at.problem, at.cycle);
      LimitSettings settings;
      settings.tolerance = 1e-9;
      const LimitReport report = load_limit(given, settings);
      if (report.status != LimitStatus::certified) { continue; }
      const LimitGradient by = load_limit_gradient(given, report, {{at.dK, {}, {}}});
      ASSERT_TRUE(by.found) << by.message;
      const double limit = brute_force_load(at.problem, at.cycle), h = 1e-6;
      const auto compare = [&](double derivative, const auto &change, const char *what)
      {
         LimitCase above = at, below = at;
         change(above, h);
         change(below, -h);
         const double up = (brute_force_load(above.problem, above.cycle) - limit) / h,
                      down = (limit - brute_force_load(below.problem, below.cycle)) / h;
         // Where another corner takes over the limit has two derivatives.
         if (std::abs(up - down) > 1e-3 * (std::abs(up) + limit))
         {
            ++bends;
            return;
         }
         ++compared;
         EXPECT_NEAR(derivative, 0.5 * (up + down), 1e-4 * (limit + std::abs(up)))
            << what << ' ' << seed;
      };
      for (Index i = 0; i < at.problem.nodes(); ++i)
      {
         compare(
            by.friction[i], [i](LimitCase &c, double step) { c.problem.friction[i] += step; },
            "friction");
         compare(
            by.gap[i], [i](LimitCase &c, double step) { c.change_gap(i, step); }, "gap");
      }
      for (Index k = 0; k < 3; ++k)
      {
         compare(
            by.constant[k], [k](LimitCase &c, double step) { c.cycle.constant[k] += step; },
            "constant");
         compare(
            by.varying(k, 1), [k](LimitCase &c, double step) { c.cycle.varying(k, 1) += step; },
            "varying");
      }
      compare(
         by.stiffness[0], [](LimitCase &c, double step) { c.change_stiffness(step); },
         "stiffness");
      // Loads that are scaled scale the limit: of the constant ones with it, of the others
      // against it.
      EXPECT_NEAR(by.constant.dot(at.cycle.constant), limit, 1e-6 * limit);
      EXPECT_NEAR(by.varying.cwiseProduct(at.cycle.varying).sum(), -limit, 1e-6 * limit);
   }
   EXPECT_GT(compared, 80);
   EXPECT_LT(bends, 10);
}

// The same of cones in two directions, and of the least friction; by limits nearby.
TEST(LimitGradient, WithTorsionAndOfTheLeastFriction)
{
   LimitSettings settings;
   settings.tolerance = 1e-9;
   for (unsigned seed = 0; seed < 4; ++seed)
   {
      LimitCase at(seed, 1 + seed % 2);
      const bool of_friction = seed % 4 >= 2;
      const double factor = 0.3, h = 1e-4;
      const auto find = [&](const LimitCase &c)
      {
         const LimitProblem problem = limit_problem(c.problem, c.cycle);
         return of_friction ? friction_limit(problem, factor, settings)
                            : load_limit(problem, settings);
      };
      const LimitReport report = find(at);
      if (report.status != LimitStatus::certified) { continue; }
      const LimitProblem given = limit_problem(at.problem, at.cycle);
      const LimitGradient by = of_friction ? friction_limit_gradient(given, factor, report)
                                           : load_limit_gradient(given, report);
      ASSERT_TRUE(by.found) << by.message;
      for (Index k = 0; k < 3; ++k)
      {
         LimitCase above = at, below = at;
         above.cycle.constant[k] += h;
         below.cycle.constant[k] -= h;
         const double up = (find(above).limit - report.limit) / h,
                      down = (report.limit - find(below).limit) / h;
         if (std::abs(up - down) > 0.01 * (std::abs(up) + report.limit)) { continue; }
         EXPECT_NEAR(by.constant[k], 0.5 * (up + down), 5e-3 * (report.limit + std::abs(up)))
            << seed << ' ' << k;
      }
   }
}

TEST(LimitGradient, NeedsALimitAndWhatFits)
{
   const LimitCase at(1, 1);
   const LimitProblem given = limit_problem(at.problem, at.cycle);
   LimitReport report = load_limit(given);
   expect_input_error(
      [&] {
         load_limit_gradient(given, report, {{MatrixXd::Zero(2, 2), {}, {}}});
      },
      "change of the stiffness is 2");
   report.status = LimitStatus::unlimited;
   report.message = "it holds any";
   const LimitGradient none = load_limit_gradient(given, report);
   EXPECT_FALSE(none.found);
   EXPECT_NE(none.message.find("holds any"), std::string::npos);
}
