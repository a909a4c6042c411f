#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "line_along.hpp"
#include "trusses.hpp"

#include <cattaneo/condense/condense.hpp>
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
