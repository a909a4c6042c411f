#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "line_along.hpp"
#include "trusses.hpp"

#include <cattaneo/friction/loop.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

TEST_F(Interfaces, OfTwoBodiesAgreeWithMultipliers)
{
   for (SlaveSide slave : {SlaveSide::first, SlaveSide::second})
   {
      for (int held : {0, 1, 2})
      {
         Truss upper({side({0, 0}, {2, 0}, 4, 2)}, {1, 1}),
            lower({side({2, 0}, {0, 0}, 5, 1)}, {1, -1}, 3);
         if (held != 1) { upper.hold().lift("lift"); }
         if (held != 0) { lower.hold(); }
         upper.load("P");
         lower.load("P").load("Q");
         const std::vector<Interface> one{between(0, upper.lines[0], 1, lower.lines[0], slave)};
         Reduction reduction = reduce({upper.condensed(), lower.condensed()}, one);
         EXPECT_EQ(reduction.problem.rigid_motions.cols(), held == 2 ? 0 : 3);
         EXPECT_EQ(reduction.counters.unions, 1);
         EXPECT_EQ(reduction.counters.factorisations, 2);
         agrees_with_multipliers({upper, lower}, reduction, one);
      }
   }
}

TEST_F(Interfaces, OfAGappedArcAgreeWithMultipliers)
{
   const ContactLine disc = line_along(circle({0, 1}, 1), uniform_grid(-2.3, -0.8, 5), 2),
                     hole =
                        line_along(circle({0, 0.9}, 1.2, true), uniform_grid(0.9, 2.2, 4), 3);
   Truss inner({disc}, {0, 1}), outer({hole}, {0, -1});
   outer.hold().load("P");
   inner.load("P");
   const std::vector<Interface> one{between(0, disc, 1, hole, SlaveSide::second)};
   Reduction reduction = reduce({inner.condensed("pin"), outer.condensed("plate")}, one);
   EXPECT_GT(reduction.problem.gap.minCoeff(), 0.05);
   agrees_with_multipliers({inner, outer}, reduction, one);
}

/// A middle body with two faces, of one of which it is the slave; only the lowest is held.
TEST_F(Interfaces, OfAStackAgreeWithMultipliers)
{
   for (int which = 0; which < 4; ++which)
   {
      Truss low({side({2, 0}, {0, 0}, 3, 2)}, {1, -1}),
         middle({side({0, 0}, {2, 0}, 5, 1), side({2, 1}, {0, 1}, 2, 3)}, {1, 0.5}, 10),
         top({side({0, 1}, {2, 1}, 4, 1)}, {1, 2});
      low.hold().lift("lift");
      for (Truss *body : {&low, &middle, &top}) { body->load("P"); }
      top.load("Q");
      const auto slave = [](bool second)
      { return second ? SlaveSide::second : SlaveSide::first; };
      const std::vector<Interface> two{
         between(0, low.lines[0], 1, middle.lines[0], slave(which & 1)),
         between(1, middle.lines[1], 2, top.lines[0], slave(which & 2))};
      Reduction reduction = reduce({low.condensed(), middle.condensed(), top.condensed()}, two);
      EXPECT_EQ(reduction.problem.rigid_motions.cols(), 6);
      EXPECT_EQ(reduction.counters.factorisations, 3);
      EXPECT_EQ(reduction.problem.chains.size(), 2u);
      agrees_with_multipliers({low, middle, top}, reduction, two);
   }
}

