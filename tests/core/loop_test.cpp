#include "random_problem.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <gtest/gtest.h>

// Loops of loads: force against displacement, their area, secant and loss factor.

namespace
{

using namespace cattaneo;
using cattaneo_test::random_problem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/** A load Q acts on one end of a spring of stiffness 5; at its other end is the contact node,
    with a spring of stiffness 2 to the ground and friction f = 0.4 under P = 1:

       ground --2-- node --5-- Q

    With R = f P = 0.4, Q cycled between ±1 sticks over 2R (stiffness 5), then the node slips by
    (2 - 2R)/2 = 0.6 against R (5 and 2 in series): a parallelogram that loses 2 · 0.6 R = 0.48,
    between displacements ±(1/5 + 0.6/2). */
ReducedProblem spring_and_slider(Control control)
{
   const bool force = control == Control::force;
   ReducedProblem problem;
   const auto one = [](double x) { return MatrixXd::Constant(1, 1, x); };
   problem.set_stiffness(one(force ? 2 : 7), one(0), one(3));
   problem.patterns = {
      {"P", Control::force, VectorXd::Zero(1), VectorXd::Ones(1)},
      {"Q", control, VectorXd::Constant(1, force ? -1 : -5), VectorXd::Zero(1)}};
   // Force: the spring's own give. Displacement: its reaction with the node clamped.
   problem.H = Eigen::Matrix2d{{0, 0}, {0, force ? 0.2 : 5.0}};
   problem.gap = VectorXd::Zero(1);
   set_friction(problem, 0.4);
   return problem;
}

/// To and fro under P = 1.
LoadHistory swings(double amplitude, int cycles)
{
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, amplitude),
                            Vector2d(1, -amplitude), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

MarchSettings exactly()
{
   MarchSettings settings;
   settings.every_event = true;
   return settings;
}

void expect_parallelogram(const Loop &loop, Control control, double tolerance)
{
   EXPECT_NEAR(loop.work(), 0.48, tolerance) << static_cast<int>(control);
   EXPECT_NEAR(loop.force_range(), 2, tolerance);
   EXPECT_NEAR(loop.displacement_range(), 1, tolerance);
   EXPECT_NEAR(loop.stiffness(), 2, tolerance);
   // U = ½ · 1 · ½
   EXPECT_NEAR(loop.loss_factor(), 0.48 / (2 * M_PI * 0.25), tolerance);
}

TEST(Loop, OfASpringAndASliderIsAParallelogram)
{
   for (const Control control : {Control::force, Control::displacement})
   {
      const bool force = control == Control::force;
      const ReducedProblem problem = spring_and_slider(control);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, swings(force ? 1 : 0.5, 3), state, exactly());
      ASSERT_EQ(report.status, FrictionStatus::converged);
      ASSERT_GE(report.cycles.size(), 2u);
      for (std::size_t k = 0; k < report.cycles.size(); ++k)
      {
         EXPECT_EQ(report.cycles[k].cycle, static_cast<int>(k) + 1);
         EXPECT_TRUE(report.cycles[k].whole);
         ASSERT_EQ(report.cycles[k].loops.size(), 2u);
      }
      expect_parallelogram(report.cycles[1].loops[1], control, 1e-14);
      EXPECT_NEAR(report.cycles[1].dissipation, 0.48, 1e-14);
      // P is held: it does no work, and has no secant.
      const Loop &press = report.cycles[1].loops[0];
      EXPECT_EQ(press.work(), 0);
      EXPECT_EQ(press.force_range(), 0);
      EXPECT_TRUE(std::isnan(press.stiffness()));
      EXPECT_TRUE(std::isnan(press.loss_factor()));
      // Corners in the second cycle, as (Q, d): (1, 0.5), from where it sticks to (0.2, 0.34).
      int corners = 0;
      for (const IncrementRecord &record : report.increments)
      {
         const double Q = force ? record.multipliers[1] : record.conjugates[1],
                      d = force ? record.conjugates[1] : record.multipliers[1];
         if (record.cycle != 2) { continue; }
         if (std::abs(Q - 1) < 1e-12) { corners += std::abs(d - 0.5) < 1e-14; }
         if (std::abs(Q - 0.2) < 1e-12) { corners += std::abs(d - 0.34) < 1e-14; }
      }
      EXPECT_EQ(corners, 2);
   }
}

