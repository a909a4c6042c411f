#include "expect_input_error.hpp"
#include "frame_of_bars.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::Frame;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A contact node on a line that leans by 30 degrees: 30 from what is held along x, 60 from what
// is held along y.
TEST(CondenseMatrix, AHeldContactNodeOnALeaningLineIsRefusedWithItsAngle)
{
   const double lean = std::acos(-1.0) / 6;
   for (const auto &[component, angle] : {std::pair{0, "30"}, std::pair{1, "60"}})
   {
      const Frame frame(5, 4, true);
      AssembledBody body = frame.body(true);
      ContactLine line = frame.line();
      body.fixed.insert(body.fixed.begin(), line.nodes[0].dofs[component]);
      for (LineNode &node : line.nodes) { node.tangent = {std::cos(lean), std::sin(lean)}; }
      expect_input_error([&] { condense(body, line); },
                         std::string("meets it at ") + angle + " degrees, must be 0 or 90");
   }
}

TEST(CondenseMatrix, SpringsThatConnectNoComponents)
{
   // Between five points, each as stiff along x as along y, which do not feel each other: the
   // contact points 0 and 1 hang on 2 and 3, those on each other and on 4, which is held.
   AssembledBody body;
   MatrixXd K = MatrixXd::Zero(10, 10);
   const Eigen::Matrix2d spring{{1, -1}, {-1, 1}};
   for (const auto &[i, j] :
        std::vector<std::pair<int, int>>{{0, 2}, {1, 3}, {2, 3}, {2, 4}, {3, 4}})
   {
      for (int c : {0, 1})
      {
         const std::vector<int> dofs{2 * i + c, 2 * j + c};
         K(dofs, dofs) += spring;
      }
   }
   body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   body.places = {VectorXd(10), VectorXd(10), {}, Formulation::plane};
   body.places.x << 0, 0, 1, 1, 0.2, 0.2, 0.9, 0.9, 0.5, 0.5;
   body.places.y << 0, 0, 0, 0, 1, 1, 1, 1, 2, 2;
   for (int dof = 0; dof < 10; ++dof) { body.places.component.push_back(dof % 2); }
   body.fixed = {8, 9};
   ContactLine line;
   line.chains = {{0, 2}};
   line.nodes = {{{0, 1}, {0, 0}, {1, 0}, 1, 0, 1}, {{2, 3}, {1, 0}, {1, 0}, 1, 1, 1}};
   // Eliminated by hand: K_II = [3 -1; -1 3] of points 2 and 3, its inverse [3 1; 1 3]/8.
   const Eigen::Matrix2d own{{0.625, -0.125}, {-0.125, 0.625}};
   for (const bool grounded : {true, false})
   {
      body.grounded = grounded;
      const CondensedBody condensed = condense(body, line);
      EXPECT_LT((condensed.S.topLeftCorner(2, 2) - own).norm(), 1e-15);
      EXPECT_LT((condensed.S.bottomRightCorner(2, 2) - own).norm(), 1e-15);
      EXPECT_TRUE(condensed.S.bottomLeftCorner(2, 2).isZero(0));
      EXPECT_EQ(condensed.free_motions.cols(), 0);
   }
   // Held by nothing, they resist turning, which no part knows as a rigid motion.
   body.fixed.clear();
   body.grounded = true;
   EXPECT_EQ(condense(body, line).free_motions.cols(), 2);
}

