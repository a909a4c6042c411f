#include "expect_input_error.hpp"
#include "lemke.hpp"
#include "random_problem.hpp"

#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::lemke;
using cattaneo_test::LemkeReport;
using cattaneo_test::random_problem;
using cattaneo_test::solve_by_lemke;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

ReducedProblem one_node(double a, double b, double c, double q, double p, double f, double gap)
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Constant(1, 1, a), Eigen::MatrixXd::Constant(1, 1, b),
                         Eigen::MatrixXd::Constant(1, 1, c));
   problem.patterns = {
      {"load", Control::force, VectorXd::Constant(1, q), VectorXd::Constant(1, p)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = VectorXd::Constant(1, gap);
   problem.friction = VectorXd::Constant(1, f);
   return problem;
}

/// Two nodes that do not feel each other, A = C = 1, B = ½.
ReducedProblem free_nodes()
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), 0.5 * Eigen::Matrix2d::Identity(),
                         Eigen::Matrix2d::Identity());
   problem.patterns = {{"load", Control::force, Vector2d(0, 0), Vector2d(1, 1)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Vector2d(0, 0);
   set_friction(problem, 1);
   return problem;
}

/// Largest violation of the laws of contact and friction, checked in plain words from v, w
/// alone.
double violation(const ReducedProblem &problem, const ContactState &state,
                 const VectorXd &v_old)
{
   const VectorXd f = problem.clamped_forces(state.multipliers);
   const Eigen::Index n = problem.nodes();
   const VectorXd q = problem.A() * state.v + problem.B().transpose() * state.w + f.head(n);
   const VectorXd p = problem.B() * state.v + problem.C() * state.w + f.tail(n);
   double worst = 0;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double gap = state.w[i] + problem.gap[i], slip = state.v[i] - v_old[i];
      const double fp = problem.friction[i] * p[i];
      switch (state.status[i])
      {
      case NodeState::separation:
         worst = std::max({worst, std::abs(p[i]), std::abs(q[i]), -gap});
         break;
      case NodeState::stick:
         worst = std::max({worst, std::abs(gap), std::abs(slip), -p[i], std::abs(q[i]) - fp});
         break;
      case NodeState::forward_slip:
         worst = std::max({worst, std::abs(gap), -slip, -p[i], std::abs(q[i] + fp)});
         break;
      case NodeState::backward_slip:
         worst = std::max({worst, std::abs(gap), slip, -p[i], std::abs(q[i] - fp)});
         break;
      case NodeState::slip:
         ADD_FAILURE() << "a state of two tangential components";
         break;
      }
      worst = std::max({worst, std::abs(state.q[i] - q[i]), std::abs(state.p[i] - p[i])});
   }
   return worst;
}

/// All states of one node for which the laws hold, by trying the four of them.
std::vector<NodeState> enumerate(const ReducedProblem &problem, double v_old)
{
   const double a = problem.A()(0, 0), b = problem.B()(0, 0), c = problem.C()(0, 0);
   const double g = problem.gap[0], f = problem.friction[0];
   const double q0 = problem.patterns[0].q[0] + a * v_old - b * g;
   const double p0 = problem.patterns[0].p[0] + b * v_old - c * g;
   std::vector<NodeState> found;
   const double det = a * c - b * b;
   if ((b * q0 - a * p0) / det > 0) { found.push_back(NodeState::separation); }
   if (p0 >= 0 && std::abs(q0) <= f * p0) { found.push_back(NodeState::stick); }
   const double forward = -(q0 + f * p0) / (a + f * b), backward = -(q0 - f * p0) / (a - f * b);
   if (forward > 0 && p0 + b * forward >= 0) { found.push_back(NodeState::forward_slip); }
   if (backward < 0 && p0 + b * backward >= 0) { found.push_back(NodeState::backward_slip); }
   return found;
}

