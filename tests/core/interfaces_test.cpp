#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "line_along.hpp"

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/friction/loop.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

std::mt19937 random_numbers(7);
double random_number(double low = -1, double high = 1)
{
   return std::uniform_real_distribution<double>(low, high)(random_numbers);
}

class Interfaces : public testing::Test
{
   void SetUp() override { random_numbers.seed(7); } // whatever tests ran before
};

/** A body that no finite-element program made: points joined by bars, each to each, of random
    stiffnesses. Its points are the nodes of its lines, each once, and some more around a place.
    Rigid motions strain none. */
struct Truss
{
   std::vector<ContactLine> lines;
   std::vector<Vector2d> points;
   std::vector<int> fixed; ///< dofs
   MatrixXd K;
   std::vector<BodyLoad> loads;

   Truss(std::vector<ContactLine> sides, const Vector2d &around, double stiffness = 1)
      : lines(std::move(sides))
   {
      for (ContactLine &line : lines)
      {
         for (LineNode &node : line.nodes)
         {
            std::size_t p = 0;
            while (p < points.size() && (points[p] - node.position).norm() > 1e-9) { ++p; }
            if (p == points.size()) { points.push_back(node.position); }
            node.dofs = {2 * static_cast<int>(p), 2 * static_cast<int>(p) + 1};
         }
      }
      for (int k = 0; k < 5; ++k)
      {
         points.push_back(around +
                          Vector2d(random_number(-0.3, 0.3), random_number(-0.3, 0.3)));
      }
      const auto count = static_cast<int>(points.size());
      K = MatrixXd::Zero(2 * count, 2 * count);
      for (int p = 0; p < count; ++p)
      {
         for (int q = p + 1; q < count; ++q)
         {
            const Vector2d along = points[q] - points[p];
            const Eigen::Vector4d stretch =
               (Eigen::Vector4d() << -along, along).finished() / along.norm();
            const std::vector<int> dofs{2 * p, 2 * p + 1, 2 * q, 2 * q + 1};
            K(dofs, dofs) +=
               stiffness * random_number(0.5, 2) / along.norm() * stretch * stretch.transpose();
         }
      }
   }
   int size() const { return static_cast<int>(K.rows()); }
   /// Fixes two points inside.
   Truss &hold()
   {
      for (int k = 4; k > 0; --k) { fixed.push_back(size() - k); }
      return *this;
   }
   Truss &load(const std::string &name)
   {
      loads.push_back({name, Control::force, VectorXd(size())});
      for (double &force : loads.back().values) { force = random_number(); }
      for (int dof : fixed) { loads.back().values[dof] = 0; }
      return *this;
   }
   Truss &lift(const std::string &name)
   {
      loads.push_back({name, Control::displacement, VectorXd::Zero(size())});
      for (int dof : fixed) { loads.back().values[dof] = random_number(-0.1, 0.1); }
      return *this;
   }
   CondensedBody condensed(const std::string &name = "",
                           const CondensedBody *alike = nullptr) const
   {
      AssembledBody body;
      body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
      body.places = {VectorXd(size()), VectorXd(size()), {}, Formulation::plane};
      for (int dof = 0; dof < size(); ++dof)
      {
         body.places.x[dof] = points[dof / 2][0];
         body.places.y[dof] = points[dof / 2][1];
         body.places.component.push_back(dof % 2);
      }
      body.fixed = fixed;
      body.loads = loads;
      CondensedBody made = condense(body, joined(lines), alike);
      made.name = name;
      return made;
   }
};

/// Nodes of a line that stand at given places.
std::vector<int> at_places(const ContactLine &line, const std::vector<Vector2d> &places)
{
   std::vector<int> nodes;
   for (Index k = 0; k < line.size(); ++k)
   {
      for (const Vector2d &x : places)
      {
         if ((line.nodes[k].position - x).norm() < 1e-12) { nodes.push_back(int(k)); }
      }
   }
   return nodes;
}

/// Contact nodes know the dofs of their slave's nodes, and of no other body unless lines match.
void expect_dofs_of_nodes(const Reduction &reduction, const std::vector<Interface> &interfaces,
                          std::size_t bodies)
{
   const ReducedProblem &problem = reduction.problem;
   ASSERT_EQ(problem.dofs.cols(), Index(2 * bodies));
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      const InterfaceReport &report = reduction.interfaces[k];
      if (report.matching) { continue; }
      const InterfaceSide &slave =
         interfaces[k].slave == SlaveSide::first ? interfaces[k].first : interfaces[k].second;
      for (Index i = report.first; i < report.first + report.nodes; ++i)
      {
         const std::vector<int> at = at_places(slave.line, {problem.position.row(i)});
         ASSERT_EQ(at.size(), 1u);
         Eigen::RowVectorXi expected = Eigen::RowVectorXi::Constant(problem.dofs.cols(), -1);
         expected[2 * slave.body] = slave.line.nodes[at[0]].dofs[0];
         expected[2 * slave.body + 1] = slave.line.nodes[at[0]].dofs[1];
         EXPECT_EQ(problem.dofs.row(i), expected);
      }
   }
}

