#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "half_space_contacts.hpp"
#include "period_two.hpp"
#include "random_problem.hpp"
#include "small_problems.hpp"

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
using cattaneo_test::as_disc;
using cattaneo_test::one_block;
using cattaneo_test::press_then_shear;
using cattaneo_test::random_problem;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// A pin amid a hole that has walls at the given angles, a gap of 0.02 from each, pushed by F.
ReducedProblem pin_amid_walls(const std::vector<double> &degrees, const Vector2d &F, double f)
{
   const auto n = static_cast<Eigen::Index>(degrees.size());
   MatrixXd moved(2 * n, 2); // {v; w} by the pin's displacement
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double angle = degrees[i] * M_PI / 180;
      moved.row(i) << std::sin(angle), -std::cos(angle);
      moved.row(n + i) << -std::cos(angle), -std::sin(angle);
   }
   const MatrixXd Z = moved.householderQr().householderQ() * MatrixXd::Identity(2 * n, 2);
   ReducedProblem problem;
   const MatrixXd K = 1000 * (MatrixXd::Identity(2 * n, 2 * n) - Z * Z.transpose());
   problem.set_stiffness(K.topLeftCorner(n, n), K.bottomLeftCorner(n, n),
                         K.bottomRightCorner(n, n), Z);
   // Forces whose work along each motion is that of F.
   const VectorXd all = -moved * (moved.transpose() * moved).inverse() * F;
   problem.patterns = {{"F", Control::force, all.head(n), all.tail(n)}};
   problem.H = MatrixXd::Zero(1, 1);
   problem.gap = VectorXd::Constant(n, 0.02);
   set_friction(problem, f);
   return problem;
}

TEST(March, TakesUpTheClearanceOfWhatIsFree)
{
   const std::vector<double> walls{0, 90, 180, 270};
   const LoadHistory history = LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)});
   for (double f : {0.0, 0.3})
   {
      for (double size : {1.0, 1e3})
      {
         // Into the corner of two walls, each of which takes its part of F.
         const ReducedProblem corner = pin_amid_walls(walls, {3 * size, 4 * size}, f);
         ContactState state = ContactState::virgin(corner);
         MarchReport report = march(corner, history, state);
         ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
         // The forces on the pin: of the wall at 0 {q, p} along {-y, -x}, at 90 along {x, -y}.
         EXPECT_NEAR(state.p[0] - state.q[1], 3 * size, 1e-9 * size);
         EXPECT_NEAR(state.p[1] + state.q[0], 4 * size, 1e-9 * size);
         EXPECT_GT(state.p[0], 0);
         EXPECT_GT(state.p[1], 0);
         EXPECT_EQ(state.p[2], 0);
         EXPECT_EQ(state.p[3], 0);
         if (f == 0) { continue; } // what pushes at one wall is free along it
         // As far along the others as it was.
         const ReducedProblem straight = pin_amid_walls(walls, {size, 0}, f);
         state = ContactState::virgin(straight);
         report = march(straight, history, state);
         ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
         EXPECT_NEAR(state.p[0], size, 1e-9 * size);
         EXPECT_NEAR(state.v[0], 0, 1e-9);
      }
      // Away from all walls.
      const ReducedProblem away = pin_amid_walls({0, 90}, {-1, -1}, f);
      ContactState state = ContactState::virgin(away);
      const MarchReport report = march(away, history, state);
      EXPECT_EQ(report.status, FrictionStatus::no_solution) << report.message;
      EXPECT_EQ(report.taken_up_clearance, 0);
      EXPECT_EQ(state.w, VectorXd::Zero(2));
      // A wall that touches at rest would be slid along: that is for friction.
      ReducedProblem touching = pin_amid_walls(walls, {3, 4}, f);
      touching.gap[0] = 0;
      state = ContactState::virgin(touching);
      EXPECT_EQ(march(touching, history, state).taken_up_clearance, 0);
   }
   // So little a load that the way to the walls drowns it in rounding: no first increment is
   // found from amid the hole.
   const ReducedProblem lightly = pin_amid_walls(walls, {3e-6, 4e-6}, 0.3);
   ContactState state = ContactState::virgin(lightly);
   const MarchReport report = march(lightly, history, state);
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_NEAR(report.taken_up_clearance, 0.02, 1e-9);
   EXPECT_NEAR(state.p[0] - state.q[1], 3e-6, 1e-13);
   EXPECT_NEAR(state.p[1] + state.q[0], 4e-6, 1e-13);
   expect_input_error([&] { trace_march(lightly, history); }, "touches nothing at rest");
}

