#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

namespace
{

using namespace cattaneo;
using namespace shakedown_test;

/// Three nodes in a row with the stuck forces P: p = (2, 1, 2), q = (-0.2, 0, 0.2) and
/// Q: p = (0.5, 0, -0.5), q = (1, 1, 1); transfer M = B A⁻¹ with A the identity.
ReducedProblem three_nodes(const Eigen::Matrix3d &M = Eigen::Matrix3d::Zero())
{
   ReducedProblem problem;
   problem.A = Eigen::Matrix3d::Identity();
   problem.B = M;
   problem.C = 4 * Eigen::Matrix3d::Identity();
   problem.patterns = {
      {"P", Control::force, Eigen::Vector3d(-0.2, 0, 0.2), Eigen::Vector3d(2, 1, 2)},
      {"Q", Control::force, Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0.5, 0, -0.5)}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector3d::Zero();
   set_friction(problem, 0.4);
   return problem;
}

TEST(Monolith, RatiosAndTheirLargestByHand)
{
   const ReducedProblem problem = three_nodes();
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", 0);
   const Eigen::VectorXd ratio = traction_ratio(problem, Eigen::Vector2d(1, 1));
   EXPECT_NEAR(ratio[0], 0.8 / 2.5, 1e-15);
   EXPECT_NEAR(ratio[1], 1.0, 1e-15);
   EXPECT_NEAR(ratio[2], 1.2 / 1.5, 1e-15);
   EXPECT_LT(traction_ratio(problem, Eigen::Vector2d(1, -1))[0], 0);
   EXPECT_TRUE(std::isinf(traction_ratio(problem, Eigen::Vector2d(1, 5))[2]));

   const auto map = adhesion_map(problem, cycle, 0, {0, 0.05, 0.5});
   EXPECT_NEAR(map[0].friction, 0.1, 1e-15);
   EXPECT_EQ(map[1].node, 2);
   EXPECT_NEAR(map[1].friction, 0.25 / 1.975, 1e-15);
   EXPECT_EQ(map[2].node, 1);
   EXPECT_NEAR(map[2].friction, 0.5, 1e-15);
   EXPECT_EQ(adhesion_map(problem, cycle, 0, {0.5}, {0, 2})[0].node, 2);

   const Incipience open = incipient_separation(problem, cycle, 0);
   EXPECT_NEAR(open.load_factor, 4, 1e-14);
   EXPECT_EQ(open.node, 2);
   EXPECT_TRUE(std::isinf(incipient_separation(problem, cycle, 0, {0, 1}).load_factor));
   const Incipience slip = incipient_slip(problem, cycle, 0);
   EXPECT_NEAR(slip.load_factor, 0.4, 1e-14);
   EXPECT_EQ(slip.node, 1);
   // Node 2: 0.2 + λ = 0.4 (2 - 0.5 λ); node 0: λ - 0.2 = 0.4 (2 + 0.5 λ).
   EXPECT_NEAR(incipient_slip(problem, cycle, 0, {2}).load_factor, 0.5, 1e-14);
   EXPECT_NEAR(incipient_slip(problem, cycle, 0, {0}).load_factor, 1.25, 1e-14);
   EXPECT_THROW(incipient_slip(problem, cycle, 2), InputError);
   EXPECT_THROW(adhesion_map(problem, cycle, 0, {1}, {3}), InputError);
}

TEST(Method1, ByHand)
{
   const ReducedProblem problem = three_nodes();
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", -0.5);
   // At λ = 1 each |q_a - q_b| is 1.5; p_a + p_b = 4.25, 2, 3.75.
   const PointwiseEstimate friction = method1_friction(problem, cycle, 1);
   EXPECT_NEAR(friction.value, 0.75, 1e-15);
   EXPECT_EQ(friction.node, 1);
   const PointwiseEstimate load = method1_load(problem, cycle);
   EXPECT_EQ(load.node, 1);
   EXPECT_NEAR(load.value, 0.4 * 2 / 1.5, 1e-14);
}

TEST(Method2, IsMethod1WithoutCoupling)
{
   const ReducedProblem problem = three_nodes();
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
   const Method2Estimate estimate = method2_friction(limit, 1);
   ASSERT_TRUE(estimate.exists);
   for (const double f : {estimate.low, estimate.natural, estimate.high})
   {
      EXPECT_NEAR(f, 0.75, 1e-12);
   }
}

TEST(Method2, RangeByHand)
{
   // Only the residual shear of node 0 changes a pressure, that of node 1, by 0.5 of it.
   // Without a rigid motion r_0 is free in its permissible range at f = 0.75: max_j(-f p_j -
   // q_j) = max(-2.675, -0.6125), min_j(f p_j - q_j) = min(1.075, 2.0125).
   Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
   M(1, 0) = 0.5;
   const ReducedProblem problem = three_nodes(M);
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
   const Method2Estimate estimate = method2_friction(limit, 1);
   ASSERT_TRUE(estimate.exists);
   EXPECT_NEAR(estimate.residual_low[0], -0.6125, 1e-14);
   EXPECT_NEAR(estimate.residual_high[0], 1.075, 1e-14);
   EXPECT_NEAR(estimate.high, 1.5 / (2 - 0.6125), 1e-12);
   EXPECT_NEAR(estimate.low, 1.5 / (2 + 1.075), 1e-6);
   EXPECT_NEAR(estimate.natural, 1.5 / (2 + 0.5 * (1.075 - 0.6125)), 1e-12);
}

TEST(Method2, KeepsTheResultantZero)
{
   const ReducedProblem problem = punch_like(33);
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
   const Method2Estimate estimate = method2_friction(limit, 0.6);
   ASSERT_TRUE(estimate.exists) << estimate.message;
   EXPECT_NEAR(estimate.natural_residual.sum(), 0, 1e-14);
   EXPECT_LT(estimate.low, estimate.natural);
   EXPECT_LT(estimate.natural, estimate.high);
   // No choice that is drawn at random and balanced goes beyond the range.
   const StuckForces forces = stuck_forces(problem, limit.cycle);
   const Eigen::VectorXd q = forces.q(0.6).col(0) - forces.q(0.6).col(1);
   const Eigen::VectorXd p = forces.p(0.6).rowwise().sum();
   std::mt19937 random(1);
   for (int k = 0; k < 200; ++k)
   {
      Eigen::VectorXd r = estimate.residual_low +
                          (0.5 + 0.5 * random_matrix(random, 33, 1).array())
                             .matrix()
                             .cwiseProduct(estimate.residual_high - estimate.residual_low);
      // Towards the end that restores the balance.
      const Eigen::VectorXd end = r.sum() > 0 ? estimate.residual_low : estimate.residual_high;
      r += (end - r) * (-r.sum() / (end - r).sum());
      ASSERT_NEAR(r.sum(), 0, 1e-13);
      const Eigen::VectorXd change = problem.B * (limit.residual.flexibility * r);
      const double f = q.cwiseAbs().cwiseQuotient(p + 2 * change).maxCoeff();
      EXPECT_GE(f, estimate.low * (1 - 1e-6));
      EXPECT_LE(f, estimate.high * (1 + 1e-12));
   }
}

TEST(Coupling, IsDundursParameterOfTwoHalfPlanes)
{
   // On a periodic line the operators are |k| for slip and opening, β i k between them.
   for (const Eigen::Index n : {9, 33})
   {
      ReducedProblem problem = random_contact(1, n, 1, false);
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), B = A;
      for (Eigen::Index k = 1; k <= n / 2; ++k)
      {
         const Eigen::ArrayXd phase =
            Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) * 2 * M_PI *
            static_cast<double>(k) / static_cast<double>(n);
         const Eigen::VectorXd c = phase.cos(), s = phase.sin();
         A += static_cast<double>(k) * (c * c.transpose() + s * s.transpose());
         B += 0.2 * static_cast<double>(k) * (c * s.transpose() - s * c.transpose());
      }
      problem.A = problem.C = A;
      problem.B = B;
      EXPECT_NEAR(degree_of_coupling(problem), 0.2, 1e-12);
   }
}

