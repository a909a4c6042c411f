#include "expect_input_error.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace
{

using cattaneo::InputError;
using cattaneo::ReducedProblem;

ReducedProblem two_nodes()
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d{{4, -1}, {-1, 4}},
                         Eigen::Matrix2d{{0.5, 0.1}, {-0.2, 0.3}},
                         Eigen::Matrix2d{{5, -1}, {-1, 5}});
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
   problem.C()(0, 1) = 3;
   EXPECT_THROW(problem.validate(), InputError);
   // Symmetric to 1e-9 of the largest entry, which is 5.
   problem = two_nodes();
   problem.C()(0, 1) = problem.C()(1, 0) + 4.5e-9;
   EXPECT_NO_THROW(problem.validate());
   problem.C()(0, 1) = problem.C()(1, 0) + 5.5e-9;
   expect_input_error([&] { problem.validate(); }, "at most 5e-09 is allowed");
   problem = two_nodes();
   problem.gap[0] = std::numeric_limits<double>::quiet_NaN();
   EXPECT_THROW(problem.validate(), InputError);
   problem = two_nodes();
   problem.patterns[0].p.resize(3);
   EXPECT_THROW(problem.validate(), InputError);
   EXPECT_THROW(two_nodes().pattern("pull"), InputError);
   EXPECT_THROW(set_friction(problem, std::numeric_limits<double>::quiet_NaN()), InputError);
}

// One node whose slip presses more than it resists, and two that press each other apart more
// than each resists: (-1/2, 1/2) and (1/2, -1/2) are both at rest under the same loads.
TEST(ReducedProblem, RefusesAStiffnessThatGivesEnergy)
{
   const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
   ReducedProblem problem;
   expect_input_error([&] { problem.set_stiffness(one, 2 * one, one); },
                      "smallest eigenvalue is -");
   problem = {};
   expect_input_error(
      [&]
      {
         problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                               Eigen::Matrix2d{{1, 3}, {3, 1}});
      },
      "smallest eigenvalue is -");
   // A body that slides and opens in one: energy zero is no energy below zero.
   problem = {};
   EXPECT_NO_THROW(problem.set_stiffness(one, -one, one));
   EXPECT_EQ(problem.rigid_motions.cols(), 1);
}

TEST(ReducedProblem, ANodeThatOpensAloneIsRefusedWhateverRoundOffLeftOfItsStiffness)
{
   // Two nodes of a free body on a straight line: one may open alone, the body turns about the
   // other. Only their distance is resisted.
   for (const double left : {-3e-30, 0.0, 3e-30})
   {
      ReducedProblem problem = two_nodes();
      Eigen::MatrixXd motions(4, 3);
      motions << std::sqrt(0.5), 0, 0, std::sqrt(0.5), 0, 0, 0, 1, 0, 0, 0, 1;
      problem.set_stiffness(Eigen::Matrix2d{{4, -4}, {-4, 4}}, Eigen::Matrix2d::Zero(),
                            left * Eigen::Matrix2d::Identity(), motions);
      expect_input_error([&] { problem.validate(); }, "opening at node 0 alone");
   }
   // One above the other's place by a hundredth: to open alone is to slide, too.
   ReducedProblem problem = two_nodes();
   Eigen::MatrixXd motions(4, 3);
   Eigen::Vector4d resisted(1, -1, 0.01, -0.01);
   resisted.normalize();
   problem.K = 8 * resisted * resisted.transpose();
   cattaneo::complete(problem);
   ASSERT_EQ(problem.rigid_motions.cols(), 3);
   EXPECT_NO_THROW(problem.validate());
}