TEST(March, RecognisesAStateOfPeriodTwo)
{
   const ReducedProblem problem = cattaneo_test::period_two();
   const Eigen::MatrixXd loads = cattaneo_test::loads_of_period_two();
   const Eigen::Vector3d pressed(1, 0, 0);
   LoadHistory history = LoadHistory::through({VectorXd(pressed), loads.col(0), loads.col(1),
                                               loads.col(2), loads.col(3), loads.col(0)});
   history.cycle_start = 1;
   history.cycles = 9;
   for (double first_slip : {0.0, 0.7})
   {
      const double x = -0.125;
      ContactState start = ContactState::with_slip(problem, Eigen::Vector3d(first_slip, x, 0));
      ASSERT_EQ(FrictionSolver(problem).solve(start, pressed).status,
                FrictionStatus::converged);
      ContactState state = start;
      const MarchReport report = march(problem, history, state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.steady_period, 2);
      // Node 0 stays at 0.7 when the first cycle begins, but for that it is the steady one.
      const int steady = first_slip > 0 ? 2 : 1;
      EXPECT_EQ(report.steady_cycle, steady);
      ASSERT_EQ(report.cycles.size(), steady + 1u);
      for (int k = 0; k <= steady; ++k)
      {
         const double begins = k % 2 ? -x : x,
                      more = k == 0 && first_slip > 0 ? (0.7 - 0.625) * (1 + x) : 0;
         EXPECT_NEAR(report.cycles[k].dissipation,
                     cattaneo_test::loss_of_period_two(begins) + more, 1e-13);
         if (k > 0) { EXPECT_NEAR(report.cycles[k].slip_change, 0.25, 1e-13); }
      }
      const double last = steady % 2 ? x : -x; // v1 at the end
      EXPECT_NEAR(state.v[0], 0.5 - last, 1e-13);
      EXPECT_NEAR(state.v[1], last, 1e-13);
      EXPECT_EQ(state.cycle_slip.size(), 3u);
      EXPECT_EQ(state.steady_period(1e-10), 2);
      // One that goes on steadily does so when it is not stopped.
      MarchSettings on;
      on.stop_at_steady_state = false;
      state = start;
      const MarchReport all = march(problem, history, state, on);
      EXPECT_EQ(all.cycles.size(), 9u);
      EXPECT_EQ(all.steady_cycle, steady);
      EXPECT_EQ(all.steady_period, 2);
   }
}

/// A block on a spring, pressed and sheared in one increment, loses what it does in many: by
/// hand, from where its friction is exhausted, and the same however near it was to slipping.
TEST(March, LossOfWhatStuckBeginsWhereItSlips)
{
   ReducedProblem problem;
   const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1), zero = Eigen::MatrixXd::Zero(1, 1);
   problem.set_stiffness(one, zero, one);
   problem.patterns = {{"P", Control::force, zero, one}, {"Q", Control::force, one, zero}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = VectorXd::Zero(1);
   set_friction(problem, 0.3);
   for (const double shear : {0.2, 0.3 - 1e-9, 0.3})
   {
      // From (1, Q) to (1.5, -0.6): Q + s (-0.6 - Q) = -0.3 (1 + 0.5 s); then it slips by 0.15.
      const double s = (shear + 0.3) / (0.6 + shear - 0.15),
                   lost = 0.5 * 0.3 * (1 + 0.5 * s + 1.5) * 0.15;
      for (const int increments : {1, 7})
      {
         ContactState state = ContactState::virgin(problem);
         MarchSettings settings;
         settings.stepping = Stepping::fixed;
         settings.increments = increments;
         settings.single_increment_if_exact = false;
         const MarchReport report =
            march(problem,
                  LoadHistory::through(
                     {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, shear), Vector2d(1.5, -0.6)}),
                  state, settings);
         ASSERT_EQ(report.status, FrictionStatus::converged);
         EXPECT_NEAR(state.dissipation, lost, 1e-14) << shear << ", " << increments;
      }
   }
}

/// Where a node's slip began: only that beyond it vanishes at an advancing front.
TEST(March, SlipBeginsWhereTheNodeStuckOpenedOrTurned)
{
   // q = 2 v + Q, |q| <= 0.4, as above.
   const ReducedProblem problem = one_block(0.4);
   const auto loaded = [&](const std::vector<VectorXd> &points, int increments)
   {
      ContactState state = ContactState::virgin(problem);
      MarchSettings settings;
      settings.stepping = Stepping::fixed;
      settings.increments = increments;
      const MarchReport report = march(problem, LoadHistory::through(points), state, settings);
      EXPECT_EQ(report.status, FrictionStatus::converged);
      return state;
   };
   const Vector2d none(0, 0), pressed(1, 0), there(1, 1), back(1, -1), part(1, 0.5);
   for (int increments : {1, 4})
   {
      EXPECT_EQ(loaded({none, pressed, there}, increments).slip_origin[0], 0);
      EXPECT_NEAR(loaded({none, pressed, there, back}, increments).slip_origin[0], -0.3, 1e-15);
      // Stuck in between: it begins where that was.
      const ContactState again =
         loaded({none, pressed, there, part, Vector2d(1, 2)}, increments);
      EXPECT_NEAR(again.slip_origin[0], -0.3, 1e-15);
      EXPECT_NEAR(again.v[0], -0.8, 1e-15);
      // Pulled open, where it moves freely to v = -Q/2; pressed again it has slipped from
      // there.
      const ContactState open = loaded({none, pressed, there, Vector2d(-1, 1)}, increments);
      EXPECT_EQ(open.status[0], NodeState::separation);
      EXPECT_NEAR(open.slip_origin[0], -0.5, 1e-15);
      EXPECT_NEAR(loaded({none, pressed, there, part}, increments).slip_origin[0], -0.3, 1e-15);
   }
}

TEST(March, SaysWhereItFirstWasNotUnique)
{
   // Both nodes are above their critical friction of 2; node 1 is pressed from the start, node
   // 0 closes its gap of 0.3 later, at P = 0.225.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), 0.5 * Eigen::Matrix2d::Identity(),
                         Eigen::Matrix2d::Identity());
   problem.patterns = {{"P", Control::force, Vector2d(0, 0), Vector2d(1, 1)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Vector2d(0.3, 0);
   set_friction(problem, 3);
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 10;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}), state, settings);
   EXPECT_EQ(report.status, FrictionStatus::not_unique);
   EXPECT_TRUE(closed(state.status[0]));
   EXPECT_NE(report.message.find("node 1"), std::string::npos) << report.message;
   EXPECT_NEAR(report.event_time, 0.1, 1e-15);
   EXPECT_NEAR(report.event_multipliers[0], 0.1, 1e-15);
   EXPECT_EQ(report.time, 1);
   ASSERT_TRUE(report.not_unique);
   EXPECT_EQ(report.not_unique->time, report.event_time);
   EXPECT_EQ(named(problem, report.not_unique->multipliers).at("P"),
             report.event_multipliers[0]);
   EXPECT_EQ(report.not_unique->message, report.message);
   // The exact path says where the first of them closes.
   problem.gap = Vector2d(0.3, 0.6);
   settings.stepping = Stepping::exact;
   state = ContactState::virgin(problem);
   const MarchReport exact = march(
      problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}), state, settings);
   EXPECT_EQ(exact.status, FrictionStatus::not_unique);
   EXPECT_NE(exact.message.find("node 0"), std::string::npos) << exact.message;
   EXPECT_NEAR(exact.event_time, 0.225, 1e-14);
   ASSERT_TRUE(exact.not_unique);
   EXPECT_EQ(exact.not_unique->time, exact.event_time);
   EXPECT_EQ(exact.not_unique->multipliers, exact.event_multipliers);
}

