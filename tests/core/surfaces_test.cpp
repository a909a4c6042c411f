#include "blocks_of_cells.hpp"
#include "comparison.hpp"
#include "contact_laws.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Geometry>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Nodes = NodalStiffness::Nodes;
using cattaneo_test::askew;
using cattaneo_test::block;
using cattaneo_test::on_line;
using cattaneo_test::on_surface;
using cattaneo_test::plane_block;
using cattaneo_test::pressed;
using cattaneo_test::Solid;
using cattaneo_test::solved;

/// The first tangents of a surface along e, so that two can be compared.
MatrixXd global_forces(const Reduction &reduction, const ContactState &state)
{
   return reduction.contact_forces(0, state.q, state.p);
}

} // namespace

TEST(Surfaces, FreeBlockHasSixRigidMotionsAndThreeTwoOneSupportsHoldThem)
{
   for (const Solid solid : {Solid::hexahedra, Solid::wedges, Solid::tetrahedra})
   {
      NodalStiffness body = block({2, 2, 3}, {1, 2, 3}, {2, 1, 3}, 7, 0.3, solid, askew);
      const CondensedBody free = on_surface(body, "BOTTOM");
      EXPECT_EQ(free.rigid_modes, 6);
      EXPECT_EQ(free.free_motions.cols(), 6);
      EXPECT_EQ(free.rigid_motions().cols(), 6);
      EXPECT_LT(largest(free.S * free.rigid_motions()), 1e-12 * largest(free.S));
      // In energy nothing else is free.
      const VectorXd energies = Eigen::SelfAdjointEigenSolver<MatrixXd>(free.S).eigenvalues();
      EXPECT_GT(energies[6], 1e-4 * energies[energies.size() - 1]);
      EXPECT_LT(free.S.rows() > 0 ? CondensedBody(free).error_estimate() : 1, 1e-10);
      // Three pins at corners that are not in a row.
      body.fix({body.nodes_of("TOP").front()}, 1);
      body.fix({body.nodes_of("TOP").front()}, 2);
      body.fix({body.nodes_of("TOP").front()}, 3);
      EXPECT_EQ(on_surface(body, "BOTTOM").rigid_modes, 3);
      body.fix({body.nodes_of("TOP").back()}, 1);
      body.fix({body.nodes_of("TOP").back()}, 2);
      EXPECT_EQ(on_surface(body, "BOTTOM").rigid_modes, 1);
      body.fix({body.nodes_of("TOP")[2]}, 3);
      EXPECT_EQ(on_surface(body, "BOTTOM").rigid_modes, 0);
   }
}

TEST(Surfaces, WeightsAndFramesAreThoseOfFaces)
{
   for (const Solid solid : {Solid::hexahedra, Solid::wedges, Solid::tetrahedra})
   {
      const NodalStiffness body = block({3, 1, 2}, {0, 0, 0}, {3, 1, 2}, 1, 0.2, solid, askew);
      for (const char *set : {"BOTTOM", "TOP"})
      {
         const ContactSurface surface = body.contact_surface(body.nodes_of(set));
         EXPECT_EQ(surface.size(), 12);
         expect_relative(surface.weights().sum(), 6, 1e-14);
         const Vector3d up = askew.col(1), inward = set[0] == 'B' ? up : Vector3d(-up);
         for (const SurfaceNode &node : surface.nodes)
         {
            EXPECT_LT((node.normal() - inward).norm(), 1e-14);
            EXPECT_NEAR(node.frame.determinant(), 1, 1e-14);
         }
      }
   }
   // Seen from the origin of a body, of a half cube all normals point to its middle.
   const NodalStiffness cube = block({1, 1, 1}, {-1, -1, -1}, {2, 2, 2}, 1, 0);
   for (const SurfaceNode &node : cube.contact_surface(cube.faces).nodes)
   {
      EXPECT_LT((node.normal() + node.position.normalized()).norm(), 1e-14);
   }
}

