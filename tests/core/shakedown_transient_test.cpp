#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <gtest/gtest.h>
#include <period_two.hpp>
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
      EXPECT_EQ(optimal.verdict, TransientVerdict::shaken_down);
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
      EXPECT_EQ(below.verdict, TransientVerdict::shaken_down)
         << below.load_factor << ' ' << below.message;
      EXPECT_LT(below.load_factor, report.limit);
   }
   for (const TransientReport &above : bracket.above)
   {
      EXPECT_EQ(above.status, FrictionStatus::converged) << above.message;
      EXPECT_EQ(above.verdict, TransientVerdict::cyclic_slip) << above.load_factor;
      EXPECT_GT(above.dissipation.back(), 0);
   }
   FrictionSolver solver(problem);
   std::mt19937 random(4);
   for (int k = 0; k < 5; ++k)
   {
      const Eigen::VectorXd start = 0.3 * random_matrix(random, 33, 1);
      EXPECT_EQ(transient(solver, limit, 0.98 * report.limit, start).verdict,
                TransientVerdict::shaken_down)
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
   EXPECT_EQ(run.verdict, TransientVerdict::shaken_down);
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
   // Two springs apart from each other, f = 0.5: q = v + 1.5 Q, p = 1 - 2 Q at the first, Q
   // from 0.6 to -0.6. It opens at Q = 0.5, closes there with v = -0.75, and slips back against
   // q = -f p = Q - 0.5: v = -0.5 - 0.5 Q, to v = -0.2. From Q = 0.28 it slips forward, v =
   // 0.5 - 2.5 Q, until it opens again, for ever. What is lost in a cycle, ∫ f p |dv|:
   // 0.5 · 1.1²/2 + 2.5 · 0.22²/2 = 0.363. The second carries 0.06 of its 0.5 and never slips.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                         Eigen::Matrix2d::Identity());
   problem.patterns = {
      {"P", Control::force, Eigen::Vector2d::Zero(), Eigen::Vector2d(1, 1)},
      {"Q", Control::force, Eigen::Vector2d(1.5, 0.1), Eigen::Vector2d(-2, 0)}};
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
   EXPECT_EQ(run.verdict, TransientVerdict::slips_and_opens) << name(run.verdict);
   // The increments in which slip sets in and the node opens add a little.
   EXPECT_NEAR(run.opened_loss, 0.363, 0.02 * 0.363);
   // Below, nothing opens, and all is still from the start.
   const TransientReport below = transient(solver, limit, 0.1, Eigen::Vector2d::Zero());
   EXPECT_EQ(below.verdict, TransientVerdict::shaken_down);
   EXPECT_TRUE(below.opened.empty());
   EXPECT_EQ(below.opened_loss, 0);
}

