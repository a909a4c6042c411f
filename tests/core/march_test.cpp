#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "half_space_contacts.hpp"
#include "period_two.hpp"
#include "random_problem.hpp"
#include "same_state.hpp"
#include "small_problems.hpp"

#include <array>
#include <cattaneo/design/march_trace.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::one_block;
using cattaneo_test::press_then_shear;
using cattaneo_test::random_problem;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

TEST(March, OneBlockCycleInClosedForm)
{
   // q = 2 v + λ, |q| <= f: with λ = ±1 and f = 0.4 the block slips from v = ∓0.3 to ±0.3. Each
   // way it loses f · 0.6, a cycle 0.48.
   const ReducedProblem problem = one_block(0.4);
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 7;
   const MarchReport report = march(problem, press_then_shear(1.0, 20), state, settings);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   ASSERT_GE(report.cycles.size(), 2u);
   // The pressure is constant: the loss does not depend on the increments.
   EXPECT_NEAR(report.cycles[1].dissipation, 0.48, 1e-14);
   EXPECT_EQ(report.steady_period, 1);
   EXPECT_EQ(report.steady_cycle, 2);
   EXPECT_EQ(report.cycles.size(), 2u);                   // the other 18 are not marched
   EXPECT_NEAR(report.cycles[0].slip_change, 0.2, 1e-15); // from 0 to where q = 2 v = 0.4
   EXPECT_NEAR(report.cycles[1].slip_change, 0, 1e-15);
   // The work of the loads does: it is exact where increments meet the slip events.
   EXPECT_GT(std::abs(report.energy_imbalance), 1e-3);
   settings.increments = 10;
   state = ContactState::virgin(problem);
   const MarchReport exact = march(problem, press_then_shear(1.0, 3), state, settings);
   EXPECT_NEAR(exact.cycles[1].dissipation, 0.48, 1e-14);
   EXPECT_LT(std::abs(exact.energy_imbalance), 1e-14);
}

// What a jump would come to depends on the way: pressed first the block sticks, sheared first
// it slides away.
TEST(March, RefusesLoadsThatJump)
{
   const ReducedProblem problem = one_block(0.4);
   ContactState state = ContactState::virgin(problem);
   const LoadHistory jumps = LoadHistory::through({Vector2d(1, 0.2), Vector2d(1, 0)});
   expect_input_error([&] { march(problem, jumps, state); },
                      "history: load 'press' is 1 at its first point, and 0 before any load");
   march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state);
   state.time = 0;
   expect_input_error(
      [&] { march(problem, jumps, state); },
      "'shear' is 0.2 at its first point, and 0 in the state from which the march continues");
   state.time = 0.5; // half-way from 0.2 to nothing
   expect_input_error([&] { march(problem, jumps, state); },
                      "'shear' is 0.1 at time 0.5, and 0 in the state");
   // Without friction there is one answer, whatever the way.
   state = ContactState::virgin(one_block(0));
   march(one_block(0), LoadHistory::through({Vector2d(1, 0), Vector2d(2, 0)}), state);
   EXPECT_NEAR(state.p[0], 2, 1e-15);
}

TEST(March, AHistoryThatIsACycleFromItsStartIsComparedWithIt)
{
   // Never beyond friction: the first cycle is steady. In whatever unit of length.
   LoadHistory history =
      LoadHistory::through({Vector2d(1, 0), Vector2d(1, 0.1), Vector2d(1, 0)});
   history.cycle_start = 0;
   history.cycles = 5;
   for (double stiffness : {1.0, 1e12})
   {
      ReducedProblem problem = one_block(0.4);
      problem.K *= stiffness;
      ContactState state = ContactState::virgin(problem);
      FrictionSolver(problem).solve(state, Vector2d(1, 0));
      const MarchReport report = march(problem, history, state);
      EXPECT_EQ(report.steady_cycle, 1);
      // Beyond it, it is the second, as in closed form above.
      state = ContactState::virgin(problem);
      const MarchReport second = march(problem, press_then_shear(1.0, 20), state);
      EXPECT_EQ(second.steady_cycle, 2);
      EXPECT_EQ(second.steady_period, 1);
   }
}