TEST(Surfaces, PressureGoesThroughMatchingFaces)
{
   // Without Poisson's ratio a clamped column under pressure has one stress.
   const double E = 3, pressure = 0.02, height = 1.5;
   for (const Solid solid : {Solid::hexahedra, Solid::wedges, Solid::tetrahedra})
   {
      for (const int way : {0, 1, 2, 3})
      {
         const Matrix3d turn = way % 2 == 0 ? Matrix3d(Matrix3d::Identity()) : askew;
         const int order = way < 2 ? 1 : 2;
         NodalStiffness upper = block({3, 2, 2}, {0, 0, 0}, {3, height, 2}, E, 0, solid, turn,
                                      order),
                        lower = block({3, 2, 2}, {0, -1, 0}, {3, 1, 2}, 2 * E, 0, solid, turn,
                                      order);
         for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
         upper.add_surface_traction("P", upper.nodes_of("TOP"),
                                    Vector3d(-pressure * turn.col(1)));
         const CondensedBody above = on_surface(upper, "BOTTOM"),
                             below = on_surface(lower, "TOP");
         Reduction reduction =
            reduce(above, below, pair_surfaces(above.surface, below.surface));
         const ReducedProblem &problem = reduction.problem;
         EXPECT_EQ(problem.components(), 2);
         EXPECT_EQ(problem.rigid_motions.cols(), 6);
         EXPECT_EQ(problem.position.cols(), 3);
         const ContactState state = solved(problem, 0.5, {VectorXd::Constant(1, 1)}).front();
         EXPECT_LT(largest(state.p - pressure * problem.weights), 1e-12 * pressure);
         EXPECT_LT(largest(state.q), 1e-12 * pressure);
         // The top goes down as that of two columns in a row.
         const VectorXd u = reduction.displacement(0, state.v, state.w, state.multipliers);
         const double down = pressure * (height / E + 1 / (2 * E));
         for (int node : upper.nodes_of("TOP"))
         {
            EXPECT_LT((u.segment(3 * node, 3) + down * turn.col(1)).norm(), 1e-11 * down);
         }
         // Bodies push each other with the whole load.
         const MatrixXd on_upper = global_forces(reduction, state),
                        on_lower = reduction.contact_forces(1, state.q, state.p);
         EXPECT_LT((on_upper.colwise().sum().transpose() - 6 * pressure * turn.col(1)).norm(),
                   1e-12 * pressure);
         EXPECT_LT((on_lower.colwise().sum() + on_upper.colwise().sum()).norm(),
                   1e-12 * pressure);
      }
   }
}

namespace
{

/** Two extruded blocks pressed and sheared to and fro, against the plane problem: contact
   forces and openings to 1e-10. With Poisson's ratios supports hold plane strain, so that the
   blocks stand along axes. Without (`held` false) nothing resists, and they may be turned. If
   the lower block has another number of cells along the contact, the upper one is the slave. */
void compare_extruded(const std::vector<Matrix3d> &turns, bool held, int lower_cells = 6)
{
   const bool matching = lower_cells == 6;
   const Vector3d low(0, -1, 0), up(0, 0, 0);
   const double friction = 0.4, thick = 0.7, of_upper = held ? 0.3 : 0,
                of_lower = held ? 0.2 : 0;
   const std::vector<Eigen::Vector2d> path = {{1, 0},    {1, 0.2}, {1, 0.3},
                                              {1, 0.36}, {1, 0.1}, {1, -0.33}};
   NodalStiffness above = plane_block(6, 3, up, {3, 2, 0}, 2, of_upper),
                  below = plane_block(lower_cells, 3, low, {3, 1, 0}, 5, of_lower);
   for (int c : {1, 2}) { below.fix(below.nodes_of("BOTTOM"), c); }
   above.add_traction("P", above.nodes_of("TOP"), Eigen::Vector2d(0, -1));
   above.add_traction("Q", above.nodes_of("TOP"), Eigen::Vector2d(1, 0));
   const CondensedBody one = on_line(above, "BOTTOM"), two = on_line(below, "TOP");
   Interface between;
   between.first = {0, one.line};
   between.second = {1, two.line};
   between.slave = SlaveSide::first;
   const Reduction plane = matching ? reduce(one, two, pair_lines(one.line, two.line))
                                    : reduce({one, two}, {between});
   std::vector<VectorXd> loads(path.begin(), path.end());
   const std::vector<ContactState> expected = solved(plane.problem, friction, loads);
   const Eigen::Index n = plane.problem.nodes();
   // Some of all states are there, or the comparison says little.
   int slipping = 0, open = 0, sticking = 0;
   for (const ContactState &state : expected)
   {
      for (NodeState each : state.status)
      {
         slipping += slips(each);
         open += !closed(each);
         sticking += each == NodeState::stick;
      }
   }
   ASSERT_TRUE(slipping > 0 && open > 0 && sticking > 0) << slipping << open << sticking;
   for (const int layers : {1, 3})
   {
      for (const Matrix3d &turn : turns)
      {
         NodalStiffness upper = block({6, 3, layers}, up, {3, 2, thick}, 2, of_upper,
                                      Solid::hexahedra, turn),
                        lower = block({lower_cells, 3, layers}, low, {3, 1, thick}, 5, of_lower,
                                      Solid::hexahedra, turn);
         int through = 0;
         turn.col(2).maxCoeff(&through);
         for (NodalStiffness *body : {&upper, &lower})
         {
            if (held) { body->fix(body->nodes_of("ALL"), through + 1); }
         }
         for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
         upper.add_surface_traction("P", upper.nodes_of("TOP"), Vector3d(-turn.col(1)));
         upper.add_surface_traction("Q", upper.nodes_of("TOP"), Vector3d(turn.col(0)));
         const CondensedBody first = on_surface(upper, "BOTTOM"),
                             second = on_surface(lower, "TOP");
         between.first = {0, {}, first.surface};
         between.second = {1, {}, second.surface};
         const Reduction reduction =
            matching ? reduce(first, second, pair_surfaces(first.surface, second.surface))
                     : reduce({first, second}, {between});
         EXPECT_EQ(reduction.interfaces[0].matching, matching);
         const ReducedProblem &problem = reduction.problem;
         ASSERT_EQ(problem.nodes(), n * (layers + 1));
         EXPECT_EQ(static_cast<Eigen::Index>(problem.held.size()), held ? problem.nodes() : 0);
         const std::vector<ContactState> states = solved(problem, friction, loads);
         for (std::size_t k = 0; k < states.size(); ++k)
         {
            const MatrixXd forces = global_forces(reduction, states[k]),
                           flat = plane.contact_forces(0, expected[k].q, expected[k].p);
            const double most = largest(flat);
            for (Eigen::Index i = 0; i < first.surface.size(); ++i)
            {
               const Vector3d place = turn.transpose() * first.surface.nodes[i].position;
               const bool outer = place[2] < 1e-9 || place[2] > thick - 1e-9;
               const double share = thick / layers * (outer ? 0.5 : 1);
               Eigen::Index m = 0;
               while (std::abs(one.line.nodes[m].position[0] - place[0]) > 1e-9) { ++m; }
               const Vector3d force = turn.transpose() * forces.row(i).transpose();
               EXPECT_NEAR(force[0], share * flat(m, 0), 1e-10 * most);
               EXPECT_NEAR(force[1], share * flat(m, 1), 1e-10 * most);
               EXPECT_NEAR(force[2], 0, held ? 0 : 1e-10 * most);
               EXPECT_NEAR(states[k].w[i], expected[k].w[m], 1e-10 * largest(expected[k].w));
            }
         }
      }
   }
}

} // namespace