/// With two tangential components there is no exact path: an estimate, beside many increments,
/// which may be exceeded, but seldom and by little.
TEST(March, LossErrorOfADiscIsAnEstimateThatHoldsMostly)
{
   std::mt19937 random(13);
   int marched = 0, covered = 0;
   for (int k = 0; k < 100; ++k)
   {
      const ReducedProblem problem =
         cattaneo_test::random_disc_problem(2 + k % 4, 0.2 + 0.004 * k, 0.1, random);
      Eigen::Vector3d zero(0, 0, 0), press(1, 0, 0), shear(1, 0.6, 0), twist(1, 0.6, 0.5),
         back(1, -0.6, 0.2);
      const LoadHistory history = LoadHistory::through({zero, press, shear, twist, back});
      MarchSettings settings;
      settings.increments = 4 + k % 12;
      settings.loss_error = true;
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, history, state, settings);
      MarchSettings fine;
      fine.increments = 30 * settings.increments;
      ContactState other = ContactState::virgin(problem);
      const MarchReport finest = march(problem, history, other, fine);
      if (report.status != FrictionStatus::converged ||
          finest.status != FrictionStatus::converged)
      {
         continue;
      }
      ++marched;
      EXPECT_FALSE(report.loss_error.bound);
      const double apart = std::abs(state.dissipation - other.dissipation);
      covered += apart <= report.loss_error.value;
      EXPECT_LE(apart, 2 * report.loss_error.value) << k << ' ' << report.loss_error.by;
   }
   std::printf("   %d of %d estimates of the error of the loss held\n", covered, marched);
   EXPECT_GT(marched, 80);
   EXPECT_GE(covered, 0.97 * marched);
}

/// Two spheres that are pressed and sheared: slip keeps its direction, one increment a leg has
/// the loss to 1e-8 of the work, and the pressing, which loses nothing, is no part of its
/// error.
TEST(March, LossErrorOfADiscDoesNotKnowOfPressing)
{
   const double edge = 2.0 / 11, P = 0.1, f = 0.3;
   const cattaneo_test::Places centres = cattaneo_test::cells(13, edge, 1.2);
   const Material material = cattaneo_test::of_shear(1, 0);
   ReducedProblem problem = cattaneo_test::contact_of(material, material, edge, centres)
                               .problem(centres.rowwise().squaredNorm() / 10);
   set_friction(problem, f);
   MarchSettings settings;
   settings.increments = 1;
   settings.loss_error = true;
   ContactState state = ContactState::virgin(problem);
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"P", P}}, {{"P", P}, {"Q1", 0.8 * f * P}}});
   const MarchReport report = march(problem, history, state, settings);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   MarchSettings fine;
   fine.increments = 64;
   ContactState other = ContactState::virgin(problem);
   ASSERT_EQ(march(problem, history, other, fine).status, FrictionStatus::converged);
   const double apart = std::abs(state.dissipation - other.dissipation);
   EXPECT_LE(apart, report.loss_error.value + 1e-12 * state.dissipation);
   EXPECT_LE(report.loss_error.value, 1e-6 * state.dissipation);
   EXPECT_FALSE(report.loss_error.bound);
}

