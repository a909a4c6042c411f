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
   problem.set_stiffness(Eigen::Matrix3d::Identity(), M, 4 * Eigen::Matrix3d::Identity());
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
   // Sheared backwards: -0.7/1.75, -0.5/1, -0.3/2.25.
   const LoadCycle reversed = held_and_cycled(problem, "P", 1, "Q", -1);
   EXPECT_NEAR(adhesion_map(problem, reversed, 1, {0.5})[0].friction, 0.5, 1e-15);
   EXPECT_EQ(adhesion_map(problem, reversed, 1, {0.5})[0].node, 1);

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

/// Nodes apart from each other, f = ½, with constant forces {q, p} under "P" and {dq, dp} for
/// each unit of "Q".
ReducedProblem nodes_apart(const Eigen::MatrixXd &forces)
{
   const Eigen::Index n = forces.rows();
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                         Eigen::MatrixXd::Identity(n, n));
   problem.patterns = {{"P", Control::force, forces.col(0), forces.col(1)},
                       {"Q", Control::force, forces.col(2), forces.col(3)}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::VectorXd::Zero(n);
   set_friction(problem, 0.5);
   return problem;
}

TEST(Monolith, APlaneOfSymmetryAndAClosedLineAreNoEndsToKeepAwayFrom)
{
   ReducedProblem whole = three_nodes(), half = three_nodes();
   EXPECT_THROW(nodes_away_from_ends(whole, 0.1), InputError); // no arc length
   whole.arc_length = Eigen::Vector3d(0, 1, 2);
   EXPECT_EQ(nodes_away_from_ends(whole, 0.3), NodeList{1});
   EXPECT_EQ(nodes_away_from_ends(whole, 0), (NodeList{0, 1, 2}));
   // The halves of a line from -2 to 2, of which a quarter is 1.
   half.arc_length = whole.arc_length;
   half.chains = one_chain(3);
   half.chains[0].ends[0] = LineEnd::symmetry;
   EXPECT_EQ(nodes_away_from_ends(half, 0.25), (NodeList{0, 1}));
   EXPECT_EQ(nodes_away_from_ends(half, 0.26), NodeList{0});
   half.chains[0].ends = {LineEnd::corner, LineEnd::symmetry};
   EXPECT_EQ(nodes_away_from_ends(half, 0.25), (NodeList{1, 2}));
   half.chains[0].loop = true;
   EXPECT_EQ(nodes_away_from_ends(half, 0.4), (NodeList{0, 1, 2}));
}