/// Half of a model: on the plane of symmetry neither body slides, which is no row.
TEST_F(Interfaces, OnAPlaneOfSymmetryAgreeWithMultipliers)
{
   Truss upper({side({0, 0}, {2, 0}, 4, 2)}, {1, 1}), lower({side({2, 0}, {0, 0}, 5)}, {1, -1});
   upper.load("P");
   lower.hold().load("P");
   upper.fixed = {0}; // the first node of its line
   lower.fixed.insert(lower.fixed.begin(), 10);
   for (Truss *body : {&upper, &lower})
   {
      for (int dof : body->fixed) { body->loads[0].values[dof] = 0; }
   }
   for (SlaveSide slave : {SlaveSide::first, SlaveSide::second})
   {
      const std::vector<Interface> one{between(0, upper.lines[0], 1, lower.lines[0], slave)};
      Reduction reduction = reduce({upper.condensed(), lower.condensed()}, one);
      ASSERT_EQ(reduction.problem.held.size(), 1u);
      EXPECT_EQ(reduction.problem.rigid_motions.cols(),
                2); // up, and turning about a point of it
      const ContactChain &chain = reduction.problem.chains[0];
      const std::size_t end = slave == SlaveSide::first ? 0 : 1;
      EXPECT_TRUE(chain.mirrored_at(end));
      EXPECT_FALSE(chain.mirrored_at(1 - end));
      agrees_with_multipliers({upper, lower}, reduction, one);
   }
   lower.fixed.erase(lower.fixed.begin());
   expect_input_error(
      [&]
      {
         reduce({upper.condensed("pad"), lower.condensed()},
                {between(0, upper.lines[0], 1, lower.lines[0])});
      },
      "the contact node at (0, 0) is fixed along the line, but the side that it faces is not");
   // Unless it is free which side has the nodes.
   {
      std::vector<Interface> one{
         between(0, upper.lines[0], 1, lower.lines[0], SlaveSide::second)};
      const MatrixXd K = reduce({upper.condensed(), lower.condensed()}, one).problem.K;
      one[0].slave = SlaveSide::finer; // which would be the upper one, of 9 nodes on 6
      const Reduction reduction = reduce({upper.condensed(), lower.condensed()}, one);
      EXPECT_EQ(reduction.interfaces[0].bodies[0], 1);
      EXPECT_EQ(reduction.problem.K, K);
   }
   // In whatever order bodies come.
   expect_input_error(
      [&]
      {
         reduce({lower.condensed(), upper.condensed("pad")},
                {between(1, upper.lines[0], 0, lower.lines[0])});
      },
      "the contact node at (0, 0) is fixed along the line, but the side that it faces is not");
   upper.fixed = {1};
   expect_input_error(
      [&]
      {
         reduce({upper.condensed("pad"), lower.condensed()},
                {between(0, upper.lines[0], 1, lower.lines[0])});
      },
      "the contact node at (0, 0) is fixed normal to the line");
}

/// Bodies that stand side by side, clamped where their contact ends: that end carries no row,
/// and its neighbours its part. A node within the line that is clamped is refused as ever.
TEST_F(Interfaces, OfAClampedEndLeaveItOut)
{
   for (int elements : {4, 5}) // nodes that match, and that do not
   {
      Truss upper({side({0, 0}, {2, 0}, 4, 2)}, {1, 1}),
         lower({side({2, 0}, {0, 0}, elements, 2)}, {1, -1});
      upper.load("P");
      const int end = 4 * elements; // the last node of its line
      lower.hold().fixed.insert(lower.fixed.begin(), {end, end + 1});
      lower.load("P");
      upper.fixed = {0, 1};
      for (int dof : upper.fixed) { upper.loads[0].values[dof] = 0; }
      for (SlaveSide slave : {SlaveSide::first, SlaveSide::second})
      {
         const std::vector<Interface> one{between(0, upper.lines[0], 1, lower.lines[0], slave)};
         Reduction reduction = reduce({upper.condensed(), lower.condensed()}, one);
         const InterfaceReport &report = reduction.interfaces[0];
         EXPECT_EQ(report.nodes, slave == SlaveSide::first ? 8 : 2 * elements);
         ASSERT_EQ(report.without_row.size(), 1u);
         EXPECT_EQ(report.without_row[0].norm(), 0);
         EXPECT_NEAR(reduction.problem.weights.sum(), 2, 1e-12);
         EXPECT_EQ(reduction.problem.rigid_motions.cols(), 1); // about the clamped node
         agrees_with_multipliers({upper, lower}, reduction, one);
      }
      // Alone on a rigid line, too.
      const std::vector<Interface> alone{{"floor", {0, lower.lines[0]}, {}}};
      EXPECT_EQ(reduce({lower.condensed()}, alone).interfaces[0].nodes, 2 * elements);
      upper.fixed = {4, 5};
      expect_input_error(
         [&]
         {
            reduce({upper.condensed(), lower.condensed()},
                   {between(0, upper.lines[0], 1, lower.lines[0])});
         },
         "the contact node at (0.5, 0) is fixed normal to the line");
   }
}