TEST(FrictionSolver, OneNodeAgreesWithEnumeration)
{
   std::mt19937 random(1);
   std::uniform_real_distribution<double> uniform(-1, 1);
   int seen[4] = {0, 0, 0, 0};
   for (int k = 0; k < 2000; ++k)
   {
      const double b = 0.9 * uniform(random), f = std::abs(uniform(random));
      ReducedProblem problem = one_node(1, b, 1.5, uniform(random), uniform(random), f,
                                        k % 2 ? 0.0 : 0.3 * std::abs(uniform(random)));
      const double v_old = 0.2 * uniform(random);
      const std::vector<NodeState> expected = enumerate(problem, v_old);
      ASSERT_EQ(expected.size(), 1u); // f < A/|B|: unique
      const ContactState start = ContactState::with_slip(problem, VectorXd::Constant(1, v_old));
      const auto oracle = solve_by_lemke(problem, start, VectorXd::Ones(1));
      ASSERT_TRUE(oracle) << "problem " << k;
      EXPECT_EQ(oracle->status[0], expected[0]);
      for (FrictionMethod method : {FrictionMethod::automatic, FrictionMethod::gauss_seidel})
      {
         FrictionSettings settings;
         settings.method = method;
         FrictionSolver solver(problem, settings);
         ContactState state = start;
         const IncrementReport report = solver.solve(state, VectorXd::Ones(1));
         ASSERT_EQ(report.status, FrictionStatus::converged)
            << "problem " << k << " method " << static_cast<int>(method) << ": "
            << report.message;
         EXPECT_EQ(state.status[0], expected[0]);
         EXPECT_LT(violation(problem, state, VectorXd::Constant(1, v_old)), 1e-12);
      }
      ++seen[static_cast<int>(expected[0])];
   }
   for (int count : seen) { EXPECT_GT(count, 50); }
}

TEST(FrictionSolver, ThreeMethodsAgreeOnRandomProblems)
{
   std::mt19937 random(2);
   std::uniform_real_distribution<double> uniform(0, 1);
   for (int k = 0; k < 200; ++k)
   {
      const int n = 2 + k % 14;
      const double scale = std::pow(10.0, 9 * (2 * uniform(random) - 1));
      ReducedProblem problem = random_problem(n, 3.0 * k / 199.0, 0.12, random);
      problem.K *= scale;
      for (LoadPattern &pattern : problem.patterns)
      {
         pattern.q *= scale;
         pattern.p *= scale;
      }
      ContactState states[3];
      for (int method = 0; method < 3; ++method)
      {
         FrictionSettings settings;
         if (method == 1) { settings.method = FrictionMethod::gauss_seidel; }
         FrictionSolver solver(problem, settings);
         ContactState &state = states[method];
         state = ContactState::virgin(problem);
         for (const Vector2d &loads : {Vector2d(1, 0), Vector2d(1, 0.7), Vector2d(1, -0.6)})
         {
            const VectorXd v_old = state.v;
            if (method == 2)
            {
               const auto found = solve_by_lemke(problem, state, loads);
               ASSERT_TRUE(found) << "problem " << k;
               state = *found;
            }
            else
            {
               const IncrementReport report = solver.solve(state, loads);
               ASSERT_EQ(report.status, FrictionStatus::converged)
                  << "problem " << k << " method " << method << ": " << report.message;
            }
            ContactState plain = state;
            plain.q /= scale;
            plain.p /= scale;
            ReducedProblem unit = problem;
            unit.K /= scale;
            for (LoadPattern &pattern : unit.patterns)
            {
               pattern.q /= scale;
               pattern.p /= scale;
            }
            EXPECT_LT(violation(unit, plain, v_old), 1e-10) << "problem " << k;
         }
      }
      for (int other : {1, 2})
      {
         const double size = 1e-9;
         EXPECT_LT((states[0].v - states[other].v).cwiseAbs().maxCoeff(), size)
            << "problem " << k;
         EXPECT_LT((states[0].w - states[other].w).cwiseAbs().maxCoeff(), size)
            << "problem " << k;
      }
   }
}

