#include "contact_laws.hpp"
#include "half_space_contacts.hpp"

#include <cattaneo/shakedown/limit.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <record.hpp>

// Half-spaces in three dimensions with more rectangles: late stages of CONTACT's "spence35",
// and Cattaneo's and Mindlin's spheres.

namespace
{

using namespace cattaneo;
using cattaneo_test::conjugate;
using cattaneo_test::number_closed;
using cattaneo_test::number_of;

TEST(HalfSpaceStages, KalkersContactSpence)
{
   ReducedProblem problem = cattaneo_test::kalkers_spence(2.1);
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   cattaneo_test::FactorsOfIncrements factors;
   for (int stage = 1; stage <= 18; ++stage)
   {
      // The force as CONTACT's input has it.
      Eigen::VectorXd loads = Eigen::VectorXd::Zero(3);
      loads[problem.pattern("P")] = std::round(1e6 * std::pow(stage / 45.0, 3)) / 1e6;
      ASSERT_EQ(solver.solve(state, loads).status, FrictionStatus::converged) << stage;
      factors.note(solver.counters());
   }
   EXPECT_LE(factors.most, 20);
   EXPECT_LE(factors.mean(), 6);
   EXPECT_NEAR(conjugate(problem, state, "P"), 2.610e-2, 0.5e-5);
   EXPECT_NEAR(state.p.maxCoeff() / problem.weights[0], 1.220e-2, 0.5e-5);
   EXPECT_EQ(number_closed(state), 241);
   EXPECT_EQ(number_of(state, NodeState::stick), 61);
   cattaneo_test::record("approach", conjugate(problem, state, "P"));
   cattaneo_test::record("pressure", state.p.maxCoeff() / problem.weights[0]);
}

/// A march leaves out rectangles that are far from touching, and comes to what all of them come
/// to.
TEST(HalfSpaceStages, NearPartsAreTheWhole)
{
   ReducedProblem problem = cattaneo_test::kalkers_spence(2.1);
   ContactState state = ContactState::virgin(problem), whole = state;
   FrictionSolver solver(problem);
   std::vector<NamedLoads> points{{}};
   for (const double P : {1e-3, 4e-3, 9e-3, 16e-3})
   {
      points.push_back({{"P", P}, {"Q1", 0.1 * P}});
      ASSERT_EQ(solver.solve(whole, problem.multipliers(points.back())).status,
                FrictionStatus::converged);
   }
   const MarchReport report = cattaneo_test::marched(problem, points, state);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   EXPECT_GT(report.counters.near_contacts, 0);
   EXPECT_LT((state.q - whole.q).cwiseAbs().maxCoeff(), 1e-10 * whole.p.maxCoeff());
   EXPECT_LT((state.p - whole.p).cwiseAbs().maxCoeff(), 1e-10 * whole.p.maxCoeff());
   EXPECT_EQ(state.status, whole.status);
}

/// One of 1,101 rectangles touches.
TEST(HalfSpaceStages, OneRectangleOfAThousand)
{
   ReducedProblem problem = cattaneo_test::kalkers_spence(3.75);
   ASSERT_EQ(problem.nodes(), 1101);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = cattaneo_test::marched(problem, {{}, {{"P", 1.1e-5}}}, state);
   ASSERT_EQ(report.status, FrictionStatus::converged);
   EXPECT_EQ(number_closed(state), 1);
   EXPECT_NEAR(state.p.sum(), 1.1e-5, 1e-12);
   EXPECT_LE(report.counters.dense_factorisations, 20);
   // A solver of all rectangles comes to it too, also with kernels whose sums of thousands of
   // products leave as much as the tolerance (`./test --kernels`).
   ContactState whole = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   ASSERT_EQ(solver.solve(whole, state.multipliers).status, FrictionStatus::converged);
   EXPECT_EQ(whole.status, state.status);
   EXPECT_NEAR(whole.p.sum(), 1.1e-5, 1e-12);
   EXPECT_LE(solver.counters().dense_factorisations, 20);
}

/// A rigid sphere is pressed onto 1,125 squares of another material in one increment. Newton's
/// steps with all of the load go on changing stick to slip and back.
TEST(HalfSpaceStages, ARigidSphereIsPressedInOneIncrement)
{
   const double edge = 2.0 / 35, P = 4.0 / 30 / 0.91;
   const HalfSpace contact = cattaneo_test::contact_of(
      {1, 0.3}, {}, edge, cattaneo_test::cells(39, edge, 1 + 1.49 * edge));
   ReducedProblem problem = contact.problem(contact.centres.rowwise().squaredNorm() / 20);
   ASSERT_EQ(problem.nodes(), 1125);
   set_friction(problem, 0.3);
   const ContactState virgin = ContactState::virgin(problem);
   ContactState state = virgin;
   FrictionSolver solver(problem);
   const IncrementReport report = solver.solve(state, problem.multipliers({{"P", P}}));
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_STREQ(report.found_by, "growing load");
   // 1. The laws, from displacements alone, and equilibrium.
   cattaneo_test::LawChecker laws(problem, virgin);
   EXPECT_LE(laws.violation(virgin.v, state), 1) << laws.what();
   EXPECT_NEAR(state.p.sum(), P, 1e-10 * P);
   // 2. The answer is unique, so that it has the symmetry of the squares: mirrored in x = y and
   // in x = 0 it is the same.
   std::map<std::pair<long, long>, Eigen::Index> at;
   const auto cell = [&](Eigen::Index i)
   {
      return std::make_pair(std::lround(contact.centres(i, 0) / edge),
                            std::lround(contact.centres(i, 1) / edge));
   };
   for (Eigen::Index i = 0; i < problem.nodes(); ++i) { at[cell(i)] = i; }
   const double small = 1e-8 * state.p.maxCoeff();
   for (const auto &[where, i] : at)
   {
      const auto [x, y] = where;
      const Eigen::Index n = problem.nodes(), turned = at.at({y, x}), mirrored = at.at({-x, y});
      EXPECT_NEAR(state.p[turned], state.p[i], small);
      EXPECT_NEAR(state.q[n + turned], state.q[i], small);
      EXPECT_NEAR(state.p[mirrored], state.p[i], small);
      EXPECT_NEAR(state.q[mirrored], -state.q[i], small);
   }
   EXPECT_GT(number_of(state, NodeState::stick), 100);
   EXPECT_GT(number_of(state, NodeState::slip), 100);
}

/// A rigid punch of 545 squares under shear around a circle: proven bounds within 1e-4.
TEST(HalfSpaceStages, LimitOfHundredsOfClosedNodes)
{
   HalfSpace punch =
      cattaneo_test::contact_of({2.6, 0.3}, {}, 1, cattaneo_test::cells(27, 1, 13.1));
   punch.ends = true;
   ReducedProblem problem = punch.problem(Eigen::VectorXd::Zero(punch.centres.rows()));
   ASSERT_GE(problem.nodes(), 532);
   set_friction(problem, 0.03);
   std::vector<NamedLoads> around;
   for (int k = 0; k < 8; ++k)
   {
      around.push_back({{"Q1", std::cos(k * M_PI / 4)}, {"Q2", std::sin(k * M_PI / 4)}});
   }
   const LimitReport report =
      load_limit(limit_problem(problem, LoadCycle::through(problem, {{"P", 1}}, around)));
   ASSERT_TRUE(report.proven()) << report.message;
   EXPECT_LE(report.upper - report.lower, 1e-4 * report.upper);
   EXPECT_LE(report.violation, 0);
   EXPECT_GT(report.lower, 0);
   EXPECT_LE(report.upper, 0.03 * (1 + 1e-4)); // all slides
}

TEST(HalfSpaceStages, TwoThousandSquaresOfCattaneoAndMindlin)
{
   const cattaneo_test::ShearedSpheres error = cattaneo_test::sheared_spheres(51);
   EXPECT_NEAR(error.approach, 0, 1e-4);
   EXPECT_NEAR(error.loading, 0, 1e-4);
   EXPECT_NEAR(error.unloading, 0, 2e-4);
   EXPECT_NEAR(error.loss, 0, 5e-4);
   cattaneo_test::record("approach", 1 + error.approach);
   cattaneo_test::record("loading", 1 + error.loading);
   cattaneo_test::record("unloading", 1 + error.unloading);
   cattaneo_test::record("loss", 1 + error.loss);
}

} // namespace
