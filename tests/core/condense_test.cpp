#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "frame_of_bars.hpp"

#include <algorithm>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace
{

using namespace cattaneo;
using cattaneo_test::Frame;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Dofs that are neither in one list nor in the other.
std::vector<int> others(int size, const std::vector<int> &a, const std::vector<int> &b)
{
   std::vector<bool> in(size, false);
   for (int dof : a) { in[dof] = true; }
   for (int dof : b) { in[dof] = true; }
   std::vector<int> rest;
   for (int dof = 0; dof < size; ++dof)
   {
      if (!in[dof]) { rest.push_back(dof); }
   }
   return rest;
}

/// Fields of both bodies for given relative displacements, against what they must obey: the
/// relative displacements are there, nothing but contact and supports bears, contact forces are
/// those of the problem, and the conjugates are works.
void expect_fields_obey(Reduction &reduction, const std::vector<AssembledBody> &bodies,
                        const VectorXd &v, const VectorXd &w, const VectorXd &loads)
{
   const ReducedProblem &problem = reduction.problem;
   const auto n = problem.nodes();
   VectorXd u(2 * n);
   u << v, w;
   VectorXd f = problem.K * u + problem.clamped_forces(loads);
   for (Eigen::Index row : problem.held) { f[row] = 0; }
   // Over all bodies: what was moved, by what forces.
   VectorXd works = VectorXd::Zero(loads.size());
   MatrixXd apart = MatrixXd::Zero(n, 2);
   for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
   {
      const AssembledBody &body = bodies[b];
      const VectorXd U = reduction.displacement(b, v, w, loads);
      const Eigen::MatrixX2d contact = reduction.contact_forces(b, f.head(n), f.tail(n));
      VectorXd rest = body.K.view() * U;
      for (Eigen::Index i = 0; i < contact.rows(); ++i)
      {
         for (int c : {0, 1})
         {
            rest[reduction.bodies[b].line.nodes[i].dofs[c]] -= contact(i, c);
         }
      }
      for (std::size_t k = 0; k < body.loads.size(); ++k)
      {
         const int pattern = problem.pattern(body.loads[k].name);
         if (body.loads[k].control == Control::force)
         {
            rest -= loads[pattern] * body.loads[k].values;
            works[pattern] += body.loads[k].values.dot(U);
         }
      }
      const double scale = (body.K.view() * U).cwiseAbs().maxCoeff();
      for (int dof = 0; dof < rest.size(); ++dof)
      {
         const bool fixed = std::binary_search(body.fixed.begin(), body.fixed.end(), dof);
         double moved = 0;
         for (const BodyLoad &load : body.loads)
         {
            if (load.control == Control::force || !fixed) { continue; }
            const int pattern = problem.pattern(load.name);
            moved += loads[pattern] * load.values[dof];
            works[pattern] += load.values[dof] * rest[dof];
         }
         if (fixed) { EXPECT_NEAR(U[dof], moved, 1e-12); }
         else { EXPECT_NEAR(rest[dof], 0, 1e-11 * scale) << "body " << b << ", dof " << dof; }
      }
      for (Eigen::Index i = 0; i < n; ++i) // nodes lie at the same places
      {
         for (int c : {0, 1})
         {
            const Eigen::RowVector2d place = problem.position.row(i);
            int dof = -1;
            for (int k = 0; k < U.size(); ++k)
            {
               const double x = body.places.x[k] - place[0], y = body.places.y[k] - place[1];
               if (std::hypot(x, y) < 1e-9 && body.places.component[k] == c) { dof = k; }
            }
            ASSERT_GE(dof, 0);
            apart(i, c) += (b == 0 ? 1 : -1) * U[dof];
         }
      }
   }
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const bool held = std::count(problem.held.begin(), problem.held.end(), i) > 0;
      if (!held) { EXPECT_NEAR(apart(i, 0), v[i], 1e-11); }
      EXPECT_NEAR(apart(i, 1), w[i], 1e-11);
   }
   // Works of the loads: of forces along what they push, of prescribed displacements of the
   // supports along what they move.
   VectorXd known = problem.H * loads;
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadPattern &load = problem.patterns[k];
      const double done = load.q.dot(v) + load.p.dot(w);
      known[k] += load.control == Control::force ? -done : done;
      EXPECT_NEAR(known[k], works[k], 1e-10 * works.cwiseAbs().maxCoeff()) << load.name;
   }
}