TEST(FrictionSolver, LemkeAloneAgreesWithActiveSet)
{
   FrictionSettings lemke_alone; // no sweeps, and Newton only to check what Lemke found
   lemke_alone.sweeps = 0;
   lemke_alone.max_newton = 1;
   std::mt19937 random(4);
   long pivots = 0;
   for (int k = 0; k < 300; ++k)
   {
      ReducedProblem problem = random_problem(2 + k % 29, 3.0 * k / 299, 0.2, random);
      if (k % 4 == 0) { problem.friction[k % problem.nodes()] = 0; }
      FrictionSolver solver(problem), lemke(problem, lemke_alone);
      ContactState state = ContactState::virgin(problem);
      for (const Vector2d &loads :
           {Vector2d(1, 0), Vector2d(1, 0.7), Vector2d(1, -0.6), Vector2d(0.1, 0.2)})
      {
         ContactState other = state;
         const VectorXd v_old = state.v;
         const IncrementReport report = lemke.solve(other, loads);
         ASSERT_EQ(report.status, FrictionStatus::converged) << "problem " << k;
         EXPECT_LT(violation(problem, other, v_old), 1e-10) << "problem " << k;
         ASSERT_EQ(solver.solve(state, loads).status, FrictionStatus::converged);
         EXPECT_LT((other.v - state.v).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
         EXPECT_LT((other.w - state.w).cwiseAbs().maxCoeff(), 1e-9) << "problem " << k;
      }
      pivots += lemke.counters().pivots;
   }
   EXPECT_GT(pivots, 10000);
}

/// One node on a slope that is nearly free to slide up it, `stiffness` against that.
ReducedProblem node_on_a_slope(double stiffness)
{
   ReducedProblem problem;
   const auto one = [](double x) { return Eigen::MatrixXd::Constant(1, 1, x); };
   problem.set_stiffness(one(1), one(-0.5), one(0.25 + stiffness));
   problem.patterns = {{"press", Control::force, VectorXd::Zero(1), VectorXd::Ones(1)}};
   problem.H = one(0);
   problem.gap = VectorXd::Zero(1);
   set_friction(problem, 0.1);
   return problem;
}

TEST(FrictionSolver, SaysWhenRoundOffHidesTheForces)
{
   const VectorXd pull = -VectorXd::Ones(1);
   ReducedProblem problem = node_on_a_slope(1e-6);
   ContactState state = ContactState::virgin(problem);
   EXPECT_EQ(FrictionSolver(problem).solve(state, pull).status, FrictionStatus::converged);
   EXPECT_NEAR(state.w[0], 1e6, 1e-3);
   problem = node_on_a_slope(1e-10);
   state = ContactState::virgin(problem);
   const IncrementReport report = FrictionSolver(problem).solve(state, pull);
   EXPECT_EQ(report.status, FrictionStatus::stalled);
   EXPECT_NE(report.message.find("lost in round-off"), std::string::npos) << report.message;
   EXPECT_EQ(state.w[0], 0);
}

TEST(FrictionSolver, AFreeNodeWithoutFrictionCarriesWhatPressesIt)
{
   ReducedProblem problem = node_on_a_slope(0);
   problem.gap[0] = -0.2;
   set_friction(problem, 0);
   ContactState state = ContactState::virgin(problem);
   EXPECT_EQ(FrictionSolver(problem).solve(state, VectorXd::Ones(1)).status,
             FrictionStatus::converged);
   EXPECT_NEAR(state.w[0], 0.2, 1e-15);
   EXPECT_NEAR(state.p[0], 1, 1e-12);
}

TEST(FrictionSolver, FrictionlessHasNoTangentialUnknownsAndNoShear)
{
   std::mt19937 random(3);
   const ReducedProblem problem = random_problem(9, 0.0, 0.2, random);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Vector2d(1, 0.4)).status, FrictionStatus::converged);
   EXPECT_EQ(solver.counters().tangential_unknowns, 0);
   EXPECT_TRUE(solver.frictionless());
   const VectorXd f = problem.clamped_forces(Vector2d(1, 0.4));
   const VectorXd q = problem.A() * state.v + problem.B().transpose() * state.w + f.head(9);
   const VectorXd p = problem.B() * state.v + problem.C() * state.w + f.tail(9);
   EXPECT_LT(q.cwiseAbs().maxCoeff(), 1e-13);
   EXPECT_LT((p - state.p).cwiseAbs().maxCoeff(), 1e-13);
   EXPECT_GE(state.p.minCoeff(), 0);
   EXPECT_GE((state.w + problem.gap).minCoeff(), -1e-15);
   // The limit of vanishing friction is the frictionless solution.
   ReducedProblem nearly = problem;
   set_friction(nearly, 1e-9);
   FrictionSolver other(nearly);
   ContactState close = ContactState::virgin(problem);
   ASSERT_EQ(other.solve(close, Vector2d(1, 0.4)).status, FrictionStatus::converged);
   EXPECT_LT((close.p - state.p).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(FrictionSolver, WithoutCouplingStuckNodesAreHeldWhereTheyWere)
{
   // Shear 2 at the first of three nodes in a row that bear 1 each, f = 1/2: it slips by
   // (1/2 - 2) / 2 = -3/4 and sheds 3/8 on the second, less than friction. The sweeps find
   // these states, so one active-set solve is the answer, and one more may confirm it.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix3d{{2, -0.5, 0}, {-0.5, 2, -0.5}, {0, -0.5, 2}},
                         Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity());
   problem.patterns = {{"load", Control::force, Vector3d(2, 0, 0), Vector3d(1, 1, 1)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Vector3d::Zero();
   set_friction(problem, 0.5);
   FrictionSolver solver(problem);
   ASSERT_FALSE(problem.coupled);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, VectorXd::Ones(1)).status, FrictionStatus::converged);
   EXPECT_LE((state.v - Vector3d(-0.75, 0, 0)).norm(), 1e-15);
   EXPECT_LE((state.q - Vector3d(0.5, 0.375, 0)).norm(), 1e-15);
   EXPECT_LE(solver.counters().newton_steps, 2);
   EXPECT_EQ(solver.counters().sweeps, FrictionSettings().sweeps);
}