TEST(Surfaces, ExtrudedPlaneProblemIsThePlaneOne)
{
   // Turned so that x, y, z are y, z, x, and so on: supports stay along axes.
   Matrix3d next;
   next << 0, 0, 1, 1, 0, 0, 0, 1, 0;
   compare_extruded({Matrix3d::Identity(), next, next * next}, true);
}

TEST(Surfaces, ExtrudedPlaneProblemIsThePlaneOneHoweverItIsTurned)
{
   compare_extruded({Matrix3d::Identity(), askew, askew * askew}, false);
}

TEST(Surfaces, ExtrudedMortarIsThatOfThePlane)
{
   for (const int lower_cells : {4, 7})
   {
      compare_extruded({Matrix3d::Identity()}, true, lower_cells);
      compare_extruded({askew}, false, lower_cells);
   }
}

namespace
{

/// All outer faces of a block carry the tractions of one stress, but those of a set.
void add_stress(NodalStiffness &body, const Matrix3d &stress, const Matrix3d &turn,
                const Vector3d &from, const Vector3d &size, const std::string &but)
{
   for (int c : {0, 1, 2})
   {
      for (const bool last : {false, true})
      {
         Nodes nodes;
         for (const auto &[node, place] : body.places)
         {
            const Vector3d x = turn.transpose() * Vector3d(place[0], place[1], body.z.at(node));
            if (std::abs(x[c] - from[c] - (last ? size[c] : 0)) < 1e-9)
            {
               nodes.push_back(node);
            }
         }
         if (c == 1 && last == (but == "TOP")) { continue; }
         const Vector3d normal = (last ? 1 : -1) * turn.col(c);
         body.add_surface_traction("P", nodes, stress * normal);
      }
   }
}

} // namespace