TEST(March, RecordsOfACycleByHand)
{
   // Node 0 is pulled open by P (w = -P/3 when P < 0), node 1 is pressed by N and sheared by Q:
   // q = 2 v + Q, |q| <= 0.4. P and Q go from 1 to (-3, -1) in one increment and back in two:
   // w from 0 to 1, 1/3 and 0, v from -0.3 to 0.3, 0.2 and -0.3.
   ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                         3 * Eigen::Matrix2d::Identity());
   const Vector2d zero(0, 0), first(1, 0), second(0, 1);
   problem.patterns = {{"P", Control::force, zero, first},
                       {"N", Control::force, zero, second},
                       {"Q", Control::force, second, zero}};
   problem.H = Eigen::Matrix3d::Zero();
   problem.gap = zero;
   set_friction(problem, 0.4);
   using Eigen::Vector3d;
   LoadHistory history = LoadHistory::through(
      {Vector3d(0, 0, 0), Vector3d(1, 1, 1), Vector3d(-3, 1, -1), Vector3d(1, 1, 1)});
   history.cycle_start = 1;
   history.cycles = 2;
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 2;
   settings.increments_of_piece = {20, 1};
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, settings);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   EXPECT_EQ(report.increments.size(), 1u + 3u); // loading in proportion takes one
   EXPECT_EQ(report.time, 3);
   ASSERT_EQ(report.cycles.size(), 1u);
   EXPECT_EQ(report.steady_cycle, 1);
   EXPECT_EQ(report.steady_period, 1);
   const CycleRecord &cycle = report.cycles[0];
   EXPECT_NEAR(cycle.dissipation, 0.4 * 1.2, 1e-14);
   ASSERT_EQ(cycle.node_dissipation.size(), 2);
   EXPECT_NEAR(cycle.node_dissipation[0], 0, 1e-14);
   EXPECT_NEAR(cycle.node_dissipation[1], 0.4 * 1.2, 1e-14);
   // -½ (p0 + p1) Δw: -½ (1 + 0) (1 - 0), then -½ (0 + 1) (0 - 1/3).
   EXPECT_NEAR(cycle.normal_work, -0.5 + 1.0 / 6, 1e-14);
   // Mean load times what its point of attack moves by, -Δw and -Δv: P does 1, then
   // -2 · 2/3, then 0; Q does 0, then -0.5 · 0.1, then 0.5 · 0.5.
   EXPECT_NEAR(cycle.external_work, 1 - 4.0 / 3 - 0.05 + 0.25, 1e-14);
   const double work = cycle.external_work + report.increments[0].external_work,
                lost = cycle.dissipation + report.increments[0].dissipation,
                stored = elastic_energy(problem, state); // q = -0.6 of a spring of 2
   EXPECT_NEAR(stored, 0.5 * 2 * 0.3 * 0.3, 1e-14);
   EXPECT_NEAR(report.energy_imbalance,
               (work - stored - lost - cycle.normal_work) /
                  std::max({report.increments[0].external_work + 1, stored, lost}),
               1e-14); // most is put in by the first increment of the cycle
   EXPECT_EQ(report.increments[1].separation, 1);
   EXPECT_EQ(report.increments[1].forward_slip, 1);
   EXPECT_EQ(report.increments[2].backward_slip, 1);
   EXPECT_EQ(report.increments[3].separation, 0);
   EXPECT_EQ(report.increments[3].cycle, 1);
   EXPECT_EQ(report.increments[0].cycle, 0);
}

TEST(March, LossInTheDiscByHand)
{
   // f = ½. A slip of (0.3, 0.4) against f p from 1 to 2; where the friction has turned round,
   // |q0 + s (trial - q0)| = f p at s = 7.6/10.84: trial = q1 - A Δv = (-1.8, -2), q0 = (1, 0).
   ReducedProblem problem;
   problem.set_stiffness(Vector2d(2, 1).asDiagonal(), Eigen::MatrixXd::Zero(1, 2),
                         Eigen::MatrixXd::Ones(1, 1));
   problem.gap = VectorXd::Zero(1);
   set_friction(problem, 0.5);
   ContactState before = ContactState::virgin(problem), after = before;
   before.status[0] = after.status[0] = NodeState::slip;
   before.p[0] = 2;
   after.p[0] = 4;
   before.q << 1, 0;
   after.q << -1.2, -1.6;
   before.v << 5, 6;
   after.v << 5.3, 6.4;
   const double turned = 2 + 2 * 7.6 / 10.84;
   EXPECT_NEAR(frictional_loss(problem, before, after)[0], 0.25 * (turned + 4) * 0.5, 1e-13);
   // A node that stuck begins to slip where 8.29 s² - 4.3 s - 0.75 = 0, likewise.
   before.status[0] = NodeState::stick;
   before.q << 0.5, 0;
   const double began = 2 + 2 * (4.3 + std::sqrt(4.3 * 4.3 + 4 * 8.29 * 0.75)) / (2 * 8.29);
   EXPECT_NEAR(frictional_loss(problem, before, after)[0], 0.25 * (began + 4) * 0.5, 1e-13);
   // One that was open bears more and more as it slips.
   before.status[0] = NodeState::separation;
   before.q.setZero();
   before.p[0] = 0;
   EXPECT_NEAR(frictional_loss(problem, before, after)[0], 0.25 * 4 * 0.5, 1e-13);
   // What goes on slips all the way, but for a moment where its friction grows sooner than the
   // force: 3.64 s² - 0.4 s = 0.
   before.status[0] = NodeState::slip;
   before.p[0] = 2;
   before.q << -1, 0;
   EXPECT_NEAR(frictional_loss(problem, before, after)[0],
               0.25 * (2 + 2 * 0.4 / 3.64 + 4) * 0.5, 1e-13);
   before.q << -0.6, -0.8;
   EXPECT_NEAR(frictional_loss(problem, before, after)[0], 0.25 * (2 + 4) * 0.5, 1e-13);
}