/// Springs between all nodes of a body that is free to translate: the sought motions span the
/// stated ones, for few rows (by pivots) and many (by inverse iteration), and what is not
/// stated, or resisted, is named.
TEST(ReducedProblem, RigidMotionsAreSoughtOrHandedOver)
{
   for (const Eigen::Index n : {4, 150})
   {
      Eigen::MatrixXd springs =
         n * Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Ones(n, n);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         // Unlike nodes, which are still held by nothing.
         springs.row(i) *= 1 + 0.5 * std::sin(i);
         springs.col(i) *= 1 + 0.5 * std::sin(i);
      }
      const Eigen::VectorXd free =
         Eigen::VectorXd::NullaryExpr(n, [](Eigen::Index i)
                                      { return 1 / (1 + 0.5 * std::sin(i)); })
            .normalized();
      ReducedProblem problem;
      problem.set_stiffness(springs, Eigen::MatrixXd::Zero(n, n), springs);
      ASSERT_EQ(problem.rigid_motions.cols(), 2) << n;
      Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(2 * n, 2);
      motions.col(0).head(n) = free;
      motions.col(1).tail(n) = free;
      const Eigen::MatrixXd &Z = problem.rigid_motions;
      EXPECT_LT((motions - Z * (Z.transpose() * motions)).norm(), 1e-12);
      motions.col(1) = 3 * motions.col(0) - 2 * motions.col(1);
      complete(problem, motions);
      EXPECT_LT((motions - Z * (Z.transpose() * motions)).norm(), 1e-12);
      EXPECT_NO_THROW(problem.validate());
      expect_input_error(
         [&] { complete(problem, motions.leftCols(1)); },
         "it lists 1 rigid motions, must list all 2 that the stiffness does not resist");
      expect_input_error([&] { complete(problem, motions.topRows(n)); }, "must have");
      motions.col(1) = 2 * motions.col(0);
      expect_input_error([&] { complete(problem, motions); }, "linearly independent");
      motions.col(1) = Eigen::VectorXd::Unit(2 * n, 0);
      expect_input_error([&] { complete(problem, motions); }, "a rigid motion causes forces");
   }
}

TEST(ReducedProblem, SaysWhichSizeIsWrong)
{
   const auto refused =
      [](const std::string &said, const std::function<void(ReducedProblem &)> &spoil)
   {
      ReducedProblem problem = two_nodes();
      spoil(problem);
      expect_input_error([&] { problem.validate(); }, said);
   };
   using Eigen::MatrixXd, Eigen::VectorXd;
   refused("no contact nodes", [](auto &p) { p = {}; });
   expect_input_error(
      []
      {
         ReducedProblem p = two_nodes();
         p.set_stiffness(MatrixXd::Identity(3, 3), p.B(), p.C());
      },
      "sizes of A (3×3), B (2×2) and C (2×2) do not fit");
   refused("the stiffness is 5×5, must have 1, 2 or 3 rows and columns for each of the 2 nodes",
           [](auto &p)
           { p.set_stiffness(MatrixXd::Identity(3, 3), MatrixXd::Zero(2, 3), p.C()); });
   refused("the stiffness is 1×1, must have", [](auto &p) { p.K = MatrixXd::Identity(1, 1); });
   refused("the stiffness is 4×6, must have", [](auto &p) { p.K = MatrixXd::Identity(4, 6); });
   refused("3 tangential components", [](auto &p)
           { p.set_stiffness(MatrixXd::Identity(6, 6), MatrixXd::Zero(2, 6), p.C()); });
   refused("the stiffness has an entry that is not finite",
           [](auto &p) { p.C()(1, 0) = std::numeric_limits<double>::quiet_NaN(); });
   refused("must be the transpose of B", [](auto &p) { p.B()(0, 1) = 0; });
   refused("`coupled` is false, but B is not zero", [](auto &p) { p.coupled = false; });
   refused("`coupled` is true, but B is zero",
           [](auto &p)
           {
              p.B().setZero();
              complete(p);
              p.coupled = true;
           });
   refused("A is not symmetric", [](auto &p) { p.A()(0, 1) += 1e-7; });
   refused("diagonal of A is 0 at row 1", [](auto &p) { p.A() << 1, 0, 0, 0; });
   refused("dofs is 2×3", [](auto &p) { p.dofs = Eigen::MatrixXi::Zero(2, 3); });
   refused("dofs is 1×2", [](auto &p) { p.dofs = Eigen::MatrixXi::Zero(1, 2); });
   refused("position is 2×4", [](auto &p) { p.position = MatrixXd::Zero(2, 4); });
   refused("position is 3×2", [](auto &p) { p.position = MatrixXd::Zero(3, 2); });
   refused("H is 1×2", [](auto &p) { p.H = MatrixXd::Zero(1, 2); });
   refused("two load patterns are named 'press'",
           [](auto &p)
           {
              p.patterns.push_back(p.patterns[0]);
              p.H = MatrixXd::Zero(2, 2);
           });
   // Work of a force on another's displacement; a displacement's reaction works against it.
   for (const cattaneo::Control other :
        {cattaneo::Control::force, cattaneo::Control::displacement})
   {
      const bool alike = other == cattaneo::Control::force;
      const auto with = [&](ReducedProblem &p, double h)
      {
         const VectorXd z = VectorXd::Zero(2);
         p.patterns = {{"one", cattaneo::Control::force, z, z}, {"two", other, z, z}};
         p.H = Eigen::Matrix2d{{2, h}, {1, alike ? 3.0 : -3.0}};
      };
      refused(alike ? "H(1, 0) is 1 and H(0, 1) -1, must be the same"
                    : "H(1, 0) is 1 and H(0, 1) 1, must be opposite",
              [&](auto &p) { with(p, alike ? -1 : 1); });
      ReducedProblem sound = two_nodes();
      with(sound, alike ? 1 : -1);
      EXPECT_NO_THROW(sound.validate());
   }
   refused("the stiffness is 4×4, must have 1, 2 or 3 rows and columns for each of the 3 nodes",
           [](auto &p) { p.gap = VectorXd::Zero(3); });
   refused("weights has 1 entries", [](auto &p) { p.weights = VectorXd::Ones(1); });
   refused("weight 0 of node 1, must be positive",
           [](auto &p) { p.weights = VectorXd::Unit(p.nodes(), 0); });
   // Asymmetry of round-off is none: below 1e-9 of the largest entry, 5.
   ReducedProblem problem = two_nodes();
   problem.C()(0, 1) += 4e-9;
   EXPECT_NO_THROW(problem.validate());
   problem.patterns.push_back({"pull", cattaneo::Control::force, {}, {}});
   EXPECT_EQ(problem.pattern("pull"), 1);
   try
   {
      problem.pattern("twist");
      FAIL();
   }
   catch (const InputError &error)
   {
      EXPECT_STREQ(
         error.what(),
         "reduced problem: there is no load pattern 'twist', must be one of: press, pull");
   }
   EXPECT_THROW(problem.clamped_forces(VectorXd::Ones(1)), InputError);
   cattaneo::set_friction(problem, 0);
   EXPECT_EQ(problem.friction, Eigen::Vector2d(0, 0));
   EXPECT_THROW(cattaneo::set_friction(problem, -1e-300), InputError);
}

