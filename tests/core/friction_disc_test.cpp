#include "contact_laws.hpp"
#include "disc_problems.hpp"
#include "same_state.hpp"

#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/exact_path.hpp>
#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::random_disc_problem;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Largest disc_violation of the laws of contact and friction, in plain words from v and w
/// alone: no penetration, no tension, |q| <= f p, and power q·Δv = -f p |Δv| of friction.
double disc_violation(const ReducedProblem &problem, const ContactState &state,
                      const VectorXd &v_old)
{
   const VectorXd f = problem.clamped_forces(state.multipliers);
   const Index n = problem.nodes();
   const VectorXd q = problem.A() * state.v + problem.B().transpose() * state.w + f.head(2 * n);
   const VectorXd p = problem.B() * state.v + problem.C() * state.w + f.tail(n);
   double worst =
      std::max((q - state.q).cwiseAbs().maxCoeff(), (p - state.p).cwiseAbs().maxCoeff());
   for (Index i = 0; i < n; ++i)
   {
      const double gap = state.w[i] + problem.gap[i];
      const Vector2d slip(state.v[i] - v_old[i], state.v[n + i] - v_old[n + i]);
      const Vector2d shear(q[i], q[n + i]);
      const double fp = problem.friction[i] * p[i];
      worst = std::max({worst, -gap, -p[i], std::abs(gap * p[i])});
      worst =
         std::max({worst, shear.norm() - fp, std::abs(shear.dot(slip) + fp * slip.norm())});
      if (state.status[i] == NodeState::stick) { worst = std::max(worst, slip.norm()); }
      if (state.status[i] == NodeState::separation) { worst = std::max(worst, p[i]); }
      else { worst = std::max(worst, gap); }
   }
   return worst;
}

TEST(FrictionDisc, OneNodeObeysTheLawInEveryState)
{
   std::mt19937 random(1);
   std::uniform_real_distribution<double> uniform(-1, 1);
   int seen[5] = {0, 0, 0, 0, 0};
   for (int k = 0; k < 5000; ++k)
   {
      LoneNode node = {};
      node.c = 1.5;
      node.A.resize(2, 2);
      node.b.resize(2);
      node.q0.resize(2);
      node.A << 1 + uniform(random) / 2, 0, 0, 1 + uniform(random) / 2;
      node.A(0, 1) = node.A(1, 0) = 0.3 * uniform(random);
      node.b << 0.2 * uniform(random), 0.2 * uniform(random);
      const double friction = 1 + uniform(random);
      node.bound = FrictionBound(friction);
      node.q0 << uniform(random), uniform(random);
      node.p0 = uniform(random);
      if (friction >= critical_friction(node)) { continue; }
      const NodeMove move = solve_node(node);
      ASSERT_TRUE(move.found);
      const Vector2d q = node.q0 + node.A * move.slip + node.b * move.gap;
      const double p = node.p0 + node.b.dot(move.slip) + node.c * move.gap;
      const double fp = friction * p;
      switch (move.state)
      {
      case NodeState::separation:
         EXPECT_LT(q.norm() + std::abs(p), 1e-14);
         EXPECT_GT(move.gap, 0);
         break;
      case NodeState::stick:
         EXPECT_TRUE(move.slip.isZero(0) && move.gap == 0 && q.norm() <= fp);
         break;
      default:
         EXPECT_EQ(move.state, NodeState::slip);
         EXPECT_EQ(move.gap, 0);
         EXPECT_GE(p, 0);
         EXPECT_LT((q * move.slip.norm() + fp * move.slip).norm(), 1e-14) << k;
      }
      ++seen[static_cast<int>(move.state)];
   }
   for (int state : {0, 1, 4}) { EXPECT_GT(seen[state], 500); }
}