TEST(Transient, SlipThatLosesNextToNothingGoesOn)
{
   // A spring alone, q = v + Q/2, p = 1 - 2 Q, Q from 0 to λ: the slip v = -1/4 holds it up to
   // λ = 1/2, where p = q = 0. Above, at λ = (1 + e)/2, it opens at Q = 1/2 and moves on with
   // Q, by e/4, without a force: closed again it sticks. Whatever increments make of that loses
   // e² of what a whole slip loses.
   ReducedProblem problem;
   const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
   const Eigen::VectorXd unit = Eigen::VectorXd::Ones(1);
   problem.set_stiffness(one, 0 * one, one);
   problem.patterns = {{"P", Control::force, 0 * unit, unit},
                       {"Q", Control::force, 0.5 * unit, -2 * unit}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = 0 * unit;
   set_friction(problem, 0.5);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", 0));
   const LimitReport report = load_limit(limit);
   ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_NEAR(report.upper, 0.5, 1e-6);
   FrictionSolver solver(problem);
   for (const double e : {1e-7, 1e-5, 1e-3, 1e-1})
   {
      // Equal increments close it again at the end of one, where it sticks beyond its limit:
      // they would miss what moves, and are not asked.
      const TransientReport run = transient(solver, limit, report.upper * (1 + e), report.slip);
      ASSERT_EQ(run.status, FrictionStatus::converged) << run.message;
      EXPECT_EQ(run.opened, NodeList{0}) << e;
      EXPECT_EQ(run.verdict, TransientVerdict::slips_and_opens) << e << name(run.verdict);
      EXPECT_LT(run.opened_loss, 10 * e * e) << e;
      EXPECT_NEAR(run.cycle_slip[0], 2 * 0.25 * e, 1e-3 * e + 1e-9) << e;
   }
   const TransientReport below = transient(solver, limit, report.lower, report.slip);
   EXPECT_EQ(below.verdict, TransientVerdict::shaken_down);
   EXPECT_LT(below.cycle_slip[0], 1e-12 * below.elastic_slip);
   // Where the limit is known it is no shakedown, though it moves by less than 1e-9.
   for (const double e : {1e-10, 1e-9, 1e-8, 1e-7})
   {
      for (const double start : {0.0, 1.0})
      {
         TransientSettings settings;
         settings.upper = report.upper;
         const TransientReport run =
            transient(solver, limit, report.upper * (1 + e), start * report.slip, settings);
         EXPECT_EQ(run.verdict, run.opened.empty() ? TransientVerdict::still_slipping
                                                   : TransientVerdict::slips_and_opens)
            << e << ' ' << start << ' ' << name(run.verdict);
      }
   }
}

TEST(Transient, SlipThatFallsGeometricallyIsNoCyclicSlip)
{
   // Uncoupled: below the limit every start shakes down. Losses fall by 0.71 in each cycle, and
   // slip changes by less than 1e-10 of the start while it loses more than 1e-9 of the elastic
   // energy still.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix3d{{3.08595, -2.81641, 0.0226648},
                                         {-2.81641, 3.6189, -0.518902},
                                         {0.0226648, -0.518902, 0.914836}},
                         Eigen::Matrix3d::Zero(),
                         Eigen::Matrix3d{{2.08573, -1.81664, -0.0619496},
                                         {-1.81664, 4.76425, -2.62278},
                                         {-0.0619496, -2.62278, 3.02895}});
   problem.patterns = {{"P", Control::force, Eigen::Vector3d(0.0285189, -0.0214429, 0.019252),
                        Eigen::Vector3d(0.834493, 0.550778, 1.40542)},
                       {"Q", Control::force, Eigen::Vector3d(1.31138, -0.73997, -0.37485),
                        Eigen::Vector3d(0.514638, 0.224715, -0.00649264)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Eigen::Vector3d::Zero();
   set_friction(problem, 0.702857793);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   const LimitReport report = load_limit(limit);
   ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
   ASSERT_FALSE(report.coupled);
   FrictionSolver solver(problem);
   const Eigen::Vector3d start(0.5690617217816977, 1.3666663176682405, -0.31548446710817213);
   for (const double size : {1.0, 10.0, 100.0})
   {
      for (const int cycles : {60, 100, 300})
      {
         TransientSettings settings;
         settings.cycles = cycles;
         const TransientReport run =
            transient(solver, limit, 0.4 * report.lower, size * start, settings);
         EXPECT_EQ(run.verdict, TransientVerdict::shaken_down)
            << size << ' ' << cycles << ' ' << name(run.verdict);
      }
   }
}

/// Above a certified upper limit nothing has shaken down, from whatever start, however close.
TEST(Transient, NothingShakesDownAboveACertifiedLimit)
{
   int certified = 0;
   for (unsigned seed = 1; seed <= 40; ++seed)
   {
      const Eigen::Index n = 1 + seed % 6;
      ReducedProblem problem = random_contact(seed, n, 1, false);
      if (seed % 2 == 0)
      {
         problem.B().setZero();
         join_coupling(problem);
      }
      const LimitProblem limit = limit_problem(
         problem, held_and_cycled(problem, "press", 1, "shear", seed % 3 == 0 ? 0 : -1));
      const LimitReport report = load_limit(limit);
      if (report.status != LimitStatus::certified) { continue; }
      ++certified;
      FrictionSolver solver(problem);
      TransientSettings settings;
      settings.cycles = 60;
      for (const double above : {1e-6, 1e-5, 1e-4, 1e-2})
      {
         for (const double start : {0.0, 1.0})
         {
            const double load_factor = report.upper * (1 + above);
            const Eigen::VectorXd slip = start * report.slip;
            const TransientReport run = transient(solver, limit, load_factor, slip, settings);
            EXPECT_NE(run.verdict, TransientVerdict::shaken_down)
               << seed << ' ' << above << ' ' << start;
            // Where the bound is known, whatever the tolerances are.
            settings.shaken_down = 0.9;
            settings.upper = report.upper;
            EXPECT_NE(transient(solver, limit, load_factor, slip, settings).verdict,
                      TransientVerdict::shaken_down)
               << seed << ' ' << above << ' ' << start;
            settings = {};
            settings.cycles = 60;
         }
      }
   }
   EXPECT_GT(certified, 20);
}

TEST(Transient, AStateOfPeriodTwoIsJudgedByTheCycleThatLosesMore)
{
   // A cycle loses 33/16 or 29/16. Slip is judged beside 1e-9 of the slip of the stuck contact
   // let go, √(2 stored/soft) with soft = 2⁻³⁰: 0.46 and 2.5, where nodes slip by about 1.
   const double x = -0.125;
   LoadCycle cycle{Eigen::Vector3d(1, 0, 0), cattaneo_test::loads_of_period_two()};
   cycle.varying.row(0).setZero();
   for (const double stored : {0.0, 1e8, 3e9})
   {
      const ReducedProblem problem = cattaneo_test::period_two(stored);
      const LimitProblem limit = limit_problem(problem, cycle);
      FrictionSolver solver(problem);
      const TransientReport run = transient(solver, limit, 1, Eigen::Vector3d(0, x, 0));
      ASSERT_EQ(run.status, FrictionStatus::converged) << run.message;
      EXPECT_EQ(run.steady_cycle, 1);
      EXPECT_EQ(run.steady_period, 2);
      ASSERT_EQ(run.dissipation.size(), 2u);
      EXPECT_NEAR(run.dissipation[0], cattaneo_test::loss_of_period_two(x), 1e-12);
      EXPECT_NEAR(run.dissipation[1], cattaneo_test::loss_of_period_two(-x), 1e-12);
      // Half of 1.5 squared is the elastic energy of the node that is sheared most.
      EXPECT_NEAR(run.energy, 1.125 + stored, 1e-14 * stored + 1e-14);
      EXPECT_EQ(run.verdict,
                stored < 1e9 ? TransientVerdict::cyclic_slip : TransientVerdict::shaken_down)
         << name(run.verdict);
   }
}

/// Two springs that pull each other along by half their slip, f P = 1, pushed the same way by
/// 1.1 one after the other: each push slips on by half of what the other one did.
struct Ratchet
{
   ReducedProblem problem;
   LoadCycle cycle{Eigen::Vector3d(1, 0, 0), Eigen::MatrixXd::Zero(3, 2)};

   Ratchet()
   {
      const Eigen::Vector2d zero(0, 0);
      problem.set_stiffness(Eigen::Matrix2d{{1, -0.5}, {-0.5, 1}}, Eigen::Matrix2d::Zero(),
                            Eigen::Matrix2d::Identity());
      problem.patterns = {{"P", Control::force, zero, Eigen::Vector2d(2, 2)},
                          {"Q0", Control::force, Eigen::Vector2d(1, 0), zero},
                          {"Q1", Control::force, Eigen::Vector2d(0, 1), zero}};
      problem.H = Eigen::Matrix3d::Zero();
      problem.gap = zero;
      set_friction(problem, 0.5);
      cycle.varying(1, 0) = cycle.varying(2, 1) = 1.1;
   }
};

TEST(Transient, ANodeThatOpensAtFirstOnlyIsNotSaidToOpen)
{
   // Node 0 is pressed by 0.1 and by half of node 1's slip. It begins with v1 = -0.8, open by
   // 0.3; as soon as node 1 has come to -0.2 it is closed for good, under 0.05 of pressure, and
   // slips by 0.13 to either side: 0.05 · 0.52 is lost in a cycle.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::Matrix2d{{0, 0.5}, {0, 0}},
                         Eigen::Matrix2d::Identity());
   const Eigen::Vector2d zero(0, 0);
   problem.patterns = {{"P", Control::force, zero, Eigen::Vector2d(0.1, 1)},
                       {"Q", Control::force, Eigen::Vector2d(0.2, 1), zero}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = zero;
   set_friction(problem, 1);
   FrictionSolver solver(problem);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      TransientSettings settings;
      settings.march.stepping = stepping;
      const TransientReport report =
         transient(solver, limit, 0.9, Eigen::Vector2d(0, -0.8), settings);
      EXPECT_EQ(report.verdict, TransientVerdict::cyclic_slip);
      EXPECT_TRUE(report.opened.empty());
      EXPECT_EQ(report.opened_loss, 0);
      EXPECT_NEAR(report.dissipation.back(), 0.026, 1e-14);
      EXPECT_NEAR(std::abs(report.slip[1]), 0.1, 1e-14);
   }
}