TEST(ReducedProblem, HoldingARowTakesItOutAndAllThatMovesIt)
{
   ReducedProblem problem = two_nodes();
   cattaneo::hold(problem, {1, 1});
   EXPECT_EQ(problem.A(), (Eigen::Matrix2d{{4, 0}, {0, 4}}));
   EXPECT_EQ(problem.B(), (Eigen::Matrix2d{{0.5, 0}, {-0.2, 0}}));
   EXPECT_EQ(problem.C(), two_nodes().C());
   EXPECT_EQ(problem.patterns[0].q, Eigen::Vector2d(0.1, 0));
   EXPECT_EQ(problem.patterns[0].p, Eigen::Vector2d(1, 1));
   EXPECT_EQ(problem.held, std::vector<Eigen::Index>{1});
   EXPECT_NO_THROW(problem.validate());
   EXPECT_TRUE(problem.coupled);
   cattaneo::hold(problem, {1, 0}); // one that is held already does not end it
   EXPECT_EQ(problem.held, (std::vector<Eigen::Index>{1, 0}));
   EXPECT_FALSE(problem.coupled);
   EXPECT_THROW(cattaneo::hold(problem, {2}), InputError);
   EXPECT_THROW(cattaneo::hold(problem, {-1}), InputError);
}

TEST(ReducedProblem, BothGapFormulationsGiveTheSameForces)
{
   const ReducedProblem problem = two_nodes();
   const ReducedProblem closed = absorb_gap(problem);
   Eigen::Vector4d u(0.2, -0.1, 0.03, 0.04);
   Eigen::Vector4d u_star = u;
   u_star.tail(2) += problem.gap;
   const Eigen::Vector4d f =
      problem.K * u + problem.clamped_forces(Eigen::VectorXd::Constant(1, 2.0));
   const Eigen::Vector4d f_star =
      closed.K * u_star + closed.clamped_forces(Eigen::Vector2d(2.0, 1.0));
   EXPECT_LT((f - f_star).norm(), 1e-15);
   EXPECT_TRUE(closed.gap.isZero(0));
   EXPECT_EQ(closed.patterns.back().name, "gap");
   EXPECT_EQ(closed.patterns.back().control, cattaneo::Control::force);
   // Clamped, the pattern that closes the gap does no work with the others.
   ReducedProblem loaded = problem;
   loaded.H << 3;
   const Eigen::MatrixXd H = absorb_gap(loaded).H;
   ASSERT_EQ(H.rows(), 2);
   ASSERT_EQ(H.cols(), 2);
   EXPECT_EQ(H, (Eigen::Matrix2d{{3, 0}, {0, 0}}));
}

} // namespace