TEST(FrictionSolver, AboveCriticalFrictionNamesTheNode)
{
   // One node, A = 1, B = 0.5: critical friction 2. Backward slip with f = 3: stick holds as
   // well as slip, the answer is not unique.
   const ReducedProblem problem = one_node(1, 0.5, 1, -0.2, 1, 3.0, 0);
   FrictionSolver solver(problem);
   EXPECT_DOUBLE_EQ(critical_friction(problem).node, 2.0);
   ContactState state = ContactState::virgin(problem);
   const IncrementReport report = solver.solve(state, VectorXd::Ones(1));
   EXPECT_EQ(report.status, FrictionStatus::not_unique);
   EXPECT_NE(report.message.find("node 0"), std::string::npos);
   ReducedProblem below = problem;
   set_friction(below, 1.9);
   FrictionSolver unique(below);
   ContactState other = ContactState::virgin(below);
   EXPECT_EQ(unique.solve(other, VectorXd::Ones(1)).status, FrictionStatus::converged);
}

TEST(FrictionSolver, OnlyClosedNodesAboveCriticalFrictionLeaveAChoice)
{
   // Two nodes apart, critical friction 2 each; the loads press one and pull at the other.
   ReducedProblem problem = free_nodes();
   const double p[][2] = {{1, -1}, {-1, 1}, {1, 1}, {-1, -1}};
   const double f[][2] = {{1, 3}, {3, 1}, {1, 2}, {2, 1}, {1.999, 1.999}, {3, 3}};
   for (const auto &pressed : p)
   {
      for (const auto &friction : f)
      {
         problem.patterns[0].p = Vector2d(pressed[0], pressed[1]);
         problem.friction = Vector2d(friction[0], friction[1]);
         FrictionSolver solver(problem);
         ContactState state = ContactState::virgin(problem), before = state;
         const IncrementReport report = solver.solve(state, VectorXd::Ones(1));
         int above = -1;
         for (int i : {1, 0})
         {
            if (pressed[i] > 0 && friction[i] >= 2) { above = i; }
         }
         for (const IncrementReport &verdict : {report, solver.judge(before, state)})
         {
            EXPECT_EQ(verdict.status,
                      above < 0 ? FrictionStatus::converged : FrictionStatus::not_unique);
            if (above < 0) { EXPECT_EQ(verdict.message, ""); }
            else
            {
               EXPECT_NE(verdict.message.find("at node " + std::to_string(above)),
                         std::string::npos)
                  << verdict.message;
            }
         }
      }
   }
}

