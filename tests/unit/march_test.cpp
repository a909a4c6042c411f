#include "random_problem.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <stress/two_blocks.hpp>

namespace
{

using namespace cattaneo;
using cattaneo_test::random_problem;
using Eigen::Vector2d;
using Eigen::VectorXd;

LoadHistory press_then_shear(double amplitude, int cycles)
{
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, amplitude),
                            Vector2d(1, -amplitude), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

/// One block on a spring: slip and dissipation of a cycle are known in closed form.
ReducedProblem one_block(double f)
{
   ReducedProblem problem;
   problem.A = Eigen::MatrixXd::Constant(1, 1, 2.0);
   problem.B = Eigen::MatrixXd::Zero(1, 1);
   problem.C = Eigen::MatrixXd::Constant(1, 1, 3.0);
   problem.patterns = {{"press", Control::force, VectorXd::Zero(1), VectorXd::Ones(1)},
                       {"shear", Control::force, VectorXd::Ones(1), VectorXd::Zero(1)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = VectorXd::Zero(1);
   set_friction(problem, f);
   return problem;
}

TEST(March, OneBlockCycleInClosedForm)
{
   // q = 2 v + λ, |q| <= f: with λ = ±1 and f = 0.4 the block slips from v = ∓0.3 to ±0.3. Each
   // way it loses f · 0.6, a cycle 0.48.
   const ReducedProblem problem = one_block(0.4);
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.increments = 7;
   const MarchReport report = march(problem, press_then_shear(1.0, 20), state, settings);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   ASSERT_GE(report.cycles.size(), 2u);
   // The pressure is constant: the loss does not depend on the increments.
   EXPECT_NEAR(report.cycles[1].dissipation, 0.48, 1e-14);
   EXPECT_EQ(report.steady_period, 1);
   EXPECT_EQ(report.steady_cycle, 2);
   EXPECT_EQ(report.cycles.size(), 2u); // the other 18 are not marched
   // The work of the loads does: it is exact where increments meet the slip events.
   EXPECT_GT(std::abs(report.energy_imbalance), 1e-3);
   settings.increments = 10;
   state = ContactState::virgin(problem);
   const MarchReport exact = march(problem, press_then_shear(1.0, 3), state, settings);
   EXPECT_NEAR(exact.cycles[1].dissipation, 0.48, 1e-14);
   EXPECT_LT(std::abs(exact.energy_imbalance), 1e-14);
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
      const MarchReport report = march(problem, press_then_shear(0.7, 3), state);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      // What increments miss goes to zero with them; the exact path misses nothing.
      for (const bool exact : {false, true})
      {
         MarchSettings finer;
         finer.increments = 160;
         if (exact) { finer.stepping = Stepping::exact; }
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
   settings.increments = 9;
   ContactState whole = ContactState::virgin(problem);
   std::vector<ContactState> passed;
   march(problem, history, whole, settings,
         [&](const ContactState &state, const IncrementRecord &) { passed.push_back(state); });
   const std::string file = testing::TempDir() + "cattaneo_state.json";
   for (std::size_t cut : {std::size_t(3), passed.size() / 2, passed.size() - 2})
   {
      save(passed[cut], file);
      ContactState rest = load_contact_state(file);
      march(problem, history, rest, settings);
      EXPECT_EQ(rest.v, whole.v) << "cut at " << cut;
      EXPECT_EQ(rest.w, whole.w);
      EXPECT_EQ(rest.q, whole.q);
      EXPECT_EQ(rest.p, whole.p);
      EXPECT_EQ(rest.status, whole.status);
      EXPECT_EQ(rest.dissipation, whole.dissipation);
      EXPECT_EQ(rest.time, whole.time);
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

TEST(March, GrossSlidingIsReportedWithItsLoad)
{
   ReducedProblem problem;
   problem.A = Eigen::Matrix2d{{1, -1}, {-1, 1}};
   problem.B = Eigen::Matrix2d::Zero();
   problem.C = Eigen::Matrix2d{{1, -1}, {-1, 1}};
   problem.patterns = {{"press", Control::force, Vector2d(0, 0), Vector2d(0.5, 0.5)},
                       {"shear", Control::force, Vector2d(0.8, 0.2), Vector2d(0, 0)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Vector2d(0, 0);
   set_friction(problem, 0.4);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)}), state);
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NEAR(report.event_multipliers[1], 0.4, 1e-9); // Q = f P
   EXPECT_EQ(state.time, report.event_time);
}

/// A row of nodes with a parabolic gap: contact advances.
/// Sweeps that are one too few for a whole increment are enough for shorter ones, which start
/// nearer to their end.
TEST(March, PassesAnIncrementThatStalls)
{
   std::mt19937 random(21);
   for (int k = 0; k < 10; ++k)
   {
      const ReducedProblem problem = random_problem(15, 0.5, 0.15, random);
      ContactState pressed = ContactState::virgin(problem);
      MarchSettings settings;
      settings.increments = 1;
      settings.stepping = Stepping::fixed;
      settings.friction.method = FrictionMethod::gauss_seidel;
      const LoadHistory press = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}),
                        shear = LoadHistory::through({Vector2d(1, 0), Vector2d(1, 0.6)});
      ASSERT_EQ(march(problem, press, pressed, settings).status, FrictionStatus::converged);
      pressed.time = 0;
      ContactState whole = pressed, cut = pressed;
      const MarchReport enough = march(problem, shear, whole, settings);
      ASSERT_EQ(enough.status, FrictionStatus::converged);
      EXPECT_EQ(enough.stalled, 0);
      settings.friction.max_sweeps = enough.counters.sweeps - 1;
      const MarchReport report = march(problem, shear, cut, settings);
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.time, 1);
      EXPECT_GT(report.stalled, 0);
      EXPECT_EQ(report.counters.rejected_increments, report.stalled);
      EXPECT_GT(report.increments.size(), 1u);
      EXPECT_LE(report.largest_residual, 1e-12);
   }
}

TEST(March, LoadsThatAreHeldChangeNothing)
{
   const ReducedProblem problem = one_block(0.4);
   for (Stepping stepping : {Stepping::fixed, Stepping::advancing, Stepping::exact})
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
      EXPECT_EQ(held.v, slid.v);
      EXPECT_EQ(held.slip_origin, slid.slip_origin);
      EXPECT_EQ(held.dissipation, slid.dissipation);
      EXPECT_EQ(held.time, 4);
   }
}