/// Around a corner slip turns, and the loss of spheres is wrong to the first order or less:
/// extrapolated from three marches it is nearer to that of many increments than this march.
TEST(March, LossAroundACornerIsExtrapolated)
{
   const double edge = 2.0 / 15, P = 0.3, f = 0.3;
   const cattaneo_test::Places centres = cattaneo_test::cells(19, edge, 1.2);
   int known = 0;
   for (const double share : {0.5, 0.7})
   {
      ReducedProblem problem =
         cattaneo_test::contact_of(cattaneo_test::of_shear(1, 0.3), {}, edge, centres)
            .problem(centres.rowwise().squaredNorm() / 10);
      set_friction(problem, f);
      const double Q = share * f * P;
      const LoadHistory history = LoadHistory::through(
         problem, {{}, {{"P", P}}, {{"Q1", Q}}, {{"Q2", 0.6 * Q}}, {{"Q1", -0.5 * Q}}});
      MarchSettings settings;
      settings.increments = 8;
      settings.loss_error = true;
      ContactState state = ContactState::virgin(problem), other = state;
      const MarchReport report = march(problem, history, state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      settings.loss_error = false;
      settings.increments = 64;
      ASSERT_EQ(march(problem, history, other, settings).status, FrictionStatus::converged);
      const double apart = std::abs(state.dissipation - other.dissipation);
      EXPECT_LE(apart, report.loss_error.value);
      if (std::isnan(report.loss_error.extrapolated)) { continue; }
      ++known;
      EXPECT_LT(std::abs(report.loss_error.extrapolated - other.dissipation), apart);
   }
   EXPECT_GE(known, 1);
}

/// What is exact says so, and what is not asked for is not known.
TEST(March, LossErrorOfWhatIsExactIsNone)
{
   std::mt19937 random(14);
   const ReducedProblem problem = random_problem(6, 0.3, 0.1, random);
   const LoadHistory history = press_then_shear(0.5, 1);
   MarchSettings settings;
   ContactState state = ContactState::virgin(problem);
   EXPECT_TRUE(std::isnan(march(problem, history, state, settings).loss_error.value));
   settings.loss_error = true;
   settings.stepping = Stepping::exact;
   state = ContactState::virgin(problem);
   const MarchReport path = march(problem, history, state, settings);
   EXPECT_EQ(path.fallbacks, 0);
   EXPECT_EQ(path.loss_error.value, 0);
   EXPECT_TRUE(path.loss_error.bound);
   // A march that is taken up speaks of what is left.
   settings.stepping = Stepping::fixed;
   settings.increments = 5;
   ContactState middle;
   state = ContactState::virgin(problem);
   const MarchReport whole = march(problem, history, state, settings,
                                   [&](const ContactState &at, const IncrementRecord &)
                                   {
                                      if (at.time <= 2.5) { middle = at; }
                                   });
   const double before = middle.dissipation;
   const MarchReport rest = march(problem, history, middle, settings);
   EXPECT_EQ(middle.dissipation, state.dissipation);
   MarchSettings exactly;
   exactly.stepping = Stepping::exact;
   ASSERT_GT(before, 0);
   EXPECT_TRUE(rest.loss_error.bound);
   EXPECT_GT(rest.loss_error.value, 0);
   // What stopped the march stops that beside it.
   std::atomic<bool> stop{true};
   settings.monitor.stop = &stop;
   state = ContactState::virgin(problem);
   EXPECT_EQ(march(problem, history, state, settings).status, FrictionStatus::stopped);
   EXPECT_GT(whole.loss_error.counters.increments, 0);
}

/// Where nothing happens the balance is 0, not round-off over round-off: bodies that are
/// pressed and pushed along a line that neither feels.
TEST(March, EnergyBalanceOfNothingIsNone)
{
   std::mt19937 random(15);
   for (int k = 0; k < 40; ++k)
   {
      ReducedProblem problem = random_problem(6, 0.4, 0.1, random);
      problem.gap.setZero();
      // Loads that do nothing but to the last digit, as of supports that hold what is pushed.
      problem.patterns[1].q *= 1e-17;
      problem.patterns[1].p *= 1e-17;
      problem.H(1, 1) = 0;
      MarchSettings settings;
      settings.stepping = k % 2 ? Stepping::exact : Stepping::fixed;
      settings.increments = 4;
      ContactState state = ContactState::virgin(problem);
      march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state, settings);
      state.time = 0;
      const MarchReport report = march(problem,
                                       LoadHistory::through({Vector2d(1, 0), Vector2d(1, 1),
                                                             Vector2d(1, -1), Vector2d(1, 1)}),
                                       state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.energy_imbalance, 0) << k;
   }
}

/// q = v + Q, f p = 2: at Q = -6 the node has slipped by 4. Back at Q = 0 it has slipped back
/// by 2, against 2, which loses 4; the spring has given 8 - 2, and the one increment takes -3
/// for the mean load over a way of 2 where it is -1.
TEST(March, EnergyThatIsGivenBackIsAMeasureToo)
{
   ReducedProblem problem = one_block(0.5);
   problem.set_stiffness(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1), MatrixXd::Ones(1, 1));
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 1;
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(4, 0), Vector2d(4, -6)});
   ContactState state = ContactState::virgin(problem);
   march(problem, history, state, settings);
   EXPECT_NEAR(state.v[0], 4, 1e-14);
   history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(4, 0), Vector2d(4, -6), Vector2d(4, 0)});
   const MarchReport back = march(problem, history, state, settings);
   EXPECT_NEAR(state.v[0], 2, 1e-14);
   EXPECT_NEAR(back.energy_imbalance, (-6 + 6 - 4) / 6.0, 1e-14);
}

/// Two nodes of a body that nothing else holds, a spring 2 between them, f = 1/2, pressed by 1
/// and 0.6. Q pulls the first: from 0.5 on it slips, 0.5 = 2 (v1 - v2) + Q, and at 0.8 the
/// second one would let go: v = {-0.15, 0}, and 0.5 · 0.15 is lost.
TEST(March, WhatAFreeBodySlipsBeforeItSlidesOffIsDecidedByItsLastStick)
{
   ReducedProblem problem;
   problem.set_stiffness(MatrixXd{{2, -2}, {-2, 2}}, MatrixXd::Zero(2, 2),
                         4 * MatrixXd::Identity(2, 2));
   problem.rigid_motions = Eigen::Vector4d(1, 1, 0, 0) / std::sqrt(2);
   problem.patterns = {{"P", Control::force, Vector2d(0, 0), Vector2d(1, 0.6)},
                       {"Q", Control::force, Vector2d(1, 0), Vector2d(0, 0)}};
   problem.H = MatrixXd::Zero(2, 2);
   problem.gap = Vector2d::Zero();
   set_friction(problem, 0.5);
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      // Also at the limit itself, and beyond it by less than its forces are known to.
      for (const double peak : {0.8 * (1 - 1e-15), 0.8, 0.8 * (1 + 1e-12), 0.9, 1.0, 1.6, 7.0})
      {
         MarchSettings settings;
         settings.stepping = stepping;
         settings.increments = 7;
         ContactState state = ContactState::virgin(problem);
         const MarchReport report = march(
            problem, LoadHistory::through(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", peak}}}),
            state, settings);
         if (peak > 0.81)
         {
            EXPECT_EQ(report.status, FrictionStatus::gross_sliding) << report.message;
            EXPECT_NEAR(report.event_multipliers[1], 0.8, 1e-8);
         }
         EXPECT_NEAR(state.v[0], -0.15, 1e-8);
         EXPECT_NEAR(state.v[1], 0, 1e-8);
         EXPECT_NEAR(state.dissipation, 0.075, 1e-8);
      }
   }
}