TEST(March, OneIncrementOnlyWhereItIsExact)
{
   const auto increments =
      [](const ReducedProblem &problem, const LoadHistory &history, ContactState state)
   {
      MarchSettings settings;
      settings.stepping = Stepping::fixed;
      settings.increments = 7;
      const MarchReport report = march(problem, history, state, settings);
      EXPECT_EQ(report.status, FrictionStatus::converged);
      EXPECT_EQ(report.counters.increments, report.increments.size());
      return report.increments.size();
   };
   const Vector2d none(0, 0), pressed(1, 0), both(1, 0.9), harder(2, 0), less(0.2, 0);
   ReducedProblem problem = one_block(0.4), coupled = problem;
   coupled.B()(0, 0) = 0.1;
   complete(coupled);
   const ContactState virgin = ContactState::virgin(problem);
   // In proportion, from nothing: neither gap nor slip, force or load.
   EXPECT_EQ(increments(coupled, LoadHistory::through({none, both}), virgin), 1u);
   ContactState slipped = ContactState::with_slip(problem, VectorXd::Constant(1, 0.1));
   EXPECT_EQ(increments(coupled, LoadHistory::through({none, both}), slipped), 7u);
   ContactState loaded = virgin;
   FrictionSolver(coupled).solve(loaded, pressed);
   EXPECT_EQ(increments(coupled, LoadHistory::through({pressed, both}), loaded), 7u);
   ReducedProblem apart = coupled;
   apart.gap[0] = 0.01;
   EXPECT_EQ(increments(apart, LoadHistory::through({none, both}), ContactState::virgin(apart)),
             7u);
   // Pressed without coupling or shear nothing slips: loading and unloading, with a gap or not.
   loaded = virgin;
   FrictionSolver(problem).solve(loaded, pressed);
   EXPECT_EQ(increments(problem, LoadHistory::through({pressed, harder, less}), loaded), 2u);
   EXPECT_EQ(increments(coupled, LoadHistory::through({pressed, harder}), loaded), 7u);
   EXPECT_EQ(increments(problem, LoadHistory::through({pressed, both}), loaded), 7u);
   apart.B().setZero();
   complete(apart);
   EXPECT_EQ(
      increments(apart, LoadHistory::through({none, pressed}), ContactState::virgin(apart)),
      1u);
   ContactState sheared = virgin;
   FrictionSolver(problem).solve(sheared, Vector2d(1, 0.3));
   EXPECT_EQ(increments(problem, LoadHistory::through({Vector2d(1, 0.3), less}), sheared), 7u);
   slipped = virgin;
   FrictionSolver(problem).solve(slipped, Vector2d(1, 0.6));
   FrictionSolver(problem).solve(slipped, pressed);
   EXPECT_EQ(increments(problem, LoadHistory::through({pressed, harder}), slipped), 7u);
}

TEST(March, CountsItsOwnWorkOnly)
{
   std::mt19937 random(22);
   const ReducedProblem problem = random_problem(9, 0.3, 0.12, random);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   MarchSettings fixed; // by the solver alone
   fixed.stepping = Stepping::fixed;
   const MarchReport first = march(solver, press_then_shear(0.7, 1), state, fixed);
   const Counters before = solver.counters();
   state = ContactState::virgin(problem);
   const MarchReport again = march(solver, press_then_shear(0.7, 1), state, fixed);
   EXPECT_GT(first.counters.newton_steps, 0);
   EXPECT_EQ(again.counters.newton_steps, first.counters.newton_steps);
   EXPECT_EQ(again.counters.newton_steps, solver.counters().newton_steps - before.newton_steps);
   EXPECT_EQ(again.counters.sweeps, solver.counters().sweeps - before.sweeps);
   // Without a solver it includes the making of one.
   ReducedProblem smooth = problem;
   set_friction(smooth, 0);
   state = ContactState::virgin(problem);
   const long made = FrictionSolver(smooth).counters().dense_factorisations;
   EXPECT_EQ(made, 1);
   FrictionSolver other(smooth);
   const long marched =
      march(other, press_then_shear(0.7, 1), state).counters.dense_factorisations;
   state = ContactState::virgin(problem);
   EXPECT_EQ(march(smooth, press_then_shear(0.7, 1), state).counters.dense_factorisations,
             marched + made);
}