// A load pushes the end of the upper body, and with it a node of the contact.
TEST(CondenseMatrix, ALoadMovesContactNodes)
{
   const Frame above(4, 3, true), below(4, 3, false, 2);
   for (const bool both : {false, true})
   {
      AssembledBody upper = above.body(false), lower = below.body(true);
      VectorXd push = VectorXd::Zero(24);
      for (int row = 0; row < 3; ++row)
      {
         upper.fixed.push_back(2 * (4 * row + 3));
         push[upper.fixed.back()] = 0.7;
      }
      upper.loads.push_back({"push", Control::displacement, push});
      std::vector<AssembledBody> bodies{upper, lower};
      if (both)
      {
         // The node that it faces is held: they cannot follow each other.
         const int facing = 2 * (4 * 2 + 3);
         bodies[1].fixed.push_back(facing);
         std::sort(bodies[1].fixed.begin(), bodies[1].fixed.end());
      }
      CondensedBody one = condense(bodies[0], above.line()),
                    two = condense(bodies[1], below.line());
      EXPECT_EQ(one.moved.rows(), 8);
      EXPECT_EQ(one.moved(3, 1), 0.7);
      EXPECT_EQ(one.moved.cwiseAbs().sum(), 0.7);
      EXPECT_EQ(two.moved.size(), 0);
      EXPECT_NE(one.line.chains[0].ends[1], LineEnd::symmetry);
      Reduction reduction = reduce(one, two, pair_lines(one.line, two.line, 1e-6));
      const auto &moved = reduction.interfaces[0].moved;
      ASSERT_EQ(moved.size(), both ? 1u : 0u);
      if (both)
      {
         EXPECT_EQ(moved[0].node, 3);
         EXPECT_EQ(reduction.problem.patterns[moved[0].pattern].name, "push");
      }
      VectorXd v(4), w(4), loads(3);
      v << 0.3, -0.1, 0.2, both ? 0 : 0.4;
      w << 0.05, -0.2, 0.1, 0.3;
      loads << 1.3, 0.4, -0.6;
      expect_fields_obey(reduction, bodies, v, w, loads);
      if (both) { continue; }
      // With a shank between both bodies as well: the same, once its force is known.
      Reduction bolted = reduction;
      bolted.add_shank("pull", 0.05);
      VectorXd u(8);
      u << v, w;
      const ReducedProblem &free = reduction.problem, &joined = bolted.problem;
      const int k = free.pattern("pull");
      // N = T - s g, with g by the problem without a shank under N.
      VectorXd f(8);
      f << free.patterns[k].q, free.patterns[k].p;
      const VectorXd others = free.H.row(k).transpose().cwiseProduct(loads);
      const double rest = others.sum() - others[k] - f.dot(u),
                   N = (loads[k] - 0.05 * rest) / (1 + 0.05 * free.H(k, k));
      VectorXd acting = loads;
      acting[k] = N;
      const VectorXd expected = free.K * u + free.clamped_forces(acting),
                     found = joined.K * u + joined.clamped_forces(loads);
      EXPECT_LT((expected - found).norm(), 1e-11 * expected.norm());
      EXPECT_LT(
         (bolted.displacement(0, v, w, loads) - reduction.displacement(0, v, w, acting)).norm(),
         1e-11);
   }
}

// On a rigid floor the node that is moved cannot slip against anything that gives way.
TEST(CondenseMatrix, ALoadMovesANodeAlongARigidFloor)
{
   const Frame frame(4, 3, true);
   AssembledBody body = frame.body(false);
   VectorXd push = VectorXd::Zero(24);
   for (int row = 0; row < 3; ++row)
   {
      body.fixed.push_back(2 * (4 * row + 3));
      push[body.fixed.back()] = 0.7;
   }
   body.loads.push_back({"push", Control::displacement, push});
   Reduction reduction = reduce(condense(body, frame.line()));
   ASSERT_EQ(reduction.interfaces[0].moved.size(), 1u);
   EXPECT_EQ(reduction.interfaces[0].moved[0].node, 3);
   VectorXd v(4), w(4), loads(2);
   v << 0.3, -0.1, 0.2, 0;
   w << 0.05, -0.2, 0.1, 0.3;
   loads << 1.3, -0.6;
   expect_fields_obey(reduction, {body}, v, w, loads);
}

