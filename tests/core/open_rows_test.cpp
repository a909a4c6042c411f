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

} // namespace