TEST(Loop, AFirstQuarterHasNoSecantOfItsOwnPatternUntilItMoves)
{
   Loop loop(Control::displacement, 0, 0);
   EXPECT_EQ(loop.work(), 0);
   EXPECT_TRUE(std::isnan(loop.stiffness()));
   loop.add(2, 3); // the reaction of 3 at a displacement of 2
   EXPECT_EQ(loop.work(), 3);
   EXPECT_EQ(loop.stiffness(), 1.5);
   loop.add(2, -1); // relaxes at a held displacement
   EXPECT_EQ(loop.work(), 3);
   EXPECT_EQ(loop.force_range(), 4);
   Loop rigid(Control::force, 0, 0);
   rigid.add(1, 0); // nothing gives
   EXPECT_TRUE(std::isinf(rigid.stiffness()));
   EXPECT_TRUE(std::isnan(rigid.loss_factor()));
}

/// Both loads vary: what one puts in the other may take out.
LoadHistory ellipse_like(int cycles)
{
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1.2, 0.5),
                            Vector2d(0.9, 0.7), Vector2d(0.8, -0.6), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

TEST(Loop, AreasAddUpToTheLossOfTheNodes)
{
   std::mt19937 random(31);
   int slipped = 0;
   for (int k = 0; k < 12; ++k)
   {
      ReducedProblem problem = random_problem(8, 0.15 + 0.04 * k, 0.1, random);
      if (k % 2) // a force and a displacement, with the signs that reciprocity wants
      {
         problem.patterns[1].control = Control::displacement;
         problem.H = Eigen::Matrix2d{{1.3, 0.4}, {-0.4, 2.1}};
      }
      else { problem.H = Eigen::Matrix2d{{1.3, 0.4}, {0.4, 2.1}}; }
      ContactState state = ContactState::virgin(problem), before = state;
      double lost = 0, largest = 0; // of the last cycle, by the forces and slips of the nodes
      int cycle = 0;
      const MarchReport report =
         march(problem, ellipse_like(60), state, exactly(),
               [&](const ContactState &now, const IncrementRecord &record)
               {
                  if (record.cycle != cycle) { lost = 0; }
                  cycle = record.cycle;
                  lost -= 0.5 * (now.q + before.q).dot(now.v - before.v);
                  largest = std::max(largest, record.conjugates.cwiseAbs().maxCoeff());
                  before = now;
               });
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      ASSERT_EQ(report.steady_period, 1) << k;
      ASSERT_EQ(report.fallbacks, 0);
      const CycleRecord &last = report.cycles.back();
      const double sum = last.loops[0].work() + last.loops[1].work();
      EXPECT_NEAR(sum, lost, 1e-9 * largest) << k;
      EXPECT_NEAR(sum, last.dissipation, 1e-9 * largest) << k;
      EXPECT_NEAR(sum, last.external_work, 1e-13 * largest) << k;
      slipped += lost > 1e-3;
   }
   EXPECT_GE(slipped, 6);
}