/// An end of the slave that is clamped has a row all the same if the node that it is paired
/// with can open from it.
TEST_F(Interfaces, OfAClampedEndHaveItsRowIfThePartnerMoves)
{
   for (const bool opens : {true, false})
   {
      Truss upper({side({0, 0}, {2, 0}, 4, 2)}, {1, 1}),
         lower({side({2, 0}, {0, 0}, 4, 2)}, {1, -1});
      upper.load("P");
      lower.hold().load("P");
      upper.fixed = {0, 1};
      for (int dof : upper.fixed) { upper.loads[0].values[dof] = 0; }
      // The last node of the lower line, along the line or along and across it.
      const int end = 4 * 4;
      lower.fixed.insert(lower.fixed.begin(), end);
      lower.loads[0].values[end] = 0;
      if (!opens)
      {
         lower.fixed.insert(lower.fixed.begin() + 1, end + 1);
         lower.loads[0].values[end + 1] = 0;
      }
      const ContactLine &above = upper.lines[0], &below = lower.lines[0];
      Interface one = between(0, above, 1, below, SlaveSide::first);
      one.pairing = pair_lines(above, below);
      Reduction reduction = reduce({upper.condensed(), lower.condensed()}, {one});
      EXPECT_EQ(reduction.interfaces[0].nodes, opens ? 9 : 8);
      EXPECT_EQ(reduction.interfaces[0].without_row.size(), opens ? 0u : 1u);
   }
}

/// Both lips of a slit in one body, which have their tip in common: it carries no row.
TEST_F(Interfaces, OfABodyWithItselfLeaveOutTheTip)
{
   // Where the lips match the tip would face itself.
   for (int lower : {3, 4})
   {
      const int order = lower == 3 ? 2 : 1;
      Truss body({side({0, 0.01}, {2, 0}, 4), side({2, 0}, {0, -0.01}, lower, order)}, {3, 0});
      body.hold().load("P");
      const std::vector<Interface> one{between(0, body.lines[0], 0, body.lines[1])};
      Reduction reduction = reduce({body.condensed()}, one);
      ASSERT_EQ(reduction.interfaces[0].without_row.size(), 1u);
      EXPECT_EQ(reduction.interfaces[0].without_row[0], Vector2d(2, 0));
      EXPECT_EQ(reduction.problem.nodes(), 4);
      EXPECT_EQ(reduction.problem.chains[0].bodies, (std::array<int, 2>{0, 0}));
      agrees_with_multipliers({body}, reduction, one);
   }
}

/// Four bricks that meet at one point, all of whose sides touch: the last interface of the ring
/// has no row there, and a corner that is slave of one may be master of the next.
TEST_F(Interfaces, InARingLeaveOutARow)
{
   for (int trial = 0; trial < 6; ++trial)
   {
      const auto count = [&] { return 2 + trial % 2 + (random_number() > 0 ? 1 : 0); };
      std::vector<Truss> bricks;
      // Counter-clockwise from the first quadrant; each has a side on the one before and after.
      for (int q = 0; q < 4; ++q)
      {
         const Eigen::Rotation2Dd turn(M_PI / 2 * q);
         const auto made = [&](Vector2d a, Vector2d b)
         {
            return side((turn * a).array().round(), (turn * b).array().round(), count(),
                        1 + trial % 3);
         };
         bricks.emplace_back(
            std::vector<ContactLine>{made({0, 0}, {1, 0}), made({0, 1}, {0, 0})},
            turn * Vector2d(1, 1));
         bricks.back().load("P");
      }
      bricks[0].hold();
      std::vector<Interface> ring;
      for (int q = 0; q < 4; ++q)
      {
         ring.push_back(between(q, bricks[q].lines[1], (q + 1) % 4,
                                bricks[(q + 1) % 4].lines[0],
                                random_number() > 0 ? SlaveSide::first : SlaveSide::second));
      }
      std::vector<CondensedBody> condensed;
      for (const Truss &brick : bricks) { condensed.push_back(brick.condensed()); }
      Reduction reduction = reduce(condensed, ring);
      std::size_t without = 0;
      for (const InterfaceReport &report : reduction.interfaces)
      {
         without += report.without_row.size();
         for (const Vector2d &x : report.without_row) { EXPECT_EQ(x, Vector2d(0, 0)); }
      }
      EXPECT_GE(without, 1u);
      EXPECT_EQ(reduction.problem.rigid_motions.cols(), 9);
      agrees_with_multipliers(bricks, reduction, ring, 1e-9);
   }
}