TEST(March, EnergyBalancesOnRandomProblems)
{
   std::mt19937 random(5);
   for (int k = 0; k < 20; ++k)
   {
      ReducedProblem problem = random_problem(8, 0.1 + 0.05 * k, 0.12, random);
      // One force and one displacement pattern, with a response of the loads to the loads of
      // the right symmetry.
      problem.patterns[1].control = Control::displacement;
      problem.H = Eigen::Matrix2d{{1.3, 0.4}, {-0.4, 2.1}};
      ContactState state = ContactState::virgin(problem);
      MarchSettings settings;
      settings.stepping = Stepping::fixed;
      const MarchReport report = march(problem, press_then_shear(0.7, 3), state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      // What increments miss goes to zero with them; the exact path misses nothing.
      for (const bool exact : {false, true})
      {
         MarchSettings finer;
         finer.increments = 160;
         finer.stepping = exact ? Stepping::exact : Stepping::fixed;
         ContactState again = ContactState::virgin(problem);
         const double left =
            march(problem, press_then_shear(0.7, 3), again, finer).energy_imbalance;
         EXPECT_LT(std::abs(left), exact ? 1e-12 : 0.3 * std::abs(report.energy_imbalance));
      }
      for (const IncrementRecord &increment : report.increments)
      {
         // End-of-increment forces lag, so single increments may gain a little: bounded by
         // size.
         EXPECT_GT(increment.dissipation, -1e-3);
      }
      EXPECT_GE(state.dissipation, 0);
   }
}

/// A march by fixed increments, the exact path beside it, and what the first says of its loss.
struct TwoMarches
{
   double lost = 0, exact_lost = 0, imbalance = 0;
   LossError error;
   double worst_cycle = 0; ///< largest difference of the loss of one cycle
};

TwoMarches march_twice(const ReducedProblem &problem, const LoadHistory &history,
                       int increments)
{
   TwoMarches two;
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = increments;
   settings.loss_error = true;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, settings);
   MarchSettings exactly;
   exactly.stepping = Stepping::exact;
   exactly.stop_at_steady_state = false;
   ContactState other = ContactState::virgin(problem);
   LoadHistory same = history;
   if (!report.cycles.empty()) { same.cycles = report.cycles.back().cycle; }
   const MarchReport path = march(problem, same, other, exactly);
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_EQ(path.status, FrictionStatus::converged) << path.message;
   EXPECT_EQ(path.fallbacks, 0);
   two = {state.dissipation, other.dissipation, report.energy_imbalance, report.loss_error};
   for (std::size_t k = 0; k < report.cycles.size(); ++k)
   {
      two.worst_cycle = std::max(
         two.worst_cycle, std::abs(report.cycles[k].dissipation - path.cycles[k].dissipation));
   }
   return two;
}

/// The stated error covers what increments do to the loss, of the whole and of each cycle; the
/// balance of energy does not.
TEST(March, LossErrorCoversWhatIncrementsDoToTheLoss)
{
   std::mt19937 random(12);
   int marched = 0, covered_by_balance = 0;
   for (int k = 0; k < 300; ++k)
   {
      const ReducedProblem problem = random_problem(3 + k % 6, 0.1 + 0.002 * k, 0.1, random);
      const LoadHistory history = press_then_shear(0.4 + 0.01 * (k % 50), 1 + k % 3);
      ContactState trial = ContactState::virgin(problem);
      MarchSettings exactly;
      exactly.stepping = Stepping::exact;
      const MarchReport path = march(problem, history, trial, exactly);
      if (path.status != FrictionStatus::converged || path.fallbacks > 0) { continue; }
      ++marched;
      const TwoMarches two = march_twice(problem, history, 3 + k % 20);
      const double apart = std::abs(two.lost - two.exact_lost);
      const double round_off = 1e-11 * (two.lost + two.exact_lost);
      EXPECT_TRUE(two.error.bound) << two.error.by;
      EXPECT_LE(apart, two.error.value + round_off) << k;
      EXPECT_LE(two.worst_cycle, two.error.value + round_off) << k;
      EXPECT_LE(two.error.value, std::max(two.lost, two.exact_lost)) << k;
      covered_by_balance += apart <= std::abs(two.imbalance) * two.exact_lost + round_off;
   }
   EXPECT_GT(marched, 250);
   EXPECT_LT(covered_by_balance, marched); // the old measure
}