TEST(Loop, IsTheSameUnderAForceAndUnderItsDisplacement)
{
   std::mt19937 random(32);
   for (int k = 0; k < 5; ++k)
   {
      ReducedProblem forced = random_problem(8, 0.3, 0.1, random);
      forced.gap.setZero();
      const double h = 2.1, hp = 0.4;
      forced.H = Eigen::Matrix2d{{1.3, hp}, {hp, h}};
      // d = h Q + hp P - Fᵀ u, solved for Q.
      ReducedProblem moved = forced;
      const LoadPattern &press = forced.patterns[0], &shear = forced.patterns[1];
      VectorXd F(16), G(16);
      F << shear.q, shear.p;
      G << press.q, press.p;
      moved.K += F * F.transpose() / h;
      const VectorXd by_d = F / h, by_P = G - F * hp / h;
      moved.patterns = {{"press", Control::force, by_P.head(8), by_P.tail(8)},
                        {"shear", Control::displacement, by_d.head(8), by_d.tail(8)}};
      moved.H = Eigen::Matrix2d{{1.3 - hp * hp / h, hp / h}, {-hp / h, 1 / h}};
      moved.validate();

      std::vector<Vector2d> points = {{0, 0}, {1, 0}};
      for (double Q : {0.5, -0.4, 0.5, -0.4, 0.5, -0.4, 0.5}) { points.emplace_back(1, Q); }
      const auto run = [](const ReducedProblem &problem, const std::vector<Vector2d> &through)
      {
         ContactState state = ContactState::virgin(problem);
         const MarchReport report = march(
            problem, LoadHistory::through({through.begin(), through.end()}), state, exactly());
         EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
         return report.increments;
      };
      // From the fifth point to the seventh.
      const auto last_loop = [](const std::vector<IncrementRecord> &records, Control control)
      {
         std::optional<Loop> loop;
         for (const IncrementRecord &record : records)
         {
            const double m = record.multipliers[1], c = record.conjugates[1];
            if (record.time == 6) { loop.emplace(control, m, c); }
            else if (record.time > 6 && loop) { loop->add(m, c); }
         }
         return loop.value();
      };
      const std::vector<IncrementRecord> by_force = run(forced, points);
      for (const IncrementRecord &record : by_force)
      {
         const auto point = static_cast<std::size_t>(record.time);
         if (record.time == std::floor(record.time))
         {
            points[point][1] = record.conjugates[1];
         }
      }
      const std::vector<IncrementRecord> by_displacement = run(moved, points);
      const Loop a = last_loop(by_force, Control::force),
                 b = last_loop(by_displacement, Control::displacement);
      EXPECT_GT(a.work(), 1e-4) << k;
      EXPECT_NEAR(b.work(), a.work(), 1e-9);
      EXPECT_NEAR(b.stiffness(), a.stiffness(), 1e-9 * a.stiffness());
      EXPECT_NEAR(b.loss_factor(), a.loss_factor(), 1e-9);
   }
}

TEST(Loop, ScalesWithUnitsAndTurnsRoundWithItsLoad)
{
   std::mt19937 random(33);
   const ReducedProblem problem = random_problem(8, 0.3, 0.1, random);
   const auto last_cycle = [](const ReducedProblem &of, double sense)
   {
      ContactState state = ContactState::virgin(of);
      const MarchReport report = march(of, swings(0.5 * sense, 4), state, exactly());
      EXPECT_EQ(report.status, FrictionStatus::converged);
      return report.cycles.back();
   };
   const CycleRecord reference = last_cycle(problem, 1);
   const Loop &shear = reference.loops[1];
   ASSERT_GT(shear.work(), 1e-3);

   // Lengths are L times as many, forces F times.
   const double L = 1024, F = 0.125;
   ReducedProblem scaled = problem;
   scaled.K *= F / L;
   scaled.gap *= L;
   scaled.H *= F * L;
   for (LoadPattern &pattern : scaled.patterns)
   {
      pattern.q *= F;
      pattern.p *= F;
   }
   const CycleRecord other = last_cycle(scaled, 1);
   EXPECT_NEAR(other.loops[1].work() / (F * L), shear.work(), 1e-11);
   EXPECT_NEAR(other.loops[1].stiffness() * (F * L), shear.stiffness(), 1e-11);
   EXPECT_NEAR(other.loops[1].loss_factor(), shear.loss_factor(), 1e-11);

   // Seen in a mirror slips and shears have the other sign; the shear's multiplier is turned
   // round as well.
   ReducedProblem mirrored = problem;
   mirrored.B() *= -1;
   join_coupling(mirrored);
   mirrored.patterns[0].q *= -1;
   mirrored.patterns[1].p *= -1;
   mirrored.H.row(1) *= -1;
   mirrored.H.col(1) *= -1;
   const CycleRecord image = last_cycle(mirrored, -1);
   for (std::size_t k : {0u, 1u})
   {
      EXPECT_NEAR(image.loops[k].work(), reference.loops[k].work(), 1e-12);
      EXPECT_NEAR(image.loops[k].displacement_range(), reference.loops[k].displacement_range(),
                  1e-12);
   }
   EXPECT_NEAR(image.loops[1].loss_factor(), shear.loss_factor(), 1e-12);
}