/// Two blocks of one material under a uniform stress, with other elements on each side: every
/// node of either side has the force of the stress on its part of the interface.
TEST(Surfaces, ConstantStressPassesMeshesThatDoNotMatch)
{
   Matrix3d stress;
   stress << -1, 0.2, 0.1, 0.2, -2, 0.15, 0.1, 0.15, -0.7;
   struct Case
   {
      Solid upper, lower;
      int order_upper, order_lower;
      bool distorted;
   };
   const std::vector<Case> cases = {{Solid::hexahedra, Solid::hexahedra, 1, 1, false},
                                    {Solid::hexahedra, Solid::hexahedra, 1, 1, true},
                                    {Solid::hexahedra, Solid::tetrahedra, 1, 1, false},
                                    {Solid::tetrahedra, Solid::wedges, 1, 1, false},
                                    {Solid::tetrahedra, Solid::hexahedra, 2, 1, false},
                                    {Solid::hexahedra, Solid::hexahedra, 2, 2, false},
                                    {Solid::wedges, Solid::tetrahedra, 2, 2, false},
                                    {Solid::tetrahedra, Solid::hexahedra, 2, 2, true}};
   for (std::size_t k = 0; k < cases.size(); ++k)
   {
      const Case &each = cases[k];
      const Matrix3d turn = k % 2 == 0 ? Matrix3d(Matrix3d::Identity()) : askew;
      // Moves nodes along the interface, but not those at its edges.
      const auto bend = [&](const Vector3d &place)
      {
         Vector3d x = turn.transpose() * place;
         const double bump = 0.08 * std::sin(M_PI * x[0] / 2) * std::sin(M_PI * x[2]);
         x += bump * Vector3d(std::cos(7 * x[2] + 3 * x[0]), 0, std::sin(5 * x[0]));
         return Vector3d(turn * x);
      };
      const auto if_distorted = each.distorted && each.order_upper == 1
                                   ? std::function<Vector3d(const Vector3d &)>(bend)
                                   : nullptr;
      const Vector3d up(0, 0, 0), low(0, -0.5, 0), size(2, 0.5, 1);
      NodalStiffness upper = block({4, 1, 2}, up, size, 10, 0.3, each.upper, turn,
                                   each.order_upper, if_distorted),
                     lower = block({3, 1, 3}, low, size, 10, 0.3, each.lower, turn,
                                   each.order_lower, if_distorted);
      const Matrix3d turned = turn * stress * turn.transpose();
      add_stress(upper, turned, turn, up, size, "BOTTOM");
      add_stress(lower, turned, turn, low, size, "TOP");
      const CondensedBody above = on_surface(upper, "BOTTOM"), below = on_surface(lower, "TOP");
      for (const bool tied : {false, true})
      {
         for (const SlaveSide slave : {SlaveSide::first, SlaveSide::second})
         {
            Interface between;
            between.first = {0, {}, above.surface};
            between.second = {1, {}, below.surface};
            between.slave = slave;
            between.tied = tied;
            const Reduction reduction = reduce({above, below}, {between});
            EXPECT_FALSE(reduction.interfaces[0].matching);
            EXPECT_EQ(reduction.interfaces[0].left_out, 0);
            MatrixXd on_upper, on_lower;
            if (tied)
            {
               const VectorXd none, load = VectorXd::Constant(1, 1),
                                    forces = reduction.tied_forces(none, none, load);
               on_upper = reduction.contact_forces(0, none, none, forces);
               on_lower = reduction.contact_forces(1, none, none, forces);
            }
            else
            {
               const ContactState state =
                  solved(reduction.problem, 0.5, {VectorXd::Constant(1, 1)}).front();
               for (NodeState node : state.status) { EXPECT_EQ(node, NodeState::stick); }
               on_upper = reduction.contact_forces(0, state.q, state.p);
               on_lower = reduction.contact_forces(1, state.q, state.p);
            }
            const auto expect =
               [&](const ContactSurface &surface, const MatrixXd &found, const Vector3d &normal)
            {
               const Vector3d traction = turned * normal;
               const VectorXd areas = surface.forces_at_nodes(surface.weights());
               EXPECT_LT(largest(found - areas * traction.transpose()),
                         1e-11 * areas.maxCoeff())
                  << "case " << k << (tied ? " tied" : "") << (surface.size());
            };
            expect(above.surface, on_upper, -turn.col(1));
            expect(below.surface, on_lower, turn.col(1));
         }
      }
   }
}