// A body that is thickened takes as many times the forces; pressures do not change.
TEST(CondenseMatrix, BodiesHaveAThickness)
{
   const Frame above(4, 3, true), below(4, 3, false, 2);
   CondensedBody one = condense(above.body(false), above.line()),
                 two = condense(below.body(true), below.line());
   const double error = one.error_estimate();
   const Pairing pairs = pair_lines(one.line, two.line, 1e-6);
   const ReducedProblem thin = reduce(one, two, pairs).problem;
   one.thicken(2);
   one.thicken(2.5);
   EXPECT_EQ(one.thickness, 5);
   EXPECT_NEAR(one.error_estimate(), error, 1e-12);
   two.thicken(5);
   const ReducedProblem thick = reduce(one, two, pairs).problem;
   EXPECT_LT((thick.K - 5 * thin.K).norm(), 1e-12 * thick.K.norm());
   EXPECT_LT((thick.H - 5 * thin.H).norm(), 1e-12 * thick.H.norm());
   EXPECT_LT((thick.patterns[0].p - 5 * thin.patterns[0].p).norm(),
             1e-12 * thick.patterns[0].p.norm());
   EXPECT_EQ(thick.weights, 5 * thin.weights);
   two.thicken(0.4); // to 2: the thinner one counts
   EXPECT_LT((reduce(one, two, pairs).problem.weights - 2 * thin.weights).norm(), 1e-13);
   expect_input_error([&] { one.thicken(0); },
                      "factor of the thickness is 0, must be positive");
}

TEST(CondenseMatrix, IsTheSchurComplementOfItsBlocks)
{
   for (const bool above : {true, false})
   {
      const Frame frame(5, 4, above);
      const AssembledBody body = frame.body(true);
      CondensedBody condensed = condense(body, frame.line());
      const std::vector<int> C = frame.contact(), D = body.fixed,
                             I = others(2 * frame.points(), C, D);
      const auto inner = MatrixXd(frame.K(I, I)).llt();
      const double side = above ? 1 : -1; // of the line's frames
      const MatrixXd S = frame.K(C, C) - frame.K(C, I) * inner.solve(MatrixXd(frame.K(I, C)));
      EXPECT_LT(difference(condensed.S, S), 1e-13);
      EXPECT_EQ(condensed.rigid_modes, 0);
      EXPECT_LT(condensed.error_estimate(), 1e-11);
      EXPECT_EQ(condensed.counters.factorisations, 1);

      const VectorXd &F = body.loads[0].values, d = body.loads[1].values(D);
      const VectorXd u = VectorXd::LinSpaced(10, 1, 2).array().sin(),
                     m = Eigen::Vector2d(2, -3);
      const VectorXd field = condensed.recover(u, m);
      EXPECT_LT((field(C) - side * u).norm(), 1e-15);
      EXPECT_LT((field(D) + 3 * d).norm(), 1e-15);
      // Interior equilibrium, and the forces at the contact.
      const VectorXd forces = frame.K * field - 2 * F;
      EXPECT_LT(forces(I).norm(), 1e-12 * forces.norm());
      VectorXd expected = condensed.S * u;
      for (int k : {0, 1})
      {
         const LoadPattern &pattern = condensed.patterns[k];
         expected.head(5) += m[k] * pattern.q;
         expected.tail(5) += m[k] * pattern.p;
      }
      EXPECT_LT((side * forces(C) - expected).norm(), 1e-12 * forces.norm());
      // Work of the pull at its own response with the contact clamped.
      EXPECT_NEAR(condensed.H(0, 0), VectorXd(F(I)).dot(inner.solve(VectorXd(F(I)))), 1e-11);
   }
}