/// A contact that sticks goes round its cycle without a loss: taken up again in the steady
/// state it loses, stores and receives the round-off of what it has stored from the start.
TEST(March, EnergyOfASteadyElasticCycleBalances)
{
   std::mt19937 random(9);
   for (int k = 0; k < 10; ++k)
   {
      ReducedProblem problem = random_problem(8, 0.2, 0.12, random);
      set_friction(problem, 100);
      MarchSettings settings;
      settings.stepping = Stepping::fixed;
      ContactState state = ContactState::virgin(problem);
      march(problem, press_then_shear(0.01, 2), state, settings);
      state.time = 1; // the end of a cycle is the start of the next one
      state.cycle_slip.clear();
      const MarchReport again = march(problem, press_then_shear(0.01, 1), state, settings);
      ASSERT_EQ(again.cycles.size(), 1u);
      EXPECT_LT(again.cycles[0].dissipation, 1e-14);
      EXPECT_LT(std::abs(again.energy_imbalance), 1e-8); // over a millionth of it
   }
}

/// Pressed and let go without friction, a contact gives all back: what is left of the balance
/// is round-off of the work on the way, not of what is left of it.
TEST(March, EnergyThatComesBackBalances)
{
   std::mt19937 random(11);
   for (int k = 0; k < 10; ++k)
   {
      ReducedProblem problem = random_problem(8, 0.2, 0.12, random);
      set_friction(problem, 0);
      MarchSettings settings;
      settings.stepping = Stepping::fixed;
      settings.increments = 5;
      ContactState state = ContactState::virgin(problem);
      const LoadHistory history =
         LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(0, 0)});
      const MarchReport report = march(problem, history, state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      EXPECT_LT(std::abs(report.energy_imbalance), 1e-12);
   }
}

TEST(March, ResultDoesNotDependOnTheScaleOfTime)
{
   std::mt19937 random(6);
   const ReducedProblem problem = random_problem(8, 0.3, 0.1, random);
   LoadHistory history = press_then_shear(0.7, 2);
   ContactState a = ContactState::virgin(problem), b = a;
   march(problem, history, a);
   history.times *= 1024; // exact in binary arithmetic
   march(problem, history, b);
   EXPECT_EQ(a.v, b.v);
   EXPECT_EQ(a.p, b.p);
}

TEST(March, CutInTwoGivesTheSameBits)
{
   std::mt19937 random(7);
   const ReducedProblem problem = random_problem(12, 0.3, 0.1, random);
   const LoadHistory history = press_then_shear(0.8, 4);
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 9;
   ContactState whole = ContactState::virgin(problem);
   std::vector<ContactState> passed;
   const MarchReport all = march(problem, history, whole, settings,
                                 [&](const ContactState &state, const IncrementRecord &)
                                 { passed.push_back(state); });
   const std::string file = testing::TempDir() + "cattaneo_state.json";
   for (std::size_t cut : {std::size_t(3), passed.size() / 2, passed.size() - 2})
   {
      save(passed[cut], file);
      ContactState rest = load_contact_state(file);
      const MarchReport after = march(problem, history, rest, settings);
      SCOPED_TRACE(cut);
      cattaneo_test::expect_same(rest, whole);
      // The cycle within which it was cut is whole all the same.
      ASSERT_FALSE(after.cycles.empty());
      for (std::size_t k = 1; k <= after.cycles.size(); ++k)
      {
         const CycleRecord &mine = after.cycles[after.cycles.size() - k],
                           &same = all.cycles[all.cycles.size() - k];
         EXPECT_TRUE(mine.whole);
         EXPECT_EQ(mine.cycle, same.cycle);
         EXPECT_EQ(mine.dissipation, same.dissipation);
         EXPECT_EQ(mine.loops[1].work(), same.loops[1].work());
         EXPECT_EQ(mine.loops[1].stiffness(), same.loops[1].stiffness());
      }
   }
   std::remove(file.c_str());
}

TEST(March, FirstProportionalLoadingTakesOneIncrement)
{
   std::mt19937 random(8);
   ReducedProblem problem = random_problem(10, 0.2, 0.1, random);
   problem.gap.setZero();
   const LoadHistory history = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0.4)});
   ContactState once = ContactState::virgin(problem), often = once;
   const MarchReport report = march(problem, history, once);
   EXPECT_EQ(report.counters.increments, 1);
   MarchSettings settings;
   settings.single_increment_if_exact = false;
   EXPECT_GE(march(problem, history, often, settings).counters.increments, 20);
   EXPECT_LT((once.v - often.v).cwiseAbs().maxCoeff(), 1e-12);
   EXPECT_LT((once.p - often.p).cwiseAbs().maxCoeff(), 1e-12);
}

// Late in a long history the times of equal steps lose digits; their loads do not.
TEST(March, BeginsAtAnyTimeWithTheSameBits)
{
   std::mt19937 random(9);
   const ReducedProblem problem = random_problem(10, 0.3, 0.1, random);
   LoadHistory early = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.9)}),
               late = early;
   late.times.array() += 1e6;
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 7;
   ContactState a = ContactState::virgin(problem), b = a;
   EXPECT_EQ(march(problem, early, a, settings).status, FrictionStatus::converged);
   EXPECT_EQ(march(problem, late, b, settings).status, FrictionStatus::converged);
   EXPECT_EQ(a.v, b.v);
   EXPECT_EQ(a.dissipation, b.dissipation);
   EXPECT_GT(a.dissipation, 0);
}