/** The whole of all bodies by Lagrange multipliers: rows of relative displacements, made of the
    dual functions and frames, tie all dofs of all bodies. Compares stiffness, loads, energies
    and fields of the reduction with it. `flip`: sides of the interfaces as (slave, master). */
void agrees_with_multipliers(const std::vector<Truss> &bodies, Reduction &reduction,
                             const std::vector<Interface> &interfaces, double tolerance = 1e-9)
{
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   const Index n = problem.nodes();
   std::vector<Index> offset{0};
   for (const Truss &body : bodies) { offset.push_back(offset.back() + body.size()); }
   const Index size = offset.back();
   MatrixXd G = MatrixXd::Zero(2 * n, size);
   Index row = 0;
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      const InterfaceReport &report = reduction.interfaces[k];
      ASSERT_EQ(report.first, row);
      const bool first = interfaces[k].slave == SlaveSide::first;
      const InterfaceSide &slave = first ? interfaces[k].first : interfaces[k].second,
                          &master = first ? interfaces[k].second : interfaces[k].first;
      const ContactLine &line = slave.line;
      if (master.body < 0)
      {
         for (const LineNode &node : line.nodes)
         {
            for (int c : {0, 1})
            {
               const Index column = offset[slave.body] + node.dofs[c];
               G(row, column) = node.tangent[c];
               G(n + row, column) = node.normal()[c];
            }
            ++row;
         }
         continue;
      }
      const Mortar found = mortar(line, master.line, at_places(line, report.without_row));
      ASSERT_EQ(report.nodes, Index(found.nodes.size()));
      for (Index i = 0; i < report.nodes; ++i, ++row)
      {
         const Vector2d t = found.tangent.row(i), normal(-t[1], t[0]);
         const auto add =
            [&](const InterfaceSide &side, const std::array<Mortar::Matrix, 2> &of, double sign)
         {
            for (int c : {0, 1})
            {
               for (Index j = 0; j < side.line.size(); ++j)
               {
                  const double share = sign * of[c].coeff(i, j);
                  const Index column = offset[side.body] + side.line.nodes[j].dofs[c];
                  G(row, column) += t[c] * share;
                  G(n + row, column) += normal[c] * share;
               }
            }
         };
         add(slave, found.own, 1);
         add(master, found.other, -1);
      }
   }
   ASSERT_EQ(row, n);
   expect_dofs_of_nodes(reduction, interfaces, bodies.size());
   for (Index held : problem.held) { G.row(held).setZero(); }
   const auto patterns = static_cast<Index>(problem.patterns.size());
   MatrixXd K = MatrixXd::Zero(size, size), F = MatrixXd::Zero(size, patterns),
            given = MatrixXd::Zero(size, patterns);
   std::vector<Index> rest;
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const Truss &body = bodies[b];
      K.block(offset[b], offset[b], body.size(), body.size()) = body.K;
      for (const BodyLoad &load : body.loads)
      {
         auto &values = load.control == Control::force ? F : given;
         values.block(offset[b], problem.pattern(load.name), body.size(), 1) += load.values;
      }
      for (int dof = 0; dof < body.size(); ++dof)
      {
         if (!std::count(body.fixed.begin(), body.fixed.end(), dof))
         {
            rest.push_back(offset[b] + dof);
         }
      }
   }
   const auto m = static_cast<Index>(rest.size());
   MatrixXd system = MatrixXd::Zero(m + 2 * n, m + 2 * n);
   const double unit = K.diagonal().mean();
   system << K(rest, rest), unit * G(Eigen::all, rest).transpose(), unit * G(Eigen::all, rest),
      MatrixXd::Zero(2 * n, 2 * n);
   const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(system);
   // Unit displacements, then unit multipliers.
   MatrixXd rhs = MatrixXd::Zero(m + 2 * n, 2 * n + patterns),
            u = MatrixXd::Zero(2 * n, rhs.cols());
   u.leftCols(2 * n).setIdentity();
   rhs.bottomLeftCorner(2 * n, 2 * n) = unit * MatrixXd::Identity(2 * n, 2 * n);
   for (Index held : problem.held) { rhs.row(m + held).setZero(); }
   rhs.topRightCorner(m, patterns) = F(rest, Eigen::all) - (K * given)(rest, Eigen::all);
   rhs.bottomRightCorner(2 * n, patterns) = -unit * G * given;
   const MatrixXd x = solver.solve(rhs);
   EXPECT_LT((system * x - rhs).cwiseAbs().maxCoeff(), 1e-9 * unit); // independent rows
   // K U - F = Gᵀ f
   MatrixXd f = -unit * x.bottomRows(2 * n);
   // What does not slide has any stiffness.
   for (Index held : problem.held) { f(held, held) = problem.K(held, held); }
   EXPECT_LT(difference(problem.K, f.leftCols(2 * n)), tolerance);
   for (Index k = 0; k < patterns; ++k)
   {
      VectorXd own(2 * n);
      own << problem.patterns[k].q, problem.patterns[k].p;
      EXPECT_LT(difference(own, f.col(2 * n + k)), tolerance) << problem.patterns[k].name;
   }
   // Fields and conjugates of something at random.
   VectorXd z(2 * n + patterns);
   for (double &value : z) { value = random_number(); }
   MatrixXd U = MatrixXd::Zero(size, 1);
   U(rest, Eigen::all) = x.topRows(m) * z;
   U += given * z.tail(patterns);
   // A motion that all bodies have in common is nobody's.
   const auto held = static_cast<Index>(problem.held.size());
   const bool moves = system.cols() - held > solver.rank();
   VectorXd strained = K * U.col(0);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const VectorXd field = reduction.displacement(static_cast<int>(b), z.head(n),
                                                    z.segment(n, n), z.tail(patterns));
      if (!moves)
      {
         EXPECT_LT(difference(field, U.middleRows(offset[b], bodies[b].size())), tolerance);
      }
      EXPECT_LT(difference(bodies[b].K * field, strained.segment(offset[b], bodies[b].size())),
                10 * tolerance);
   }
   // Forces that are in balance do no work on a common motion.
   for (Index k = 0; k < patterns; ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      const double work = pattern.q.dot(z.head(n)) + pattern.p.dot(z.segment(n, n));
      const VectorXd forces = K * U.col(0) - F * z.tail(patterns);
      const bool force = pattern.control == Control::force;
      const double direct = force ? F.col(k).dot(U.col(0)) : given.col(k).dot(forces);
      const double response = problem.H.row(k).dot(z.tail(patterns));
      EXPECT_NEAR(response + (force ? -work : work), direct, 1e-8 * (1 + std::abs(direct)))
         << pattern.name;
   }
}