TEST(Monolith, FirstEventsOfEveryKindByHand)
{
   // q, p, dq, dp: |q + λ dq| = (p + λ dp)/2, whichever way each of them goes.
   Eigen::MatrixXd forces(9, 4);
   forces << 0, 1, 0.1, -1, // 0.1 λ = 0.5 - 0.5 λ
      0, 1, 0.5, -1,        // 0.5 λ = 0.5 - 0.5 λ
      0, 1, 0.5, 1,         // never
      0.3, 1, 0.4, 1,       // never
      -0.3, 1, 1, 0,        // λ - 0.3 = 0.5
      0.3, 1, 1, 0,         // λ + 0.3 = 0.5
      0.6, 1, -1, 0,        // from the start
      0, -1, 0, 1,          // in tension from the start
      0.1, 2, 0, -4;        // 0.1 = 1 - 2 λ
   const double never = std::numeric_limits<double>::infinity();
   const double slips[] = {0.5 / 0.6, 0.5, never, never, 0.8, 0.2, 0, 0, 0.45};
   const double opens[] = {1, 1, never, never, never, never, never, 0, 0.5};
   const ReducedProblem problem = nodes_apart(forces);
   // The second vertex has three times the varying load, the third its opposite.
   LoadCycle cycle{Eigen::Vector2d(1, 0), Eigen::MatrixXd::Zero(2, 3)};
   cycle.varying.row(1) << 1, 3, -1;
   for (Eigen::Index i = 0; i < 9; ++i)
   {
      for (int vertex : {0, 1})
      {
         const Incipience slip = incipient_slip(problem, cycle, vertex, {i}),
                          open = incipient_separation(problem, cycle, vertex, {i});
         const double share = vertex == 0 ? 1 : 3;
         if (std::isinf(slips[i])) { EXPECT_TRUE(std::isinf(slip.load_factor)) << i; }
         else { EXPECT_NEAR(slip.load_factor, slips[i] / share, 1e-15) << i; }
         EXPECT_EQ(slip.node, std::isinf(slips[i]) ? -1 : i);
         if (std::isinf(opens[i])) { EXPECT_TRUE(std::isinf(open.load_factor)) << i; }
         else { EXPECT_NEAR(open.load_factor, opens[i] / share, 1e-15) << i; }
         EXPECT_EQ(open.node, std::isinf(opens[i]) ? -1 : i);
      }
   }
   EXPECT_NEAR(incipient_slip(problem, cycle, 2, {4}).load_factor, 0.2, 1e-15);
   EXPECT_NEAR(incipient_slip(problem, cycle, 2, {5}).load_factor, 0.8, 1e-15);
   EXPECT_EQ(incipient_slip(problem, cycle, 0, {5, 8, 1}).node, 5);
   EXPECT_EQ(incipient_separation(problem, cycle, 0, {5, 0, 8, 1}).node, 8);
   EXPECT_THROW(incipient_separation(problem, cycle, -1), InputError);
   EXPECT_THROW(adhesion_map(problem, cycle, 3, {1}), InputError);

   // In the disc |(0.3, λ)| = (1 ∓ λ/2)/2: 0.9375 λ² ± 0.25 λ - 0.16 = 0.
   ReducedProblem disc = nodes_apart(Eigen::RowVector4d(0.3, 1, 0, -0.5));
   disc.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Zero(1, 2), disc.C());
   disc.patterns[0].q = Eigen::Vector2d(0.3, 0);
   disc.patterns[1].q = Eigen::Vector2d(0, 1);
   const double root = std::sqrt(0.0625 + 0.6);
   EXPECT_NEAR(incipient_slip(disc, cycle, 0).load_factor, (root - 0.25) / 1.875, 1e-15);
   EXPECT_NEAR(incipient_slip(disc, cycle, 2).load_factor, (root + 0.25) / 1.875, 1e-15);
   EXPECT_NEAR(incipient_separation(disc, cycle, 0).load_factor, 2, 1e-15);
   EXPECT_NEAR(traction_ratio(disc, Eigen::Vector2d(1, 0.4))[0], 0.5 / 0.8, 1e-15);
   EXPECT_TRUE(std::isinf(traction_ratio(disc, Eigen::Vector2d(1, 2))[0]));
   EXPECT_NEAR(adhesion_map(disc, cycle, 2, {0.4})[0].friction, 0.5 / 1.2, 1e-15);
}

TEST(LoadCycles, MultipliersAndStuckForcesByHand)
{
   const ReducedProblem problem = nodes_apart(Eigen::RowVector4d(0.3, 2, 4, -0.5));
   const LoadCycle cycle = held_and_cycled(problem, "P", 3, "Q", -0.25);
   EXPECT_EQ(cycle.multipliers(2), (Eigen::Matrix2d{{3, 3}, {2, -0.5}}));
   const StuckForces forces = stuck_forces(problem, cycle);
   EXPECT_EQ(forces.vertices(), 2);
   EXPECT_EQ(forces.q0(0, 1), 3 * 0.3);
   EXPECT_EQ(forces.p0(0, 0), 3 * 2);
   EXPECT_EQ(forces.q1(0, 1), 4 * -0.25);
   EXPECT_EQ(forces.p1(0, 1), -0.5 * -0.25);
   EXPECT_DOUBLE_EQ(forces.q(2)(0, 1), 0.9 - 2);
   EXPECT_DOUBLE_EQ(forces.p(2)(0, 0), 6 - 1);
   EXPECT_NO_THROW(held_and_cycled(problem, "P", 1, "Q", -1));
   EXPECT_NO_THROW(held_and_cycled(problem, "P", 1, "Q", 1));
   EXPECT_THROW(held_and_cycled(problem, "P", 1, "Q", -1.01), InputError);
   const auto refused = [&](auto spoil)
   {
      LoadCycle bad = cycle;
      spoil(bad);
      EXPECT_THROW(bad.validate(problem), InputError);
   };
   refused([](LoadCycle &c) { c.constant = Eigen::VectorXd::Zero(1); });
   refused([](LoadCycle &c) { c.varying = Eigen::MatrixXd::Zero(3, 2); });
   refused([](LoadCycle &c) { c.varying = Eigen::MatrixXd::Zero(2, 0); });
   refused([](LoadCycle &c) { c.constant[1] = NAN; });
   refused([](LoadCycle &c) { c.varying(1, 1) = INFINITY; });
}

