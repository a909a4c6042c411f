// Long and unkind histories: nearly sliding, ten thousand cycles, random paths, random initial
// slips. Every increment is verified.

#include "outcomes.hpp"
#include "punch_problem.hpp"
#include "random_problem.hpp"
#include "two_blocks.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Vector2d;
using Eigen::VectorXd;

MarchSettings stepping(Stepping kind, int increments)
{
   MarchSettings settings;
   settings.stepping = kind;
   settings.increments = increments;
   return settings;
}

/// A free block is held by friction alone: it slides when Q = f P, whatever its shape.
TEST(Marches, NearlySliding)
{
   const std::string below = "nearly sliding, Q = f P (1 - 1e-9)",
                     above = "gross sliding, Q = f P (1 + 1e-9)";
   int runs = 0;
   for (bool half_plane : {false, true})
   {
      ReducedProblem problem = punch_problem(33, half_plane);
      for (double friction : {0.05, 0.2, 0.7})
      {
         set_friction(problem, friction);
         for (const MarchSettings &settings :
              {stepping(Stepping::fixed, 1), stepping(Stepping::fixed, 7),
               stepping(Stepping::exact, 7)})
         {
            for (double sign : {1.0, -1.0})
            {
               ++runs;
               const std::string run = "f " + std::to_string(friction);
               for (double beyond : {-1e-9, 1e-9})
               {
                  const double q = sign * friction * (1 + beyond);
                  ContactState state = ContactState::virgin(problem);
                  const Verdict verdict = march_and_verify(
                     problem,
                     LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, q)}),
                     state, settings);
                  record(beyond < 0 ? below : above, run, verdict);
                  if (verdict.outcome == Outcome::gross_sliding)
                  {
                     EXPECT_NEAR(verdict.report.event_multipliers[1], sign * friction,
                                 5e-9 * friction);
                  }
               }
            }
         }
      }
   }
   EXPECT_EQ(count(below, Outcome::verified), runs);
   EXPECT_EQ(count(above, Outcome::gross_sliding), runs);
}

/// Steady-state detection off: ten thousand cycles are marched. Nothing may creep.
void run_cycles(const std::string &name, const ReducedProblem &problem, double amplitude,
                MarchSettings settings)
{
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, amplitude),
                            Vector2d(1, -amplitude), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cases(10000, 100000);
   settings.stop_at_steady_state = false;
   ContactState state = ContactState::virgin(problem);
   const Verdict verdict = march_and_verify(problem, history, state, settings);
   record("10,000 cycles or more", name, verdict);
   ASSERT_EQ(verdict.outcome, Outcome::verified) << name;
   const std::vector<CycleRecord> &cycles = verdict.report.cycles;
   ASSERT_EQ(cycles.size(), static_cast<std::size_t>(history.cycles));
   const double loss = cycles[1000].dissipation;
   EXPECT_GT(loss, 0);
   EXPECT_NEAR(cycles.back().dissipation, loss, 1e-11 * loss) << name;
   EXPECT_NEAR(state.dissipation, cycles[0].dissipation + loss * (history.cycles - 1),
               1e-3 * loss * history.cycles)
      << name;
   // The slip after the last cycle is that after the thousandth.
   history.cycles = 1000;
   ContactState early = ContactState::virgin(problem);
   march(problem, history, early, settings);
   const double slip = state.v.cwiseAbs().maxCoeff();
   EXPECT_LT((state.v - early.v).cwiseAbs().maxCoeff(), 1e-13 * slip) << name;
   EXPECT_LT((state.p - early.p).cwiseAbs().maxCoeff(), 1e-13 * state.peak_force) << name;
   if (settings.stepping == Stepping::exact) // increments miss some of the work of the loads
   {
      EXPECT_LT(std::abs(verdict.report.energy_imbalance), 1e-9) << name;
   }
}

TEST(Marches, TenThousandCyclesOfARandomProblem)
{
   std::mt19937 random(500);
   const ReducedProblem problem = random_problem(8, 0.3, 0.12, random);
   run_cycles("random, steps", problem, 0.6, stepping(Stepping::fixed, 3));
   run_cycles("random, exact", problem, 0.6, stepping(Stepping::exact, 3));
}

TEST(Marches, TenThousandCyclesOfAPunch)
{
   ReducedProblem problem = punch_problem(17, false);
   set_friction(problem, 0.3);
   run_cycles("punch, steps", problem, 0.24, stepping(Stepping::fixed, 3));
   run_cycles("punch, exact", problem, 0.24, stepping(Stepping::exact, 3));
}