TEST(Transient, ABodyThatWalksDoesNotShakeDown)
{
   // Free, it walks by as much in every cycle: losses of 1.3 and then 0.4, below 0.35 · 1.3,
   // which is what counts as little here, but not less from cycle to cycle.
   Ratchet ratchet;
   ratchet.problem.A() << 1, -1, -1, 1;
   complete(ratchet.problem);
   FrictionSolver solver(ratchet.problem);
   TransientSettings settings;
   settings.cycles = 20;
   settings.shaken_down = 0.35;
   const TransientReport report =
      transient(solver, limit_problem(ratchet.problem, ratchet.cycle), 1,
                Eigen::Vector2d(-1, 0), settings);
   EXPECT_NEAR(report.dissipation.front(), 1.3, 1e-14);
   EXPECT_NEAR(report.dissipation.back(), 0.4, 1e-13);
   EXPECT_EQ(report.verdict, TransientVerdict::still_slipping);
   EXPECT_NEAR(report.decay, 1, 1e-12);
}

TEST(Transient, DecayAndVerdictOfARatchetByHand)
{
   // Slips of 0.1 · (1.5, 0.75), then a quarter of these in each cycle, against f P = 1.
   const Ratchet ratchet;
   const LimitProblem limit = limit_problem(ratchet.problem, ratchet.cycle);
   FrictionSolver solver(ratchet.problem);
   const auto run = [&](int cycles)
   {
      TransientSettings settings;
      settings.cycles = cycles;
      const TransientReport report =
         transient(solver, limit, 1, Eigen::Vector2d::Zero(), settings);
      EXPECT_EQ(report.status, FrictionStatus::converged);
      for (std::size_t k = 0; k < report.dissipation.size(); ++k)
      {
         EXPECT_NEAR(report.dissipation[k], 0.225 * std::pow(0.25, k), 1e-14) << k;
      }
      EXPECT_NEAR(report.energy, 0.5 * 1.1 * 1.1 / 0.75, 1e-14);
      return report;
   };
   // It is the energy, 0.8067, that losses are compared with: they are below 1e-6 of it from
   // the eleventh cycle on, 0.225/4^10 = 2.1e-7.
   const TransientReport early = run(3), before = run(10), after = run(12), steady = run(200);
   EXPECT_EQ(early.verdict, TransientVerdict::still_slipping);
   EXPECT_EQ(early.dissipation.size(), 3u);
   EXPECT_EQ(early.steady_cycle, 0);
   EXPECT_EQ(before.verdict, TransientVerdict::still_slipping);
   EXPECT_EQ(after.verdict, TransientVerdict::shaken_down);
   EXPECT_EQ(after.steady_cycle, 0);
   EXPECT_EQ(steady.verdict, TransientVerdict::shaken_down);
   EXPECT_GT(steady.steady_cycle, 12);
   EXPECT_LT(steady.dissipation.size(), 25u);
   for (const TransientReport &report : {early, before, after, steady})
   {
      EXPECT_NEAR(report.decay, 0.25, 1e-7);
   }
   EXPECT_EQ(run(1).decay, 0);
   EXPECT_NEAR(run(2).decay, 0.25, 1e-12);
   EXPECT_LT((steady.slip - Eigen::Vector2d(-0.2, -0.2)).norm(), 1e-10);
   // What losses are compared with is set, and that of the first cycle if it is more.
   TransientSettings settings;
   settings.cycles = 5; // the last two lose 1/64 and 1/256 of the first
   settings.shaken_down = 0.225 * 0.016 / 0.8067;
   EXPECT_EQ(transient(solver, limit, 1, Eigen::Vector2d::Zero(), settings).verdict,
             TransientVerdict::shaken_down);
   settings.shaken_down = 0.225 * 0.0038 / 0.8067;
   EXPECT_EQ(transient(solver, limit, 1, Eigen::Vector2d::Zero(), settings).verdict,
             TransientVerdict::still_slipping);
   // From a slip of 1 the first cycle slips by 0.9 + 0.45, more than the energy: the last
   // two lose 1/64 and 1/256 of that.
   settings.shaken_down = 0.016;
   const TransientReport far = transient(solver, limit, 1, Eigen::Vector2d(1, 1), settings);
   EXPECT_NEAR(far.dissipation[0], 1.35, 1e-14);
   EXPECT_EQ(far.verdict, TransientVerdict::shaken_down);
}