Interface between(int a, const ContactLine &one, int b, const ContactLine &two,
                  SlaveSide slave = SlaveSide::first)
{
   return {"face", {a, one}, {b, two}, slave, std::nullopt, 1.0};
}

ContactLine side(const Vector2d &from, const Vector2d &to, int elements, int order = 1)
{
   return line_along(straight(from, to), uniform_grid(0, 1, elements), order);
}

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

/// A body that is cut in two along a line and tied there is the whole body.
TEST_F(Interfaces, ThatAreTiedMakeOneBody)
{
   Truss lower({side({0, 0}, {2, 0}, 4, 2), side({2, 1}, {0, 1}, 3, 2)}, {1, 0.5}),
      upper({side({0, 1}, {2, 1}, 3, 2)}, {1, 2});
   lower.load("P");
   upper.hold().load("Q").lift("D");
   // The whole: points of both, those of the cut once.
   Truss whole = lower;
   std::vector<int> own;
   for (std::size_t p = 0; p < upper.points.size(); ++p)
   {
      std::size_t found = 0;
      while (found < whole.points.size() &&
             (whole.points[found] - upper.points[p]).norm() > 1e-9)
      {
         ++found;
      }
      if (found == whole.points.size()) { whole.points.push_back(upper.points[p]); }
      own.push_back(2 * static_cast<int>(found));
      own.push_back(2 * static_cast<int>(found) + 1);
   }
   const auto size = static_cast<Index>(2 * whole.points.size());
   whole.K.conservativeResizeLike(MatrixXd::Zero(size, size));
   whole.K(own, own) += upper.K;
   for (int dof : upper.fixed) { whole.fixed.push_back(own[dof]); }
   whole.loads[0].values.conservativeResizeLike(VectorXd::Zero(size));
   for (const BodyLoad &load : upper.loads)
   {
      whole.loads.push_back({load.name, load.control, VectorXd::Zero(size)});
      whole.loads.back().values(own) = load.values;
   }
   Truss block({side({2, 0}, {0, 0}, 7)}, {1, -1});
   block.hold();
   std::vector<Interface> faces{
      {"floor", {0, lower.lines[0]}, {2, block.lines[0]}, SlaveSide::first},
      {"cut", {1, upper.lines[0]}, {0, lower.lines[1]}}};
   faces[1].tied = true;
   Reduction cut =
      reduce({lower.condensed("lower"), upper.condensed("upper"), block.condensed()}, faces);
   whole.lines.pop_back(); // is no line of it
   Reduction one =
      reduce({whole.condensed(), block.condensed()},
             {{"floor", {0, lower.lines[0]}, {1, block.lines[0]}, SlaveSide::first}});
   cut.problem.validate();
   ASSERT_EQ(cut.problem.nodes(), one.problem.nodes());
   EXPECT_LT(difference(cut.problem.K, one.problem.K), 1e-11);
   EXPECT_LT(difference(cut.problem.H, one.problem.H), 1e-11);
   for (const LoadPattern &load : one.problem.patterns)
   {
      const LoadPattern &same = cut.problem.patterns[cut.problem.pattern(load.name)];
      EXPECT_LT(difference(same.q, load.q), 1e-11);
      EXPECT_LT(difference(same.p, load.p), 1e-11);
   }
   VectorXd v(one.problem.nodes()), w = v, loads(3);
   for (VectorXd *some : {&v, &w, &loads})
   {
      for (double &value : *some) { value = random_number(); }
   }
   const VectorXd field = one.displacement(0, v, w, loads);
   EXPECT_LT(difference(cut.displacement(0, v, w, loads), field.head(lower.size())), 1e-11);
   EXPECT_LT(difference(cut.displacement(1, v, w, loads), field(own)), 1e-11);
   // What the cut transfers holds the upper part: forces of its bars and loads.
   ASSERT_TRUE(cut.interfaces[1].tied);
   const VectorXd f = cut.tied_forces(v, w, loads);
   const Index t = cut.interfaces[1].nodes;
   ASSERT_EQ(f.size(), 2 * t);
   VectorXd residual = upper.K * field(own);
   for (std::size_t k = 0; k < upper.loads.size(); ++k)
   {
      if (upper.loads[k].control == Control::force)
      {
         residual -= loads[cut.problem.pattern(upper.loads[k].name)] * upper.loads[k].values;
      }
   }
   const InterfaceReport &report = cut.interfaces[1];
   ASSERT_EQ(report.bodies[0], 1);
   for (Index i = 0; i < t; ++i)
   {
      const Vector2d along = report.tangent.row(i), into(-along[1], along[0]);
      const Vector2d force = f[i] * along + f[t + i] * into;
      Index p = 0;
      while ((upper.points[p] - Vector2d(report.position.row(i))).norm() > 1e-9) { ++p; }
      EXPECT_NEAR(residual[2 * p], force[0], 1e-10);
      EXPECT_NEAR(residual[2 * p + 1], force[1], 1e-10);
   }
}