/// Random ones among which a state next to the limit, in equilibrium to round-off with every
/// node slipping, had slipped a million times as far (by increments 99, 150, 257 and 381, by
/// the exact path 169 and 175, at the limit itself most) as before the last node let go.
TEST(March, WhatFreeBodiesSlipBeforeTheySlideOffDoesNotDependOnTheSteps)
{
   for (const unsigned seed : {1, 2, 3, 4, 5, 6, 99, 150, 169, 175, 257, 381})
   {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      const auto n = static_cast<Eigen::Index>(2 + seed % 7);
      const auto matrix = [&](Eigen::Index rows, Eigen::Index columns) {
         return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
      };
      VectorXd rigid = VectorXd::Zero(2 * n);
      rigid.head(n).setConstant(1 / std::sqrt(double(n)));
      const MatrixXd unit = MatrixXd::Identity(2 * n, 2 * n), R = matrix(2 * n, 2 * n);
      const MatrixXd without = unit - rigid * rigid.transpose();
      MatrixXd K = without * (unit + 0.3 * R * R.transpose() / double(n)) * without;
      K = (0.5 * (K + K.transpose())).eval();
      ReducedProblem problem;
      problem.set_stiffness(K.topLeftCorner(n, n), K.bottomLeftCorner(n, n),
                            K.bottomRightCorner(n, n));
      problem.rigid_motions = rigid;
      const VectorXd p = (VectorXd::Ones(n) + 0.3 * matrix(n, 1)).cwiseMax(0.1);
      VectorXd q = 0.3 * matrix(n, 1);
      q.array() -= q.mean();
      problem.patterns = {{"P", Control::force, q, p},
                          {"Q", Control::force, matrix(n, 1).cwiseAbs(), 0.1 * matrix(n, 1)}};
      problem.H = MatrixXd::Zero(2, 2);
      problem.gap = VectorXd::Zero(n);
      set_friction(problem, 0.2);
      const auto shear = [&](double peak, Stepping stepping, ContactState &state)
      {
         MarchSettings settings;
         settings.increments = 8;
         settings.stepping = stepping;
         return march(problem,
                      LoadHistory::through(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", peak}}}),
                      state, settings);
      };
      SCOPED_TRACE(seed);
      ContactState followed = ContactState::virgin(problem);
      const MarchReport beyond = shear(3, Stepping::exact, followed);
      EXPECT_EQ(beyond.status, FrictionStatus::gross_sliding);
      const double limit = beyond.event_multipliers[1];
      for (const double peak :
           {limit * (1 - 1e-12), limit, limit * (1 + 1e-12), limit * (1 + 1e-10), 3.0})
      {
         for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
         {
            ContactState state = ContactState::virgin(problem);
            const MarchReport report = shear(peak, stepping, state);
            if (peak == 3) { EXPECT_EQ(report.status, FrictionStatus::gross_sliding); }
            // Fixed increments know only which nodes slipped by their ends.
            EXPECT_LT((state.v - followed.v).cwiseAbs().maxCoeff(),
                      (stepping == Stepping::fixed ? 0.5 : 1e-5) *
                         followed.v.cwiseAbs().maxCoeff());
         }
      }
   }
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

/// A rigid wedge of half the angle a, guided across, on four springs of stiffness 1 along and
/// across its flank.
ReducedProblem rigid_wedge(double friction, double a)
{
   const double s = std::sin(a), c = std::cos(a);
   const Eigen::Index n = 4;
   VectorXd motion(2 * n);
   motion << VectorXd::Constant(n, c), VectorXd::Constant(n, -s);
   motion.normalize();
   const MatrixXd K = MatrixXd::Identity(2 * n, 2 * n) - motion * motion.transpose();
   ReducedProblem problem;
   problem.set_stiffness(K.topLeftCorner(n, n), K.bottomLeftCorner(n, n),
                         K.bottomRightCorner(n, n), motion);
   problem.gap = VectorXd::Zero(n);
   problem.patterns = {{"P", Control::force, VectorXd::Constant(n, -c / double(n)),
                        VectorXd::Constant(n, s / double(n))}};
   problem.H = MatrixXd::Zero(1, 1);
   set_friction(problem, friction);
   return problem;
}

/// Pressed by P = 1 the wedge slips: N (sin a + f cos a) = 1. Drawn back it sticks, and moves
/// by y until friction has turned round on all of them: f N + y cos a = -f (N + y sin a), at P
/// = 1
/// + y. From there on what slips bears less, and the wedge jumps free.
TEST(March, AWedgePulledFreeIsFollowedToItsLastLoadAndNotBisected)
{
   const double f = 0.6, a = 0.2, s = std::sin(a), c = std::cos(a);
   const ReducedProblem problem = rigid_wedge(f, a);
   const double N = 1 / (s + f * c), y = -2 * f * N / (c + f * s);
   for (const bool every_event : {false, true})
   {
      MarchSettings settings;
      settings.stepping = Stepping::exact;
      settings.every_event = every_event;
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem,
               LoadHistory::through(
                  {VectorXd::Zero(1), VectorXd::Ones(1), VectorXd::Constant(1, -0.9)}),
               state, settings);
      EXPECT_EQ(report.status, FrictionStatus::stalled);
      EXPECT_NE(report.message.find("jumps free"), std::string::npos) << report.message;
      EXPECT_NEAR(report.event_multipliers[0], 1 + y, 1e-12);
      EXPECT_NEAR(state.p.sum(), N + y * s, 1e-12);
      EXPECT_LE(report.counters.rejected_increments, 1);
   }
}

/// Nothing holds the wedge from rest, and no proof says so where it can lock itself.
TEST(March, AWedgePulledFromRestIsTriedOnce)
{
   const ReducedProblem problem = rigid_wedge(0.6, 0.2);
   for (Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      for (const bool once : {true, false})
      {
         MarchSettings settings;
         settings.stepping = stepping;
         settings.single_increment_if_exact = once;
         ContactState state = ContactState::virgin(problem);
         const MarchReport report = march(
            problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Constant(1, -0.1)}),
            state, settings);
         EXPECT_EQ(report.status, FrictionStatus::stalled) << report.message;
         EXPECT_EQ(report.time, 0);
         EXPECT_EQ(report.event_multipliers[0], 0);
         EXPECT_EQ(report.counters.rejected_increments, 0);
      }
   }
}