TEST(Transient, BeginsAtTheConstantLoadsWhereTheyLieOnTheCycle)
{
   // q = 2 v + λ, f P = 0.4. To and fro between λ and R λ with the constant loads between or at
   // the end: from there; else from the first vertex, and what it slips to it is no cycle's.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Constant(1, 1, 2), Eigen::MatrixXd::Zero(1, 1),
                         Eigen::MatrixXd::Ones(1, 1));
   const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1), one = Eigen::VectorXd::Ones(1);
   problem.patterns = {{"P", Control::force, zero, one}, {"Q", Control::force, one, zero}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = zero;
   set_friction(problem, 0.4);
   FrictionSolver solver(problem);
   const auto run = [&](double load, double reversal)
   {
      const LimitProblem limit =
         limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", reversal));
      return transient(solver, limit, load, zero);
   };
   // R = -1: -0.3, 0.3, 0.2, then -0.3, 0.3, 0.2 again.
   const TransientReport reversed = run(1, -1);
   ASSERT_EQ(reversed.dissipation.size(), 2u);
   EXPECT_NEAR(reversed.dissipation[0], 0.4 * 1, 1e-14);
   EXPECT_NEAR(reversed.dissipation[1], 0.4 * 1.2, 1e-14);
   EXPECT_EQ(reversed.verdict, TransientVerdict::cyclic_slip);
   EXPECT_EQ(reversed.steady_cycle, 2);
   EXPECT_EQ(reversed.steady_period, 1);
   EXPECT_NEAR(reversed.energy, 0.25, 1e-15);
   // R = 0: -0.3, -0.2, then -0.3, -0.2.
   const TransientReport repeated = run(1, 0);
   ASSERT_EQ(repeated.dissipation.size(), 2u);
   EXPECT_NEAR(repeated.dissipation[0], 0.4 * 0.4, 1e-14);
   EXPECT_NEAR(repeated.dissipation[1], 0.4 * 0.2, 1e-14);
   // R = ½, λ = 2: to -0.8 first; each cycle to -0.7 and back.
   const TransientReport pulsed = run(2, 0.5);
   ASSERT_EQ(pulsed.dissipation.size(), 1u);
   EXPECT_NEAR(pulsed.dissipation[0], 0.4 * 0.2, 1e-14);
   EXPECT_EQ(pulsed.verdict, TransientVerdict::cyclic_slip);
   EXPECT_NEAR(pulsed.slip[0], -0.8, 1e-14);
   // λ = 1.5: it comes to -0.55 and stays.
   const TransientReport rests = run(1.5, 0.5);
   EXPECT_EQ(rests.verdict, TransientVerdict::shaken_down);
   EXPECT_NEAR(rests.dissipation[0], 0, 1e-14);
   EXPECT_NEAR(rests.slip[0], -0.55, 1e-14);
}