/// Blocks are their points on a rigid motion: the energy's minimum over it, by dense algebra.
TEST_F(Interfaces, OfBodiesWithBlocksMinimiseOverTheirMotions)
{
   for (int moving = 1; moving <= 3; ++moving)
   {
      Truss truss({side({0, 0}, {2, 0}, 4, 2)}, {1, 1});
      truss.hold().load("P").load("Q").lift("D");
      truss.loads[2].values.setZero();
      const int size = truss.size();
      const std::vector<int> contact = [&]
      {
         std::vector<int> dofs;
         for (const LineNode &node : truss.lines[0].nodes)
         {
            dofs.insert(dofs.end(), node.dofs.begin(), node.dofs.end());
         }
         return dofs;
      }();
      // The two points that are held become a block: x, y, rotation; the rest of it is lifted.
      MatrixXd motions = MatrixXd::Zero(size, 3);
      for (int dof : truss.fixed)
      {
         const Vector2d &x = truss.points[dof / 2];
         motions(dof, dof % 2) = 1;
         motions(dof, 2) = dof % 2 ? x[0] - 1 : 1 - x[1];
      }
      if (moving < 3) { truss.loads[2].values = motions.col(2); }
      AssembledBody body;
      body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(truss.K.sparseView()));
      body.places = {VectorXd(size), VectorXd(size), {}, Formulation::plane};
      for (int dof = 0; dof < size; ++dof)
      {
         body.places.x[dof] = truss.points[dof / 2][0];
         body.places.y[dof] = truss.points[dof / 2][1];
         body.places.component.push_back(dof % 2);
      }
      body.fixed = truss.fixed;
      body.loads = truss.loads;
      if (moving == 3) { body.loads.pop_back(); }
      const auto loads = static_cast<Index>(body.loads.size());
      VectorXd force = VectorXd::Zero(moving);
      for (int k = 0; k < moving; ++k)
      {
         body.blocks.push_back({motions.col(k), k == 1 ? "Q" : "", k == 1 ? 3.5 : 0});
         if (k == 1) { force[k] = 3.5; }
      }
      CondensedBody found = condense(body, truss.lines[0]);
      EXPECT_EQ(found.rigid_modes, moving == 1 ? 1 : moving == 2 ? 2 : 3);
      // Unknowns: inner dofs, and the block's motions.
      std::vector<int> inner;
      for (int dof = 0; dof < size; ++dof)
      {
         if (!std::count(truss.fixed.begin(), truss.fixed.end(), dof) &&
             !std::count(contact.begin(), contact.end(), dof))
         {
            inner.push_back(dof);
         }
      }
      const auto inside = static_cast<Index>(inner.size());
      MatrixXd T = MatrixXd::Zero(size, inside + moving);
      for (Index k = 0; k < inside; ++k) { T(inner[k], k) = 1; }
      T.rightCols(moving) = motions.leftCols(moving);
      const Eigen::LDLT<MatrixXd> factor(T.transpose() * truss.K * T);
      // Contact displacements and multipliers are random.
      VectorXd u(contact.size()), lambda(loads), U = VectorXd::Zero(size);
      for (double &x : u) { x = random_number(); }
      for (double &x : lambda) { x = random_number(); }
      VectorXd F = VectorXd::Zero(size);
      for (Index k = 0; k < loads; ++k)
      {
         const BodyLoad &load = body.loads[k];
         (load.control == Control::force ? F : U) += lambda[k] * load.values;
      }
      for (std::size_t k = 0; k < contact.size(); ++k) { U[contact[k]] = u[k]; }
      VectorXd rhs = T.transpose() * (F - truss.K * U);
      rhs.tail(moving) += lambda[1] * force;
      U += T * factor.solve(rhs);
      // The line is along x: frames are the axes.
      const Index n = found.line.size();
      VectorXd local(2 * n);
      for (Index i = 0; i < n; ++i)
      {
         local[i] = u[2 * i];
         local[n + i] = u[2 * i + 1];
      }
      EXPECT_LT(difference(found.recover(local, lambda), U), 1e-10) << moving;
      const VectorXd residual = truss.K * U - F;
      VectorXd f = found.S * local;
      for (Index k = 0; k < loads; ++k)
      {
         VectorXd own(2 * n);
         own << found.patterns[k].q, found.patterns[k].p;
         f += lambda[k] * own;
      }
      for (Index i = 0; i < n; ++i)
      {
         EXPECT_NEAR(f[i], residual[2 * truss.lines[0].nodes[i].dofs[0] / 2], 1e-9);
         EXPECT_NEAR(f[n + i], residual[truss.lines[0].nodes[i].dofs[1]], 1e-9);
      }
      // The conjugate of the force on the block: how far it and its other forces moved.
      VectorXd g = found.H * lambda;
      const LoadPattern &Q = found.patterns[1];
      const double conjugate = g[1] - local.head(n).dot(Q.q) - local.tail(n).dot(Q.p);
      const double block = moving > 1 ? factor.solve(rhs)[inside + 1] : 0;
      EXPECT_NEAR(conjugate, truss.loads[1].values.dot(U) + 3.5 * block * (moving > 1), 1e-9);
      if (moving == 3) { EXPECT_GT(found.error_estimate(), 0); }
   }
}