/// A wall of bricks at random on a rigid floor, which is the obstacle of some.
TEST_F(Interfaces, OfManyBodiesAgreeWithMultipliers)
{
   for (int trial = 0; trial < 5; ++trial)
   {
      std::vector<Truss> bodies;
      std::vector<Interface> all;
      const int levels = 3 + trial;
      for (int k = 0; k < levels; ++k)
      {
         const double y = k;
         const int order = 1 + (k + trial) % 3;
         bodies.emplace_back(
            std::vector<ContactLine>{side({0.1 * k, y}, {2, y}, 2 + trial % 3, order),
                                     side({2, y + 1}, {0, y + 1}, 3, 1 + k % 2)},
            Vector2d(1, y + 0.5), std::pow(10, random_number()));
         bodies.back().load(k % 2 ? "P" : "Q");
         if (random_number() > 0.3 && k > 0) { bodies.back().hold(); }
      }
      all.push_back({"floor", {0, bodies[0].lines[0]}, {}, SlaveSide::first});
      for (int k = 1; k < levels; ++k)
      {
         all.push_back(between(k - 1, bodies[k - 1].lines[1], k, bodies[k].lines[0],
                               random_number() > 0 ? SlaveSide::first : SlaveSide::second));
      }
      std::vector<CondensedBody> condensed;
      for (const Truss &body : bodies) { condensed.push_back(body.condensed()); }
      Reduction reduction = reduce(condensed, all);
      agrees_with_multipliers(bodies, reduction, all);
   }
}

/// Nodes that match are what they were, to the last bit, at the same cost; and the union over
/// interfaces says the same of them.
TEST_F(Interfaces, WithNodesThatMatchAreThePairing)
{
   Truss upper({side({0, 0}, {2, 0}, 4, 2)}, {1, 1}),
      lower({side({2, 0}, {0, 0}, 4, 2)}, {1, -1}, 3);
   upper.load("P");
   lower.hold().load("P");
   const CondensedBody one = upper.condensed(), two = lower.condensed();
   const Pairing pairing = pair_lines(one.line, two.line);
   const Reduction before = reduce(one, two, pairing);
   const Reduction same = reduce({one, two}, {{"flank", {0, one.line}, {1, two.line}}});
   EXPECT_EQ(before.problem.K, same.problem.K);
   EXPECT_EQ(before.problem.patterns[0].p, same.problem.patterns[0].p);
   EXPECT_EQ(before.problem.H, same.problem.H);
   EXPECT_EQ(same.problem.chains[0].interface, "flank");
   EXPECT_TRUE(same.interfaces[0].matching);
   EXPECT_EQ(before.counters.unions, same.counters.unions);
   // By the other way round, and by the formula of many.
   const Reduction turned = reduce(two, one, pair_lines(two.line, one.line));
   const Reduction many =
      reduce({one, two}, {{"flank", {0, one.line}, {1, two.line}, SlaveSide::second}});
   EXPECT_LT(difference(many.problem.K, turned.problem.K), 1e-11);
   EXPECT_LT(difference(many.problem.patterns[0].p, turned.problem.patterns[0].p), 1e-11);
   EXPECT_LT(difference(many.problem.H, turned.problem.H), 1e-11);
   EXPECT_LT(
      difference(many.problem.rigid_motions * many.problem.rigid_motions.transpose(),
                 turned.problem.rigid_motions * turned.problem.rigid_motions.transpose()),
      1e-11);
}

/// Discs that touch, with nodes paired one to one where they part: stiffness, loads, gaps and
/// areas of the nodes are the same whichever is called the first.
TEST_F(Interfaces, OfPairedNodesKnowNoFirstBody)
{
   Truss left({line_along(circle({-1, 0}, 1), uniform_grid(-0.3, 0.3, 4), 2)}, {-1, 0.2}),
      right({line_along(circle({1.5, 0}, 1.5), uniform_grid(M_PI - 0.2, M_PI + 0.2, 4), 2)},
            {1.5, 0.1}, 3);
   left.load("P");
   right.hold().load("P");
   const CondensedBody one = left.condensed(), two = right.condensed();
   const Pairing pairing = pair_lines(one.line, two.line, 0.2);
   const Reduction by_one = reduce(one, two, pairing),
                   by_two = reduce(two, one, pair_lines(two.line, one.line, 0.2));
   const ReducedProblem &a = by_one.problem, &b = by_two.problem;
   const std::vector<int> &node = pairing.partner;
   std::vector<int> row = node;
   for (int k : node) { row.push_back(a.nodes() + k); }
   EXPECT_LT(difference(a.K, b.K(row, row)), 1e-12);
   EXPECT_LT(difference(a.H, b.H), 1e-12);
   EXPECT_LT(difference(a.patterns[0].q, b.patterns[0].q(node)), 1e-12);
   EXPECT_LT(difference(a.patterns[0].p, b.patterns[0].p(node)), 1e-12);
   EXPECT_LT(difference(a.gap, b.gap(node)), 1e-12);
   EXPECT_LT(difference(a.weights, b.weights(node)), 1e-14);
   // As far as circles of curvatures 1 and 2/3 are apart, to the fourth order in 0.3.
   for (Index i = 0; i < a.nodes(); ++i)
   {
      const double y = one.line.nodes[i].position[1];
      EXPECT_NEAR(a.gap[i], 0.5 * (1 + 1 / 1.5) * y * y, std::pow(0.3, 4) / 3);
   }
}