/// A pad that is pressed on a softer block from touching: friction in a contact that advances
/// depends on how it is cut into increments. The exact path has none.
TEST(March, SaysByHowMuchAdvancingContactDependsOnItsIncrements)
{
   const LoadHistory press = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}),
                     both = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0.1)});
   for (double contrast : {4.0, 0.3})
   {
      cattaneo_test::TwoBlocks scene;
      scene.contrast = contrast;
      scene.curved_gap = 3e-3;
      scene.intervals = 16;
      ReducedProblem problem = cattaneo_test::reduce_two_blocks(scene, 0.0);
      for (double friction : {0.1, 0.2, 0.6})
      {
         set_friction(problem, friction);
         for (const LoadHistory &history : {press, both})
         {
            const auto marched = [&](Stepping stepping, int increments, ContactState &state)
            {
               MarchSettings settings;
               settings.stepping = stepping;
               settings.increments = increments;
               state = ContactState::virgin(problem);
               const MarchReport report = march(problem, history, state, settings);
               EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
               return report;
            };
            // Increments only where one node bears and the pad may rock.
            ContactState exact, state;
            const MarchReport path = marched(Stepping::exact, 20, exact);
            EXPECT_LT(path.advance_error, 1e-5);
            double first = 0, last = 0;
            for (int increments : {4, 5, 10, 20, 50, 200, 1000})
            {
               const MarchReport report = marched(Stepping::advancing, increments, state);
               const double error =
                  (state.q - exact.q).cwiseAbs().maxCoeff() / exact.peak_force;
               (increments == 4 ? first : last) = error;
               EXPECT_LE(error, report.advance_error + path.advance_error)
                  << contrast << ' ' << friction << ' ' << increments;
            }
            EXPECT_LE(last, 0.1 * first + 1e-12); // the two ways agree in the end
         }
      }
   }
}

TEST(March, AdvancingContactClosesALayerAtATime)
{
   const int n = 41;
   ReducedProblem problem;
   problem.A = Eigen::MatrixXd::Zero(n, n);
   for (int i = 0; i < n; ++i)
   {
      problem.A(i, i) = 2.2;
      if (i > 0) { problem.A(i, i - 1) = problem.A(i - 1, i) = -1; }
   }
   problem.C = problem.A;
   problem.B = Eigen::MatrixXd::Zero(n, n);
   for (int i = 0; i + 1 < n; ++i)
   {
      problem.B(i, i + 1) = 0.2;
      problem.B(i + 1, i) = -0.2;
   }
   problem.patterns = {{"press", Control::force, VectorXd::Zero(n), VectorXd::Ones(n)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = VectorXd::NullaryExpr(n, [&](int i) { return 0.01 * (i - 20) * (i - 20); });
   set_friction(problem, 0.3);
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.increments = 4;
   int closed_before = 1, widest = 0;
   const MarchReport report =
      march(problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Constant(1, 4)}), state,
            settings,
            [&](const ContactState &s, const IncrementRecord &record)
            {
               const int now = n - record.separation;
               widest = std::max(widest, now - closed_before);
               closed_before = now;
               EXPECT_EQ(s.status[20] != NodeState::separation, true);
            });
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_GT(closed_before, 15);
   EXPECT_LE(widest, 2); // one at each end
   EXPECT_GT(report.counters.rejected_increments, 0);
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
   EXPECT_THROW(march(problem, history, state), InputError);
   history = LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)});
   EXPECT_THROW(march(problem, history, state), InputError);
   MarchSettings settings;
   settings.increments = 0;
   EXPECT_THROW(march(problem, press_then_shear(1, 1), state, settings), InputError);
}

TEST(ContactState, RefusesFilesThatAreNone)
{
   EXPECT_THROW(load_contact_state("/nonexistent/state.json"), InputError);
   const std::string file = testing::TempDir() + "cattaneo_bad_state.json";
   std::ofstream(file) << "{\"format\": \"something else\"}";
   EXPECT_THROW(load_contact_state(file), InputError);
   std::ofstream(file) << "not json";
   EXPECT_THROW(load_contact_state(file), InputError);
   std::remove(file.c_str());
   EXPECT_THROW(save(ContactState(), "/nonexistent/state.json"), InputError);
}

} // namespace