/// A shank between two parts of a body is a spring of its stiffness matrix.
TEST_F(Interfaces, ShanksAreSprings)
{
   Truss body({side({0, 0}, {2, 0}, 4, 2)}, {1, 1});
   body.hold().load("P").load("T").lift("D").load("S");
   Truss stiff = body;
   const VectorXd first = body.loads[1].values, second = body.loads[3].values;
   stiff.K += 3 * first * first.transpose() + 0.2 * second * second.transpose();
   Reduction shanks = reduce(body.condensed()), springs = reduce(stiff.condensed());
   shanks.add_shank("T", 3);
   shanks.add_shank("S", 0.2);
   shanks.problem.validate();
   EXPECT_LT(difference(shanks.problem.K, springs.problem.K), 1e-11);
   EXPECT_LT(difference(shanks.problem.H, springs.problem.H), 1e-11);
   for (std::size_t k = 0; k < 4; ++k)
   {
      const LoadPattern &one = shanks.problem.patterns[k], &other = springs.problem.patterns[k];
      EXPECT_LT(difference(one.q, other.q), 1e-11);
      EXPECT_LT(difference(one.p, other.p), 1e-11);
   }
   VectorXd v(shanks.problem.nodes()), w = v, loads(4);
   for (VectorXd *some : {&v, &w, &loads})
   {
      for (double &value : *some) { value = random_number(); }
   }
   EXPECT_LT(
      difference(shanks.displacement(0, v, w, loads), springs.displacement(0, v, w, loads)),
      1e-11);
   expect_input_error([&] { shanks.add_shank("D", 1); }, "prescribes displacements");
   expect_input_error([&] { shanks.add_shank("P", -1); }, "its stiffness is -1");
}