TEST(FrictionSolver, ForcesAreComparedWithTheLargestSoFar)
{
   // By hand: the loads with the contact clamped, an interference or an initial slip times the
   // stiffness, and never less than before. A gap, however wide, is no force.
   const auto peak = [](double q, double p, double gap, double slip)
   {
      const ReducedProblem problem = one_node(2, 0, 3, q, p, 0.4, gap);
      ContactState state = ContactState::with_slip(problem, VectorXd::Constant(1, slip));
      EXPECT_EQ(FrictionSolver(problem).solve(state, VectorXd::Ones(1)).status,
                FrictionStatus::converged);
      return state.peak_force;
   };
   EXPECT_DOUBLE_EQ(peak(0.3, 1, 0, 0), 1);
   EXPECT_DOUBLE_EQ(peak(-2, 1, 0, 0), 2);
   EXPECT_DOUBLE_EQ(peak(0.3, 1, 100, 0), 1);
   EXPECT_DOUBLE_EQ(peak(0.3, 1, -0.5, 0), 1.5);
   EXPECT_DOUBLE_EQ(peak(0.3, 1, 0, -5), 10);
   EXPECT_DOUBLE_EQ(peak(0, 0, 0, 0), 0);

   // After unloading to a millionth what breaks the laws by 1e-13 of the peak is round-off.
   const ReducedProblem problem = one_node(2, 0, 3, 0.3, 1, 0.4, 0);
   FrictionSolver solver(problem);
   ContactState loaded = ContactState::virgin(problem), unloaded;
   solver.solve(loaded, VectorXd::Ones(1));
   unloaded = loaded;
   const IncrementReport report = solver.solve(unloaded, VectorXd::Constant(1, 1e-6));
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_EQ(unloaded.peak_force, 1);
   for (double spoilt : {1e-13, 1e-11})
   {
      ContactState other = unloaded;
      other.p[0] += spoilt;
      const IncrementReport normal = solver.judge(loaded, other);
      EXPECT_NEAR(normal.residual_normal, spoilt, 1e-16);
      EXPECT_LT(normal.residual_tangential, 1e-15);
      EXPECT_EQ(normal.status,
                spoilt < 1e-12 ? FrictionStatus::converged : FrictionStatus::stalled);
      other = unloaded;
      other.q[0] -= spoilt;
      const IncrementReport tangential = solver.judge(loaded, other);
      EXPECT_NEAR(tangential.residual_tangential, spoilt, 1e-16);
      EXPECT_LT(tangential.residual_normal, 1e-15);
      EXPECT_EQ(tangential.status, normal.status);
   }
}

TEST(FrictionSolver, OutcomesHaveNames)
{
   const std::vector<std::string> names = {
      name(FrictionStatus::converged), name(FrictionStatus::gross_sliding),
      name(FrictionStatus::not_unique), name(FrictionStatus::no_solution),
      name(FrictionStatus::stalled)};
   EXPECT_EQ(names, (std::vector<std::string>{"converged", "gross sliding", "not unique",
                                              "no solution", "stalled"}));
   const std::vector<std::string> states = {
      name(NodeState::stick), name(NodeState::separation), name(NodeState::forward_slip),
      name(NodeState::backward_slip), name(NodeState::slip)};
   EXPECT_EQ(states, (std::vector<std::string>{"stick", "separation", "forward slip",
                                               "backward slip", "slip"}));
}

TEST(FrictionSolver, RefusesBadSettings)
{
   FrictionSettings settings;
   settings.tolerance = 0;
   EXPECT_THROW(FrictionSolver(one_node(1, 0, 1, 0, 1, 0.3, 0), settings), InputError);
   settings = {};
   settings.max_newton = 0;
   EXPECT_THROW(FrictionSolver(one_node(1, 0, 1, 0, 1, 0.3, 0), settings), InputError);
}

/// Two equal nodes on a rigid free block: the only stiffness is against relative motion.
ReducedProblem free_block(double f)
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d{{1, -1}, {-1, 1}}, Eigen::Matrix2d::Zero(),
                         Eigen::Matrix2d{{1, -1}, {-1, 1}});
   problem.patterns = {
      {"press", Control::force, Vector2d(0, 0), Vector2d(0.5, 0.5)},
      {"shear", Control::force, Vector2d(0.8, 0.2), Vector2d(0, 0)},
      {"lift", Control::force, Vector2d(0, 0), Vector2d(-1, -1)},
   };
   problem.H = Eigen::Matrix3d::Zero();
   problem.gap = Vector2d(0, 0);
   set_friction(problem, f);
   return problem;
}