/// A support on a slope that was eliminated in axes of its own, the matrix turned back.
TEST(CondenseMatrix, SupportsOnASlopeThatWereEliminatedAreRefused)
{
   const Frame frame(4, 3, true);
   const AssembledBody body = frame.body(true);
   const MatrixXd K = MatrixXd(body.K.view());
   const auto sparse = [](const MatrixXd &full)
   { return SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(full.sparseView())); };
   const int node = 4; // in the middle of the frame
   for (const double degrees : {-60.0, 0.5, 30.0, 45.0, 89.0})
   {
      const double angle = degrees / 180 * std::acos(-1.0);
      MatrixXd turn = MatrixXd::Identity(K.rows(), K.cols());
      turn.block(2 * node, 2 * node, 2, 2) = Eigen::Rotation2Dd(angle).toRotationMatrix();
      for (const double diagonal : {1.0, 1e-3, 1e6})
      {
         for (const bool grounded : {false, true})
         {
            SCOPED_TRACE(testing::Message() << degrees << " degrees, " << diagonal);
            MatrixXd along = turn.transpose() * K * turn;
            along.row(2 * node).setZero();
            along.col(2 * node).setZero();
            along(2 * node, 2 * node) = diagonal;
            MatrixXd back = turn * along * turn.transpose();
            back = (0.5 * (back + back.transpose())).eval();
            AssembledBody gone = body;
            gone.K = sparse(back);
            gone.grounded = grounded;
            expect_input_error([&] { condense(gone, frame.line()); },
                               "holds the node (0, 1) along (");
         }
      }
      // A spring on the slope is none, be it soft or stiff.
      for (const double stiff : {1e-3, 1.0, 1e3})
      {
         MatrixXd sprung = K;
         const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
         sprung.block(2 * node, 2 * node, 2, 2) += stiff * n * n.transpose();
         AssembledBody held = body;
         held.K = sparse(sprung);
         held.grounded = true;
         EXPECT_NO_THROW(condense(held, frame.line()));
      }
      // Nor is a bar on a slope that ends at a node of its own.
      MatrixXd with_bar = MatrixXd::Zero(K.rows() + 2, K.cols() + 2);
      with_bar.topLeftCorner(K.rows(), K.cols()) = K;
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      const std::vector<int> ends{2 * node, 2 * node + 1, static_cast<int>(K.rows()),
                                  static_cast<int>(K.rows()) + 1};
      const Eigen::Vector4d stretch = (Eigen::Vector4d() << -n, n).finished();
      with_bar(ends, ends) += stretch * stretch.transpose();
      AssembledBody bar = body;
      bar.K = sparse(with_bar);
      const Eigen::Index size = with_bar.rows();
      bar.places.x.conservativeResize(size);
      bar.places.y.conservativeResize(size);
      bar.places.x.tail(2).setConstant(frame.x[node] + n[0]);
      bar.places.y.tail(2).setConstant(frame.y[node] + n[1]);
      bar.places.component.insert(bar.places.component.end(), {0, 1});
      for (BodyLoad &load : bar.loads)
      {
         load.values.conservativeResize(size);
         load.values.tail(2).setZero();
      }
      EXPECT_NO_THROW(bar.validate());
   }
}

/// Conjugates at rest by reciprocity: an obstacle that moves by d has the pattern f = K d, and
/// its reaction to a pattern f' is dᵀ f' = fᵀ K⁻¹ f'.
TEST(CondenseMatrix, ObstaclesThatMoveReactToTheOtherLoads)
{
   const Frame frame(3, 2, true);
   Reduction reduction = reduce(condense(frame.body(true), frame.line()));
   const int motion = static_cast<int>(reduction.problem.patterns.size());
   reduction.add_obstacle_motion(
      "turn", [](double, double y) { return 0.5 - y; },
      [](double x, double) { return x - 0.7; });
   reduction.add_obstacle_motion("askew", 1.0, 0.3);
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   const auto of_pattern = [&](int k)
   {
      VectorXd f(problem.K.rows());
      f << problem.patterns[k].q, problem.patterns[k].p;
      return f;
   };
   const Eigen::LDLT<MatrixXd> stiffness(problem.K);
   for (int a : {motion, motion + 1})
   {
      const VectorXd d = stiffness.solve(of_pattern(a));
      for (int b = 0; b < motion + 2; ++b)
      {
         const double reaction = d.dot(of_pattern(b));
         EXPECT_NEAR(problem.H(a, b), reaction, 1e-12 * of_pattern(b).norm()) << a << " " << b;
         const bool force = problem.patterns[b].control == Control::force;
         EXPECT_NEAR(problem.H(b, a), force ? -reaction : reaction,
                     1e-12 * of_pattern(b).norm());
      }
   }
   expect_input_error(
      [&]
      {
         const VectorXd u = VectorXd::Zero(problem.nodes());
         reduction.displacement(1, u, u, VectorXd::Zero(motion + 2));
      },
      "displacement: body 1, must be from 0 to 0");
}

TEST(CondenseMatrix, AnObstacleThatMovesKnowsNoMoreOfTheOtherLoads)
{
   const Frame frame(3, 2, true);
   Reduction reduction = reduce(condense(frame.body(true), frame.line()));
   reduction.problem.H.resize(0, 0);
   ASSERT_FALSE(reduction.problem.knows_loads());
   reduction.add_obstacle_motion("rise", 0.0, 1.0);
   EXPECT_FALSE(reduction.problem.knows_loads());
   reduction.problem.validate();
}