/// An obstacle that is free to rise, under a force, and to turn, without one: with how far it
/// has gone put back, all is as on an obstacle at rest, and its own forces balance.
TEST_F(Interfaces, ObstaclesUnderForcesAreInEquilibrium)
{
   Truss body({side({0, 0}, {2, 0}, 5, 2)}, {1, 1});
   body.hold().load("P").lift("D");
   Reduction rest = reduce(body.condensed()), free = reduce(body.condensed());
   const auto up = [](double, double) { return 1.0; };
   const auto turns_x = [](double, double y) { return 0.5 - y; };
   const auto turns_y = [](double x, double) { return x - 0.7; };
   free.free_obstacles({{"Q", 3, {{0, 0.0, up}}}, {"", 1, {{0, turns_x, turns_y}}}});
   free.problem.validate();
   const Index n = rest.problem.nodes();
   MatrixXd D = MatrixXd::Zero(2 * n, 2);
   for (Index i = 0; i < n; ++i)
   {
      const Vector2d x = rest.interfaces[0].position.row(i),
                     t = rest.interfaces[0].tangent.row(i), normal(-t[1], t[0]);
      const Vector2d moves[] = {{0, 1}, {turns_x(0, x[1]), turns_y(x[0], 0)}};
      for (Index a : {0, 1})
      {
         D(i, a) = moves[a].dot(t);
         D(n + i, a) = moves[a].dot(normal);
      }
   }
   VectorXd u(2 * n), loads(3);
   for (VectorXd *some : {&u, &loads})
   {
      for (double &value : *some) { value = random_number(); }
   }
   const auto forces = [](const ReducedProblem &problem, const VectorXd &moved,
                          const VectorXd &by) -> VectorXd
   { return problem.K * moved + problem.clamped_forces(by); };
   const auto conjugate =
      [](const ReducedProblem &problem, const VectorXd &moved, const VectorXd &by)
   {
      ContactState state = ContactState::virgin(problem);
      state.v = moved.head(problem.slips());
      state.w = moved.tail(problem.nodes());
      state.multipliers = by;
      return conjugates(problem, state);
   };
   const VectorXd f = forces(free.problem, u, loads);
   EXPECT_NEAR(D.col(0).dot(f), 3 * loads[2], 1e-11);
   EXPECT_NEAR(D.col(1).dot(f), 0, 1e-11);
   // How far it turns makes the rest of the forces those of an obstacle at rest.
   const VectorXd g = conjugate(free.problem, u, loads);
   const double rises = g[2] / 3;
   const VectorXd left = f - forces(rest.problem, u + rises * D.col(0), loads.head(2)),
                  of_turn = rest.problem.K * D.col(1);
   const double turned = left.dot(of_turn) / of_turn.squaredNorm();
   EXPECT_LT(difference(left, turned * of_turn), 1e-11);
   const VectorXd U = u + rises * D.col(0) + turned * D.col(1);
   EXPECT_LT(difference(g.head(2), conjugate(rest.problem, U, loads.head(2))), 1e-11);
   const VectorXd field = free.displacement(0, u.head(n), u.tail(n), loads);
   EXPECT_LT(difference(field, rest.displacement(0, U.head(n), U.tail(n), loads.head(2))),
             1e-11);
   // What the contact puts on the nodes of the body is what its other forces leave.
   const Eigen::MatrixX2d on = rest.contact_forces(0, f.head(n), f.tail(n));
   VectorXd residual = body.K * field - loads[0] * body.loads[0].values;
   for (Index i = 0; i < n; ++i)
   {
      const LineNode &node = body.lines[0].nodes[i];
      EXPECT_NEAR(residual[node.dofs[0]], on(i, 0), 1e-10);
      EXPECT_NEAR(residual[node.dofs[1]], on(i, 1), 1e-10);
   }
   expect_input_error(
      [&] {
         free.free_obstacles({{"R", 1, {{0, 0.0, up}}}});
      },
      "they have been freed already");
   expect_input_error([&] { rest.free_obstacles({}); }, "there is no motion");
   // A force on the obstacle with the name of the body's load is one load with it, and so is a
   // motion of the obstacle with the name of a load that moves the body.
   VectorXd together = loads;
   together[2] = loads[0];
   Reduction joined = reduce(body.condensed());
   joined.free_obstacles({{"P", 3, {{0, 0.0, up}}}, {"", 1, {{0, turns_x, turns_y}}}});
   ASSERT_EQ(joined.problem.patterns.size(), 2u);
   joined.problem.validate();
   const auto expect_joined = [&](Reduction &one, Reduction &apart, Index load)
   {
      const VectorXd two = loads.head(2);
      EXPECT_LT(difference(forces(one.problem, u, two), forces(apart.problem, u, together)),
                1e-11);
      VectorXd expected = conjugate(apart.problem, u, together);
      expected[load] += expected[2];
      EXPECT_LT(difference(conjugate(one.problem, u, two), expected.head(2)), 1e-11);
      EXPECT_LT(difference(one.displacement(0, u.head(n), u.tail(n), two),
                           apart.displacement(0, u.head(n), u.tail(n), together)),
                1e-11);
   };
   expect_joined(joined, free, 0);
   Reduction moves = reduce(body.condensed()), apart = reduce(body.condensed());
   moves.add_obstacle_motion("D", turns_x, turns_y);
   apart.add_obstacle_motion("E", turns_x, turns_y);
   together[2] = loads[1];
   expect_joined(moves, apart, 1);
   expect_input_error(
      [&] {
         rest.free_obstacles({{"D", 1, {{0, 0.0, up}}}});
      },
      "a load pattern with this name exists already, and is controlled by displacement");
   expect_input_error(
      [&] {
         rest.free_obstacles({{"Q", 1, {{0, 0.0, up}}}, {"R", 1, {{0, 0.0, up}}}});
      },
      "the bodies do not resist all motions of the obstacles");
   const std::vector<Interface> floor{{"floor", {0, body.lines[0]}, {}}};
   Reduction named = reduce({body.condensed()}, floor);
   expect_input_error(
      [&] {
         named.free_obstacles({{"Q", 1, {{0, 0.0, up}}}, {"R", 1, {{0, 0.0, up}}}});
      },
      "all motions of the obstacles of interface 'floor': support");
}