/// A small block on a large one, whose edges cut its elements: the forces on both bodies are in
/// balance, and so are their moments, whichever side has the nodes.
TEST(Surfaces, FacesThatAreCoveredInPartKeepBothBodiesInBalance)
{
   for (const int order : {1, 2})
   {
      for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
      {
         NodalStiffness upper = block({3, 1, 3}, {0.37, 0, 0.23}, {1, 0.5, 1.1}, 1, 0.3, solid,
                                      Matrix3d::Identity(), order),
                        lower = block({5, 1, 4}, {0, -0.5, 0}, {2, 0.5, 1.5}, 3, 0.2, solid,
                                      Matrix3d::Identity(), order);
         for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
         upper.add_surface_traction("P", upper.nodes_of("TOP"), Vector3d(0.1, -1, 0.05));
         const CondensedBody above = on_surface(upper, "BOTTOM"),
                             below = on_surface(lower, "TOP");
         for (const SlaveSide slave : {SlaveSide::coarser, SlaveSide::first, SlaveSide::second})
         {
            Interface between;
            between.first = {0, {}, above.surface};
            between.second = {1, {}, below.surface};
            between.slave = slave;
            const Reduction reduction = reduce({above, below}, {between});
            // The side within the other one is the slave.
            EXPECT_EQ(reduction.interfaces[0].of_second, slave == SlaveSide::second);
            EXPECT_NEAR(reduction.problem.weights.sum(), 1.1, 1e-12);
            EXPECT_GT(reduction.problem.weights.minCoeff(), 0);
            const ContactState state =
               solved(reduction.problem, 0.4, {VectorXd::Constant(1, 1)}).front();
            const MatrixXd on_upper = reduction.contact_forces(0, state.q, state.p),
                           on_lower = reduction.contact_forces(1, state.q, state.p);
            const auto moment = [](const ContactSurface &surface, const MatrixXd &forces)
            {
               Vector3d sum(0, 0, 0);
               for (Eigen::Index i = 0; i < surface.size(); ++i)
               {
                  const Vector3d force = forces.row(i);
                  sum += surface.nodes[i].position.cross(force);
               }
               return sum;
            };
            EXPECT_LT(
               (on_upper.colwise().sum() - 1.1 * Eigen::RowVector3d(-0.1, 1, -0.05)).norm(),
               1e-12);
            EXPECT_LT((on_upper.colwise().sum() + on_lower.colwise().sum()).norm(), 1e-12);
            EXPECT_LT(
               (moment(above.surface, on_upper) + moment(below.surface, on_lower)).norm(),
               1e-12);
         }
      }
   }
}

TEST(Surfaces, TurnedBodiesHaveTheSameContact)
{
   const double friction = 0.3;
   const std::vector<VectorXd> loads = {Vector3d(1, 0, 0), Vector3d(1, 0.1, 0),
                                        Vector3d(1, 0.1, 0.15), Vector3d(1, -0.1, 0.1)};
   std::vector<MatrixXd> expected;
   for (const Matrix3d &turn : {Matrix3d(Matrix3d::Identity()), askew})
   {
      for (const bool swapped : {false, true})
      {
         NodalStiffness upper =
                           block({4, 2, 3}, {0, 0, 0}, {2, 1, 2}, 1, 0.3, Solid::wedges, turn),
                        lower =
                           block({4, 2, 3}, {0, -1, 0}, {2, 1, 2}, 4, 0.2, Solid::wedges, turn);
         for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
         upper.add_surface_traction("P", upper.nodes_of("TOP"), Vector3d(-turn.col(1)));
         upper.add_surface_traction("Q", upper.nodes_of("TOP"), Vector3d(turn.col(0)));
         upper.add_surface_traction("R", upper.nodes_of("TOP"), Vector3d(turn.col(2)));
         const CondensedBody above = on_surface(upper, "BOTTOM"),
                             below = on_surface(lower, "TOP");
         const Reduction reduction =
            swapped ? reduce(below, above, pair_surfaces(below.surface, above.surface))
                    : reduce(above, below, pair_surfaces(above.surface, below.surface));
         const std::vector<ContactState> states = solved(reduction.problem, friction, loads);
         for (std::size_t k = 0; k < states.size(); ++k)
         {
            const MatrixXd forces =
               reduction.contact_forces(swapped ? 1 : 0, states[k].q, states[k].p) * turn;
            if (expected.size() == k) { expected.push_back(forces); }
            EXPECT_LT(difference(forces, expected[k]), 1e-9);
         }
      }
   }
}