/// A free body of two nodes.
ReducedProblem free_body()
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d{{1, -1}, {-1, 1}}, Eigen::Matrix2d::Zero(),
                         Eigen::Matrix2d{{1, -1}, {-1, 1}});
   problem.patterns = {{"press", Control::force, Vector2d(0, 0), Vector2d(0.5, 0.5)},
                       {"shear", Control::force, Vector2d(0.8, 0.2), Vector2d(0, 0)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Vector2d(0, 0);
   set_friction(problem, 0.4);
   return problem;
}

/// Where everything scales with the loads they are too much from the beginning or not at all:
/// no shorter increment is tried.
TEST(March, LoadsThatAreTooMuchFromTheBeginningAreTriedOnce)
{
   const ReducedProblem problem = free_body();
   MarchSettings settings;
   for (const bool once : {true, false})
   {
      settings.single_increment_if_exact = once;
      for (const double shear : {0.39, 0.41})
      {
         ContactState state = ContactState::virgin(problem);
         const MarchReport report =
            march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, shear)}), state,
                  settings);
         EXPECT_EQ(report.counters.rejected_increments, 0);
         EXPECT_EQ(report.status,
                   shear < 0.4 ? FrictionStatus::converged : FrictionStatus::gross_sliding);
         EXPECT_EQ(report.time, shear < 0.4 ? 1 : 0);
      }
   }
}

TEST(March, GrossSlidingIsReportedWithItsLoad)
{
   const ReducedProblem problem = free_body();
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)}), state);
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NEAR(report.event_multipliers[1], 0.4, 1e-9);       // Q = f P
   EXPECT_LE(report.event_multipliers[1], 0.4 * (1 + 2e-12)); // of an equilibrium
   EXPECT_EQ(state.time, report.event_time);
}

TEST(March, LoadsThatAreHeldChangeNothing)
{
   const ReducedProblem problem = one_block(0.4);
   for (Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      ContactState slid = ContactState::virgin(problem), held = slid;
      const Vector2d none(0, 0), pressed(1, 0), sheared(1, 0.6);
      march(problem, LoadHistory::through({none, pressed, sheared}), slid, settings);
      march(problem, LoadHistory::through({none, none, pressed, sheared, sheared}), held,
            settings);
      EXPECT_EQ(slid.status[0], NodeState::backward_slip);
      EXPECT_EQ(held.status, slid.status);
      // Stops of a path are at shares of its time, which is another one.
      const double round_off = stepping == Stepping::exact ? 1e-15 : 0;
      EXPECT_NEAR(held.v[0], slid.v[0], round_off);
      EXPECT_EQ(held.slip_origin, slid.slip_origin);
      EXPECT_NEAR(held.dissipation, slid.dissipation, round_off);
      EXPECT_EQ(held.time, 4);
   }
}

TEST(LoadHistory, PiecesOfRepeatedCyclesGoOnInTime)
{
   LoadHistory history;
   history.times = Eigen::Vector4d(1, 2, 4, 5);
   history.multipliers = Eigen::RowVector4d(0, 3, 7, 3);
   history.cycle_start = 1;
   history.cycles = 3;
   ReducedProblem problem = one_block(0.3);
   problem.patterns.resize(1);
   history.validate(problem);
   ASSERT_EQ(history.pieces(), 7);
   const double starts[] = {1, 2, 4, 5, 7, 8, 10, 11};
   const double loads[] = {0, 3, 7, 3, 7, 3, 7, 3};
   for (int k = 0; k < 7; ++k)
   {
      const LoadPiece piece = history.piece(k);
      EXPECT_EQ(piece.start, starts[k]) << k;
      EXPECT_EQ(piece.end, starts[k + 1]) << k;
      EXPECT_EQ(piece.duration(), starts[k + 1] - starts[k]) << k;
      EXPECT_EQ(piece.from[0], loads[k]) << k;
      EXPECT_EQ(piece.to[0], loads[k + 1]) << k;
      EXPECT_EQ(piece.at(0.25)[0], 0.75 * loads[k] + 0.25 * loads[k + 1]) << k;
      EXPECT_EQ(piece.cycle, (k + 1) / 2) << k;
      EXPECT_EQ(piece.ends_cycle, k > 0 && k % 2 == 0) << k;
      EXPECT_EQ(piece.point, k == 0 ? 0 : k % 2 ? 1 : 2) << k;
   }
   // All of it is the cycle; none of it is.
   history.multipliers = Eigen::RowVector4d(3, 0, 7, 3);
   history.cycle_start = 0;
   EXPECT_EQ(history.pieces(), 9);
   EXPECT_EQ(history.piece(0).cycle, 1);
   EXPECT_EQ(history.piece(8).end, 13);
   EXPECT_TRUE(history.piece(2).ends_cycle);
   history.cycle_start = -1;
   EXPECT_EQ(history.pieces(), 3);
   EXPECT_EQ(history.piece(2).end, 5);
   EXPECT_EQ(history.piece(2).cycle, 0);
   EXPECT_FALSE(history.piece(2).ends_cycle);
}

