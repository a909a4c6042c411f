#include "disc_problems.hpp"

#include <cattaneo/friction/friction_disc.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cstdio>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::random_disc_problem;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Largest violation of the laws of contact and friction, in plain words from v and w alone:
/// no penetration, no tension, |q| <= f p, and power q·Δv = -f p |Δv| of friction.
double violation(const ReducedProblem &problem, const ContactState &state,
                 const VectorXd &v_old)
{
   const VectorXd f = problem.clamped_forces(state.multipliers);
   const Index n = problem.nodes();
   const VectorXd q = problem.A * state.v + problem.B.transpose() * state.w + f.head(2 * n);
   const VectorXd p = problem.B * state.v + problem.C * state.w + f.tail(n);
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
      DiscNode node;
      node.A << 1 + uniform(random) / 2, 0, 0, 1 + uniform(random) / 2;
      node.A(0, 1) = node.A(1, 0) = 0.3 * uniform(random);
      node.b << 0.2 * uniform(random), 0.2 * uniform(random);
      node.c = 1.5;
      node.friction = 1 + uniform(random);
      node.q0 << uniform(random), uniform(random);
      node.p0 = uniform(random);
      if (node.friction >= critical_friction(node.A, node.b)) { continue; }
      const DiscMove move = solve_node(node);
      ASSERT_TRUE(move.found);
      const Vector2d q = node.q0 + node.A * move.slip + node.b * move.gap;
      const double p = node.p0 + node.b.dot(move.slip) + node.c * move.gap;
      const double fp = node.friction * p;
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
            EXPECT_LT(violation(problem, state, v_old), 1e-10) << "problem " << k;
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

} // namespace