TEST(Surfaces, ObstaclesAreAsFarAsClosedFormsSay)
{
   const NodalStiffness body = block({3, 1, 2}, {-1, 0.1, -1}, {2, 1, 2}, 1, 0.2);
   const ContactSurface surface = body.contact_surface(body.nodes_of("BOTTOM"));
   const VectorXd flat = gaps_to_plane(surface, {5, 0, 5}, {0, -2, 0}),
                  slope = gaps_to_plane(surface, {0, 0, 0}, {0.1, 1, 0}),
                  ball = gaps_to_sphere(surface, {0, -10, 0}, 10);
   for (Eigen::Index i = 0; i < surface.size(); ++i)
   {
      const Vector3d &x = surface.nodes[i].position;
      EXPECT_NEAR(flat[i], 0.1, 1e-15);
      EXPECT_NEAR(slope[i], 0.1 + 0.1 * x[0], 1e-15);
      EXPECT_NEAR(ball[i], 0.1 + 10 - std::sqrt(100 - x[0] * x[0] - x[2] * x[2]), 1e-13);
   }
   expect_input_error(
      [&] {
         gaps_to_plane(surface, {0, 0, 0}, {1, 0, 0});
      },
      "does not face the obstacle");
   expect_input_error([&] { gaps_to_sphere(surface, {0, 0, 0}, 0); }, "its radius is 0");
   // Normals of nodes that pass a small ball count as turned towards it by 5 degrees.
   const VectorXd small = gaps_to_sphere(surface, {0, -0.8, 0}, 0.8);
   for (Eigen::Index i = 0; i < surface.size(); ++i)
   {
      const Vector3d &x = surface.nodes[i].position;
      const double beside = std::hypot(x[0], x[2]);
      const double gap = beside < 0.8
                            ? 0.1 + 0.8 - std::sqrt(0.64 - beside * beside)
                            : (std::hypot(beside, 0.9) - 0.8) / std::sin(std::acos(-1.0) / 36);
      EXPECT_NEAR(small[i], gap, 1e-12);
   }
   expect_input_error(
      [&] {
         gaps_to_sphere(surface, {5, -1, 0}, 1);
      },
      "no node of the side faces the sphere");
   // Pressed on the plane, the block bears its load.
   NodalStiffness pressed = body;
   pressed.add_surface_traction("P", pressed.nodes_of("TOP"), Vector3d(0, -1, 0));
   const CondensedBody condensed = on_surface(pressed, "BOTTOM");
   const Reduction reduction = reduce(condensed, flat);
   const ContactState state = solved(reduction.problem, 0.2, {VectorXd::Constant(1, 1)})[0];
   expect_relative(state.p.sum(), 4, 1e-12);
}

TEST(Surfaces, DissectionAndMinimumDegreeGiveTheSameStiffness)
{
   const NodalStiffness body = block({4, 4, 4}, {0, 0, 0}, {1, 1, 1}, 1, 0.3);
   std::vector<int> keep, nodes;
   int trailing = 0;
   for (const bool last : {false, true})
   {
      for (std::size_t row = 0; row < body.dofs.size(); ++row)
      {
         const int node = body.dofs[row].node;
         const bool contact = body.places.at(node)[1] == 0;
         if (contact != last) { continue; }
         keep.push_back(static_cast<int>(row));
         nodes.push_back(node);
         trailing += contact;
      }
   }
   const SharedMatrix K(body.K);
   const SparseFactor by_degree(K.view(), keep, trailing, 1),
      dissected(K.view(), keep, trailing, 1, SparseFactor::Backend::automatic, nodes),
      permissive(K.view(), keep, trailing, 1, SparseFactor::Backend::eigen, nodes);
   EXPECT_LT(difference(dissected.schur(), by_degree.schur()), 1e-13);
   EXPECT_LT(difference(permissive.schur(), by_degree.schur()), 1e-13);
   const MatrixXd rhs = MatrixXd::Identity(body.K.rows(), 3);
   EXPECT_LT(difference(dissected.solve(rhs), by_degree.solve(rhs)), 1e-12);
}

TEST(Surfaces, FilesKeepBodiesInSpace)
{
   NodalStiffness body = block({2, 1, 1}, {0, 0, 0}, {2, 1, 1}, 1, 0.3, Solid::wedges, askew);
   for (int c : {1, 2, 3}) { body.fix(body.nodes_of("TOP"), c); }
   body.add_forces("F", {0}, 3, 2.5);
   for (const std::string file : {"surfaces_test.mtx", "surfaces_test.npz"})
   {
      if (file.back() == 'x') { write_matrix_market(file, body); }
      else { write_npz(file, body); }
      const NodalStiffness read = read_stiffness(file);
      EXPECT_EQ(read.formulation, Formulation::space);
      EXPECT_EQ(read.z, body.z);
      EXPECT_EQ(read.places, body.places);
      EXPECT_EQ(read.faces, body.faces);
      EXPECT_EQ(read.fixed, body.fixed);
      EXPECT_EQ(read.sets, body.sets);
      EXPECT_LT(difference(MatrixXd(read.K), MatrixXd(body.K)), 1e-15);
      EXPECT_EQ(read.loads.at(0).values, body.loads.at(0).values);
      EXPECT_LT(difference(on_surface(read, "BOTTOM").S, on_surface(body, "BOTTOM").S), 1e-13);
      std::filesystem::remove(file);
   }
   // Without loads too.
   const std::string bare = "surfaces_test.npz";
   write_npz(bare, block({1, 1, 1}, {0, 0, 0}, {1, 1, 1}, 1, 0.3));
   EXPECT_TRUE(read_stiffness(bare).loads.empty());
   std::filesystem::remove(bare);
   expect_input_error([&] { write_abaqus("surfaces_test.inp", body); }, "is in space");
   std::filesystem::remove("surfaces_test.dofs");
}