TEST(FrictionSolver, RefusesStatesAndLoadsThatAreNotOfItsProblem)
{
   const ReducedProblem problem = free_nodes();
   FrictionSolver solver(problem);
   const VectorXd load = VectorXd::Ones(1);
   const ContactState good = ContactState::virgin(problem),
                      other = ContactState::virgin(one_node(1, 0, 1, 0, 1, 1, 0));
   ContactState state = other;
   expect_input_error([&] { solver.solve(state, load); },
                      "contact state: it has 1 nodes and 1 load multipliers");
   expect_input_error([&] { solver.judge(good, other); }, "contact state: it has 1 nodes");
   expect_input_error([&] { solver.judge(other, good); }, "contact state: it has 1 nodes");
   state = good;
   expect_input_error([&] { solver.solve(state, VectorXd::Ones(2)); },
                      "2 load multipliers, must be one for each of the 1 load patterns");
   expect_input_error([&] { solver.solve(state, VectorXd::Constant(1, NAN)); },
                      "friction solver: the multiplier of load pattern 'load' is nan");
   EXPECT_EQ(solver.solve(state, load).status, FrictionStatus::converged);
   EXPECT_EQ(solver.judge(good, state).status, FrictionStatus::converged);
}

TEST(FrictionSolver, RefusesAProblemWithoutFrictionCoefficients)
{
   ReducedProblem problem = free_nodes();
   problem.friction.resize(0);
   expect_input_error([&] { FrictionSolver{problem}; }, "friction has 0 entries, must be 2");
}

TEST(FrictionSolver, ReportsSlidingAndLiftingApart)
{
   const ReducedProblem problem = free_block(0.4);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   EXPECT_EQ(solver.solve(state, Eigen::Vector3d(1, 0.399, 0)).status,
             FrictionStatus::converged);
   const ContactState before = state;
   EXPECT_EQ(solver.solve(state, Eigen::Vector3d(1, 0.401, 0)).status,
             FrictionStatus::gross_sliding);
   EXPECT_EQ(state.v, before.v); // left as it was
   const IncrementReport lifted = solver.solve(state, Eigen::Vector3d(1, 0, 0.6));
   EXPECT_EQ(lifted.status, FrictionStatus::no_solution);
   EXPECT_NE(lifted.message.find("lifts off"), std::string::npos);
}

TEST(Mechanism, FindsTheMotionThatTheLoadsDrive)
{
   const ReducedProblem problem = free_block(0.4);
   const Eigen::MatrixXd &Z = problem.rigid_motions;
   ASSERT_EQ(Z.cols(), 2);
   EXPECT_LT((problem.K * Z).cwiseAbs().maxCoeff(), 1e-15);
   EXPECT_FALSE(
      find_mechanism(problem, problem.clamped_forces(Eigen::Vector3d(1, 0.39, 0))).exists);
   const Mechanism sliding =
      find_mechanism(problem, problem.clamped_forces(Eigen::Vector3d(1, 0.41, 0)));
   EXPECT_TRUE(sliding.exists && sliding.slides);
   const Mechanism lifting =
      find_mechanism(problem, problem.clamped_forces(Eigen::Vector3d(0, 0, 1)));
   EXPECT_TRUE(lifting.exists && !lifting.slides);
}

TEST(Lemke, SolvesRandomProblemsAndReportsRays)
{
   std::mt19937 random(4);
   std::normal_distribution<double> normal;
   for (int k = 0; k < 100; ++k)
   {
      const int n = 1 + k % 20;
      const Eigen::MatrixXd R =
         Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
      const Eigen::MatrixXd skew = R - R.transpose();
      const Eigen::MatrixXd M = R * R.transpose() + skew; // positive definite, not symmetric
      const VectorXd b = VectorXd::NullaryExpr(n, [&] { return normal(random); });
      const LemkeReport report = lemke(M, b, VectorXd::Ones(n), 50 * n);
      ASSERT_TRUE(report.solved);
      const VectorXd s = M * report.z + b;
      EXPECT_GE(report.z.minCoeff(), 0);
      EXPECT_GE(s.minCoeff(), -1e-9);
      EXPECT_LT(std::abs(s.dot(report.z)), 1e-8);
   }
   // s = -z - 1 has no solution.
   EXPECT_FALSE(lemke(Eigen::MatrixXd::Constant(1, 1, -1), VectorXd::Constant(1, -1),
                      VectorXd::Ones(1), 50)
                   .solved);
}