TEST(Loop, WithoutTheResponseOfTheLoadsTheContactsPartIsKnown)
{
   ReducedProblem problem = spring_and_slider(Control::force);
   const ReducedProblem known = problem;
   problem.H.resize(0, 0);
   const std::string file = testing::TempDir() + "cattaneo_no_response.json";
   save(problem, file);
   problem = load_reduced_problem(file);
   std::remove(file.c_str());
   EXPECT_FALSE(problem.knows_loads());
   EXPECT_TRUE(known.knows_loads());
   EXPECT_FALSE(absorb_gap(problem).knows_loads());
   ContactState state = ContactState::virgin(problem), other = state;
   const MarchReport report = march(problem, swings(1, 3), state, exactly());
   const MarchReport whole = march(known, swings(1, 3), other, exactly());
   // What the spring gives is missing at each end; the area is not.
   const Loop &loop = report.cycles[1].loops[1];
   EXPECT_NEAR(loop.work(), 0.48, 1e-14);
   EXPECT_NEAR(loop.displacement_range(), 1 - 2 * 0.2, 1e-14);
   EXPECT_TRUE(std::isnan(loop.stiffness()));
   EXPECT_TRUE(std::isnan(loop.loss_factor()));
   ASSERT_EQ(report.increments.size(), whole.increments.size());
   for (std::size_t k = 0; k < report.increments.size(); ++k)
   {
      EXPECT_NEAR(whole.increments[k].conjugates[1] - report.increments[k].conjugates[1],
                  0.2 * whole.increments[k].multipliers[1], 1e-14);
   }
   EXPECT_LT(std::abs(report.energy_imbalance), 1e-14);
}

TEST(Loop, ACycleThatIsTakenUpWithinSaysSo)
{
   const ReducedProblem problem = spring_and_slider(Control::force);
   std::vector<ContactState> passed;
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.increments = 10;
   settings.stop_at_steady_state = false;
   march(problem, swings(1, 4), state, settings,
         [&](const ContactState &now, const IncrementRecord &) { passed.push_back(now); });
   // One increment to P, then 30 a cycle. Taken up in the middle of the second: the state knows
   // what came before, and one of another program or of a file of old does not.
   ContactState again = passed[45];
   MarchReport rest = march(problem, swings(1, 4), again, settings);
   ASSERT_EQ(rest.cycles.size(), 3u);
   EXPECT_EQ(rest.cycles[0].cycle, 2);
   EXPECT_TRUE(rest.cycles[0].whole);
   expect_parallelogram(rest.cycles[0].loops[1], Control::force, 1e-13);
   again = passed[45];
   again.cycle.reset();
   rest = march(problem, swings(1, 4), again, settings);
   ASSERT_EQ(rest.cycles.size(), 3u);
   EXPECT_EQ(rest.cycles[0].cycle, 2);
   EXPECT_FALSE(rest.cycles[0].whole);
   EXPECT_TRUE(rest.cycles[1].whole);
   expect_parallelogram(rest.cycles[1].loops[1], Control::force, 1e-13);
   settings.keep_increments = false;
   again = passed[45];
   const MarchReport lean = march(problem, swings(1, 4), again, settings);
   EXPECT_TRUE(lean.increments.empty());
   ASSERT_EQ(lean.cycles.size(), 3u);
   EXPECT_EQ(lean.cycles[2].loops[1].work(), rest.cycles[2].loops[1].work());
}

TEST(Loop, ConjugatesRefuseAnotherProblemsState)
{
   const ReducedProblem problem = spring_and_slider(Control::force);
   ContactState state = ContactState::virgin(problem);
   state.multipliers.resize(1);
   EXPECT_THROW(conjugates(problem, state), std::invalid_argument);
}

} // namespace