TEST(Surfaces, WrongSurfacesAreRefused)
{
   NodalStiffness body = block({2, 1, 2}, {0, 0, 0}, {2, 1, 2}, 1, 0.3);
   expect_input_error([&] { body.contact_surface(Nodes{0, 1}); }, "no outer face");
   expect_input_error(
      [&] {
         body.contact_surface(std::vector<Nodes>{{0, 1}});
      },
      "has 2 nodes, must have 3, 4, 6, 8, 9, 10 or 16");
   expect_input_error(
      [&] {
         body.contact_surface(std::vector<Nodes>{{0, 1, 2}});
      },
      "has no area");
   expect_input_error([&] { body.contact_line(body.nodes_of("BOTTOM")); }, "is in space");
   NodalStiffness far = block({2, 1, 2}, {0, -1.5, 0.1}, {2, 1, 2}, 1, 0.3);
   const ContactSurface above = body.contact_surface(body.nodes_of("BOTTOM")),
                        below = far.contact_surface(far.nodes_of("TOP")),
                        away = far.contact_surface(far.nodes_of("BOTTOM"));
   expect_input_error([&] { pair_surfaces(above, below); }, "without a partner");
   expect_input_error([&] { pair_surfaces(above, away); }, "do not face each other anywhere");
   EXPECT_NEAR(pair_surfaces(above, below, 0.2).gap.minCoeff(), 0.5, 1e-15);
   for (const bool second : {false, true})
   {
      ContactSurface one = above, two = below;
      (second ? two : one).nodes[1].spacing = 0;
      expect_input_error([&] { pair_surfaces(one, two, 0.2); }, "the spacing 0");
   }
   expect_input_error([] { straight_line({0, 1}, 1, Formulation::space); }, "it is in space");
   ContactLine line = straight_line({0, 1}, 1);
   line.formulation = Formulation::space;
   expect_input_error([&] { line.validate(); }, "must be given by a surface");
   // A normal component that a support holds cannot open.
   body.fix({body.nodes_of("BOTTOM").front()}, 2);
   const CondensedBody held = on_surface(body, "BOTTOM");
   expect_input_error([&] { reduce(held, VectorXd::Zero(held.nodes())); },
                      "fixed normal to the surface");
   // A matrix whose rows are in another order resists turning.
   NodalStiffness mixed = body;
   mixed.fixed.clear();
   std::swap(mixed.dofs[0], mixed.dofs[4]);
   expect_input_error([&] { mixed.body(); }, "it resists a ");
}

TEST(Surfaces, FunctionsOfOrderTwoHavePositiveWeights)
{
   // Of one face: 2/15 and 1/5 of a triangle's area, 1/20 and 1/5 of a quadrilateral's, where
   // the consistent weights are 0 and 1/3, -1/12 and 1/3.
   for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
   {
      const bool triangle = solid == Solid::tetrahedra;
      const NodalStiffness body =
         block({1, 1, 1}, {0, 0, 0}, {2, 1, 3}, 1, 0.3, solid, askew, 2);
      for (const Nodes &face : body.faces)
      {
         const auto corners = static_cast<Eigen::Index>(triangle ? 3 : 4);
         const ContactSurface surface = body.contact_surface(std::vector<Nodes>{face});
         const VectorXd weights = surface.weights(), areas = surface.forces_at_nodes(weights);
         const double area = weights.sum();
         for (Eigen::Index a = 0; a < surface.size(); ++a)
         {
            const bool middle = a >= corners;
            EXPECT_EQ(surface.nodes[a].between[0] >= 0, middle);
            const double its = middle     ? 0.2
                               : triangle ? 2. / 15
                                          : 0.05,
                         of_nodes = middle     ? 1. / 3
                                    : triangle ? 0
                                               : -1. / 12;
            EXPECT_NEAR(weights[a] / area, its, 1e-14);
            EXPECT_NEAR(areas[a] / area, of_nodes, 1e-14);
         }
         // Work is the same in both, and straight edges leave places where they are.
         EXPECT_LT(largest(surface.points() - surface.positions()), 1e-14);
         const MatrixXd u = MatrixXd::Random(surface.size(), 3),
                        f = MatrixXd::Random(surface.size(), 3);
         EXPECT_NEAR(surface.at_nodes(u).cwiseProduct(surface.forces_at_nodes(f)).sum(),
                     u.cwiseProduct(f).sum(), 1e-14);
         EXPECT_LT(largest(surface.of_nodes(surface.at_nodes(u)) - u), 1e-14);
         EXPECT_LT(largest(surface.forces_of_nodes(surface.forces_at_nodes(f)) - f), 1e-14);
      }
   }
}