/// A bar of 20,000 springs 1, along as across, whose end stands on a foundation: in a row with
/// it, 1/S = 20,000 + 1/c. Elimination rounds a pivot of order one in each of its steps.
TEST(CondenseMatrix, AWeakFoundationHoldsALargeBody)
{
   const int springs = 20000;
   for (const double foundation : {1e-6, 1e-7})
   {
      std::vector<Eigen::Triplet<double>> entries;
      const auto add = [&](int i, int j, double k) { entries.emplace_back(i, j, k); };
      AssembledBody body;
      const int dofs = 2 * (springs + 1);
      body.places = {VectorXd(dofs), VectorXd::Zero(dofs), {}, Formulation::plane};
      for (int i = 0; i <= springs; ++i)
      {
         for (int c : {0, 1})
         {
            const int dof = 2 * i + c;
            body.places.x[dof] = i;
            body.places.component.push_back(c);
            if (i == springs)
            {
               add(dof, dof, foundation);
               continue;
            }
            add(dof, dof, 1);
            add(dof + 2, dof + 2, 1);
            add(dof, dof + 2, -1);
            add(dof + 2, dof, -1);
         }
      }
      Eigen::SparseMatrix<double, Eigen::RowMajor> K(dofs, dofs);
      K.setFromTriplets(entries.begin(), entries.end());
      body.K = SharedMatrix(std::move(K));
      body.grounded = true;
      ContactLine line;
      line.chains = {{0, 1}};
      line.nodes = {{{0, 1}, {0, 0}, {1, 0}, 1, 0, 1}};
      const CondensedBody condensed = condense(body, line);
      EXPECT_EQ(condensed.free_motions.cols(), 0);
      const double S = 1 / (springs + 1 / foundation);
      EXPECT_NEAR(condensed.S(0, 0), S, springs * 2.3e-16);
      EXPECT_NEAR(condensed.S(1, 1), S, springs * 2.3e-16);
   }
}

/// Two nodes that hold on to each other hang on the contact by a weak spring: a load on them
/// moves them by 1/weak + 1, of which K itself says as many digits as 1 + weak has of weak.
TEST(CondenseMatrix, WhatOnlyRoundOffHoldsMustNotBeLoaded)
{
   const auto condensed = [](double weak)
   {
      std::vector<Eigen::Triplet<double>> entries;
      AssembledBody body;
      body.places = {VectorXd(8), VectorXd::Zero(8), {}, Formulation::plane};
      for (int dof = 0; dof < 8; ++dof)
      {
         body.places.x[dof] = dof / 2;
         body.places.component.push_back(dof % 2);
         // Springs from the ground to node 0, and on from node to node, the contact is 1.
         const double own[] = {2, 1 + weak, 1 + weak, 1}, next[] = {1, weak, 1};
         entries.emplace_back(dof, dof, own[dof / 2]);
         if (dof >= 6) { continue; }
         entries.emplace_back(dof, dof + 2, -next[dof / 2]);
         entries.emplace_back(dof + 2, dof, -next[dof / 2]);
      }
      Eigen::SparseMatrix<double, Eigen::RowMajor> K(8, 8);
      K.setFromTriplets(entries.begin(), entries.end());
      body.K = SharedMatrix(std::move(K));
      body.grounded = true;
      body.loads = {{"pull", Control::force, VectorXd::Unit(8, 6)}};
      ContactLine line;
      line.chains = {{0, 1}};
      line.nodes = {{{2, 3}, {1, 0}, {1, 0}, 1, 0, 1}};
      return condense(body, line);
   };
   EXPECT_NEAR(condensed(1e-8).H(0, 0), 1e8 + 1, 1e8 * 1e-7);
   expect_input_error([&] { condensed(1e-14); },
                      "condense: load 'pull' moves the node (3, 0) by 1");
   expect_input_error([&] { condensed(1e-14); }, "must be at most 0.001");
}

TEST(CondenseMatrix, NeighboursAreAtDifferentPlaces)
{
   const Frame frame(3, 2, true);
   ContactLine line = frame.line();
   line.nodes[2].position = line.nodes[1].position;
   expect_input_error([&] { line.validate(); }, "two neighbouring nodes are both at (1, 0)");
   ContactLine two = frame.line();
   two.nodes.resize(2);
   two.chains = {{0, 2}};
   two.nodes[1].position = two.nodes[0].position;
   expect_input_error([&] { two.validate(); }, "two neighbouring nodes are both at (0, 0)");
}

