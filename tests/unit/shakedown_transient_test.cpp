#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

namespace
{

using namespace cattaneo;
using namespace shakedown_test;

TEST(Transient, OptimalSlipDissipatesNothing)
{
   // A wrong sign or a transposed coupling in either half would slip at once.
   for (const double coupling : {0.1, -0.1})
   {
      const ReducedProblem problem = punch_like(65, coupling);
      const LimitProblem limit =
         limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
      const LimitReport report = load_limit(limit);
      ASSERT_EQ(report.status, LimitStatus::certified);
      FrictionSolver solver(problem);
      TransientSettings settings;
      settings.cycles = 3;
      const TransientReport optimal =
         transient(solver, limit, report.lower, report.slip, settings);
      ASSERT_EQ(optimal.status, FrictionStatus::converged) << optimal.message;
      ASSERT_FALSE(optimal.dissipation.empty());
      for (const double loss : optimal.dissipation) { EXPECT_EQ(loss, 0); }
      EXPECT_TRUE((optimal.slip.array() == report.slip.array()).all());
      EXPECT_EQ(optimal.verdict, Verdict::shaken_down);
      EXPECT_TRUE(optimal.opened.empty());
      // It is not that nothing ever slips.
      const TransientReport zero =
         transient(solver, limit, report.lower, 0 * report.slip, settings);
      EXPECT_GT(zero.dissipation[0], 1e-3 * zero.energy);
   }
}

TEST(Transient, UncoupledContactShakesDownFromAnyStartBelowTheLimitAndFromNoneAbove)
{
   const ReducedProblem problem = punch_like(33, 0);
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
   const LimitReport report = load_limit(limit);
   const TransientBracket bracket = transient_bracket(limit, report, 0.02);
   for (const TransientReport &below : bracket.below)
   {
      EXPECT_EQ(below.verdict, Verdict::shaken_down)
         << below.load_factor << ' ' << below.message;
      EXPECT_LT(below.load_factor, report.limit);
   }
   for (const TransientReport &above : bracket.above)
   {
      EXPECT_EQ(above.status, FrictionStatus::converged) << above.message;
      EXPECT_EQ(above.verdict, Verdict::cyclic_slip) << above.load_factor;
      EXPECT_GT(above.dissipation.back(), 0);
   }
   FrictionSolver solver(problem);
   std::mt19937 random(4);
   for (int k = 0; k < 5; ++k)
   {
      const Eigen::VectorXd start = 0.3 * random_matrix(random, 33, 1);
      EXPECT_EQ(transient(solver, limit, 0.98 * report.limit, start).verdict,
                Verdict::shaken_down)
         << k;
   }
   EXPECT_FALSE(find_counter_example(limit, report, 0).found);
}

TEST(Transient, DecayOfOneSpringPairIsImmediate)
{
   // The cycle through a single node is over after one turn: nothing left to decay.
   const ReducedProblem problem = punch_like(3, 0);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", 0));
   const LimitReport report = load_limit(limit);
   FrictionSolver solver(problem);
   TransientSettings settings;
   settings.cycles = 10;
   const TransientReport run =
      transient(solver, limit, 0.9 * report.limit, Eigen::VectorXd::Zero(3), settings);
   EXPECT_EQ(run.verdict, Verdict::shaken_down);
   EXPECT_LT(run.dissipation.size(), 10u);
}

TEST(Transient, LimitOfARecedingContactHoldsInAMarchOfTheWholeContact)
{
   // Two of seven nodes are pulled open by the constant loads and stay so.
   ReducedProblem problem = random_contact(21, 7, 1, false);
   problem.patterns[0].p[2] = problem.patterns[0].p[5] = -2;
   set_friction(problem, 0.4);
   const LoadCycle cycle = held_and_cycled(problem, "press", 1, "shear", -1);
   const ClosedContact contact = closed_contact(problem, {0, 1, 3, 4, 6});
   const LimitProblem limit = limit_problem(contact.reduced, cycle);
   const LimitReport report = load_limit(limit);
   ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
   const Eigen::MatrixXd vertices = cycle.multipliers(report.limit);
   for (Eigen::Index j = 0; j < 2; ++j)
   {
      ASSERT_GT(contact.open_gaps(report.slip, vertices.col(j)).minCoeff(), 0);
   }
   // The whole contact, from the optimal slip of its closed nodes: the open ones move freely.
   Eigen::VectorXd start = Eigen::VectorXd::Zero(7);
   start(contact.closed) = report.slip;
   const LimitProblem whole = limit_problem(problem, cycle);
   FrictionSolver solver(problem);
   TransientSettings settings;
   settings.cycles = 3;
   const TransientReport run =
      transient(solver, whole, report.limit * (1 - 1e-9), start, settings);
   ASSERT_EQ(run.status, FrictionStatus::converged) << run.message;
   for (const double loss : run.dissipation) { EXPECT_LT(std::abs(loss), 1e-14 * run.energy); }
   EXPECT_LT((Eigen::VectorXd(run.slip(contact.closed)) - report.slip).norm(),
             1e-12 * report.slip.norm());
   // Above the limit it slips from there, and for ever.
   const TransientReport above = transient(solver, whole, report.limit * 1.05, start, settings);
   EXPECT_GT(above.dissipation.back(), 1e-6 * above.energy);
}

TEST(Transient, SaysWhichNodesOpenAndSlipForEver)
{
   // Two springs apart from each other, f = 0.5. The first loses its pressure 1 - 2λ at λ = 0.6
   // and its shear with it (v = -0.6); reloaded, it carries 0.3 λ beyond friction: it slips
   // back while the pressure is still there, 2 f p ≥ 1.1, and opens again, for ever. The second
   // carries 0.06 of its 0.5 and never slips.
   ReducedProblem problem;
   problem.A = problem.C = Eigen::Matrix2d::Identity();
   problem.B = Eigen::Matrix2d::Zero();
   problem.patterns = {{"P", Control::force, Eigen::Vector2d::Zero(), Eigen::Vector2d(1, 1)},
                       {"Q", Control::force, Eigen::Vector2d(1, 0.1), Eigen::Vector2d(-2, 0)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Eigen::Vector2d::Zero();
   set_friction(problem, 0.5);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   // The bound is of a contact that stays closed: λ < 1/2.
   EXPECT_LT(load_limit(limit).upper, 0.5 + 1e-9);
   FrictionSolver solver(problem);
   const TransientReport run = transient(solver, limit, 0.6, Eigen::Vector2d::Zero());
   ASSERT_EQ(run.status, FrictionStatus::converged) << run.message;
   EXPECT_EQ(run.opened, NodeList{0});
   EXPECT_EQ(run.verdict, Verdict::slips_and_opens) << name(run.verdict);
   EXPECT_GT(run.opened_loss, 1e-3 * run.energy);
   // Below, nothing opens, and all is still from the start.
   const TransientReport below = transient(solver, limit, 0.1, Eigen::Vector2d::Zero());
   EXPECT_EQ(below.verdict, Verdict::shaken_down);
   EXPECT_TRUE(below.opened.empty());
   EXPECT_EQ(below.opened_loss, 0);
}

TEST(CounterExample, IsFoundBetweenTheTwoLimitsOnly)
{
   // Node 1 feels the slip of node 0 (see the lower limit's test of this chain).
   ReducedProblem problem;
   problem.A = problem.C = 2 * Eigen::Matrix2d::Identity();
   problem.B = Eigen::Matrix2d{{0, 0}, {0.8, 0}};
   problem.patterns = {{"P", Control::force, Eigen::Vector2d::Zero(), Eigen::Vector2d(1, 1)},
                       {"Q", Control::force, Eigen::Vector2d(0.3, 1), Eigen::Vector2d::Zero()}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector2d::Zero();
   set_friction(problem, 0.5);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   const LimitReport upper = load_limit(limit);
   const LowerLimitReport lower = lower_limit(limit, upper);
   CounterExampleSettings settings;
   settings.halvings = 10;
   const CounterExample found = find_counter_example(limit, upper, 0, settings);
   ASSERT_TRUE(found.found) << found.message;
   EXPECT_GE(found.load_factor, lower.value * (1 - 1e-9));
   EXPECT_LT(found.load_factor, lower.value + 0.02 * (upper.limit - lower.value));
   EXPECT_GT(found.dissipation, 0);
   EXPECT_THROW(transient_bracket(limit, upper, 0), InputError);
}

} // namespace