TEST(CondenseMatrix, AFreeBodyKeepsItsRigidMotions)
{
   const Frame frame(6, 3, true);
   const CondensedBody condensed = condense(frame.body(false), frame.line());
   EXPECT_EQ(condensed.rigid_modes, 3);
   EXPECT_LT((condensed.S * condensed.rigid_motions()).norm(), 1e-13);
   // The loads' resultant and moment about the origin are those of the contact.
   const LoadPattern &pull = condensed.patterns[0];
   const VectorXd F = frame.body(false).loads[0].values;
   double fx = 0, fy = 0, moment = 0;
   for (int p = 0; p < frame.points(); ++p)
   {
      fx += F[2 * p];
      fy += F[2 * p + 1];
      moment += frame.x[p] * F[2 * p + 1] - frame.y[p] * F[2 * p];
   }
   EXPECT_NEAR(pull.q.sum(), -fx, 1e-13);
   EXPECT_NEAR(pull.p.sum(), -fy, 1e-13);
   EXPECT_NEAR(pull.p.dot(frame.line().each(&LineNode::position).col(0)), -moment, 1e-12);
}

TEST(StiffnessError, OfAFreeTwistByHand)
{
   // Rings about an axis, each sprung to the next: what turns them all alike meets nothing.
   const int rings = 5;
   MatrixXd K = MatrixXd::Zero(rings, rings);
   for (int i = 0; i + 1 < rings; ++i)
   {
      K.block(i, i, 2, 2) += (i + 1) * Eigen::Matrix2d{{1, -1}, {-1, 1}};
   }
   AssembledBody body;
   body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   body.places = {VectorXd::LinSpaced(rings, 1, 3), VectorXd::Zero(rings),
                  std::vector<int>(rings, 0), Formulation::torsion};
   ContactLine line;
   line.formulation = Formulation::torsion;
   line.chains = {{0, 3}};
   for (int i = 0; i < 3; ++i)
   {
      const double r = body.places.x[i];
      line.nodes.push_back({{i, -1}, {r, 0}, {1, 0}, r, 0.5 * i, 0.5});
   }
   CondensedBody condensed = condense(body, line);
   EXPECT_EQ(condensed.rigid_modes, 1);
   // u_θ = r ψ and q = M / r; the rings beyond the third follow it without a moment.
   const Eigen::Vector3d r = line.each(&LineNode::position).col(0);
   const Eigen::Matrix3d chain{{1, -1, 0}, {-1, 3, -2}, {0, -2, 2}};
   const Eigen::Matrix3d expected =
      r.cwiseInverse().asDiagonal() * chain * r.cwiseInverse().asDiagonal();
   EXPECT_LT(difference(condensed.S, expected), 1e-14);
   EXPECT_LT(condensed.error_estimate(), 1e-12);
   condensed.S *= 1.001;
   EXPECT_GT(condensed.error_estimate(), 0.99e-3);
   EXPECT_LT(condensed.error_estimate(), 0.1); // as sharp as of a plane body, on the whole
}

TEST(CondenseMatrix, TwoBodiesAreSpringsInSeries)
{
   const Frame upper(5, 4, true), lower(5, 3, false, 2);
   const CondensedBody first = condense(upper.body(true), upper.line()),
                       second = condense(lower.body(true), lower.line());
   const Reduction both = reduce(first, second, pair_lines(first.line, second.line));
   // The lower one's nodes run the other way, its frames are turned by 180°.
   std::vector<int> turned;
   for (int k = 0; k < 10; ++k) { turned.push_back(k / 5 * 5 + 4 - k % 5); }
   const MatrixXd series =
      (first.S.inverse() + MatrixXd(second.S(turned, turned)).inverse()).inverse();
   EXPECT_LT(difference(both.problem.K, series), 1e-11);
   EXPECT_EQ(both.problem.gap, VectorXd::Zero(5));
   EXPECT_EQ(both.counters.factorisations, 2);
}