TEST(Transient, SaysWhenThereIsNoEquilibriumAndRefusesBadSettings)
{
   // A free body that is sheared by more than f P = 1.
   Ratchet ratchet;
   ratchet.problem.A() << 1, -1, -1, 1;
   complete(ratchet.problem);
   const LimitProblem limit = limit_problem(ratchet.problem, ratchet.cycle);
   FrictionSolver solver(ratchet.problem);
   const Eigen::Vector2d stuck(0, 0);
   const TransientReport slides = transient(solver, limit, 3, stuck);
   EXPECT_EQ(slides.status, FrictionStatus::gross_sliding);
   EXPECT_EQ(slides.verdict, TransientVerdict::no_equilibrium);
   EXPECT_NE(slides.message.find("slides"), std::string::npos) << slides.message;
   EXPECT_EQ(slides.load_factor, 3);
   // Not even the constant loads.
   LimitProblem pulled = limit;
   pulled.cycle.constant[0] = -1;
   const TransientReport lifts = transient(solver, pulled, 1, stuck);
   EXPECT_EQ(lifts.verdict, TransientVerdict::no_equilibrium);
   EXPECT_NE(lifts.status, FrictionStatus::converged);
   EXPECT_NE(lifts.message, "");
   EXPECT_EQ(lifts.slip, Eigen::VectorXd(stuck));
   const std::vector<std::string> names = {
      name(TransientVerdict::shaken_down), name(TransientVerdict::slips_and_opens),
      name(TransientVerdict::cyclic_slip), name(TransientVerdict::still_slipping),
      name(TransientVerdict::no_equilibrium)};
   EXPECT_EQ(names,
             (std::vector<std::string>{"shaken down", "moves only at nodes that open",
                                       "cyclic slip", "still slipping", "no equilibrium"}));
   const auto refused = [](auto spoil)
   {
      CounterExampleSettings settings;
      EXPECT_NO_THROW(settings.validate());
      spoil(settings);
      EXPECT_THROW(settings.validate(), InputError);
   };
   refused([](CounterExampleSettings &s) { s.starts = -1; });
   refused([](CounterExampleSettings &s) { s.halvings = 0; });
   refused([](CounterExampleSettings &s) { s.transient.cycles = 0; });
   refused([](CounterExampleSettings &s) { s.transient.shaken_down = 0; });
   refused([](CounterExampleSettings &s) { s.transient.shaken_down = 1; });
   refused([](CounterExampleSettings &s) { s.transient.upper = std::nan(""); });
   refused([](CounterExampleSettings &s) { s.transient.march.increments = 0; });
   LimitReport none;
   EXPECT_THROW(transient_bracket(limit, none, 0.1), InputError);
   EXPECT_THROW(find_counter_example(limit, none, 0), InputError);
   none.slip = stuck;
   EXPECT_THROW(transient_bracket(limit, none, 1), InputError);
   // Uncoupled, there is none, and nothing is marched.
   none.limit = 0.7;
   const CounterExample proven = find_counter_example(limit, none, 0.1);
   EXPECT_FALSE(proven.found);
   EXPECT_EQ(proven.quiet, 0.7);
   EXPECT_EQ(proven.marches, 0);
   EXPECT_NE(proven.message.find("proven"), std::string::npos);
}