/// Bolts that are tightened one after the other, under a load, and again: each has the force of
/// the history when its tightening ends, does nothing before, and is a spring afterwards. A
/// march is taken up from any of its states, amid a tightening too.
TEST_F(Interfaces, BoltsAreTightenedInTheOrderOfTheHistory)
{
   Truss body({side({0, 0}, {2, 0}, 6, 2)}, {1, 1});
   body.hold().load("P").load("T").load("S");
   Reduction loose = reduce(body.condensed(), 0.05);
   set_friction(loose.problem, 0.3);
   const BoltedJoint joint(loose, {{"T", 0.3}, {"S", 0.2}});
   const ReducedProblem &problem = joint.problem();
   const LoadHistory history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"T", 1}}, {{"S", 0.5}}, {{"P", 0.7}}, {{"T", 1.5}}, {{"P", 1}}});
   MarchSettings settings;
   settings.increments = 3;
   settings.loss_error = true;
   std::vector<ContactState> states;
   ContactState end = ContactState::virgin(problem);
   const MarchReport report = joint.march(
      history, end, settings,
      [&](const ContactState &state, const IncrementRecord &record)
      {
         states.push_back(state);
         EXPECT_EQ(record.multipliers, state.multipliers);
         EXPECT_LT(difference(record.conjugates, conjugates(problem, state)), 1e-12);
         EXPECT_NO_THROW(state.require_of(problem));
      });
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_EQ(report.time, 6);
   EXPECT_EQ(report.increments.size(), states.size());
   EXPECT_EQ(report.loss_error.value, 0);
   // The forces: as they are tightened, and between.
   const auto at = [&](double time)
   {
      return *std::find_if(states.begin(), states.end(),
                           [&](const ContactState &state) { return state.time == time; });
   };
   EXPECT_LT(joint.forces(at(1)).cwiseAbs().maxCoeff(), 1e-12);
   EXPECT_NEAR(joint.forces(at(2))[0], 1, 1e-12);
   EXPECT_NEAR(joint.forces(at(2))[1], 0, 1e-12);
   EXPECT_NEAR(joint.forces(at(3))[1], 0.5, 1e-12);
   EXPECT_GT(std::abs(joint.forces(at(3))[0] - 1), 1e-6); // what the other takes
   EXPECT_NEAR(joint.forces(at(5))[0], 1.5, 1e-12);
   EXPECT_EQ(at(6).multipliers.tail(2), at(5).multipliers.tail(2)); // nobody turns a nut
   // Before the second is there, the first is a force on a problem without either.
   ContactState alone = ContactState::virgin(loose.problem);
   march(loose.problem, LoadHistory::through(loose.problem, {{}, {{"P", 1}}, {{"T", 1}}}),
         alone, settings);
   EXPECT_LT(difference(alone.displacements(), at(2).displacements()), 1e-11);
   for (ContactState state : states)
   {
      if (state.time == 6) { continue; }
      EXPECT_EQ(joint.march(history, state, settings).status, FrictionStatus::converged);
      EXPECT_LT(difference(state.displacements(), end.displacements()), 1e-9) << state.time;
      EXPECT_LT(difference(joint.forces(state), joint.forces(end)), 1e-9);
   }
   // The other loads alone change it afterwards: as of the problem with both shanks.
   ContactState then = at(5);
   LoadHistory rest;
   rest.times = Eigen::Vector2d(5, 6);
   rest.multipliers.resize(3, 2);
   rest.multipliers << then.multipliers, then.multipliers;
   rest.multipliers(0, 1) = 1;
   rest.cycles = 1;
   march(joint.tightened().problem, rest, then, settings);
   EXPECT_LT(difference(then.displacements(), end.displacements()), 1e-11);
   // A stopped march says so, and bad input is named.
   std::atomic<bool> stop{true};
   settings.monitor.stop = &stop;
   ContactState none = ContactState::virgin(problem);
   EXPECT_EQ(joint.march(history, none, settings).status, FrictionStatus::stopped);
   const auto refused = [&](const std::vector<NamedLoads> &points, const std::string &says)
   {
      expect_input_error([&] { joint.march(LoadHistory::through(problem, points), none); },
                         says);
   };
   refused({{}, {{"T", 1}}}, "the bolt 'S' is never tightened");
   refused({{}, {{"T", -1}, {"S", 1}}}, "the bolt 'T' is tightened to -1");
   refused({{}, {{"T", 1}, {"S", 1}}, {{"T", 0}}},
           "the bolt 'T' is loosened at the last point");
}