TEST(CondenseMatrix, ArraysOfAnyProgramAreTakenAsTheyAre)
{
   // Columns of a row in any order, which every program has its own of; and the factor of an
   // equal body is shared.
   const Frame frame(4, 4, true);
   const AssembledBody body = frame.body(true);
   const SparseView K = body.K.view();
   std::vector<int> start{0}, column;
   std::vector<double> value;
   for (int row = 0; row < K.rows(); ++row)
   {
      for (int k = K.outerIndexPtr()[row + 1]; k-- > K.outerIndexPtr()[row];)
      {
         column.push_back(K.innerIndexPtr()[k]);
         value.push_back(K.valuePtr()[k]);
      }
      start.push_back(static_cast<int>(column.size()));
   }
   AssembledBody other = body;
   other.K = SharedMatrix(body.K.size(), start.data(), column.data(), value.data(), nullptr);
   const CondensedBody first = condense(body, frame.line()),
                       second = condense(other, frame.line()),
                       third = condense(other, frame.line(), &second),
                       fourth = condense(other, frame.line(), &first);
   EXPECT_LT(difference(second.S, first.S), 1e-14);
   EXPECT_EQ(third.S, second.S);
   EXPECT_EQ(third.counters.factorisations, 0);
   EXPECT_EQ(fourth.counters.factorisations, 1); // not the same arrays
   EXPECT_LT(difference(fourth.S, first.S), 1e-13);
}

TEST(StiffnessProbes, BoundByHand)
{
   // A spring of 4 has L = 2. For one between two nodes a motion of both counts for nothing.
   const double factor = 10 * std::sqrt(2 / std::acos(-1.0));
   const StiffnessProbes spring(MatrixXd::Constant(1, 1, 4), MatrixXd(1, 0));
   EXPECT_EQ(spring.motions().rows(), 1);
   EXPECT_NEAR(spring.bound(Eigen::RowVector3d(0.1, -0.6, 0.2)), factor * 0.3, 1e-14);
   const Eigen::Vector2d both = Eigen::Vector2d::Ones().normalized();
   const StiffnessProbes between(Eigen::Matrix2d{{1, -1}, {-1, 1}}, both);
   EXPECT_LT(between.motions().colwise().sum().norm(), 1e-14);
   EXPECT_LT(between.bound(Eigen::Vector2d(3, 3)), 1e-14);
   EXPECT_NEAR(between.bound(Eigen::Vector2d(5, 3)), factor, 1e-14); // √2 over √2
   EXPECT_EQ(spring.bound(MatrixXd::Constant(1, 3, NAN)),
             std::numeric_limits<double>::infinity());
}

TEST(StiffnessError, OfAStiffnessThatIsWrongByHand)
{
   const Frame frame(4, 3, true);
   const AssembledBody body = frame.body(true);
   const std::vector<int> contact = frame.contact();
   std::vector<int> keep = others(body.K.size(), contact, body.fixed);
   keep.insert(keep.end(), contact.begin(), contact.end());
   const auto m = static_cast<int>(contact.size());
   const SparseFactor factor(body.K.view(), keep, m, 0);
   const MatrixXd S = factor.schur(), none(m, 0);
   const auto error = [&](const MatrixXd &claimed)
   { return stiffness_error(body.K, keep, m, factor, claimed, none); };
   EXPECT_LT(error(S), 1e-12);
   for (const double wrong : {1e-6, -1e-3})
   {
      // The energy of every motion is wrong by that, and the vectors have m entries of size 1.
      const double size = std::abs(wrong) / (1 + wrong), estimate = error((1 + wrong) * S);
      EXPECT_GE(estimate, size);
      EXPECT_LT(estimate, 10 * std::sqrt(2.0 * m) * size);
   }
   // It pushes on where the body resists.
   EXPECT_EQ(error(-S), std::numeric_limits<double>::infinity());
}