TEST(CounterExample, IsFoundBetweenTheTwoLimitsOnly)
{
   // Node 1 feels the slip of node 0 (see the lower limit's test of this chain).
   ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix2d::Identity(), Eigen::Matrix2d{{0, 0}, {0.8, 0}},
                         2 * Eigen::Matrix2d::Identity());
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
   EXPECT_LT(found.quiet, found.load_factor);
   EXPECT_GE(found.quiet, 0);
   EXPECT_GE(found.marches, 10);
   // From that start it does slip for ever, and at the quiet load it does not.
   FrictionSolver solver(problem);
   const TransientReport cycles = transient(solver, limit, found.load_factor, found.start);
   EXPECT_EQ(cycles.verdict, TransientVerdict::cyclic_slip);
   EXPECT_NEAR(cycles.dissipation.back(), found.dissipation, 1e-14);
   EXPECT_EQ(transient(solver, limit, found.quiet, found.start).verdict,
             TransientVerdict::shaken_down);
   // Where none is found after one march of each start at 0.98 of the limit, that is quiet.
   LimitReport below = upper;
   below.limit = 0.9 * lower.value;
   settings.starts = 2;
   const CounterExample none = find_counter_example(limit, below, 0, settings);
   EXPECT_FALSE(none.found);
   EXPECT_EQ(none.quiet, 0.98 * below.limit);
   EXPECT_EQ(none.marches, 4 + 2);
   EXPECT_NE(none.message.find("not proven"), std::string::npos);
   EXPECT_THROW(transient_bracket(limit, upper, 0), InputError);
}