/// Two nodes without coupling, f = 1, gap g at the second, pressed by 1 and pushed there by 0.3
/// in proportion: from where it closes it sticks, so that q = 0.3 (1 - g).
TEST(March, AnErrorOfAdvancingContactIsStatedHoweverItIsCut)
{
   for (double gap : {0.3, 0.6, 0.97})
   {
      ReducedProblem problem;
      problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                            Eigen::Matrix2d::Identity());
      problem.gap = Vector2d(0, gap);
      problem.friction = Vector2d(1, 1);
      problem.patterns = {{"L", Control::force, Vector2d(0, 0.3), Vector2d(1, 1)}};
      problem.H = Eigen::MatrixXd::Zero(1, 1);
      const LoadHistory history = LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)});
      for (int increments : {1, 2, 3, 20, 333})
      {
         MarchSettings settings;
         settings.increments = increments;
         settings.stepping = Stepping::fixed;
         ContactState state = ContactState::virgin(problem);
         MarchReport report = march(problem, history, state, settings);
         EXPECT_LE(std::abs(state.q[1] - 0.3 * (1 - gap)),
                   report.advance_error * state.peak_force + 1e-14)
            << gap << ' ' << increments;
         // No more than four times all that a node can have gained in one of them.
         EXPECT_LE(report.advance_error * state.peak_force, 1.2 / increments + 1e-14);
         for (const bool every_event : {false, true})
         {
            settings.stepping = Stepping::exact;
            settings.every_event = every_event;
            state = ContactState::virgin(problem);
            report = march(problem, history, state, settings);
            EXPECT_EQ(report.advance_error, 0);
            EXPECT_EQ(report.fallbacks, 0);
            EXPECT_NEAR(state.q[1], 0.3 * (1 - gap), 1e-14);
         }
      }
   }
}

/// A rigid pad that may rock, on three springs of stiffness 1 along and across, with gaps g
/// beside the middle one, which bears alone up to P = g, wherever the pad leans: it may come to
/// touch at one side, without force, at any load. From P = g on each node takes a third of the
/// rest, and Q = f P/2, so that all stick.
TEST(March, APadThatRocksUntilItTouchesHasHadNoFrictionThere)
{
   const double friction = 0.6;
   MatrixXd motions = MatrixXd::Zero(6, 3); // along, across, rocking
   motions.col(0).head(3).setOnes();
   motions.col(1).tail(3).setOnes();
   motions.col(2).tail(3) = Eigen::Vector3d(-1, 0, 1);
   motions.colwise().normalize();
   const MatrixXd K = MatrixXd::Identity(6, 6) - motions * motions.transpose();
   const VectorXd third = VectorXd::Constant(3, 1.0 / 3), none = VectorXd::Zero(3);
   for (double gap : {0.03, 0.1, 0.2, 0.37, 0.41, 0.6, 0.77, 0.9})
   {
      ReducedProblem problem;
      problem.set_stiffness(K.topLeftCorner(3, 3), K.bottomLeftCorner(3, 3),
                            K.bottomRightCorner(3, 3), motions);
      problem.gap = Eigen::Vector3d(gap, 0, gap);
      problem.patterns = {{"L", Control::force, 0.5 * friction * third, third}};
      problem.H = MatrixXd::Zero(1, 1);
      problem.chains = one_chain(3);
      set_friction(problem, friction);
      const double side = (1 - gap) / 3;
      const Eigen::Vector3d p(side, 1 - 2 * side, side);
      for (const bool every_event : {false, true})
      {
         for (int increments : {1, 2, 3, 4, 7, 20, 50, 101})
         {
            MarchSettings settings;
            settings.stepping = Stepping::exact;
            settings.every_event = every_event;
            settings.increments = increments;
            ContactState state = ContactState::virgin(problem);
            const MarchReport report =
               march(problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}),
                     state, settings);
            EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
            EXPECT_EQ(report.advance_error, 0) << gap << ' ' << increments;
            // The loads do not turn it: its path is that of an upright pad.
            EXPECT_EQ(report.fallbacks, 0) << report.fallback_reason;
            EXPECT_EQ(report.counters.rejected_increments, 0);
            EXPECT_LT((state.p - p).cwiseAbs().maxCoeff(), 1e-14) << gap << ' ' << increments;
            EXPECT_LT((state.q - 0.5 * friction * p).cwiseAbs().maxCoeff(), 1e-14)
               << gap << ' ' << increments;
         }
      }
   }
}