// Entries are known to half a unit of their last digit. All that is computed of these is exact,
// and still their Schur complement 1 - 1/4 - 1/16 is known no better than 1 to its last digit.
TEST(StiffnessError, IsNoLessThanWhatTheMatrixKnows)
{
   MatrixXd K(4, 4);
   K << 4, 0, -1, 0, 0, 16, -1, 0, -1, -1, 1, 0, 0, 0, 0, 1;
   const SharedMatrix shared(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   const std::vector<int> keep{0, 1, 2, 3};
   const SparseFactor factor(shared.view(), keep, 2, 0);
   const MatrixXd S = factor.schur();
   ASSERT_EQ(S, MatrixXd(Eigen::Vector2d(0.6875, 1).asDiagonal()));
   EXPECT_GE(stiffness_error(shared, keep, 2, factor, S, MatrixXd(2, 0)),
             0.5 * std::numeric_limits<double>::epsilon() / 0.6875);
}

TEST(CondenseMatrix, SaysWhatIsWrongOfALine)
{
   const Frame frame(4, 3, true);
   ContactLine line = frame.line();
   LineElement element;
   element.nodes = {0, 1, 2, 3};
   element.points = line.each(&LineNode::position).transpose();
   line.chains[0].elements = {element};
   EXPECT_EQ(condense(frame.body(true), line).S, condense(frame.body(true), frame.line()).S);
   const auto refused = [&](const char *said, const auto &spoil)
   {
      ContactLine spoilt = line;
      spoil(spoilt);
      expect_input_error([&] { condense(frame.body(true), spoilt); }, said);
   };
   refused("it has no nodes", [](auto &l) { l.nodes.clear(); });
   refused("node 2 is at (nan, 0)", [](auto &l) { l.nodes[2].position[0] = NAN; });
   refused("tangent at (1, 0) has the length 2", [](auto &l) { l.nodes[1].tangent[0] = 2; });
   refused("weight of the node at (3, 0) is 0", [](auto &l) { l.nodes[3].weight = 0; });
   refused("spacing at (3, 0) is -1", [](auto &l) { l.nodes[3].spacing = -1; });
   refused("arc length of the node at (0, 0) is inf",
           [](auto &l) { l.nodes[0].arc_length = INFINITY; });
   refused("the chains have 3 nodes, must have all 4",
           [](auto &l)
           {
              l.chains[0].nodes = 3;
              l.chains[0].elements.clear();
           });
   refused("is node 3 of the line, must be node 3 (the chain ends at node 2)",
           [](auto &l) { l.chains[0].nodes = 3; });
   refused("a chain of 4 nodes begins at node 1", [](auto &l) { l.chains[0].first = 1; });
   refused("a chain of 5 nodes begins at node 0", [](auto &l) { l.chains[0].nodes = 5; });
   refused("has 3 nodes and 4 points",
           [](auto &l) { l.chains[0].elements[0].nodes.pop_back(); });
   refused("node 1 of element 0 of the chain from node 0 is node 2 of the line, must be node 1",
           [](auto &l) { l.chains[0].elements[0].nodes[1] = 2; });
   refused("node 3 of element 0", [](auto &l) { l.chains[0].elements[0].points(1, 3) = 1; });
   refused("end before node 3, must end at node 3",
           [](auto &l)
           {
              l.chains[0].elements[0].nodes.pop_back();
              l.chains[0].elements[0].points.conservativeResize(2, 3);
           });
   refused("is axisymmetric, the body plane",
           [](auto &l)
           {
              l.formulation = Formulation::axisymmetric;
              for (LineNode &node : l.nodes) { node.position[0] += 1; }
              l.chains[0].elements.clear();
           });
   refused("have x > 0 if there is an axis",
           [](auto &l) { l.formulation = Formulation::torsion; });
}

TEST(CondenseMatrix, ALineIsWhereItsDofsAre)
{
   const Frame frame(4, 3, true);
   const AssembledBody body = frame.body(true);
   const auto refused = [&](const char *said, const auto &spoil)
   {
      ContactLine line = frame.line();
      spoil(line);
      expect_input_error([&] { condense(body, line); }, said);
   };
   refused("dof 3, given as component x of node 1 of the line, at (1, 0), is component y of "
           "the node "
           "(1, 0) of the body",
           [](auto &l) { std::swap(l.nodes[1].dofs[0], l.nodes[1].dofs[1]); });
   refused("dof 4, given as component x of node 1 of the line, at (1, 0), is component x of "
           "the node "
           "(2, 0) of the body",
           [](auto &l) { std::swap(l.nodes[1].dofs, l.nodes[2].dofs); });
   // The line is 3 long.
   refused("node 3 of the line, at (3.000001, 0)",
           [](auto &l) { l.nodes[3].position[0] = 3.000001; });
   ContactLine rounded = frame.line();
   rounded.nodes[3].position[0] += 1e-10;
   EXPECT_EQ(condense(body, rounded).S, condense(body, frame.line()).S);
   // The twist about an axis has one dof a node.
   AssembledBody shaft;
   shaft.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(
      Eigen::MatrixXd{{2, -1, 0}, {-1, 2, -1}, {0, -1, 1}}.sparseView()));
   shaft.places = {
      Eigen::Vector3d(1, 1, 2), Eigen::Vector3d(0, 1, 1), {0, 0, 0}, Formulation::torsion};
   shaft.grounded = true;
   ContactLine ring;
   ring.formulation = Formulation::torsion;
   ring.chains = {{0, 1}};
   ring.nodes = {{{0, -1}, {1, 0}, {1, 0}, 1, 0, 1}};
   EXPECT_NEAR(condense(shaft, ring).S(0, 0), 1, 1e-14); // 2 - 1, behind which nothing holds
   ring.nodes[0].dofs[0] = 1;
   expect_input_error(
      [&] { condense(shaft, ring); },
      "dof 1, given as component twist of node 0 of the line, at (1, 0), is component "
      "twist of the node (1, 1)");
}