TEST(Marches, RandomPaths)
{
   const std::string family = "random load paths";
   std::mt19937 random(501);
   std::uniform_real_distribution<double> uniform(-1, 1);
   const int runs = cases(24, 400);
   for (int k = 0; k < runs; ++k)
   {
      const double friction = 0.05 + 0.6 * std::abs(uniform(random));
      ReducedProblem problem =
         k % 3 ? random_problem(2 + k % 17, friction, 0.12, random) : punch_problem(25, k % 2);
      set_friction(problem, friction);
      std::vector<VectorXd> points{Vector2d(0, 0)};
      for (int point = 0; point < 20; ++point)
      {
         const double p = k % 4 == 0 && point % 7 == 6 ? 0.0 : 1 + 0.95 * uniform(random);
         points.push_back(Vector2d(p, 0.9 * friction * p * uniform(random)));
      }
      for (const MarchSettings &settings :
           {stepping(Stepping::fixed, 1), stepping(Stepping::exact, 1),
            stepping(Stepping::exact, 5)})
      {
         ContactState state = ContactState::virgin(problem);
         record(family,
                "path " + std::to_string(k) + " stepping " +
                   std::to_string(static_cast<int>(settings.stepping)),
                march_and_verify(problem, LoadHistory::through(points), state, settings));
      }
   }
   EXPECT_EQ(count(family, Outcome::stalled), 0);
}

TEST(Marches, RandomInitialSlips)
{
   const std::string family = "random initial slips";
   std::mt19937 random(502);
   std::uniform_real_distribution<double> uniform(-1, 1);
   const int runs = cases(24, 400);
   TwoBlocks scene;
   scene.contrast = 3;
   const ReducedProblem blocks = reduce_two_blocks(scene, 0.0),
                        punch = punch_problem(33, false);
   for (int k = 0; k < runs; ++k)
   {
      ReducedProblem problem = k % 2 ? blocks : punch;
      const double friction = 0.05 + 0.9 * std::abs(uniform(random));
      set_friction(problem, friction);
      // Slips of 1e-9 to 1e3 times what the loads would cause, rough or smooth.
      const VectorXd force = problem.clamped_forces(Vector2d(1, 0));
      const double natural = force.cwiseAbs().maxCoeff() / problem.A().diagonal().minCoeff();
      const double size = natural * std::pow(10, 6 * uniform(random) - 3);
      const double wave = 4 * uniform(random);
      const VectorXd v = VectorXd::NullaryExpr(
         problem.nodes(),
         [&](Eigen::Index i)
         {
            const double x = problem.arc_length[i];
            return size * (k % 4 < 2 ? uniform(random) : std::sin(wave * x));
         });
      const double q = 0.8 * friction;
      const LoadHistory history = LoadHistory::through(
         {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, q), Vector2d(1, -q), Vector2d(1, 0)});
      for (const MarchSettings &settings :
           {stepping(Stepping::fixed, 4), stepping(Stepping::exact, 4)})
      {
         ContactState state = ContactState::with_slip(problem, v);
         record(family,
                "slip " + std::to_string(k) + " stepping " +
                   std::to_string(static_cast<int>(settings.stepping)),
                march_and_verify(problem, history, state, settings));
      }
   }
   // Rough slips a thousand times larger than the loads would cause.
   EXPECT_LE(count(family, Outcome::stalled), 0.03 * 2 * runs); // each is marched twice
}

/// A pad that is pressed on a softer block from touching: friction in a contact that advances
/// depends on how it is cut into increments. The exact path has none.
TEST(Marches, SayByHowMuchAdvancingContactDependsOnItsIncrements)
{
   const LoadHistory press = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}),
                     both = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0.07)});
   for (double contrast : {4.0, 0.3})
   {
      TwoBlocks scene;
      scene.contrast = contrast;
      scene.curved_gap = 3e-3;
      scene.intervals = 16;
      ReducedProblem problem = reduce_two_blocks(scene, 0.0);
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
            const auto error = [&]
            { return (state.q - exact.q).cwiseAbs().maxCoeff() / exact.peak_force; };
            for (int increments : {4, 5, 10, 20, 50, 200, 1000})
            {
               const MarchReport report = marched(Stepping::fixed, increments, state);
               (increments == 4 ? first : last) = error();
               EXPECT_LE(error(), report.advance_error + path.advance_error)
                  << contrast << ' ' << friction << ' ' << increments;
            }
            EXPECT_LE(last, 0.1 * first + 1e-12); // the two ways agree in the end
            // Stops of the path change nothing.
            for (int increments : {1, 4, 50})
            {
               const MarchReport report = marched(Stepping::exact, increments, state);
               EXPECT_LT(report.advance_error, 1e-5);
               EXPECT_LE(error(), report.advance_error + path.advance_error + 1e-12)
                  << contrast << ' ' << friction << ' ' << increments;
            }
         }
      }
   }
}

} // namespace
