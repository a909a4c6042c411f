#include "expect_input_error.hpp"

#include <atomic>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

// Where a limit is one of the mesh, and which nodes stay closed, on nodes that do not feel each
// other: each bears its own load.
namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

/// "P" presses each node by 1; "Q" presses the first and lifts the last by 1/2 and shears all
/// by 0.1.
ReducedProblem springs(Index n)
{
   ReducedProblem problem;
   const auto unit = Eigen::MatrixXd::Identity(n, n);
   problem.set_stiffness(unit, Eigen::MatrixXd::Zero(n, n), unit);
   VectorXd tilt = VectorXd::Zero(n);
   tilt[0] = 0.5;
   tilt[n - 1] = -0.5;
   problem.patterns = {{"P", Control::force, VectorXd::Zero(n), VectorXd::Ones(n)},
                       {"Q", Control::force, VectorXd::Constant(n, 0.1), tilt}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = VectorXd::Zero(n);
   problem.chains = one_chain(n);
   problem.weights = VectorXd::Ones(n);
   problem.arc_length = VectorXd::LinSpaced(n, 0, 1);
   set_friction(problem, 0.5);
   return problem;
}

using Nodes = std::vector<Index>;

TEST(StayClosed, NodesWhosePressureFallsToZeroInTheCycleAreLeftOut)
{
   const ReducedProblem problem = springs(4);
   const auto stayed = [&](double load_factor, double reversal)
   {
      const StayedClosed found =
         stay_closed(problem, held_and_cycled(problem, "P", 1, "Q", reversal), load_factor, 2);
      EXPECT_EQ(found.march.status, FrictionStatus::converged) << found.march.message;
      EXPECT_GE(found.march.cycles.size(), 1u); // one, if it is steady at once
      return found.nodes;
   };
   // The last bears 1 - λ/2, the first 1 + λ R/2.
   EXPECT_EQ(stayed(1.9, -1), (Nodes{0, 1, 2, 3}));
   EXPECT_EQ(stayed(2.1, -1), (Nodes{1, 2}));
   EXPECT_EQ(stayed(2.1, 0), (Nodes{0, 1, 2}));
   EXPECT_EQ(stayed(2.1, -0.9), (Nodes{0, 1, 2}));
}

TEST(StayClosed, SaysHowItsMarchEndedAndRefusesNoCycle)
{
   const ReducedProblem problem = springs(3);
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", -1);
   std::atomic<bool> stop{true};
   Monitor monitor;
   monitor.stop = &stop;
   EXPECT_EQ(stay_closed(problem, cycle, 1, 3, monitor).march.status, FrictionStatus::stopped);
   expect_input_error([&] { stay_closed(problem, cycle, 1, 0); }, "there are 0 cycles");
   LoadCycle bad = cycle;
   bad.constant[0] = std::nan("");
   EXPECT_THROW(stay_closed(problem, bad, 1, 1), InputError);
}

TEST(LimitOfTheMesh, WorkAtTheEndsByHand)
{
   const ReducedProblem problem = springs(201); // two nodes at each end within 1 %
   const StuckForces stuck = stuck_forces(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   LimitReport limit;
   EXPECT_TRUE(std::isnan(share_of_ends(problem, stuck, limit, 1)));
   limit.slip = VectorXd::Zero(201); // nothing is locked in
   limit.mechanism.slip = Eigen::MatrixXd::Zero(201, 2);
   limit.mechanism.slip(0, 0) = -2;   // against 0.1 λ
   limit.mechanism.slip(100, 0) = -3; // in the middle
   limit.mechanism.slip(200, 1) = 4;  // at the other vertex, against -0.1 λ
   limit.mechanism.slip(2, 1) = 1;    // at 1 %, no longer at the end
   EXPECT_NEAR(share_of_ends(problem, stuck, limit, 1), 6.0 / 10, 1e-15);
   // What is locked in doubles the shear of the first node at the first vertex.
   limit.slip[0] = 0.1;
   EXPECT_NEAR(share_of_ends(problem, stuck, limit, 1), 8.0 / 12, 1e-15);
   // Along the shear nothing is dissipated.
   limit.mechanism.slip.setZero();
   limit.mechanism.slip(200, 0) = 1;
   limit.mechanism.slip(100, 0) = -1;
   EXPECT_EQ(share_of_ends(problem, stuck, limit, 4), 0);
}

TEST(LimitOfTheMesh, ContactThatEndsWithinItsLineIsSingularWhereItIsSheared)
{
   ReducedProblem problem = springs(6);
   const auto found = [&](const Nodes &closed)
   {
      const ClosedContact part = closed_contact(problem, closed);
      const LoadCycle cycle = held_and_cycled(part.reduced, "P", 1, "Q", -1);
      return singular_end(part.reduced, stuck_forces(part.reduced, cycle));
   };
   EXPECT_EQ(found({0, 1, 2, 3, 4, 5}), -1); // ends of the line are none within it
   EXPECT_EQ(found({0, 1, 2}), 2);
   EXPECT_EQ(found({3, 4, 5}), 0);
   EXPECT_EQ(found({1, 2, 4, 5}), 2); // the last of them
   // Another piece of the line is no neighbour.
   problem.chains = {{"a", 0, 3}, {"b", 3, 3}};
   EXPECT_EQ(found({0, 1, 2}), -1);
   EXPECT_EQ(found({3, 4}), 1);
   problem.patterns[1].q[4] = 0; // no shear there, nor at its neighbour
   EXPECT_EQ(found({3, 4}), -1);
}

/// The report says it itself: every node bears alone, and the mechanism is of one node.
TEST(LimitOfTheMesh, IsSaidByTheReport)
{
   ReducedProblem problem = springs(201);
   problem.patterns[1].p.setZero();
   const auto limit_of = [](const ReducedProblem &of)
   { return load_limit(limit_problem(of, held_and_cycled(of, "P", 1, "Q", -1))); };
   problem.patterns[1].q[100] = 0.4; // the weakest node, in the middle
   const LimitReport inside = limit_of(problem);
   ASSERT_EQ(inside.status, LimitStatus::certified) << inside.message;
   EXPECT_EQ(inside.of_the_mesh, "");
   problem.patterns[1].q[0] = 0.5; // at an end
   const LimitReport at_end = limit_of(problem);
   EXPECT_NE(at_end.of_the_mesh.find("100 % of the mechanism's work"), std::string::npos)
      << at_end.of_the_mesh;
   EXPECT_NE(at_end.of_the_mesh.find("falls with the spacing"), std::string::npos);
   ASSERT_FALSE(at_end.statement().empty());
   EXPECT_EQ(at_end.statement().back(), "of this mesh only: " + at_end.of_the_mesh);
   // Contact that ends within its line.
   Nodes closed(150);
   std::iota(closed.begin(), closed.end(), 20);
   const LimitReport part = limit_of(closed_contact(problem, closed).reduced);
   EXPECT_NE(part.of_the_mesh.find("inside of its line"), std::string::npos)
      << part.of_the_mesh;
   EXPECT_NE(
      friction_limit(limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1)), 1)
         .of_the_mesh.find("rises as the spacing"),
      std::string::npos);
}

} // namespace