/// Bodies by hand, held, with nodes of which those of the one are stiff where those of the
/// other are soft: springs in series, (S1⁻¹ + S2⁻¹)⁻¹, with twice as many digits. Whichever of
/// two nodes depends on the other, it must be the softer one, node by node.
TEST_F(Interfaces, OfNodesThatAreSofterInTurnsLoseNoDigits)
{
   using Exact = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
   const int elements = 7, n = elements + 1;
   const auto body = [&](const Vector2d &from, const Vector2d &to, double left, double right)
   {
      CondensedBody made;
      made.line = side(from, to, elements);
      for (int k = 0; k < n; ++k) { made.line.nodes[k].dofs = {2 * k, 2 * k + 1}; }
      MatrixXd random(2 * n, 2 * n);
      for (double &x : random.reshaped()) { x = random_number(); }
      const VectorXd own = VectorXd::NullaryExpr(
         2 * n, [&](Index row)
         { return std::sqrt(made.line.nodes[row % n].position[0] < 1 ? left : right); });
      made.S = own.asDiagonal() *
               (random * random.transpose() + MatrixXd::Identity(2 * n, 2 * n)) *
               own.asDiagonal();
      made.S = (0.5 * (made.S + made.S.transpose())).eval();
      made.free_motions = MatrixXd::Zero(2 * n, 0);
      made.H = MatrixXd::Zero(0, 0);
      return made;
   };
   const CondensedBody upper = body({0, 0}, {2, 0}, 1e8, 1e-3),
                       lower = body({2, 0}, {0, 0}, 1e-4, 1e6);
   std::vector<int> turned; // rows of the lower one in the order of the upper one
   for (int row = 0; row < 2 * n; ++row) { turned.push_back(row - row % n + n - 1 - row % n); }
   const Exact S1 = upper.S.cast<long double>(),
               S2 = lower.S(turned, turned).cast<long double>(),
               S = (S1.inverse() + S2.inverse()).inverse();
   const MatrixXd K = S.cast<double>();
   const VectorXd own = K.diagonal().cwiseSqrt().cwiseInverse();
   const auto off = [&](const MatrixXd &found)
   { return (own.asDiagonal() * (found - K) * own.asDiagonal()).cwiseAbs().maxCoeff(); };
   const MatrixXd first = reduce(upper, lower, pair_lines(upper.line, lower.line)).problem.K,
                  second = reduce(lower, upper, pair_lines(lower.line, upper.line)).problem.K;
   EXPECT_LT(off(first), 1e-12);
   EXPECT_LT(off(second(turned, turned)), 1e-12);
   // As rows of a mortar, too.
   const std::vector<Interface> face{between(0, upper.line, 1, lower.line, SlaveSide::second)};
   EXPECT_LT(off(reduce({upper, lower}, face).problem.K(turned, turned)), 1e-12);
}