TEST(CounterExample, FindsStartsThatLeaveANodeOpening)
{
   // Slip of node 0, held in ±0.25 by friction, moves the pressure of node 1, 1 + 3 v0, which Q
   // moves by ∓2. So it opens from some start above λ = (1 - 0.75)/2 = 0.125, and slips as it
   // does (see the two springs above). The limit is at 3 λ = 1 + 0.75; halved from 0.98 of it
   // as long as it opens.
   ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix2d::Identity(), Eigen::Matrix2d{{0, 0}, {3, 0}},
                         20 * Eigen::Matrix2d::Identity());
   problem.patterns = {{"P", Control::force, Eigen::Vector2d::Zero(), Eigen::Vector2d(1, 1)},
                       {"Q", Control::force, Eigen::Vector2d(0, 1.5), Eigen::Vector2d(0, -2)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Eigen::Vector2d::Zero();
   set_friction(problem, 0.5);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   const LimitReport upper = load_limit(limit);
   EXPECT_NEAR(upper.limit, 1.75 / 3, 1e-7);
   CounterExampleSettings settings;
   settings.starts = 2;
   const CounterExample found = find_counter_example(limit, upper, 0, settings);
   EXPECT_NEAR(found.opens, 0.98 * upper.limit / 4, 1e-12);
   FrictionSolver solver(problem);
   const TransientReport opens = transient(solver, limit, found.opens, found.opening_start);
   EXPECT_EQ(opens.verdict, TransientVerdict::slips_and_opens);
   EXPECT_EQ(opens.opened, NodeList{1});
   for (const double v0 : {-0.25, 0.0, 0.25})
   {
      const TransientReport below = transient(solver, limit, 0.12, Eigen::Vector2d(v0, 0));
      EXPECT_TRUE(below.opened.empty()) << v0;
   }
}

} // namespace