TEST(FrictionDisc, BothMethodsObeyTheLawOnRandomProblems)
{
   std::mt19937 random(2);
   std::uniform_real_distribution<double> uniform(0, 1);
   long solves = 0, steps = 0;
   int slipping = 0;
   for (int k = 0; k < 200; ++k)
   {
      const int n = 3 + k % 38;
      const ReducedProblem problem =
         random_disc_problem(n, 0.1 + 1.9 * k / 199.0, k % 3 ? 0.12 : 0.0, random);
      ContactState states[2];
      const FrictionMethod methods[] = {FrictionMethod::automatic,
                                        FrictionMethod::gauss_seidel};
      for (int method = 0; method < 2; ++method)
      {
         FrictionSettings settings;
         settings.method = methods[method];
         FrictionSolver solver(problem, settings);
         EXPECT_EQ(solver.counters().tangential_unknowns, 2 * n);
         ContactState &state = states[method];
         state = ContactState::virgin(problem);
         for (const Vector3d &loads : {Vector3d(1, 0, 0), Vector3d(1, 0.7, 0.2),
                                       Vector3d(1, 0.7, 0.9), Vector3d(0.8, -0.6, 0.1)})
         {
            const VectorXd v_old = state.v;
            const IncrementReport report = solver.solve(state, loads);
            ASSERT_EQ(report.status, FrictionStatus::converged)
               << "problem " << k << " method " << method << ": " << report.message;
            EXPECT_LT(disc_violation(problem, state, v_old), 1e-10) << "problem " << k;
            for (NodeState s : state.status) { slipping += s == NodeState::slip; }
            if (method == 0) { ++solves; }
         }
         if (method == 0) { steps += solver.counters().newton_steps; }
      }
      EXPECT_LT((states[0].v - states[1].v).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
      EXPECT_LT((states[0].w - states[1].w).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
   }
   EXPECT_GT(slipping, 2000);
   std::printf("%.2f Newton steps an increment\n", double(steps) / solves);
   EXPECT_LT(double(steps) / solves, 8);
}

/// Few Newton steps without a sweep before them seldom reach the end of a large increment; the
/// answer of the others, node by node, is reached in several steps of the load.
TEST(FrictionDisc, AnIncrementOutOfReachIsReachedInStepsOfItsLoad)
{
   std::mt19937 random(14);
   std::uniform_real_distribution<double> uniform(-1, 1);
   FrictionSettings few;
   few.max_newton = 3;
   int out_of_reach = 0;
   for (int k = 0; k < 300; ++k)
   {
      const ReducedProblem problem =
         random_disc_problem(3 + k % 30, 0.1 + 0.9 * k / 299.0, 0.25, random);
      FrictionSolver solver(problem, few), usual(problem);
      ContactState state = ContactState::virgin(problem);
      for (int j = 0; j < 6; ++j)
      {
         const ContactState before = state;
         const Vector3d loads(1 + 0.5 * uniform(random), uniform(random), uniform(random));
         const long steps = solver.counters().newton_steps;
         const IncrementReport report = solver.solve(state, loads);
         ASSERT_EQ(report.status, FrictionStatus::converged)
            << "problem " << k << ": " << report.message;
         out_of_reach += solver.counters().newton_steps - steps > few.max_newton;
         EXPECT_LT(disc_violation(problem, state, before.v), 1e-10) << "problem " << k;
         ContactState same = before;
         ASSERT_EQ(usual.solve(same, loads).status, FrictionStatus::converged);
         EXPECT_LT((state.v - same.v).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
         EXPECT_LT((state.w - same.w).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
      }
   }
   EXPECT_GT(out_of_reach, 100);
}

/// Press, then twist up and down; three patterns as in random_disc_problem.
LoadHistory press_then_twist(double amplitude, int cycles)
{
   LoadHistory history =
      LoadHistory::through({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 0, amplitude),
                            Vector3d(1, 0, -amplitude), Vector3d(1, 0, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

/// A problem whose second component is coupled to nothing and not loaded but by "twist".
ReducedProblem with_separate_twist(int n, double friction, double coupling,
                                   std::mt19937 &random)
{
   ReducedProblem problem = random_disc_problem(n, friction, coupling, random);
   problem.A().topRightCorner(n, n).setZero();
   problem.A().bottomLeftCorner(n, n).setZero();
   problem.B().rightCols(n).setZero();
   complete(problem);
   for (int k : {0, 1}) { problem.patterns[k].q.tail(n).setZero(); }
   return problem;
}

ReducedProblem first_component(const ReducedProblem &problem)
{
   const Index n = problem.nodes();
   ReducedProblem plane = problem;
   plane.set_stiffness(problem.A().topLeftCorner(n, n), problem.B().leftCols(n), problem.C());
   for (LoadPattern &pattern : plane.patterns) { pattern.q = VectorXd(pattern.q.head(n)); }
   return plane;
}

TEST(FrictionDisc, WithoutTorsionItIsThePlane)
{
   std::mt19937 random(3);
   for (int k = 0; k < 20; ++k)
   {
      const int n = 5 + k;
      const ReducedProblem problem = with_separate_twist(n, 0.5, k % 2 ? 0.15 : 0.0, random);
      const ReducedProblem plane = first_component(problem);
      LoadHistory history = LoadHistory::through(
         {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 0.8, 0), Vector3d(0.7, -0.8, 0)});
      ContactState disc_state = ContactState::virgin(problem),
                   plane_state = ContactState::virgin(plane);
      MarchSettings settings; // the same increments: there is no exact path in the disc
      settings.stepping = Stepping::fixed;
      ASSERT_EQ(march(problem, history, disc_state, settings).status,
                FrictionStatus::converged);
      ASSERT_EQ(march(plane, history, plane_state, settings).status, FrictionStatus::converged);
      EXPECT_LT((disc_state.v.head(n) - plane_state.v).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((disc_state.p - plane_state.p).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((disc_state.q.head(n) - plane_state.q).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_TRUE(disc_state.v.tail(n).isZero(0));
      EXPECT_TRUE(disc_state.q.tail(n).isZero(0));
      EXPECT_NEAR(disc_state.dissipation, plane_state.dissipation, 1e-12);
      for (int i = 0; i < n; ++i)
      {
         EXPECT_EQ(closed(disc_state.status[i]), closed(plane_state.status[i]));
         EXPECT_EQ(slips(disc_state.status[i]), slips(plane_state.status[i]));
      }
   }
}

/// An axis node: its tangential rows are coupled to nothing and carry nothing.
TEST(FrictionDisc, AnUncoupledNodeStaysInStick)
{
   std::mt19937 random(4);
   ReducedProblem problem = random_disc_problem(12, 0.4, 0.1, random);
   problem.gap[0] = 0;
   for (int r : {0, 12})
   {
      problem.A().row(r).setZero();
      problem.A().col(r).setZero();
      problem.A()(r, r) = 2;
      problem.B().col(r).setZero();
      for (LoadPattern &pattern : problem.patterns) { pattern.q[r] = 0; }
   }
   complete(problem);
   problem.patterns[0].p[0] = 3;
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(march(problem, press_then_twist(1.0, 2), state).status, FrictionStatus::converged);
   EXPECT_EQ(state.status[0], NodeState::stick);
   EXPECT_TRUE(state.v[0] == 0 && state.v[12] == 0 && state.q[0] == 0 && state.q[12] == 0);
   EXPECT_GT(state.p[0], 0);
}

/// Turns the tangential plane at every node by the same angle.
VectorXd turned(const VectorXd &x, double angle)
{
   const Index n = x.size() / 2;
   VectorXd y(2 * n);
   y << std::cos(angle) * x.head(n) - std::sin(angle) * x.tail(n),
      std::sin(angle) * x.head(n) + std::cos(angle) * x.tail(n);
   return y;
}

TEST(FrictionDisc, TurningThePlaneTurnsTheAnswer)
{
   std::mt19937 random(5);
   const int n = 15;
   ReducedProblem problem = random_disc_problem(n, 0.6, 0.0, random);
   problem.A().topRightCorner(n, n).setZero();
   problem.A().bottomLeftCorner(n, n).setZero();
   problem.A().bottomRightCorner(n, n) = problem.A().topLeftCorner(n, n);
   complete(problem);
   ReducedProblem other = problem;
   for (LoadPattern &pattern : other.patterns) { pattern.q = turned(pattern.q, 0.7); }
   ContactState state = ContactState::virgin(problem), image = state;
   ASSERT_EQ(march(problem, press_then_twist(1.2, 1), state).status, FrictionStatus::converged);
   ASSERT_EQ(march(other, press_then_twist(1.2, 1), image).status, FrictionStatus::converged);
   EXPECT_GT(state.v.cwiseAbs().maxCoeff(), 0.1);
   EXPECT_LT((turned(state.v, 0.7) - image.v).cwiseAbs().maxCoeff(), 1e-11);
   EXPECT_LT((turned(state.q, 0.7) - image.q).cwiseAbs().maxCoeff(), 1e-11);
   EXPECT_EQ(state.status, image.status);
}

TEST(FrictionDisc, OppositeTorqueMirrorsToTheLastBit)
{
   std::mt19937 random(6);
   const int n = 20;
   const ReducedProblem problem = with_separate_twist(n, 0.5, 0.15, random);
   ContactState state = ContactState::virgin(problem), image = state;
   MarchReport reports[2];
   reports[0] = march(problem, press_then_twist(0.9, 2), state);
   reports[1] = march(problem, press_then_twist(-0.9, 2), image);
   ASSERT_EQ(reports[0].status, FrictionStatus::converged);
   EXPECT_GT(state.v.tail(n).cwiseAbs().maxCoeff(), 0.01);
   EXPECT_EQ(state.v.head(n), image.v.head(n));
   EXPECT_EQ(state.v.tail(n), -image.v.tail(n));
   EXPECT_EQ(state.q.head(n), image.q.head(n));
   EXPECT_EQ(state.q.tail(n), -image.q.tail(n));
   EXPECT_EQ(state.w, image.w);
   EXPECT_EQ(state.p, image.p);
   EXPECT_EQ(state.status, image.status);
   EXPECT_EQ(state.dissipation, image.dissipation);
   EXPECT_EQ(reports[0].counters.newton_steps, reports[1].counters.newton_steps);
}

TEST(FrictionDisc, UnitsDoNotMatter)
{
   std::mt19937 random(7);
   const ReducedProblem problem = random_disc_problem(18, 0.5, 0.12, random);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, press_then_twist(0.9, 1), state);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   for (double force : {1e-9, 1e9})
   {
      for (double length : {1e-9, 1e9})
      {
         ReducedProblem other = problem;
         other.K *= force / length;
         other.gap *= length;
         for (LoadPattern &pattern : other.patterns)
         {
            pattern.q *= force;
            pattern.p *= force;
         }
         other.H *= length / force;
         ContactState scaled = ContactState::virgin(other);
         const MarchReport same = march(other, press_then_twist(0.9, 1), scaled);
         EXPECT_EQ(same.status, FrictionStatus::converged);
         EXPECT_EQ(same.counters.newton_steps, report.counters.newton_steps);
         EXPECT_EQ(same.counters.sweeps, report.counters.sweeps);
         EXPECT_EQ(scaled.status, state.status);
         EXPECT_LT((scaled.v / length - state.v).cwiseAbs().maxCoeff(), 1e-11);
         EXPECT_LT((scaled.q / force - state.q).cwiseAbs().maxCoeff(), 1e-11);
      }
   }
}

TEST(FrictionDisc, SavedAndResumedToTheLastBit)
{
   std::mt19937 random(8);
   const ReducedProblem problem = random_disc_problem(16, 0.4, 0.12, random);
   const LoadHistory history = press_then_twist(0.8, 2);
   ContactState whole = ContactState::virgin(problem), cut = whole;
   ASSERT_EQ(march(problem, history, whole).status, FrictionStatus::converged);
   ContactState kept;
   march(problem, history, cut, {},
         [&](const ContactState &state, const IncrementRecord &)
         {
            if (state.time <= 2.5) { kept = state; }
         });
   int slipping = 0;
   for (NodeState s : kept.status) { slipping += s == NodeState::slip; }
   EXPECT_GT(slipping, 0);
   const std::string file = testing::TempDir() + "disc_state.json";
   save(kept, file);
   ContactState resumed = load_contact_state(file);
   std::remove(file.c_str());
   EXPECT_EQ(resumed.status, kept.status);
   march(problem, history, resumed);
   cattaneo_test::expect_same(resumed, whole);
}

/// One node of stiffness 2 under a pressure and shears along and across, f p = 0.4.
ReducedProblem one_disc_node()
{
   ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Zero(1, 2),
                         Eigen::MatrixXd::Ones(1, 1));
   const VectorXd none = VectorXd::Zero(1);
   problem.patterns = {{"press", Control::force, Vector2d(0, 0), VectorXd::Ones(1)},
                       {"along", Control::force, Vector2d(1, 0), none},
                       {"across", Control::force, Vector2d(0, 1), none}};
   problem.H = Eigen::Matrix3d::Zero();
   problem.gap = none;
   set_friction(problem, 0.4);
   return problem;
}

TEST(FrictionDisc, SlipBeginsAnewWhereItTurnsByMoreThanARightAngle)
{
   // Sheared along by 1 it slips to (-0.3, 0). Then by so much that 2 (cos a, sin a) would bear
   // on it if it did not move: friction points along a, and it slips by -0.8 (cos a, sin a).
   const ReducedProblem problem = one_disc_node();
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 1;
   for (double degrees : {0.0, 80.0, -80.0, 89.9, 90.1, 100.0, -100.0, 180.0})
   {
      const double a = degrees * M_PI / 180;
      const Vector2d turned(std::cos(a), std::sin(a));
      const Vector3d along(1, 1, 0);
      Vector3d then = along, back;
      then.tail(2) += 2 * turned - Vector2d(0.4, 0);
      back = then;
      back.tail(2) -= (2 + 0.4) * turned; // and right back
      ContactState state = ContactState::virgin(problem);
      std::vector<ContactState> passed;
      const MarchReport report = march(
         problem,
         LoadHistory::through({Vector3d(0, 0, 0), Vector3d(1, 0, 0), along, then, back}), state,
         settings,
         [&](const ContactState &now, const IncrementRecord &) { passed.push_back(now); });
      ASSERT_EQ(report.status, FrictionStatus::converged);
      ASSERT_EQ(passed.size(), 4u);
      const Vector2d first(-0.3, 0), second = first - 0.8 * turned;
      EXPECT_LT((passed[1].v - first).norm(), 1e-14);
      EXPECT_EQ(passed[1].slip_origin, VectorXd(Vector2d(0, 0)));
      EXPECT_LT((passed[2].v - second).norm(), 1e-13) << degrees;
      const bool anew = std::abs(degrees) > 90;
      EXPECT_LT((passed[2].slip_origin - (anew ? first : Vector2d(0, 0))).norm(), 1e-14)
         << degrees;
      EXPECT_LT((passed[3].slip_origin - second).norm(), 1e-13) << degrees;
      EXPECT_LT((passed[3].v - (second + 0.8 * turned)).norm(), 1e-13) << degrees;
      EXPECT_NEAR(state.dissipation, 0.4 * (0.3 + 0.8 + 0.8), 1e-13);
   }
}

TEST(FrictionDisc, CriticalFrictionIsThatOfTheWeakestDirection)
{
   // Two nodes that feel each other, which does not count: each node's block of A has
   // off-diagonal entries of its own.
   ReducedProblem problem;
   problem.set_stiffness(
      Eigen::Matrix4d{
         {2, 0.3, 0.5, 0.2}, {0.3, 3, -0.1, -1}, {0.5, -0.1, 1, 0.15}, {0.2, -1, 0.15, 2}},
      Eigen::MatrixXd{{0.3, 0.07, 0.4, -0.05}, {0.02, 1, 0.06, -0.8}},
      10 * Eigen::Matrix2d::Identity());
   problem.gap = Vector2d(0, 0);
   double least[2];
   const Eigen::Matrix2d blocks[] = {Eigen::Matrix2d{{2, 0.5}, {0.5, 1}},
                                     Eigen::Matrix2d{{3, -1}, {-1, 2}}};
   const Vector2d pull[] = {Vector2d(0.3, 0.4), Vector2d(1, -0.8)};
   for (int i : {0, 1})
   {
      least[i] = 1e9;
      for (int k = 0; k < 100000; ++k)
      {
         const double angle = k * M_PI / 100000;
         const Vector2d s(std::cos(angle), std::sin(angle));
         least[i] = std::min(least[i], s.dot(blocks[i] * s) / std::abs(pull[i].dot(s)));
      }
   }
   set_friction(problem, 2.46);
   EXPECT_NEAR(critical_friction(problem).node, least[1], 1e-8);
   EXPECT_EQ(critical_friction(problem).weakest_node, 1);
   // Only a closed node counts, and it is the one that is named.
   const NodeState slip = NodeState::slip, stick = NodeState::stick,
                   open = NodeState::separation;
   const auto judged = [&](std::vector<NodeState> states)
   {
      ContactState at_rest = ContactState::virgin(problem);
      at_rest.status = std::move(states);
      return FrictionSolver(problem).judge(at_rest, at_rest);
   };
   EXPECT_EQ(judged({slip, stick}).status, FrictionStatus::converged);
   set_friction(problem, 2.47);
   EXPECT_EQ(judged({slip, open}).status, FrictionStatus::converged);
   EXPECT_EQ(judged({open, stick}).status, FrictionStatus::not_unique);
   const std::string message = judged({stick, slip}).message;
   EXPECT_NE(message.find("friction 2.47 at node 1 is above its critical value 2.463"),
             std::string::npos)
      << message;
}

// Just above it a node that sticks may slip as well under the same loads, in the direction that
// many others show to be the one of least mᵀA m/|bᵀm|.
TEST(FrictionDisc, AboveItsCriticalFrictionALoneNodeHasTwoAnswers)
{
   std::mt19937 random(4);
   std::normal_distribution<double> normal;
   for (int k = 0; k < 300; ++k)
   {
      const Eigen::Matrix2d R{{normal(random), normal(random)},
                              {normal(random), normal(random)}};
      LoneNode node = {};
      node.A = R * R.transpose() + 0.01 * Eigen::Matrix2d::Identity();
      if (k % 10 == 0) { node.A = Vector2d(node.A(0, 0), node.A(1, 1)).asDiagonal(); }
      node.b = Vector2d(normal(random), k % 5 == 0 ? 0.0 : normal(random));
      Vector2d m;
      double least = 1e300;
      const int directions = 20000;
      for (int i = 0; i < directions; ++i)
      {
         const double angle = i * M_PI / directions;
         const Vector2d tried(std::cos(angle), std::sin(angle));
         const double ratio = tried.dot(node.A * tried) / std::abs(node.b.dot(tried));
         if (ratio < least)
         {
            least = ratio;
            m = tried;
         }
      }
      if (node.b.dot(m) > 0) { m = -m; }
      const double critical = critical_friction(node);
      ASSERT_LE(critical, least * (1 + 1e-12)) << k;
      ASSERT_GT(critical, 0.999 * least) << k;
      const double friction = 1.002 * critical, p = 1e7;
      const Vector2d shear = -friction * p * m, held = shear - node.A * m;
      EXPECT_LE(held.norm(), friction * (p - node.b.dot(m))) << k; // stick: |q| <= f p
   }
   LoneNode uncoupled = {};
   uncoupled.A = Eigen::Matrix2d::Identity();
   uncoupled.b = Vector2d(0, 0);
   EXPECT_TRUE(std::isinf(critical_friction(uncoupled)));
}

/// With two tangential components increments are the march, and nothing is taken instead.
TEST(FrictionDisc, IncrementsAreTheMarch)
{
   const ReducedProblem problem = one_disc_node();
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   settings.increments = 3;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem,
            LoadHistory::through(
               {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(1, -1, 1)}),
            state, settings);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_EQ(report.fallbacks, 0);
   EXPECT_EQ(report.events, 0);
   EXPECT_EQ(report.increments.size(), 1u + 2 * 3u); // pressing takes one exact increment
}

TEST(FrictionDisc, StepsConvergeAtFirstOrderAndEnergyBalances)
{
   // Shear first, so that the torque has slip to turn. Each node that changes its state
   // disturbs the error of one problem: that of ten together is of first order.
   const LoadHistory history =
      LoadHistory::through({Vector3d(0, 0, 0), Vector3d(1, 0.6, 0), Vector3d(1, 0.6, 1.1)});
   const int steps[] = {40, 80, 160, 320, 5120};
   double error[4] = {0, 0, 0, 0}, imbalance[5] = {0, 0, 0, 0, 0};
   for (unsigned seed = 0; seed < 10; ++seed)
   {
      std::mt19937 random(seed);
      ReducedProblem problem = with_separate_twist(10, 0.5, 0.12, random);
      problem.gap.setZero();
      VectorXd slip[5];
      for (int k = 0; k < 5; ++k)
      {
         ContactState state = ContactState::virgin(problem);
         MarchSettings settings;
         settings.increments = steps[k];
         const MarchReport report = march(problem, history, state, settings);
         ASSERT_EQ(report.status, FrictionStatus::converged);
         imbalance[k] = std::max(imbalance[k], std::abs(report.energy_imbalance));
         // Where slip is short its direction is known to the round-off of displacements (2e-16)
         // over its length: here at most 1e-7.
         EXPECT_LE(report.largest_residual, 1e-9);
         EXPECT_GT(state.dissipation, 0);
         slip[k] = state.v;
      }
      for (int k = 0; k < 4; ++k) { error[k] += (slip[k] - slip[4]).norm(); }
   }
   for (int k = 0; k < 3; ++k) { EXPECT_NEAR(error[k] / error[k + 1], 2, 0.3) << k; }
   // The work that increments miss is of second order.
   for (int k = 0; k < 3; ++k) { EXPECT_NEAR(imbalance[k] / imbalance[k + 1], 4, 1.5) << k; }
   EXPECT_GT(error[3], 1e-5); // of slip: not round-off
}

TEST(FrictionDisc, ProportionalLoadingIsExactInOneIncrement)
{
   std::mt19937 random(10);
   ReducedProblem problem = random_disc_problem(17, 0.5, 0.12, random);
   problem.gap.setZero();
   const LoadHistory history = LoadHistory::through({Vector3d(0, 0, 0), Vector3d(1, 0.5, 0.8)});
   MarchSettings cut;
   cut.single_increment_if_exact = false;
   cut.increments = 13;
   ContactState one = ContactState::virgin(problem), many = one;
   const MarchReport report = march(problem, history, one);
   march(problem, history, many, cut);
   EXPECT_EQ(report.increments.size(), 1u);
   EXPECT_GT(report.increments[0].slip, 0);
   EXPECT_LT((one.v - many.v).cwiseAbs().maxCoeff(), 1e-11);
   EXPECT_NEAR(one.dissipation, many.dissipation, 1e-11);
   // A torque added to a held pressure is not proportional.
   const LoadHistory torque =
      LoadHistory::through({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 0, 0.5)});
   one = ContactState::virgin(problem);
   EXPECT_EQ(march(problem, torque, one).increments.size(), 21u);
}

TEST(FrictionDisc, WithoutFrictionThereAreNoTangentialUnknowns)
{
   std::mt19937 random(11);
   const int n = 13;
   const ReducedProblem problem = random_disc_problem(n, 0.0, 0.12, random);
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   ASSERT_EQ(march(solver, press_then_twist(0.5, 1), state).status, FrictionStatus::converged);
   EXPECT_EQ(solver.counters().tangential_unknowns, 0);
   const VectorXd f = problem.clamped_forces(state.multipliers);
   EXPECT_LT((problem.A() * state.v + problem.B().transpose() * state.w + f.head(2 * n))
                .cwiseAbs()
                .maxCoeff(),
             1e-12);
   EXPECT_EQ(state.dissipation, 0);
}

// However a closed node without friction is called, it is the same contact.
TEST(FrictionDisc, WithoutFrictionNamesOfStatesChangeNothing)
{
   std::mt19937 random(12);
   const int n = 13;
   const ReducedProblem problem = random_disc_problem(n, 0.0, 0.12, random);
   FrictionSettings newton_first;
   newton_first.sweeps = 0;
   std::vector<VectorXd> forces;
   for (const NodeState name : {NodeState::stick, NodeState::forward_slip, NodeState::slip})
   {
      ContactState state = ContactState::virgin(problem);
      for (double press : {0.4, 1.0, 0.7})
      {
         for (NodeState &node : state.status)
         {
            if (closed(node)) { node = name; }
         }
         FrictionSolver solver(problem, newton_first);
         ASSERT_EQ(solver.solve(state, Vector3d(press, 0, 0)).status,
                   FrictionStatus::converged);
         forces.push_back(state.p);
      }
   }
   for (std::size_t k = 3; k < forces.size(); ++k)
   {
      EXPECT_LT((forces[k] - forces[k % 3]).cwiseAbs().maxCoeff(), 1e-12);
   }
}

TEST(FrictionDisc, RefusesWhatNeedsThePlane)
{
   std::mt19937 random(12);
   EXPECT_THROW(ExactPath(random_disc_problem(4, 0.5, 0, random)), InputError);
}

/// A disc on a foundation of springs, free to rotate and to rise: circumferential springs only
/// resist motion relative to a rigid rotation v_θ = r φ, normal ones relative to a rise.
ReducedProblem free_disc(int n, double friction, double coupling)
{
   ReducedProblem problem;
   const VectorXd r = VectorXd::LinSpaced(n, 0.2, 1.0), one = VectorXd::Ones(n);
   const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
   Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n), B = A.topRows(n);
   A.topLeftCorner(n, n) = 2 * I;
   A.bottomRightCorner(n, n) = I - r * r.transpose() / r.squaredNorm();
   // A rise moves nothing else: rows of B that add up to zero.
   for (int i = 0; i + 1 < n; ++i)
   {
      B(i, i) += coupling;
      B(i + 1, i) -= coupling;
   }
   problem.set_stiffness(A, B, I - one * one.transpose() / n);
   LoadPattern press{"press", Control::force, VectorXd::Zero(2 * n), VectorXd::Zero(n)};
   press.p = one / n + 0.3 / n * (one - 2 * r);
   press.p *= 1 / press.p.sum();
   LoadPattern torque{"torque", Control::force, VectorXd::Zero(2 * n), VectorXd::Zero(n)};
   torque.q[2 * n - 1] = 1 / r[n - 1];
   problem.patterns = {press, torque};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = VectorXd::Zero(n);
   problem.chains = cattaneo::one_chain(n);
   problem.arc_length = r;
   set_friction(problem, friction);
   return problem;
}

TEST(FrictionDisc, SpinsAtTheFrictionTorque)
{
   const int n = 12;
   const ReducedProblem problem = free_disc(n, 0.4, 0.0);
   FrictionSolver solver(problem);
   const LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, -1)});
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(solver, history, state);
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NE(report.message.find("spins"), std::string::npos) << report.message;
   // Uncoupled: the pressure is that of the press alone, whatever the torque.
   ContactState pressed = ContactState::virgin(problem);
   solver.solve(pressed, Vector2d(1, 0));
   const double limit = 0.4 * problem.arc_length.dot(pressed.p);
   EXPECT_NEAR(-report.event_multipliers[1], limit, 1e-8 * limit);
   EXPECT_LE(-report.event_multipliers[1], limit * (1 + 1e-9));
}

TEST(FrictionDisc, SpinsTheWayTheTorqueTurns)
{
   const int n = 12;
   const ReducedProblem problem = free_disc(n, 0.4, 0.0);
   ContactState pressed = ContactState::virgin(problem);
   FrictionSolver(problem).solve(pressed, Vector2d(1, 0));
   const double limit = 0.4 * problem.arc_length.dot(pressed.p);
   for (double sign : {1.0, -1.0})
   {
      const auto steady = [&](double torque)
      {
         return find_spinning(problem, pressed.p,
                              problem.clamped_forces(Vector2d(1, sign * torque)));
      };
      EXPECT_FALSE(steady(0.999 * limit).exists);
      const Mechanism spinning = steady(1.001 * limit);
      ASSERT_TRUE(spinning.exists && spinning.slides && spinning.spins);
      VectorXd rotation = VectorXd::Zero(3 * n); // the largest radius is 1
      rotation.segment(n, n) = sign * problem.arc_length;
      EXPECT_LT((spinning.motion - rotation).norm(), 1e-13);
      // All of the force at the largest radius holds a torque of f P at most.
      const auto any = [&](double torque)
      { return find_mechanism(problem, problem.clamped_forces(Vector2d(1, torque))); };
      EXPECT_FALSE(any(sign * 0.399).exists);
      const Mechanism proof = any(sign * 0.401);
      ASSERT_TRUE(proof.exists && proof.slides && proof.spins);
      EXPECT_GT(sign * proof.motion[2 * n - 1], 0);
      EXPECT_NEAR(proof.motion.cwiseAbs().maxCoeff(), 1, 1e-14);
      EXPECT_TRUE(cattaneo_test::proves_mechanism(
         problem, proof.motion, problem.clamped_forces(Vector2d(1, sign * 0.401))));
      // The message is of the spinning, whichever way.
      ContactState state = pressed;
      const IncrementReport report =
         FrictionSolver(problem).solve(state, Vector2d(1, sign * 0.5));
      EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
      EXPECT_NE(report.message.find("spins about its axis"), std::string::npos);
   }
   // Twice the pressure holds twice the torque.
   EXPECT_FALSE(find_spinning(free_disc(n, 0.4, 0.0), 2 * pressed.p,
                              problem.clamped_forces(Vector2d(1, 1.5 * limit)))
                   .exists);
}

TEST(FrictionDisc, SpinsBeyondTheGreatestTorqueOfACoupledContact)
{
   const ReducedProblem problem = free_disc(12, 0.4, 0.15);
   FrictionSolver solver(problem);
   ASSERT_TRUE(problem.coupled);
   MarchSettings settings;
   settings.increments = 60;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)}),
            state, settings);
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NE(report.message.find("spins"), std::string::npos) << report.message;
   ReducedProblem smooth = problem;
   set_friction(smooth, 0);
   ContactState pressed = ContactState::virgin(smooth);
   ASSERT_EQ(FrictionSolver(smooth).solve(pressed, Vector2d(1, 0)).status,
             FrictionStatus::converged);
   const double steady = 0.4 * problem.arc_length.dot(pressed.p);
   std::printf("greatest torque over that of steady rotation: %.6f\n",
               report.event_multipliers[1] / steady);
   EXPECT_GE(report.event_multipliers[1], steady * (1 - 1e-6));
}