TEST(March, ErrorsOfIncrementsInWhichNodesCloseAreStated)
{
   // Against the exact path, which closes each node where it does.
   std::mt19937 random(77);
   int compared = 0;
   for (int k = 0; k < 150; ++k)
   {
      const int n = 2 + k % 8;
      ReducedProblem problem = random_problem(n, 0.1 * (1 + k % 5), k % 3 ? 0.15 : 0.0, random);
      const double height = std::pow(10.0, -1 + k % 3);
      problem.gap = VectorXd::NullaryExpr(n, [&](Eigen::Index i)
                                          { return height * std::pow((i - 0.4 * n) / n, 2); });
      const LoadHistory history = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0.2)});
      MarchSettings settings;
      settings.stepping = Stepping::exact;
      ContactState exact = ContactState::virgin(problem);
      const MarchReport path = march(problem, history, exact, settings);
      if (path.status != FrictionStatus::converged || path.fallbacks > 0) { continue; }
      settings.stepping = Stepping::fixed;
      for (int increments : {1, 5, 20})
      {
         settings.increments = increments;
         ContactState state = ContactState::virgin(problem);
         const MarchReport report = march(problem, history, state, settings);
         if (report.status != FrictionStatus::converged || report.advance_error == 0)
         {
            continue;
         }
         ++compared;
         EXPECT_LE((state.q - exact.q).cwiseAbs().maxCoeff(),
                   report.advance_error * state.peak_force + 1e-12)
            << k << ' ' << increments;
      }
   }
   EXPECT_GT(compared, 150);
}

// In the disc there is no exact path to follow: contact advances by layers there.

TEST(March, AdvancingContactClosesALayerAtATime)
{
   const int n = 41;
   ReducedProblem problem;
   Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), B = A;
   for (int i = 0; i < n; ++i)
   {
      A(i, i) = 2.2;
      if (i > 0) { A(i, i - 1) = A(i - 1, i) = -1; }
   }
   for (int i = 0; i + 1 < n; ++i)
   {
      B(i, i + 1) = 0.2;
      B(i + 1, i) = -0.2;
   }
   problem.set_stiffness(A, B, A);
   problem.patterns = {{"press", Control::force, VectorXd::Zero(n), VectorXd::Ones(n)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.chains = cattaneo::one_chain(n);
   problem.gap = VectorXd::NullaryExpr(n, [&](int i) { return 0.01 * (i - 20) * (i - 20); });
   set_friction(problem, 0.3);
   problem = as_disc(problem);
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
   // Where nothing advances any more steps grow to the whole increments, and need no choice.
   march(problem,
         LoadHistory::through(
            {VectorXd::Zero(1), VectorXd::Constant(1, 4), VectorXd::Constant(1, 3)}),
         state, settings);
   EXPECT_EQ(state.time, 2);
   EXPECT_EQ(state.step, 0);
}

TEST(March, ARingOfNodesMayBeginAnywhere)
{
   // Contact advances from one node to both sides, over the end of the list where that is.
   const int n = 12;
   const VectorXd none = VectorXd::Zero(1), pressed = VectorXd::Constant(1, 3);
   long rejected = -1;
   ContactState first;
   for (int begin : {0, 1, 5, 11})
   {
      ReducedProblem problem;
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), B = A;
      problem.gap.resize(n);
      for (int i = 0; i < n; ++i)
      {
         const int j = (i + 1) % n, away = std::min((i - begin + n) % n, (begin - i + n) % n);
         A(i, i) = 2.2;
         A(i, j) = A(j, i) = -1;
         B(i, j) = 0.2;
         B(j, i) = -0.2;
         problem.gap[i] = 0.25 * away * away;
      }
      problem.set_stiffness(A, B, A);
      problem.patterns = {{"press", Control::force, VectorXd::Zero(n), VectorXd::Ones(n)}};
      problem.H = Eigen::MatrixXd::Zero(1, 1);
      set_friction(problem, 0.3);
      problem = as_disc(problem);
      ContactChain ring;
      ring.nodes = n;
      ring.loop = true;
      problem.chains = {ring};
      MarchSettings settings;
      settings.increments = 3;
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem, LoadHistory::through({none, pressed}), state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      if (rejected < 0)
      {
         rejected = report.counters.rejected_increments;
         first = state;
      }
      EXPECT_GT(rejected, 0);
      EXPECT_EQ(report.counters.rejected_increments, rejected) << begin;
      EXPECT_LE(rejected, 40) << "a layer is no further than it must be";
      for (int i = 0; i < n; ++i) { EXPECT_NEAR(state.p[(i + begin) % n], first.p[i], 1e-12); }
   }
}

TEST(March, AContactMayBeginAtTwoNodesBesideEachOther)
{
   // Two of four equal nodes close together, at 0.1, in one increment. The others stay apart.
   // Two that are not neighbours are closed one after the other if that can be, and are not
   // told apart here: the increment is halved as often as is allowed. The first and the last
   // node are neighbours on a loop.
   const VectorXd none = VectorXd::Zero(1), pressed = VectorXd::Ones(1);
   const Eigen::Vector4d middle(1, 0.1, 0.1, 1), apart(0.1, 1, 0.1, 1), ends(0.1, 1, 1, 0.1);
   struct Case
   {
      Eigen::Vector4d gap;
      bool loop, neighbours;
   };
   for (const Case &at : {Case{middle, false, true}, Case{apart, false, false},
                          Case{ends, true, true}, Case{ends, false, false}})
   {
      ReducedProblem problem;
      problem.set_stiffness(5 * Eigen::Matrix4d::Identity(),
                            0.1 * 5 * Eigen::Matrix4d::Identity(),
                            5 * Eigen::Matrix4d::Identity());
      problem.patterns = {{"press", Control::force, VectorXd::Zero(4), VectorXd::Ones(4)}};
      problem.H = Eigen::MatrixXd::Zero(1, 1);
      problem.gap = at.gap;
      set_friction(problem, 0.3);
      problem = as_disc(problem);
      ContactChain chain; // an open line unless it is said to be a loop
      chain.nodes = 4;
      if (at.loop) { chain.loop = true; }
      problem.chains = {chain};
      MarchSettings settings;
      settings.increments = 1;
      settings.max_halvings = 3;
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem, LoadHistory::through({none, pressed}), state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      if (at.neighbours) { EXPECT_EQ(report.counters.rejected_increments, 0); }
      else { EXPECT_GE(report.counters.rejected_increments, 3); }
      EXPECT_EQ(report.increments.back().separation, 2);
   }
}