/// A body and its image in the contact line: tangential and normal displacements do not feel
/// each other, to the last bit, whichever is named first and whether one is held or both.
TEST_F(Interfaces, OfImagesAreExactlyUncoupled)
{
   const auto face = [](double up)
   {
      return side(up > 0 ? Vector2d(0, 0) : Vector2d(2, 0),
                  up > 0 ? Vector2d(2, 0) : Vector2d(0, 0), 6, 2);
   };
   Truss upper({face(1)}, {1, 1}), lower({face(-1)}, {1, -1});
   // The image of each point, and of each dof.
   std::vector<int> image(upper.size());
   for (std::size_t p = 0; p < upper.points.size(); ++p)
   {
      const bool on_line = p < upper.points.size() - 5;
      const std::size_t q = on_line ? upper.points.size() - 6 - p : p;
      lower.points[q] = {upper.points[p][0], -upper.points[p][1]};
      image[2 * p] = static_cast<int>(2 * q);
      image[2 * p + 1] = static_cast<int>(2 * q + 1);
   }
   for (int i = 0; i < upper.size(); ++i)
   {
      for (int j = 0; j < upper.size(); ++j)
      {
         const double sign = i % 2 == j % 2 ? 1 : -1;
         lower.K(image[i], image[j]) = sign * upper.K(i, j);
      }
   }
   for (int held : {0, 1, 2})
   {
      Truss a = upper, b = lower;
      if (held == 2)
      {
         a.hold();
         b.hold();
      }
      const CondensedBody one = a.condensed();
      CondensedBody other = b.condensed();
      if (held == 1) // springs on its rigid motions, which are along the contact or across it
      {
         other.S += other.free_motions * other.free_motions.transpose();
         other.free_motions.resize(other.S.rows(), 0);
      }
      const Index n = one.line.size();
      EXPECT_GT(one.S.bottomLeftCorner(n, n).cwiseAbs().maxCoeff(),
                1e-3 * one.S.cwiseAbs().maxCoeff()); // either is coupled
      for (const bool turned : {false, true})
      {
         const Reduction both =
            turned ? reduce({other, one}, {between(0, other.line, 1, one.line)})
                   : reduce({one, other}, {between(0, one.line, 1, other.line)});
         EXPECT_FALSE(both.problem.coupled) << held << turned;
         EXPECT_TRUE(both.problem.B().isZero(0)) << held << turned;
         both.problem.validate();
      }
   }
}

/// Two free bodies with nodes one to one across a gap turn together at no cost, which must not
/// make them slip, and there is nothing else that they have in common with relative motions.
TEST_F(Interfaces, OfFreeBodiesThatMatchAcrossAGapDoNotSlipAsTheyTurn)
{
   Truss above(
      {line_along(circle({0, 1}, 1), uniform_grid(-M_PI / 2 - 0.3, -M_PI / 2 + 0.3, 4), 2)},
      {0, 1}),
      below(
         {line_along(circle({0, -1}, 1), uniform_grid(M_PI / 2 - 0.3, M_PI / 2 + 0.3, 4), 2)},
         {0, -1});
   const CondensedBody one = above.condensed(), other = below.condensed();
   const Reduction both = reduce(one, other, pair_lines(one.line, other.line, 0.2));
   const ReducedProblem &problem = both.problem;
   problem.validate();
   ASSERT_GT(problem.gap.maxCoeff(), 0.05);
   const MatrixXd &Z = problem.rigid_motions;
   EXPECT_EQ(Z.cols(), 3);
   EXPECT_LT((problem.K * Z).cwiseAbs().maxCoeff(), 1e-13 * problem.K.cwiseAbs().maxCoeff());
   const MatrixXd rest = problem.K + Z * Z.transpose() * problem.K.trace();
   EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(rest).eigenvalues()[0],
             1e-4 * problem.K.trace() / static_cast<double>(problem.K.rows()));
}

/// Free bodies: what moves all of them together is at rest, loads in balance are carried, and
/// others are refused. A gap between curved sides turns nothing into slip.
TEST_F(Interfaces, OfFreeBodiesKnowTheirCommonMotions)
{
   for (double gap : {0.0, 0.05})
   {
      const ContactLine disc = line_along(circle({0, 0}, 1), uniform_grid(-1, 1, 5), 2),
                        ring = line_along(circle({0, 0}, 1 + gap, true),
                                          uniform_grid(-0.9, 0.9, 4), 2);
      Truss inner({disc}, {0, 0}), outer({ring}, {2, 0});
      inner.load("P");
      outer.load("P");
      // In balance on each body alone.
      const auto balance = [](Truss &body)
      {
         MatrixXd Z(body.size(), 3);
         for (int p = 0; p < body.size() / 2; ++p)
         {
            Z.row(2 * p) << 1, 0, -body.points[p][1];
            Z.row(2 * p + 1) << 0, 1, body.points[p][0];
         }
         VectorXd &f = body.loads[0].values;
         f -= Z * (Z.transpose() * Z).ldlt().solve(Z.transpose() * f);
      };
      expect_input_error(
         [&] {
            reduce({inner.condensed(), outer.condensed()}, {between(0, disc, 1, ring)});
         },
         "pushes body 0 and body 1 in a common rigid motion that nothing resists");
      balance(inner);
      balance(outer);
      const std::vector<Interface> one{between(0, disc, 1, ring)};
      Reduction reduction = reduce({inner.condensed(), outer.condensed()}, one);
      EXPECT_EQ(reduction.problem.rigid_motions.cols(), 3);
      reduction.problem.validate();
      // Nothing else is free: all other motions are resisted.
      const MatrixXd &Q = reduction.problem.rigid_motions;
      const MatrixXd K = reduction.problem.K + Q * Q.transpose() * reduction.problem.K.trace();
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues()[0], 1e-4);
   }
}