TEST(Method1, SaysAtWhichNodeAndWhenThereIsNone)
{
   const ReducedProblem problem = three_nodes();
   // Between the second and the third of three vertices the shear changes by 1.5.
   LoadCycle cycle{Eigen::Vector2d(1, 0), Eigen::MatrixXd::Zero(2, 3)};
   cycle.varying.row(1) << 0, 1, -0.5;
   for (const PointwiseEstimate &estimate :
        {method1_friction(problem, cycle, 1), method1_load(problem, cycle)})
   {
      EXPECT_EQ(estimate.node, 1);
   }
   // Without node 1 it is node 2: 1.5/(1.5 + 2.25); 1.5 λ = 0.4 (4 - 0.25 λ).
   EXPECT_NEAR(method1_friction(problem, cycle, 1, {0, 2}).value, 1.5 / 3.75, 1e-15);
   EXPECT_NEAR(method1_load(problem, cycle, {0, 2}).value, 1.6 / 1.6, 1e-15);
   EXPECT_EQ(method1_load(problem, cycle, {0, 2}).node, 2);
   // Each node has its own friction: 1.5 λ = 0.6 · 2 at node 1.
   ReducedProblem unequal = problem;
   unequal.friction << 2, 0.6, 0.4;
   EXPECT_NEAR(method1_load(unequal, cycle).value, 0.8, 1e-14);
   EXPECT_EQ(method1_load(unequal, cycle).node, 1);
   EXPECT_NEAR(method1_load(unequal, cycle, {0, 2}).value, 1, 1e-14);
   EXPECT_EQ(method1_load(unequal, cycle, {0, 2}).node, 2);
   // One vertex alone: nothing changes, until node 2 opens.
   cycle.varying = Eigen::Vector2d(0, 1);
   EXPECT_EQ(method1_friction(problem, cycle, 1).value, 0);
   EXPECT_NEAR(method1_load(problem, cycle).value, 4, 1e-14);
   EXPECT_TRUE(std::isinf(method1_load(problem, cycle, {0, 1}).value));
   // In tension no friction helps, and no load is held.
   cycle.constant[0] = -1;
   EXPECT_TRUE(std::isinf(method1_friction(problem, cycle, 0).value));
   EXPECT_EQ(method1_load(problem, cycle).value, 0);
   // In the disc the change is a distance, here of a triangle with the sides 3, 4 and 5.
   ReducedProblem disc = nodes_apart(Eigen::RowVector4d(0, 10, 0, 0));
   disc.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Zero(1, 2), disc.C());
   disc.patterns[0].q = Eigen::Vector2d(7, -7);
   disc.patterns[1].q = Eigen::Vector2d(3, 0);
   disc.patterns.push_back(
      {"R", Control::force, Eigen::Vector2d(0, 4), Eigen::VectorXd::Zero(1)});
   disc.H = Eigen::Matrix3d::Zero();
   LoadCycle triangle{Eigen::Vector3d(1, 0, 0), Eigen::MatrixXd::Zero(3, 3)};
   triangle.varying(1, 1) = triangle.varying(2, 2) = 1;
   const PointwiseEstimate longest = method1_friction(disc, triangle, 1);
   EXPECT_NEAR(longest.value, 5.0 / 20, 1e-15);
   EXPECT_NEAR(method1_load(disc, triangle).value, 0.5 * 20 / 5, 1e-15);
}