TEST(ContactState, IsRefusedWhereItDoesNotFit)
{
   ReducedProblem problem = one_block(0.4);
   problem.gap[0] = -0.1; // closed from the start
   const ContactState good = ContactState::with_slip(problem, VectorXd::Constant(1, 2));
   EXPECT_EQ(good.status[0], NodeState::stick);
   EXPECT_EQ(good.slip_origin[0], 2);
   EXPECT_NO_THROW(good.validate(problem));
   EXPECT_THROW(ContactState::with_slip(problem, VectorXd::Zero(2)), InputError);
   for (VectorXd ContactState::*field :
        {&ContactState::v, &ContactState::w, &ContactState::q, &ContactState::p,
         &ContactState::slip_origin, &ContactState::multipliers})
   {
      ContactState bad = good;
      bad.*field = VectorXd::Zero(3);
      EXPECT_THROW(bad.validate(problem), InputError);
      bad = good;
      (bad.*field)[0] = NAN;
      EXPECT_THROW(bad.validate(problem), InputError);
   }
   for (double ContactState::*field : {&ContactState::time, &ContactState::step,
                                       &ContactState::peak_force, &ContactState::dissipation})
   {
      ContactState bad = good;
      bad.*field = NAN;
      EXPECT_THROW(bad.validate(problem), InputError);
   }
   ContactState bad = good;
   bad.cycle_slip = {VectorXd::Zero(2)};
   EXPECT_THROW(bad.validate(problem), InputError);
   bad = good;
   bad.status.clear();
   EXPECT_THROW(bad.validate(problem), InputError);
   bad = good;
   CycleRecord &cycle = bad.cycle.emplace();
   EXPECT_THROW(bad.validate(problem), InputError); // of no load and no node
   cycle.loops = {problem.patterns.size(), Loop(Control::force, 0, 0)};
   cycle.node_dissipation = VectorXd::Zero(1);
   EXPECT_NO_THROW(bad.validate(problem));
   cycle.loops[0].add(NAN, 1);
   EXPECT_THROW(bad.validate(problem), InputError);
}

TEST(ContactState, OnlyWhatIsANumberIsSaved)
{
   const ContactState good = ContactState::virgin(one_block(0.4));
   const std::string file = testing::TempDir() + "cattaneo_state_kept.json";
   save(good, file);
   const auto refused = [&](const std::function<void(ContactState &)> &spoil)
   {
      ContactState bad = good;
      spoil(bad);
      expect_input_error([&] { save(bad, file); }, "a value is not finite");
      EXPECT_EQ(load_contact_state(file).v, good.v); // the good one is still there
   };
   refused([](ContactState &s) { s.v[0] = NAN; });
   refused([](ContactState &s) { s.slip_origin[0] = INFINITY; });
   refused([](ContactState &s) { s.dissipation = NAN; });
   refused([](ContactState &s) { s.cycle_slip = {VectorXd::Constant(1, NAN)}; });
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

// Bodies are not moved once an observer has seen an increment, were it of no length:
// interference is let go on the exact path before the loads of the history, under which it
// finds no way on.
TEST(March, ClearanceIsTakenUpBeforeAnyIncrementOrNotAtAll)
{
   MatrixXd R(8, 4), F(8, 2);
   R << 0, 0, 0, -2, -1, 0, 0, 0, -1, 0, 0, 0, -2, 0, 3, -1, // v
      0, 0, 0, -2, 0, 3, 0, 0, 0, -4, 3, 2, 1, 4, 2, -4;     // w
   F << 0, -2, 0, 0, 0, 0, 3, 2, 0, 0, 0, -2, 0, -2, -4, 0;
   ReducedProblem problem;
   const MatrixXd K = R * R.transpose() / 16;
   problem.set_stiffness(K.topLeftCorner(4, 4), K.bottomLeftCorner(4, 4),
                         K.bottomRightCorner(4, 4));
   for (int k : {0, 1})
   {
      problem.patterns.push_back(
         {k ? "Q" : "P", Control::force, F.col(k).head(4) / 4, F.col(k).tail(4) / 4});
   }
   problem.H = MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector4d(0.1, 0, -0.3, 0.4);
   problem.friction = Eigen::Vector4d(0, 0, 0.2, 0.8);
   problem.weights = VectorXd::Ones(4);
   problem.arc_length = VectorXd::LinSpaced(4, 0, 3);
   problem.chains = one_chain(4);
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   settings.increments = 4;
   ContactState state = ContactState::virgin(problem);
   long seen = 0;
   const MarchReport report =
      march(problem, LoadHistory::through({VectorXd::Zero(2), Eigen::Vector2d(0.5, 1)}), state,
            settings, [&](const ContactState &, const IncrementRecord &) { ++seen; });
   EXPECT_EQ(report.status, FrictionStatus::stalled);
   EXPECT_EQ(seen, report.counters.increments);
   EXPECT_TRUE(seen == 0 || report.taken_up_clearance == 0);
}

} // namespace