/// A stack that nothing holds, and loads that are in balance on the whole of it only.
TEST_F(Interfaces, OfAFreeStackAgreeWithMultipliers)
{
   std::vector<Truss> bodies{
      {{side({2, 0}, {0, 0}, 3, 2)}, {1, -1}},
      {{side({0, 0}, {2, 0}, 5, 1), side({2, 1}, {0, 1}, 2, 3)}, {1, 0.5}, 10},
      {{side({0, 1}, {2, 1}, 4, 1)}, {1, 2}}};
   for (const char *name : {"P", "Q", "R"})
   {
      MatrixXd Z(0, 3), f(0, 1);
      for (Truss &body : bodies)
      {
         body.load(name);
         for (Index p = 0; p < body.size() / 2; ++p)
         {
            Z.conservativeResize(Z.rows() + 2, 3);
            Z.bottomRows(2) << 1, 0, -body.points[p][1], 0, 1, body.points[p][0];
         }
         f.conservativeResize(Z.rows(), 1);
         f.bottomRows(body.size()) = body.loads.back().values;
      }
      f -= Z * (Z.transpose() * Z).ldlt().solve(Z.transpose() * f);
      Index first = 0;
      for (Truss &body : bodies)
      {
         body.loads.back().values = f.col(0).segment(first, body.size());
         first += body.size();
      }
   }
   const std::vector<Interface> two{
      between(0, bodies[0].lines[0], 1, bodies[1].lines[0]),
      between(1, bodies[1].lines[1], 2, bodies[2].lines[0], SlaveSide::second)};
   Reduction reduction =
      reduce({bodies[0].condensed(), bodies[1].condensed(), bodies[2].condensed()}, two);
   EXPECT_EQ(reduction.problem.rigid_motions.cols(), 6);
   agrees_with_multipliers(bodies, reduction, two);
}

/// Equal bodies, with all of their faces, have one factor.
TEST_F(Interfaces, OfEqualBodiesShareAFactor)
{
   const Truss upper({side({0, 0}, {2, 0}, 4), side({2, 1}, {0, 1}, 3)}, {1, 0.5});
   const CondensedBody one = upper.condensed();
   const CondensedBody two = upper.condensed("", &one);
   EXPECT_EQ(one.counters.factorisations + two.counters.factorisations, 1);
}

TEST_F(Interfaces, HaveTheNodesOfTheCoarserSideUnlessTheOtherIsNamed)
{
   Truss upper({side({0, 0}, {2, 0}, 4)}, {1, 1}), lower({side({2, 0}, {0, 0}, 3)}, {1, -1});
   lower.hold();
   const std::vector<CondensedBody> bodies{upper.condensed("pad"), lower.condensed("disc")};
   Interface face{"flank", {0, upper.lines[0]}, {1, lower.lines[0]}};
   const auto slave = [&](SlaveSide which)
   {
      face.slave = which;
      return reduce(bodies, {face}).interfaces[0].bodies[0];
   };
   EXPECT_EQ(slave(SlaveSide::coarser), 1);
   EXPECT_EQ(slave(SlaveSide::finer), 0);
   EXPECT_EQ(slave(SlaveSide::first), 0);
   EXPECT_EQ(slave(SlaveSide::second), 1);
}