TEST(Coupling, DoesNotDependOnUnitsOrOnTheBasis)
{
   const ReducedProblem problem = random_contact(5, 7, 2, false);
   const double coupling = degree_of_coupling(problem);
   EXPECT_GT(coupling, 0.1);
   EXPECT_LT(coupling, 1);
   std::mt19937 random(2);
   const Eigen::MatrixXd S = random_matrix(random, 14, 14), T = random_matrix(random, 7, 7);
   ReducedProblem other = problem;
   other.A = 1e9 * S.transpose() * problem.A * S;
   other.B = 1e9 * T.transpose() * problem.B * S;
   other.C = 1e9 * T.transpose() * problem.C * T;
   EXPECT_NEAR(degree_of_coupling(other), coupling, 1e-9);
   other.B.setZero();
   EXPECT_EQ(degree_of_coupling(other), 0);
}

TEST(ClosedContact, ForcesAreThoseOfTheWholeContactWithOpenNodes)
{
   ReducedProblem problem = random_contact(9, 6, 2, false);
   problem.gap[2] = 0.1;
   const std::vector<Eigen::Index> closed = {0, 1, 4};
   const ClosedContact contact = closed_contact(problem, closed);
   EXPECT_EQ(contact.open, (std::vector<Eigen::Index>{2, 3, 5}));
   EXPECT_NO_THROW(contact.reduced.validate());

   // The whole contact: open nodes move until they carry nothing.
   std::mt19937 random(3);
   const Eigen::VectorXd slip = random_matrix(random, 6, 1),
                         loads = random_matrix(random, 3, 1);
   Eigen::VectorXd u = Eigen::VectorXd::Zero(18);
   const std::vector<Eigen::Index> closed_v = {0, 1, 4, 6, 7, 10},
                                   open_u = {2, 3, 5, 8, 9, 11, 14, 15, 17};
   u(closed_v) = slip;
   const Eigen::MatrixXd K = problem.stiffness();
   const Eigen::VectorXd clamped = K * u + problem.clamped_forces(loads);
   u(open_u) = -Eigen::FullPivLU<Eigen::MatrixXd>(K(open_u, open_u))
                   .solve(Eigen::VectorXd(clamped(open_u)));
   const Eigen::VectorXd f = K * u + problem.clamped_forces(loads);
   EXPECT_LT(f(open_u).norm(), 1e-12);

   const ReducedProblem &reduced = contact.reduced;
   const Eigen::VectorXd own = reduced.clamped_forces(loads);
   const std::vector<Eigen::Index> closed_w = {12, 13, 16};
   EXPECT_LT((reduced.A * slip + own.head(6) - f(closed_v)).norm(), 1e-12);
   EXPECT_LT((reduced.B * slip + own.tail(3) - f(closed_w)).norm(), 1e-12);
   const Eigen::VectorXd gaps = contact.open_gaps(slip, loads);
   EXPECT_NEAR(gaps[0], u[14] + 0.1, 1e-12);
   EXPECT_NEAR(gaps[2], u[17], 1e-12);

   EXPECT_THROW(closed_contact(problem, {2}), InputError);
   EXPECT_THROW(closed_contact(problem, {0, 0}), InputError);
   EXPECT_THROW(closed_contact(problem, {7}), InputError);
   EXPECT_THROW(closed_contact(problem, {}), InputError);
}

} // namespace
