#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace
{

using cattaneo::InputError;
using cattaneo::ReducedProblem;

ReducedProblem two_nodes()
{
   ReducedProblem problem;
   problem.A = Eigen::Matrix2d{{4, -1}, {-1, 4}};
   problem.B = Eigen::Matrix2d{{0.5, 0.1}, {-0.2, 0.3}};
   problem.C = Eigen::Matrix2d{{5, -1}, {-1, 5}};
   problem.patterns = {
      {"press", cattaneo::Control::force, Eigen::Vector2d(0.1, -0.1), Eigen::Vector2d(1, 1)}};
   problem.H = Eigen::MatrixXd::Zero(1, 1);
   problem.gap = Eigen::Vector2d(0.0, 0.01);
   problem.friction = Eigen::Vector2d(0.3, 0.3);
   return problem;
}

TEST(ReducedProblem, ValidatesWhatIsSound)
{
   EXPECT_NO_THROW(two_nodes().validate());
}

TEST(ReducedProblem, RefusesBadInput)
{
   ReducedProblem problem = two_nodes();
   problem.friction[1] = -0.1;
   EXPECT_THROW(problem.validate(), InputError);
   problem = two_nodes();
   problem.C(0, 1) = 3;
   EXPECT_THROW(problem.validate(), InputError);
   problem = two_nodes();
   problem.gap[0] = std::numeric_limits<double>::quiet_NaN();
   EXPECT_THROW(problem.validate(), InputError);
   problem = two_nodes();
   problem.patterns[0].p.resize(3);
   EXPECT_THROW(problem.validate(), InputError);
   EXPECT_THROW(two_nodes().pattern("pull"), InputError);
   EXPECT_THROW(set_friction(problem, std::numeric_limits<double>::quiet_NaN()), InputError);
}

TEST(ReducedProblem, BothGapFormulationsGiveTheSameForces)
{
   const ReducedProblem problem = two_nodes();
   const ReducedProblem closed = absorb_gap(problem);
   Eigen::Vector4d u(0.2, -0.1, 0.03, 0.04);
   Eigen::Vector4d u_star = u;
   u_star.tail(2) += problem.gap;
   const Eigen::Vector4d f =
      problem.stiffness() * u + problem.clamped_forces(Eigen::VectorXd::Constant(1, 2.0));
   const Eigen::Vector4d f_star =
      closed.stiffness() * u_star + closed.clamped_forces(Eigen::Vector2d(2.0, 1.0));
   EXPECT_LT((f - f_star).norm(), 1e-15);
}

} // namespace