TEST(Semidefinite, SolvesOnTheRangeAndFindsRigidMotions)
{
   const Eigen::Matrix3d A{{1, -1, 0}, {-1, 2, -1}, {0, -1, 1}};
   const Eigen::MatrixXd Z = null_space(A);
   const SemidefiniteSolver solver(A, Z);
   ASSERT_EQ(Z.cols(), 1);
   EXPECT_LT((Z - Eigen::Vector3d::Constant(Z(0, 0))).norm(), 1e-14);
   const Eigen::Vector3d b(1, 1, -2);
   EXPECT_LT((A * solver.solve(b) - b).norm(), 1e-14);
   // What pushes along the motion is left out; a motion that was not told shows.
   EXPECT_LT((A * solver.solve(b + A.diagonal()) - b).norm(), 1e-14);
   EXPECT_TRUE(solver.definite());
   EXPECT_FALSE(SemidefiniteSolver(A, Eigen::MatrixXd(3, 0)).definite());
}

/// Where friction has nothing to say a node is called by how it moves, else by what it bears.
TEST(ContactLaw, SolutionsAreCalledByTheStateTheyBreakLeast)
{
   ContactNode node{
      NodeVector::Constant(1, -1.0), NodeVector::Zero(1), 0, 0, 1, 1, FrictionBound(0.3)};
   for (NodeState state : {NodeState::forward_slip, NodeState::stick, NodeState::backward_slip})
   {
      EXPECT_EQ(fitting_state(node, state, 1e-12), NodeState::backward_slip);
   }
   EXPECT_EQ(fitting_state(node, NodeState::separation, 1e-12), NodeState::separation);
   node.p = 1;
   node.q[0] = -0.3;
   node.slip[0] = -1e-15; // round-off
   EXPECT_EQ(fitting_state(node, NodeState::forward_slip, 1e-12), NodeState::forward_slip);
   EXPECT_EQ(fitting_state(node, NodeState::stick, 1e-12), NodeState::stick);
   node.slip[0] = 0.1;
   EXPECT_EQ(fitting_state(node, NodeState::stick, 1e-12), NodeState::forward_slip);
   // In the disc: a slip that friction opposes, at its bound.
   ContactNode disc{Eigen::Vector2d(3, 4), Eigen::Vector2d(-0.3, -0.4), 0, 1, 1, 1,
                    FrictionBound(0.5)};
   EXPECT_EQ(fitting_state(disc, NodeState::stick, 1e-12), NodeState::slip);
   disc.slip.setZero();
   EXPECT_EQ(fitting_state(disc, NodeState::slip, 1e-12), NodeState::slip);
}

// Residuals are shares of the largest force, in whatever units forces are.
TEST(FrictionSolver, ResidualsAreRelative)
{
   std::mt19937 random(31);
   const ReducedProblem problem = random_problem(20, 0.3, 0.2, random);
   IncrementReport reports[2];
   for (int k : {0, 1})
   {
      const double unit = k ? std::ldexp(1.0, 40) : 1;
      ReducedProblem scaled = problem;
      scaled.K *= unit;
      for (LoadPattern &pattern : scaled.patterns)
      {
         pattern.q *= unit;
         pattern.p *= unit;
      }
      scaled.H *= unit;
      ContactState state = ContactState::virgin(scaled);
      FrictionSolver solver(scaled);
      reports[k] = solver.solve(state, Eigen::Vector2d(1, 0.2));
      EXPECT_EQ(reports[k].status, FrictionStatus::converged);
      EXPECT_GT(std::max(reports[k].residual_normal, reports[k].residual_tangential), 0);
   }
   EXPECT_EQ(reports[1].residual_normal, reports[0].residual_normal);
   EXPECT_EQ(reports[1].residual_tangential, reports[0].residual_tangential);
   EXPECT_EQ(reports[1].round_off, reports[0].round_off);
}

} // namespace