TEST(CondenseMatrix, SaysWhatIsWrong)
{
   const Frame frame(4, 3, true);
   const AssembledBody good = frame.body(true);
   const ContactLine line = frame.line();
   AssembledBody bad = good;
   bad.fixed.insert(bad.fixed.begin(), 5);
   expect_input_error([&] { reduce(condense(bad, line)); },
                      "(2, 0) is fixed normal to the line, so that it cannot open");
   bad.blocks.push_back({VectorXd::Unit(24, 5), "", 1});
   expect_input_error(
      [&] { condense(bad, line); },
      "component y of the contact node at (2, 0) is in a guide, contact nodes must be");
   ContactLine beyond = line;
   beyond.nodes[1].dofs[1] = 24;
   expect_input_error([&] { condense(good, beyond); },
                      "contact dof 24 of node 1 of the line, must be from 0 to 23");
   const auto refused = [&](const char *said, const auto &spoil)
   {
      AssembledBody spoilt = good;
      spoil(spoilt);
      expect_input_error([&] { condense(spoilt, line); }, said);
   };
   refused("x, y and component are given for 23, 24 and 24 dofs",
           [](auto &b) { b.places.x.conservativeResize(23); });
   refused("dof 3 has component 2", [](auto &b) { b.places.component[3] = 2; });
   refused("dof 4 has a coordinate that is not finite",
           [](auto &b) { b.places.y[4] = INFINITY; });
   refused("fixed dof 24, must be from 0 to 23", [](auto &b) { b.fixed.push_back(24); });
   refused("fixed dof 16 follows 17", [](auto &b) { std::swap(b.fixed[0], b.fixed[1]); });
   refused("load 'pull' has 5 values",
           [](auto &b) { b.loads[0].values.conservativeResize(5); });
   refused("load 'pull' has 24 values", [](auto &b) { b.loads[0].values[7] = NAN; });
   refused("load 'lift' displaces dof 9", [](auto &b) { b.loads[1].values[9] = 1e-9; });
   // Eliminated: of the rows and columns of what is fixed their diagonal is left, perhaps among
   // zeros that are stored.
   for (const bool stored : {false, true})
   {
      refused("load 'lift' moves nothing, because the rows of the displaced dofs have only a "
              "diagonal: was the matrix eliminated?",
              [&](auto &b)
              {
                 Eigen::SparseMatrix<double, Eigen::RowMajor> K = frame.K.sparseView();
                 std::vector<bool> fixed(frame.K.rows(), false);
                 for (int dof : b.fixed) { fixed[dof] = true; }
                 for (int row = 0; row < K.rows(); ++row)
                 {
                    for (decltype(K)::InnerIterator entry(K, row); entry; ++entry)
                    {
                       const bool off = entry.row() != entry.col();
                       if (off && (fixed[entry.row()] || fixed[entry.col()]))
                       {
                          entry.valueRef() = 0;
                       }
                    }
                 }
                 if (!stored) { K.prune(0.0); }
                 b.K = SharedMatrix(K);
              });
   }
   // One triangle, as many programs write it.
   refused("not symmetric",
           [&](auto &b)
           {
              const MatrixXd upper = frame.K.template triangularView<Eigen::Upper>();
              b.K =
                 SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(upper.sparseView()));
           });
   const std::vector<int> start{0, 1, 2}, column{0, 2};
   const std::vector<double> value{1, 1};
   refused("row 1 of the stiffness has an entry in column 2", [&](auto &b)
           { b.K = SharedMatrix(2, start.data(), column.data(), value.data(), nullptr); });
   // Which would add up in one place and replace each other in another.
   refused("two loads are named 'pull', must have names of their own: add them up if they are "
           "one load",
           [](auto &b) { b.loads[1].name = "pull"; });
   refused("load 1 of 2 has no name", [](auto &b) { b.loads[1].name = ""; });
   refused("the stiffness has no rows", [](auto &b) { b.K = {}; });
   expect_input_error([&] { condense(AssembledBody{}, line); }, "the stiffness has no rows");
   EXPECT_EQ(SharedMatrix().view().nonZeros(), 0);
   // Entries that their program would add up, of rows that are not sorted.
   const std::vector<int> split{0, 3, 4}, twice{1, 0, 1, 0}, back{0, 2, 1};
   const std::vector<double> halves{0.5, 1, 0.5, 1};
   refused("row 0 of the stiffness has column 1 twice, must have it once: add the entries up",
           [&](auto &b)
           { b.K = SharedMatrix(2, split.data(), twice.data(), halves.data(), nullptr); });
   refused("row 1 of the stiffness begins at entry 2 and ends at 1", [&](auto &b)
           { b.K = SharedMatrix(2, back.data(), twice.data(), halves.data(), nullptr); });
   // A contact of one point lets the frame turn about it.
   ContactLine one = line;
   one.nodes.resize(1);
   one.chains = {{0, 1}};
   expect_input_error([&] { condense(frame.body(false), one); }, "1 rigid motion(s) free");
   Frame loose = frame;
   loose.K(10, 10) = -1;
   expect_input_error(
      [&] { condense(loose.body(true), line); },
      "entry (10, 10) of the stiffness is -1, its diagonal must not be negative");
   loose.K(10, 10) = 0;
   expect_input_error([&] { condense(loose.body(true), line); },
                      "not positive definite at component x of the node (1, 1)");
   loose.K(10, 10) = std::nan("");
   expect_input_error([&] { condense(loose.body(true), line); }, "nan");
   expect_input_error([] { SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(2, 3)); },
                      "2×3, must be square");
}

} // namespace