/// Rows of supports that were eliminated, with any number or none on their diagonal.
TEST(CondenseMatrix, EliminatedRowsAreSupports)
{
   const Frame frame(4, 3, true);
   AssembledBody body = frame.body(true);
   ASSERT_FALSE(body.fixed.empty());
   const auto moves = [](const BodyLoad &load)
   { return load.control == Control::displacement; };
   body.loads.erase(std::remove_if(body.loads.begin(), body.loads.end(), moves),
                    body.loads.end());
   ASSERT_FALSE(body.loads.empty());
   const ContactLine line = frame.line();
   const CondensedBody right = condense(body, line);
   const MatrixXd K = MatrixXd(body.K.view());
   const double most = K.cwiseAbs().maxCoeff();
   // Zeros may be what round-off left of them, in all columns.
   for (const auto &[diagonal, zero] :
        std::vector<std::pair<double, double>>{{1, 0},
                                               {1e-3, 0},
                                               {1e9, 0},
                                               {0, 0},
                                               {1, 1e-30},
                                               {most, 1e-17},
                                               {1, 1e-17},
                                               {0, 1e-17},
                                               {most, 1e-14},
                                               {1e9, 1e-14},
                                               {1e3 * most, 1e-13},
                                               {1e6 * most, 1e-10},
                                               {1e6 * most, 1e-8},
                                               {1e9 * most, 1e-7},
                                               {1e12 * most, 1e-4}})
   {
      SCOPED_TRACE(testing::Message() << "diagonal " << diagonal << ", zeros " << zero);
      AssembledBody gone = body;
      MatrixXd eliminated = K;
      for (int dof : body.fixed)
      {
         eliminated.row(dof) = zero * most * Eigen::RowVectorXd::Random(K.cols());
         eliminated.col(dof) = eliminated.row(dof).transpose();
      }
      for (int dof : body.fixed) { eliminated(dof, dof) = diagonal; }
      eliminated.triangularView<Eigen::StrictlyLower>() =
         eliminated.transpose().triangularView<Eigen::StrictlyLower>();
      gone.K = SharedMatrix(
         Eigen::SparseMatrix<double, Eigen::RowMajor>(MatrixXd(eliminated).sparseView()));
      gone.fixed.clear();
      EXPECT_EQ(gone.eliminated(), body.fixed);
      // Forces on supports do nothing.
      for (BodyLoad &load : gone.loads)
      {
         for (int dof : body.fixed) { load.values[dof] = 7; }
      }
      if (diagonal > 0)
      {
         expect_input_error([&] { condense(gone, line); }, "holds nothing but its diagonal");
      }
      gone.grounded = true;
      EXPECT_NE(gone.eliminated_warning().find("these rows are taken for eliminated supports"),
                std::string::npos);
      const CondensedBody condensed = condense(gone, line);
      EXPECT_LT((condensed.S - right.S).norm(), 1e-12 * right.S.norm()) << diagonal;
      EXPECT_LT((condensed.H - right.H).norm(), 1e-12 * right.H.norm()) << diagonal;
      EXPECT_EQ(condensed.held, right.held);
   }
   // A layer of another material has fewer digits than the stiff one, and is none of them.
   for (const double soft : {1e-6, 1e-10, 1e-13})
   {
      MatrixXd layers = MatrixXd::Zero(K.rows() * 2, K.rows() * 2);
      layers.topLeftCorner(K.rows(), K.rows()) = K;
      layers.bottomRightCorner(K.rows(), K.rows()) = soft * K;
      AssembledBody both = body;
      both.K = SharedMatrix(
         Eigen::SparseMatrix<double, Eigen::RowMajor>(MatrixXd(layers).sparseView()));
      both.fixed.clear();
      both.grounded = true;
      both.places.x = both.places.x.replicate(2, 1).eval();
      both.places.y = both.places.y.replicate(2, 1).eval();
      const std::vector<int> components = both.places.component;
      both.places.component.insert(both.places.component.end(), components.begin(),
                                   components.end());
      EXPECT_TRUE(both.eliminated().empty()) << soft;
   }
   // Nor is a spring to the ground that is coupled to the others by 1e-10 of them.
   {
      AssembledBody weak = body;
      MatrixXd coupled = K;
      const int dof = body.fixed[0];
      coupled.row(dof).setZero();
      coupled.col(dof).setZero();
      coupled(dof, dof) = most;
      coupled(dof, (dof + 4) % K.rows()) = coupled((dof + 4) % K.rows(), dof) = 1e-10 * most;
      weak.K = SharedMatrix(
         Eigen::SparseMatrix<double, Eigen::RowMajor>(MatrixXd(coupled).sparseView()));
      weak.fixed.clear();
      weak.grounded = true;
      EXPECT_TRUE(weak.eliminated().empty());
   }
   // Nor are springs that hold a node however stiff, as long as their stiffness shows.
   for (const double stiff : {1e3, 1e6, 1e9, 1e12})
   {
      AssembledBody sprung = body;
      MatrixXd held = K;
      for (int dof : body.fixed) { held(dof, dof) += stiff * most; }
      sprung.K = SharedMatrix(
         Eigen::SparseMatrix<double, Eigen::RowMajor>(MatrixXd(held).sparseView()));
      sprung.fixed.clear();
      sprung.grounded = true;
      EXPECT_TRUE(sprung.eliminated().empty()) << stiff;
      EXPECT_LT((condense(sprung, line).S - right.S).norm(), 100 / stiff * right.S.norm());
   }
   // A bed of springs has no others beside it that are connected.
   AssembledBody bed = body;
   bed.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(
      MatrixXd(K.diagonal().asDiagonal()).sparseView()));
   bed.fixed.clear();
   bed.grounded = true;
   EXPECT_TRUE(bed.eliminated().empty());
   EXPECT_EQ(bed.eliminated_warning(), "");
}