/// A shank that pulls a free body down leaves it two motions of three.
TEST_F(Interfaces, ShanksResistWhatTheyPull)
{
   Truss upper({side({0, 0}, {2, 0}, 3)}, {1, 1}), lower({side({2, 0}, {0, 0}, 4)}, {1, -1});
   lower.hold();
   for (Truss *body : {&upper, &lower})
   {
      body->loads.push_back({"bolt", Control::force, VectorXd::Zero(body->size())});
      body->loads[0].values[1] = body == &upper ? -1 : 1; // of the first node, in y
   }
   lower.loads[0].values.setZero();
   Reduction reduction = reduce({upper.condensed(), lower.condensed()},
                                {between(1, lower.lines[0], 0, upper.lines[0])});
   ASSERT_EQ(reduction.problem.rigid_motions.cols(), 3);
   reduction.add_shank("bolt", 2.5);
   EXPECT_EQ(reduction.problem.rigid_motions.cols(), 2);
   reduction.problem.validate();
}

// Nodes that look straight down or down to the right, at sides that rise, are level, and rise.
TEST(ObstacleShape, PolylinesByHand)
{
   const double half = std::sqrt(0.5);
   const Vector2d level(1, 0), turned(half, half);
   const struct
   {
      Vector2d at, tangent;
      double gap;
   } nodes[] = {{{0.2, 2}, level, 1.8},
                {{0, 1}, turned, half},
                {{0.5, 0.2}, level, -0.3},
                {{-1, 0}, level, 1}, // it goes on
                {{1.5, 1.25}, level, 0.25},
                {{0.5, 2.5}, turned, 1.5 / half},
                {{0.5, 0}, turned, -0.25 / half},
                {{2.5, 3}, level, 1},
                {{4, 9}, level, 4}};
   InterfaceReport report;
   report.nodes = static_cast<Index>(std::size(nodes));
   report.position.resize(report.nodes, 2);
   report.tangent.resize(report.nodes, 2);
   for (Index i = 0; i < report.nodes; ++i)
   {
      report.position.row(i) = nodes[i].at;
      report.tangent.row(i) = nodes[i].tangent;
   }
   const VectorXd gaps = gaps_to_polyline(report, {{0, 0}, {1, 1}, {2, 1}, {3, 3}});
   for (Index i = 0; i < report.nodes; ++i) { EXPECT_NEAR(gaps[i], nodes[i].gap, 1e-14) << i; }
}

/// A side that ends in the direction of what the obstacle looks along is open there, whichever
/// way round-off turns its last normal, and one that looks away is not taken for it.
TEST_F(Interfaces, NodesThatLookAlongAnObstacleAreOpen)
{
   for (const double unit : {1e-3, 1.0, 1e3})
   {
      for (const double turned : {0.0, 1e-14, -1e-14, 1e-8, -1e-8, 1e-3, -1e-3, 0.05, -0.05})
      {
         InterfaceReport report;
         report.nodes = 2;
         report.position = (Eigen::MatrixX2d(2, 2) << 1, 1, 0, 0).finished() * unit;
         // The one looks to the right, the other down.
         report.tangent =
            (Eigen::MatrixX2d(2, 2) << std::sin(turned), std::cos(turned), 1, 0).finished();
         const VectorXd gaps = gaps_to_polyline(report, {{-unit, 0}, {unit, 0}});
         EXPECT_NEAR(gaps[0], unit / std::sin(5 * M_PI / 180), 1e-12 * unit) << turned;
         EXPECT_NEAR(gaps[1], 0, 1e-15);
         report.tangent.row(0) = Vector2d(std::sin(0.1), std::cos(0.1));
         EXPECT_NEAR(std::abs(gaps_to_polyline(report, {{-unit, 0}, {unit, 0}})[0]),
                     unit / std::sin(0.1), 1e-12 * unit);
      }
   }
}

} // namespace