/// A plate of one element on three blocks, of which the middle one lies between its nodes: only
/// that block's side can have the nodes, and has them where none is named. A place that is
/// named twice is refused all the same.
TEST_F(Interfaces, HaveTheNodesOfTheSideThatCan)
{
   Truss plate({side({0, 0}, {3, 0}, 3)}, {1.5, 1}), left({side({1, 0}, {0, 0}, 2)}, {0.5, -1}),
      middle({side({1.8, 0}, {1.2, 0}, 3)}, {1.5, -1}),
      right({side({3, 0}, {2, 0}, 2)}, {2.5, -1});
   for (Truss *block : {&left, &middle, &right}) { block->hold(); }
   plate.load("P");
   const std::vector<Truss> bodies{plate, left, middle, right};
   const std::vector<CondensedBody> condensed{plate.condensed("plate"), left.condensed("left"),
                                              middle.condensed("middle"),
                                              right.condensed("right")};
   const auto on = [&](int block, SlaveSide slave)
   {
      Interface made = between(0, plate.lines[0], block, bodies[block].lines[0], slave);
      made.name = condensed[block].name;
      return made;
   };
   using Sides = std::vector<Interface>;
   expect_input_error(
      [&]
      {
         reduce(condensed, Sides{on(1, SlaveSide::first), on(3, SlaveSide::first),
                                 on(2, SlaveSide::first)});
      },
      "interface 'middle' of body 'plate' and body 'middle': ");
   Sides faces{on(1, SlaveSide::first), on(3, SlaveSide::first), on(2, SlaveSide::coarser)};
   Reduction reduction = reduce(condensed, faces);
   EXPECT_EQ(reduction.interfaces[2].bodies, (std::array<int, 2>{2, 0}));
   EXPECT_TRUE(reduction.interfaces[2].of_second);
   EXPECT_EQ(reduction.interfaces[2].nodes, 4);
   faces[2].slave = SlaveSide::second;
   agrees_with_multipliers(bodies, reduction, faces);
   faces.push_back(on(2, SlaveSide::finer));
   expect_input_error([&] { reduce(condensed, faces); },
                      "body 'middle' there are in contact by");
}

/// A side that is longer than the other: what nothing faces is counted.
TEST_F(Interfaces, CountTheFreeSurface)
{
   Truss upper({side({0.5, 0}, {1.6, 0}, 3)}, {1, 1}),
      lower({side({2, 0}, {0, 0}, 8, 2)}, {1, -1});
   lower.hold();
   upper.load("P");
   const std::vector<Interface> one{between(1, lower.lines[0], 0, upper.lines[0])};
   Reduction reduction = reduce({upper.condensed(), lower.condensed()}, one);
   EXPECT_EQ(reduction.interfaces[0].free_surface.size(), 8u); // x < 0.5 and x > 1.6
   EXPECT_NEAR(reduction.problem.weights.sum(), 1.1, 1e-12);
   ASSERT_EQ(reduction.problem.chains.size(), 1u);
   EXPECT_EQ(reduction.problem.chains[0].ends,
             (std::array<LineEnd, 2>{LineEnd::smooth, LineEnd::smooth}));
   agrees_with_multipliers({upper, lower}, reduction, one);
}

TEST_F(Interfaces, RefuseWhatDoesNotFit)
{
   Truss upper({side({0, 0}, {2, 0}, 3)}, {1, 1}), lower({side({2, 0}, {0, 0}, 4)}, {1, -1});
   lower.hold();
   const CondensedBody pad = upper.condensed("pad"), disc = lower.condensed("disc");
   const ContactLine &one = upper.lines[0], &two = lower.lines[0];
   const auto refused = [&](const std::vector<Interface> &faces, const std::string &part) {
      expect_input_error([&] { reduce({pad, disc}, faces); }, part);
   };
   refused({{"flank", {0, one}, {2, two}}},
           "interface 'flank': a side names body 2, must be from 0 to 1");
   refused(
      {{"flank", {0, one}, {1, one}}},
      "interface 'flank' of body 'pad' and body 'disc': body 'disc' was not condensed to the "
      "node (0, 0), must be");
   refused({{"floor", {1, two}, {}}}, "body 'pad' is in no interface");
   refused({}, "2 bodies and 0 interfaces");
   Truss overlapping({side({2, 0.3}, {0, 0.3}, 4)}, {1, -1});
   overlapping.hold();
   expect_input_error(
      [&]
      {
         reduce({pad, overlapping.condensed("disc")},
                {{"flank", {0, one}, {1, overlapping.lines[0]}}});
      },
      "interface 'flank' of body 'pad' and body 'disc': the sides overlap by 0.3");
   // Asked to press it open.
   Interface open{"flank", {0, one}, {1, overlapping.lines[0]}};
   open.most_overlap = 1;
   EXPECT_NEAR(reduce({pad, overlapping.condensed()}, {open}).problem.gap.maxCoeff(), -0.3,
               1e-12);
   open.gap = 0.0;
   EXPECT_EQ(reduce({pad, overlapping.condensed()}, {open}).problem.gap.maxCoeff(), 0);
   // Turning about one node is not resisted.
   Truss small({side({0.9, 0}, {1.1, 0}, 1)}, {1, 1});
   small.lines[0].nodes.resize(2);
   expect_input_error(
      [&]
      {
         const std::vector<Interface> faces{between(1, two, 0, small.lines[0])};
         reduce({small.condensed("pad"), disc}, faces);
      },
      "can move without resistance even if every contact node is closed");
}

} // namespace