TEST(Method2, SaysWhyItHasNoAnswer)
{
   ReducedProblem problem = three_nodes();
   const LoadCycle pulled = held_and_cycled(problem, "P", -1, "Q", 0);
   const Method2Estimate tension = method2_friction(limit_problem(problem, pulled), 1);
   EXPECT_FALSE(tension.exists);
   EXPECT_EQ(tension.low, 0);
   EXPECT_EQ(tension.natural, 0);
   EXPECT_EQ(tension.high, 0);
   EXPECT_NE(tension.message.find("in tension"), std::string::npos) << tension.message;
   // A steady shear needs no friction by method 1, but of a free body has a resultant.
   problem.A().array() -= 1.0 / 3;
   complete(problem);
   const LoadCycle steady = held_and_cycled(problem, "P", 1, "Q", 1);
   const Method2Estimate resultant = method2_friction(limit_problem(problem, steady), 0.3);
   EXPECT_FALSE(resultant.exists);
   EXPECT_EQ(resultant.low, 0);
   EXPECT_EQ(resultant.natural, 0);
   EXPECT_EQ(resultant.high, 0);
   EXPECT_NE(resultant.message.find("has a resultant, must have none"), std::string::npos)
      << resultant.message;
   EXPECT_THROW(
      method2_friction(limit_problem(random_contact(1, 3, 2, false), random_cycle(1, 3, 2)), 1),
      InputError);
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

TEST(Method2, LooksAtTheChosenNodesAlone)
{
   // As above, but what the residual shear changes, the pressure of node 1, is not looked at:
   // 1.5/4.25 and 1.5/3.75 are left.
   Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
   M(1, 0) = 0.5;
   const LimitProblem limit =
      limit_problem(three_nodes(M), held_and_cycled(three_nodes(M), "P", 1, "Q", -0.5));
   const Method2Estimate estimate = method2_friction(limit, 1, {0, 2});
   ASSERT_TRUE(estimate.exists) << estimate.message;
   for (const double f : {estimate.low, estimate.natural, estimate.high})
   {
      EXPECT_NEAR(f, 0.4, 1e-9);
   }
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
      const Eigen::VectorXd change = problem.B() * (limit.residual.flexibility * r);
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
      problem.set_stiffness(A, B, A);
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
   other.set_stiffness(1e9 * S.transpose() * problem.A() * S,
                       1e9 * T.transpose() * problem.B() * S,
                       1e9 * T.transpose() * problem.C() * T);
   EXPECT_NEAR(degree_of_coupling(other), coupling, 1e-9);
   other.B().setZero();
   complete(other);
   EXPECT_EQ(degree_of_coupling(other), 0);
}

TEST(Coupling, LeavesOutMotionsThatCostNothing)
{
   // A curved contact turns in its seat: one slip together with one opening stores no energy at
   // all. Another pair shares 0.3 of its energy.
   const double a = 0.4, b = 1.1;
   const Eigen::Matrix2d U{{std::cos(a), -std::sin(a)}, {std::sin(a), std::cos(a)}},
      V{{std::cos(b), -std::sin(b)}, {std::sin(b), std::cos(b)}};
   ReducedProblem problem = nodes_apart(Eigen::MatrixXd::Ones(2, 4));
   problem.B() = U * Eigen::Vector2d(1, -0.3).asDiagonal() * V.transpose();
   complete(problem);
   EXPECT_NEAR(degree_of_coupling(problem), 0.3, 1e-12);
   problem.B() = U * Eigen::Vector2d(1 - 1e-6, 0.3).asDiagonal() * V.transpose();
   complete(problem);
   EXPECT_NEAR(degree_of_coupling(problem), 1 - 1e-6, 1e-12);
}

TEST(ResidualForces, AreThoseOfAnySlip)
{
   for (const Eigen::Index c : {1, 2})
   {
      for (const bool rigid : {false, true})
      {
         const ReducedProblem problem = random_contact(31, 4, c, rigid);
         const ResidualForces residual = residual_forces(problem);
         const Eigen::MatrixXd &Z = residual.rigid;
         ASSERT_EQ(Z.cols(), rigid ? c : 0);
         EXPECT_FALSE(residual.uncoupled);
         std::mt19937 random(1);
         const Eigen::VectorXd v = random_matrix(random, 4 * c, 1), r = problem.A() * v;
         Eigen::VectorXd rest = residual.flexibility * r - v; // a rigid slip
         EXPECT_LT((problem.A() * rest).norm(), 1e-12);
         EXPECT_LT((residual.transfer * r - problem.B() * v).norm(), 1e-12);
         EXPECT_LT((residual.flexibility - residual.flexibility.transpose()).norm(), 1e-12);
         for (Eigen::Index k = 0; k < Z.cols(); ++k)
         {
            EXPECT_NEAR(Z.col(k).norm(), 1, 1e-14);
            EXPECT_LT((problem.A() * Z.col(k)).norm(), 1e-12);
         }
      }
   }
   ReducedProblem problem = nodes_apart(Eigen::MatrixXd::Ones(2, 4));
   EXPECT_TRUE(residual_forces(problem).uncoupled);
   problem.A() << 1, 2, 2, 1;
   EXPECT_THROW(residual_forces(problem), InputError);
   problem.set_stiffness({}, Eigen::MatrixXd(2, 0), problem.C());
   for (LoadPattern &pattern : problem.patterns) { pattern.q.resize(0); }
   EXPECT_THROW(residual_forces(problem), InputError);
   EXPECT_EQ(degree_of_coupling(problem), 0);
}

TEST(ClosedContact, LoadsDoTheSameWorkAndFactsAreKept)
{
   ReducedProblem problem = random_contact(10, 6, 2, false);
   std::mt19937 random(4);
   problem.patterns[1].control = Control::displacement;
   const Eigen::MatrixXd any = random_matrix(random, 3, 3);
   problem.H = any + any.transpose();
   problem.H.row(1) *= -1; // a displacement among forces
   problem.H(1, 1) *= -1;
   problem.weights = random_matrix(random, 6, 1).cwiseAbs();
   problem.arc_length = Eigen::VectorXd::LinSpaced(6, 0, 5);
   problem.position = random_matrix(random, 6, 2);
   const LineEnd corner = LineEnd::corner, smooth = LineEnd::smooth, open = LineEnd::open;
   problem.chains = {{"a", 0, 3, true, {corner, smooth}, {smooth, smooth}},
                     {"b", 3, 2, false, {smooth, corner}, {corner, smooth}},
                     {"c", 5, 1, false, {smooth, smooth}, {smooth, smooth}}};
   hold(problem, {1, 2, 10}); // along: nodes 1 and 2; across: node 4
   const std::vector<Eigen::Index> closed = {0, 1, 3, 4};
   const ReducedProblem reduced = closed_contact(problem, closed).reduced;

   // Displacements of forces and reactions of prescribed displacements, g = H λ ∓ Fᵀ u, with
   // open nodes that move until they carry nothing.
   const std::vector<Eigen::Index> closed_v = {0, 1, 3, 4, 6, 7, 9, 10},
                                   open_u = {2, 5, 8, 11, 14, 17};
   Eigen::VectorXd slip = random_matrix(random, 8, 1);
   const Eigen::VectorXd loads = random_matrix(random, 3, 1);
   Eigen::VectorXd u = Eigen::VectorXd::Zero(18);
   u(closed_v) = slip;
   const Eigen::MatrixXd K = problem.K;
   const Eigen::VectorXd clamped = K * u + problem.clamped_forces(loads);
   u(open_u) = -Eigen::FullPivLU<Eigen::MatrixXd>(K(open_u, open_u))
                   .solve(Eigen::VectorXd(clamped(open_u)));
   for (int k = 0; k < 3; ++k)
   {
      const double sign = k == 1 ? 1 : -1;
      const LoadPattern &pattern = problem.patterns[k];
      const double whole = problem.H.row(k) * loads +
                           sign * (pattern.q.dot(u.head(12)) + pattern.p.dot(u.tail(6)));
      const double part = reduced.H.row(k) * loads + sign * reduced.patterns[k].q.dot(slip);
      EXPECT_NEAR(part, whole, 1e-12) << k;
      EXPECT_EQ(reduced.patterns[k].control, pattern.control);
      EXPECT_EQ(reduced.patterns[k].name, pattern.name);
   }
   for (int i = 0; i < 4; ++i)
   {
      EXPECT_EQ(reduced.weights[i], problem.weights[closed[i]]);
      EXPECT_EQ(reduced.arc_length[i], problem.arc_length[closed[i]]);
      EXPECT_EQ(reduced.friction[i], problem.friction[closed[i]]);
      EXPECT_EQ(reduced.position(i, 1), problem.position(closed[i], 1));
   }
   // Closed nodes 1 and 4 are the second and the last of four.
   EXPECT_EQ(reduced.held, (std::vector<Eigen::Index>{1, 7}));
   ASSERT_EQ(reduced.chains.size(), 2u);
   EXPECT_EQ(reduced.chains[0].first, 0);
   EXPECT_EQ(reduced.chains[0].nodes, 2);
   EXPECT_FALSE(reduced.chains[0].loop);
   EXPECT_EQ(reduced.chains[0].ends, (std::array<LineEnd, 2>{open, open}));
   EXPECT_EQ(reduced.chains[0].other_ends, (std::array<LineEnd, 2>{open, open}));
   EXPECT_EQ(reduced.chains[1].interface, "b");
   EXPECT_EQ(reduced.chains[1].first, 2);
   EXPECT_EQ(reduced.chains[1].nodes, 2);
   EXPECT_EQ(reduced.chains[1].ends, (std::array<LineEnd, 2>{smooth, corner}));
   EXPECT_EQ(reduced.chains[1].other_ends, (std::array<LineEnd, 2>{corner, smooth}));
   EXPECT_NO_THROW(reduced.validate());
   // A line with a gap in it is two.
   ReducedProblem line = problem;
   line.chains = {{"a", 0, 6, false, {corner, smooth}, {smooth, corner}}};
   const std::vector<ContactChain> runs = closed_contact(line, {0, 1, 3, 4, 5}).reduced.chains;
   ASSERT_EQ(runs.size(), 2u);
   EXPECT_EQ(runs[0].nodes, 2);
   EXPECT_EQ(runs[0].ends, (std::array<LineEnd, 2>{corner, open}));
   EXPECT_EQ(runs[1].first, 2);
   EXPECT_EQ(runs[1].nodes, 3);
   EXPECT_EQ(runs[1].other_ends, (std::array<LineEnd, 2>{open, corner}));
   // What is not known of the loads stays so.
   line.H.resize(0, 0);
   EXPECT_FALSE(closed_contact(line, {0, 1, 3, 4, 5}).reduced.knows_loads());
   // All closed: the same contact.
   const ClosedContact all = closed_contact(problem, {0, 1, 2, 3, 4, 5});
   EXPECT_EQ(all.reduced.B(), problem.B());
   EXPECT_EQ(all.reduced.H, problem.H);
   EXPECT_TRUE(all.reduced.chains[0].loop);
   EXPECT_EQ(all.open_gaps(Eigen::VectorXd::Zero(12), loads).size(), 0);
   // Nothing holds the open nodes.
   const ReducedProblem free = random_contact(10, 6, 1, true);
   EXPECT_NO_THROW(closed_contact(free, {0, 1}));
   ReducedProblem loose = nodes_apart(Eigen::MatrixXd::Ones(3, 4));
   loose.C() << 1, 0, 0, 0, 1, -1, 0, -1, 1;
   complete(loose);
   EXPECT_THROW(closed_contact(loose, {0}), InputError);
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
   const Eigen::MatrixXd K = problem.K;
   const Eigen::VectorXd clamped = K * u + problem.clamped_forces(loads);
   u(open_u) = -Eigen::FullPivLU<Eigen::MatrixXd>(K(open_u, open_u))
                   .solve(Eigen::VectorXd(clamped(open_u)));
   const Eigen::VectorXd f = K * u + problem.clamped_forces(loads);
   EXPECT_LT(f(open_u).norm(), 1e-12);

   const ReducedProblem &reduced = contact.reduced;
   const Eigen::VectorXd own = reduced.clamped_forces(loads);
   const std::vector<Eigen::Index> closed_w = {12, 13, 16};
   EXPECT_LT((reduced.A() * slip + own.head(6) - f(closed_v)).norm(), 1e-12);
   EXPECT_LT((reduced.B() * slip + own.tail(3) - f(closed_w)).norm(), 1e-12);
   const Eigen::VectorXd gaps = contact.open_gaps(slip, loads);
   EXPECT_NEAR(gaps[1], u[15], 1e-12);
   EXPECT_NEAR(gaps[0], u[14] + 0.1, 1e-12);
   EXPECT_NEAR(gaps[2], u[17], 1e-12);

   EXPECT_THROW(closed_contact(problem, {2}), InputError);
   EXPECT_THROW(closed_contact(problem, {0, 0}), InputError);
   EXPECT_THROW(closed_contact(problem, {7}), InputError);
   EXPECT_THROW(closed_contact(problem, {}), InputError);
}

} // namespace