TEST(Surfaces, FlatPunchLeavesNoNodeOfOrderTwoOpen)
{
   // A block on a rigid plane, pressed by tractions that differ from place to place: all of it
   // bears. The consistent forces of the nodes themselves are not positive at the 9 corners
   // within, where the signs of nodal forces would open the contact.
   for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
   {
      NodalStiffness body =
         block({4, 3, 4}, {0, 0, 0}, {1, 0.7, 1}, 1, 0.3, solid, Matrix3d::Identity(), 2);
      body.add_surface_traction("P", body.nodes_of("TOP"), Vector3d(0, -1, 0));
      const CondensedBody condensed = on_surface(body, "BOTTOM");
      const ContactSurface &surface = condensed.surface;
      EXPECT_EQ(surface.size(), solid == Solid::hexahedra ? 65 : 81);
      const Reduction reduction = reduce(condensed, VectorXd::Zero(surface.size()));
      const ContactState state = pressed(reduction.problem, 0);
      EXPECT_GT(state.p.cwiseQuotient(surface.weights()).minCoeff(), 0.5);
      expect_relative(state.p.sum(), 1, 1e-12);
      const MatrixXd nodal = reduction.contact_forces(0, state.q, state.p);
      int pulls = 0;
      for (Eigen::Index i = 0; i < surface.size(); ++i)
      {
         const Vector3d &x = surface.nodes[i].position;
         const bool within = std::min({x[0], x[2], 1 - x[0], 1 - x[2]}) > 1e-9;
         const bool corner = surface.nodes[i].between[0] < 0;
         pulls += within && corner && nodal(i, 1) < 1e-3 / 81;
      }
      EXPECT_EQ(pulls, 9);
      expect_relative(nodal.col(1).sum(), 1, 1e-12);
   }
}

TEST(Surfaces, BoltIsInAJointDiagram)
{
   // Two blocks that do not contract, under a bolt with the stiffness k_b and forces that pull
   // them apart. The blocks are springs in a row, k_c. By hand: pretension T clamps with V = T
   // k_c/(k_c + k_b); a working force W adds W k_b/(k_c + k_b) to the bolt's and takes the rest
   // from the clamp, until that is gone. Then the bolt has all of W.
   const double k_b = 1.5, area = 6, upper_E = 2, lower_E = 5, T = 0.1;
   const double k_c = 1 / (2 / (upper_E * area) + 1 / (lower_E * area)),
                V = T * k_c / (k_c + k_b), opens = V * (k_c + k_b) / k_c;
   for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
   {
      NodalStiffness upper = block({3, 2, 2}, {0, 0, 0}, {3, 2, 2}, upper_E, 0, solid),
                     lower = block({3, 1, 2}, {0, -1, 0}, {3, 1, 2}, lower_E, 0, solid);
      for (NodalStiffness *body : {&upper, &lower})
      {
         for (int c : {1, 3}) { body->fix(body->nodes_of("ALL"), c); }
         const bool above = body == &upper;
         const Nodes &far = body->nodes_of(above ? "TOP" : "BOTTOM");
         const double up = (above ? 1 : -1) / area;
         body->add_surface_traction("BOLT", far, {0, -up, 0});
         body->add_surface_traction("W", far, {0, up, 0});
      }
      const CondensedBody above = on_surface(upper, "BOTTOM"), below = on_surface(lower, "TOP");
      Reduction reduction = reduce(above, below, pair_surfaces(above.surface, below.surface));
      reduction.add_shank("BOLT", k_b);
      std::vector<VectorXd> loads;
      for (const double W : {0.0, 0.5 * opens, 0.99 * opens, 1.5 * opens, 0.0})
      {
         loads.push_back(Eigen::Vector2d(T, W));
      }
      ASSERT_EQ(reduction.problem.pattern("BOLT"), 0U);
      const std::vector<ContactState> states = solved(reduction.problem, 0.2, loads);
      for (std::size_t k = 0; k < states.size(); ++k)
      {
         const double W = loads[k][1], clamp = std::max(0.0, V - W * k_c / (k_c + k_b)),
                      bolt = clamp > 0 ? V + W * k_b / (k_c + k_b) : W;
         EXPECT_NEAR(states[k].p.sum(), clamp, 1e-12);
         EXPECT_LT(largest(states[k].p - clamp / area * reduction.problem.weights), 1e-12);
         // The bolt is longer by what it has less than its pretension.
         const VectorXd top = reduction.displacement(0, states[k].v, states[k].w, loads[k]),
                        bottom = reduction.displacement(1, states[k].v, states[k].w, loads[k]);
         const double apart =
            top[3 * upper.nodes_of("TOP")[0] + 1] - bottom[3 * lower.nodes_of("BOTTOM")[0] + 1];
         EXPECT_NEAR(apart, (bolt - T) / k_b, 1e-12);
      }
   }
}
