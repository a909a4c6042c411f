#include "contact_laws.hpp"

#include <algorithm>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/open_rows.hpp>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Displacements with closed rows at u and no force on the open ones, from all of K.
VectorXd without_forces(const MatrixXd &K, const std::vector<RowState> &states,
                        const VectorXd &f, VectorXd u)
{
   std::vector<Index> open;
   for (std::size_t i = 0; i < states.size(); ++i)
   {
      if (states[i] == RowState::open) { open.push_back(static_cast<Index>(i)); }
   }
   const VectorXd forces = f + K * u;
   u(open) -= K(open, open).eval().llt().solve(forces(open).eval());
   return u;
}

TEST(OpenRows, BordersGiveWhatAWholeEliminationGives)
{
   std::mt19937 random(1);
   std::normal_distribution<double> normal;
   constexpr Index N = 120;
   const MatrixXd R = MatrixXd::NullaryExpr(N, N, [&] { return normal(random); });
   const MatrixXd K = MatrixXd::Identity(N, N) + R * R.transpose() / N;
   for (const RowState first : {RowState::open, RowState::closed})
   {
      std::vector<RowState> states(N, first);
      states[7] = RowState::absent;
      OpenRows rows;
      Counters counters;
      bool bordered = false;
      for (int step = 0; step < 60; ++step)
      {
         // 1. Up to three rows change. Rows 0 and 1 stay closed.
         for (int k = 0; k < step % 4; ++k)
         {
            RowState &state = states[8 + random() % (N - 8)];
            state = state == RowState::open ? RowState::closed : RowState::open;
         }
         states[0] = states[1] = RowState::closed;
         ASSERT_TRUE(rows.eliminate(K, states, false, counters));
         bordered = bordered || rows.bordered();
         // 2. Row 7 is not in the equations and stays at rest.
         VectorXd f = VectorXd::NullaryExpr(N, [&] { return normal(random); });
         VectorXd start = VectorXd::NullaryExpr(N, [&] { return normal(random); });
         const OpenRows::Origin origin = rows.origin(f + K * start);
         const std::vector<Index> moved{0, 1};
         const VectorXd x = Eigen::Vector2d(0.3, -0.2);
         VectorXd u = start;
         u(moved) += x;
         rows.follow(origin, moved, x, u);
         // 3. Displacements, and forces before and after the two rows move.
         VectorXd expected_start = without_forces(K, states, f, start), begin = start;
         begin(moved) += x;
         const VectorXd expected = without_forces(K, states, f, begin);
         EXPECT_LE((u - expected).cwiseAbs().maxCoeff(), 1e-11);
         const VectorXd at_start = f + K * expected_start, at_end = f + K * expected;
         const VectorXd by_x = rows.stiffness(moved, moved) * x;
         for (Index i = 0; i < N; ++i)
         {
            if (states[i] != RowState::closed) { continue; }
            EXPECT_NEAR(origin.forces[i], at_start[i], 1e-11);
         }
         for (const Index i : moved) { EXPECT_NEAR(by_x[i], at_end[i] - at_start[i], 1e-11); }
      }
      EXPECT_TRUE(bordered);
      EXPECT_LT(counters.dense_factorisations, 20);
   }
}

/// Differences along one direction of a grid of m × m nodes, one row for each pair.
MatrixXd differences(Index m, bool along_x)
{
   MatrixXd D = MatrixXd::Zero(m * (m - 1), m * m);
   for (Index j = 0, row = 0; j < m; ++j)
   {
      for (Index i = 0; i + 1 < m; ++i, ++row)
      {
         D(row, along_x ? j * m + i : i * m + j) = -1;
         D(row, along_x ? j * m + i + 1 : (i + 1) * m + j) = 1;
      }
   }
   return D;
}

/// A thin plate of m × m nodes on a crown: it bends, and its lower face moves along the surface
/// where it turns. Soft springs hold it.
ReducedProblem plate_on_a_crown(Index m, double stretching, double soft)
{
   const Index n = m * m;
   const MatrixXd Dx = differences(m, true), Dy = differences(m, false);
   const MatrixXd laplace = Dx.transpose() * Dx + Dy.transpose() * Dy;
   MatrixXd A = MatrixXd::Zero(2 * n, 2 * n), turns = MatrixXd::Zero(2 * n, n);
   A.topLeftCorner(n, n) = A.bottomRightCorner(n, n) =
      stretching * (laplace + soft * MatrixXd::Identity(n, n));
   // Mean slopes at the nodes.
   for (Index k = 0; k < n; ++k)
   {
      turns.row(k) = 0.5 * Dx.cwiseAbs().col(k).transpose() * Dx;
      turns.row(n + k) = 0.5 * Dy.cwiseAbs().col(k).transpose() * Dy;
   }
   const MatrixXd C = laplace * laplace + soft * soft * MatrixXd::Identity(n, n);
   ReducedProblem problem;
   const MatrixXd AT = A * turns;
   problem.set_stiffness(A, AT.transpose(), C + turns.transpose() * AT);
   problem.gap.resize(n);
   for (Index i = 0; i < m; ++i)
   {
      for (Index j = 0; j < m; ++j)
      {
         problem.gap[j * m + i] = static_cast<double>(i * i + j * j) / static_cast<double>(n);
      }
   }
   problem.friction = VectorXd::Constant(n, 0.3);
   problem.rigid_motions.resize(3 * n, 0);
   problem.patterns.push_back({"P", Control::force, VectorXd::Zero(2 * n), VectorXd::Ones(n)});
   return problem;
}

/// Contact of all nodes, from which it recedes step by step. The whole increment is one attempt
/// of Newton's steps, and fewer than one of two steps eliminates all open nodes anew.
TEST(OpenRows, AThinPlateLaysItselfDownWithFewEliminations)
{
   const ReducedProblem problem = plate_on_a_crown(18, 500, 1e-2);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   cattaneo_test::LawChecker laws(problem, state);
   const VectorXd unmoved = state.v;
   const IncrementReport report = solver.solve(state, VectorXd::Constant(1, 3e-4));
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_LE(laws.violation(unmoved, state), 1) << laws.what();
   EXPECT_STREQ(report.found_by, "active set");
   const auto open =
      std::count(state.status.begin(), state.status.end(), NodeState::separation);
   EXPECT_GT(open, 200);
   EXPECT_LT(open, 300);
   EXPECT_LE(solver.counters().newton_steps, 24);
   EXPECT_LE(solver.counters().dense_factorisations, 18);
   EXPECT_GT(solver.counters().dense_updates, 1000);
}

} // namespace