TEST(CondenseMatrix, LinesThatArePairedAreSound)
{
   const Frame upper(3, 2, true), lower(3, 2, false);
   const ContactLine good = upper.line();
   for (const bool second : {false, true})
   {
      ContactLine bad = second ? lower.line() : good;
      bad.nodes[1].spacing = 0;
      expect_input_error([&]
                         { second ? pair_lines(good, bad) : pair_lines(bad, lower.line()); },
                         "spacing at (1, 0) is 0");
      expect_input_error([&] { second ? pair_lines(good, {}) : pair_lines({}, good); },
                         "it has no nodes");
   }
}

TEST(CondenseMatrix, ObstacleMotionsHaveNamesOfTheirOwn)
{
   const Frame frame(3, 2, true);
   Reduction reduction = reduce(condense(frame.body(true), frame.line()));
   const auto add = [&](const char *name) { reduction.add_obstacle_motion(name, 0.0, 1.0); };
   expect_input_error([&] { add(""); }, "obstacle motion: it has no name");
   expect_input_error([&] { add("pull"); }, "a load pattern with this name exists already");
   add("rise");
   const LoadPattern once = reduction.problem.patterns.back();
   add("rise"); // as much again
   EXPECT_EQ(reduction.problem.patterns.size(), 3u);
   EXPECT_LT((reduction.problem.patterns.back().p - 2 * once.p).norm(), 1e-12 * once.p.norm());
}

} // namespace