TEST(March, RemembersTheLargestForceWhereverItIsLess)
{
   // Pressed, pushed by a fifth of it and unloaded in proportion: it sticks throughout.
   const ReducedProblem problem = one_block(0.5);
   const LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0.2), Vector2d(0.5, 0.1), Vector2d(0.25, 0.05)});
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      ContactState state = ContactState::virgin(problem);
      ASSERT_EQ(march(problem, history, state, settings).status, FrictionStatus::converged);
      EXPECT_EQ(state.peak_force, 1);
   }
}

TEST(March, SlipWithoutFrictionTurnsWhereTheLoadDoes)
{
   // v = -shear / 2: forward is where v grows, whatever its sign.
   const ReducedProblem problem = one_block(0);
   MarchSettings settings;
   settings.increments = 1;
   ContactState state = ContactState::virgin(problem);
   std::vector<std::array<int, 2>> counts;
   const MarchReport report = march(
      problem,
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1), Vector2d(1, 0.5)}),
      state, settings,
      [&](const ContactState &, const IncrementRecord &record) {
         counts.push_back({record.forward_slip, record.backward_slip});
      });
   ASSERT_EQ(report.status, FrictionStatus::converged);
   ASSERT_EQ(counts.size(), 3u);
   EXPECT_EQ(counts[1], (std::array<int, 2>{0, 1}));
   EXPECT_EQ(counts[2], (std::array<int, 2>{1, 0}));
   EXPECT_NEAR(state.v[0], -0.25, 1e-15);
   EXPECT_NEAR(state.slip_origin[0], -0.5, 1e-15);
}

TEST(LoadHistory, LoadsHaveNames)
{
   ReducedProblem problem = one_block(0.3);
   ASSERT_EQ(problem.patterns.size(), 2u);
   problem.patterns[0].name = "weight";
   problem.patterns[1].name = "a push";
   const LoadHistory history = LoadHistory::through(
      problem, {{}, {{"weight", 2}}, {{"a push", 0.5}, {"weight", 1}}, {{"a push", -0.5}}});
   EXPECT_EQ(history.times, Eigen::Vector4d(0, 1, 2, 3));
   // A load that a point does not name keeps its value.
   EXPECT_EQ(history.multipliers, (MatrixXd{{0, 2, 1, 1}, {0, 0, 0.5, -0.5}}));
   EXPECT_EQ(history.cycle_start, -1);
   const LoadHistory cyclic = LoadHistory::through(
      problem, {{}, {{"weight", 2}}, {{"a push", 0.5}}, {{"a push", 0}}}, 1, 3);
   EXPECT_EQ(cyclic.multipliers, (MatrixXd{{0, 2, 2, 2}, {0, 0, 0.5, 0}}));
   EXPECT_EQ(cyclic.cycle_start, 1);
   EXPECT_EQ(cyclic.cycles, 3);
   EXPECT_EQ(cyclic.pieces(), 7);
   expect_input_error(
      [&] {
         LoadHistory::through(problem, {{}, {{"weight", 2}}, {{"a push", 0.5}}}, 1, 3);
      },
      "load history: load 'a push' is 0.5 at the end of the cycle and 0 at its start");
   expect_input_error(
      [&] {
         LoadHistory::through(problem, {{}, {{"weight", NAN}}});
      },
      "load history: load 'weight' is nan at point 1, must be finite");
   expect_input_error(
      [&] {
         problem.multipliers({{"wait", 2}});
      },
      "no load pattern 'wait', must be one of: weight, a push");
}