/// A rigid block on springs between its nodes only, free to move in the plane of contact.
TEST(FrictionDisc, SlidesInTheDirectionOfTheLoad)
{
   const int n = 3;
   const double f = 0.3;
   ReducedProblem problem;
   const Eigen::MatrixXd relative =
      Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / n);
   Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
   A.topLeftCorner(n, n) = A.bottomRightCorner(n, n) = relative;
   problem.set_stiffness(A, Eigen::MatrixXd::Zero(n, 2 * n), relative);
   problem.patterns = {
      {"press", Control::force, VectorXd::Zero(2 * n), VectorXd::Constant(n, 1.0 / n)}};
   for (double angle : {0.0, 0.3, 0.9, 2.0, 4.5})
   {
      VectorXd q(2 * n);
      q << VectorXd::Constant(n, std::cos(angle) / n),
         VectorXd::Constant(n, std::sin(angle) / n);
      problem.patterns.resize(1);
      problem.patterns.push_back({"pull", Control::force, q, VectorXd::Zero(n)});
      problem.H = Eigen::Matrix2d::Zero();
      problem.gap = VectorXd::Zero(n);
      set_friction(problem, f);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem,
               LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.7)}), state);
      EXPECT_EQ(report.status, FrictionStatus::gross_sliding) << angle;
      EXPECT_NEAR(report.event_multipliers[1], f, 1e-8) << angle; // whatever the direction
      auto pulled = [&](double force)
      { return find_mechanism(problem, problem.clamped_forces(Vector2d(1, force))); };
      EXPECT_FALSE(pulled(f * (1 - 1e-4)).exists);
      EXPECT_TRUE(pulled(f * (1 + 1e-4)).exists);
      const VectorXd motion = pulled(1.1 * f).motion;
      EXPECT_GT(motion[0] * std::cos(angle) + motion[n] * std::sin(angle), 0) << angle;
      EXPECT_TRUE(pulled(1.1 * f).slides);
      EXPECT_EQ(pulled(1.1 * f).spins, angle != 0) << angle; // across is circumferential
      EXPECT_NEAR(motion[0] * std::sin(angle), motion[n] * std::cos(angle), 1e-4) << angle;
   }
}

