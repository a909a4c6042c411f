#include "common/lap_joint_scene.hpp"

#include <cattaneo/friction/friction_solver.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;

TEST(LapJoint, ContactIsUncoupledWhereItTouches)
{
   miniapp::LapJointOptions options;
   options.spacing = 0.025;
   miniapp::Scene joint = miniapp::make_lap_joint(options);
   ReducedProblem &problem = joint.reduction.problem;
   set_friction(problem, 0.2);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(1, 0)).status, FrictionStatus::converged);
   // The S shape of the overlap couples slip and opening at its free ends. With the separated
   // nodes released, what is left between the nodes in contact couples no more.
   const Eigen::Index n = problem.nodes();
   std::vector<Eigen::Index> in, free;
   for (int half = 0; half < 2; ++half)
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         (closed(state.status[i]) ? in : free).push_back(half * n + i);
      }
   }
   const Eigen::MatrixXd K = problem.K;
   const Eigen::MatrixXd S = K(in, in) - K(in, free) * K(free, free).ldlt().solve(K(free, in));
   const Eigen::Index m = S.rows() / 2;
   EXPECT_LT(S.bottomLeftCorner(m, m).cwiseAbs().maxCoeff(), 1e-7 * S.cwiseAbs().maxCoeff());
   EXPECT_LT(state.q.cwiseAbs().maxCoeff(), 1e-7 * state.p.maxCoeff());
}

TEST(LapJoint, ZonesDoNotDependOnTheLoadLevel)
{
   miniapp::LapJointOptions options;
   options.spacing = 0.025;
   miniapp::Scene joint = miniapp::make_lap_joint(options);
   set_friction(joint.reduction.problem, 0.2);
   FrictionSolver solver(joint.reduction.problem);
   ContactState low = ContactState::virgin(joint.reduction.problem), high = low;
   ASSERT_EQ(solver.solve(low, Eigen::Vector2d(1e-6, 0)).status, FrictionStatus::converged);
   ASSERT_EQ(solver.solve(high, Eigen::Vector2d(1e6, 0)).status, FrictionStatus::converged);
   EXPECT_EQ(low.status, high.status);
   EXPECT_LT((1e12 * low.p - high.p).cwiseAbs().maxCoeff(), 1e-9 * high.p.maxCoeff());
}

} // namespace