TEST(LoadHistory, RefusesBadInput)
{
   const ReducedProblem problem = one_block(0.3);
   ContactState state = ContactState::virgin(problem);
   LoadHistory history = press_then_shear(1, 2);
   history.times[2] = history.times[1];
   EXPECT_THROW(march(problem, history, state), InputError);
   history = press_then_shear(1, 0);
   EXPECT_THROW(march(problem, history, state), InputError);
   history = press_then_shear(1, 2);
   history.multipliers(1, 4) = 0.5;
   expect_input_error([&] { march(problem, history, state); },
                      "load history: load '" + problem.patterns[1].name +
                         "' is 0.5 at the end of the cycle and");
   history = LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)});
   EXPECT_THROW(march(problem, history, state), InputError);
   history = press_then_shear(1, 2);
   history.cycle_start = 4; // there is nothing after it
   EXPECT_THROW(history.validate(problem), InputError);
   history = press_then_shear(1, 2);
   history.multipliers(0, 2) = NAN;
   EXPECT_THROW(history.validate(problem), InputError);
   EXPECT_THROW(LoadHistory::through({VectorXd::Zero(2)}).validate(problem), InputError);
   EXPECT_THROW(LoadHistory::through({}), InputError);
   EXPECT_THROW(LoadHistory::through({VectorXd::Zero(2), VectorXd::Zero(1)}), InputError);
   EXPECT_NO_THROW(MarchSettings().validate());
   const auto refuses = [](auto spoil)
   {
      MarchSettings settings;
      spoil(settings);
      EXPECT_THROW(settings.validate(), InputError);
   };
   refuses([](MarchSettings &s) { s.increments = 0; });
   refuses([](MarchSettings &s) { s.increments_of_piece = {1, 0}; });
   refuses([](MarchSettings &s) { s.max_halvings = -1; });
   refuses([](MarchSettings &s) { s.steady_tolerance = -1e-300; });
   refuses([](MarchSettings &s) { s.steady_tolerance = NAN; });
   refuses([](MarchSettings &s) { s.friction.tolerance = 1; });
   refuses([](MarchSettings &s) { s.friction.tolerance = 0; });
   refuses([](MarchSettings &s) { s.friction.sweeps = -1; });
   refuses([](MarchSettings &s) { s.friction.max_newton = 0; });
   refuses([](MarchSettings &s) { s.friction.max_sweeps = 0; });
   MarchSettings settings;
   settings.increments = 0;
   EXPECT_THROW(march(problem, press_then_shear(1, 1), state, settings), InputError);
}

TEST(ContactState, IsStoredFieldByField)
{
   ContactState state;
   state.v = Eigen::VectorXd::LinSpaced(5, 0.1, 1.0 / 3);
   state.w = -1e-310 * state.v;
   state.q = -M_PI * state.v;
   state.p = 1e300 * state.v;
   state.slip_origin = 7 * state.v;
   state.status = {NodeState::stick, NodeState::separation, NodeState::forward_slip,
                   NodeState::backward_slip, NodeState::slip};
   state.multipliers = Vector2d(-0.0, 1e-17);
   state.time = 1.1;
   state.step = 2.2;
   state.peak_force = 3.3;
   state.dissipation = 4.4;
   state.cycle_slip = {2 * state.v, 3 * state.v};
   const std::string file = testing::TempDir() + "cattaneo_all_fields.json";
   save(state, file);
   cattaneo_test::expect_same(load_contact_state(file), state);
   CycleRecord &cycle = state.cycle.emplace();
   cycle.cycle = 7;
   cycle.whole = true;
   cycle.loops = {Loop(Control::force, 1, 0.1),
                  Loop(Control::displacement, -2, 1.0 / 3, false)};
   for (Loop &loop : cycle.loops) { loop.add(0.7, 1e-17); }
   cycle.dissipation = 5.5;
   cycle.external_work = -6.6;
   cycle.normal_work = 7.7;
   cycle.slip_change = 8.8;
   cycle.node_dissipation = 5 * state.v;
   save(state, file);
   cattaneo_test::expect_same(load_contact_state(file), state);
   for (int wrong : {-1, 5})
   {
      state.status[2] = static_cast<NodeState>(wrong);
      save(state, file);
      EXPECT_THROW(load_contact_state(file), InputError) << wrong;
   }
   std::ofstream(file) << R"({"format": "", "v": [1], "v": [2]})";
   expect_input_error([&] { load_contact_state(file); },
                      "key 'v' is there twice, must be there once");
   std::remove(file.c_str());
}

TEST(ContactState, WhatIsHeldDoesNotSlip)
{
   std::mt19937 random(7);
   ReducedProblem problem = cattaneo_test::random_problem(3, 0.3, 0.5, random);
   hold(problem, {1});
   const Eigen::Vector3d slip(0.1, 0.2, 0.3);
   expect_input_error(
      [&] { ContactState::with_slip(problem, slip); },
      "contact state: row 1 of the slip is 0.2, must be 0, because a support holds it");
   ContactState state = ContactState::with_slip(problem, Eigen::Vector3d(0.1, 0, 0.3));
   EXPECT_NO_THROW(state.validate(problem));
   state.v[1] = 1e-3;
   expect_input_error([&] { state.validate(problem); }, "row 1 of the slip is 0.001");
   state.v[1] = 1e-17; // what round-off makes of zero
   EXPECT_NO_THROW(state.validate(problem));
}

} // namespace