/// Files of a march with torsion: columns of their own, and every row complete.
TEST(FrictionDisc, TablesHaveBothComponents)
{
   std::mt19937 random(13);
   ReducedProblem problem = random_disc_problem(6, 0.5, 0.1, random);
   problem.chains = cattaneo::one_chain(6);
   problem.arc_length = VectorXd::LinSpaced(6, 0, 1);
   problem.position = Eigen::MatrixXd::Zero(6, 2);
   ContactState state = ContactState::virgin(problem);
   const std::string file = testing::TempDir() + "disc_table.csv";
   HistoryWriter table(file, problem);
   march(problem, press_then_twist(0.8, 1), state, {},
         [&](const ContactState &now, const IncrementRecord &record)
         { table.add(now, record); });
   auto check = [&](const std::string &column)
   {
      std::ifstream in(file);
      std::string line;
      std::getline(in, line);
      EXPECT_NE(line.find(column), std::string::npos) << line;
      const auto columns = std::count(line.begin(), line.end(), ',');
      int rows = 0;
      while (std::getline(in, line))
      {
         EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
         ++rows;
      }
      EXPECT_GT(rows, 5);
      std::remove(file.c_str());
   };
   check(",stick,separation,slip,dissipation");
   NodeWriter(file, problem).add(state);
   check("q1,q2,slip1,slip2");
}

} // namespace
