#include "half_space_contacts.hpp"

#include <cmath>
#include <gtest/gtest.h>
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
   for (int stage = 1; stage <= 18; ++stage)
   {
      // The force as CONTACT's input has it.
      Eigen::VectorXd loads = Eigen::VectorXd::Zero(3);
      loads[problem.pattern("P")] = std::round(1e6 * std::pow(stage / 45.0, 3)) / 1e6;
      ASSERT_EQ(solver.solve(state, loads).status, FrictionStatus::converged) << stage;
   }
   EXPECT_NEAR(conjugate(problem, state, "P"), 2.610e-2, 0.5e-5);
   EXPECT_NEAR(state.p.maxCoeff() / problem.weights[0], 1.220e-2, 0.5e-5);
   EXPECT_EQ(number_closed(state), 241);
   EXPECT_EQ(number_of(state, NodeState::stick), 61);
   cattaneo_test::record("approach", conjugate(problem, state, "P"));
   cattaneo_test::record("pressure", state.p.maxCoeff() / problem.weights[0]);
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
