#include "blocks_of_cells.hpp"
#include "comparison.hpp"
#include "contact_laws.hpp"
#include "expect_input_error.hpp"

#include <array>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/condense_joint.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>

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
using cattaneo_test::on_surface;
using cattaneo_test::pressed;
using cattaneo_test::Solid;
using cattaneo_test::solved;

} // namespace

TEST(Surfaces, StackOfThreeBodiesPassesPressureAndTiesAreOneBody)
{
   for (const int order : {1, 2})
   {
      const double E = 2, pressure = 0.03;
      for (const Solid solid : {Solid::hexahedra, Solid::wedges, Solid::tetrahedra})
      {
         std::vector<NodalStiffness> parts;
         for (int k : {0, 1, 2})
         {
            parts.push_back(block({2, 1, 2}, {0, double(k), 0}, {1, 1, 2}, E, 0.3, solid,
                                  Matrix3d::Identity(), order));
         }
         NodalStiffness whole =
            block({2, 3, 2}, {0, 0, 0}, {1, 3, 2}, E, 0.3, solid, Matrix3d::Identity(), order);
         for (NodalStiffness *top : {&parts[2], &whole})
         {
            top->add_surface_traction("P", top->nodes_of("TOP"), Vector3d(0, -pressure, 0));
            top->add_surface_traction("Q", top->nodes_of("TOP"),
                                      Vector3d(0.15 * pressure, 0, 0.1 * pressure));
         }
         std::vector<CondensedBody> bodies;
         for (const NodalStiffness &part : parts)
         {
            std::vector<ContactSurface> faces = {part.contact_surface(part.nodes_of("BOTTOM"))};
            if (&part != &parts[2])
            {
               faces.push_back(part.contact_surface(part.nodes_of("TOP")));
            }
            bodies.push_back(condense(part.body(), joined(faces)));
         }
         const auto side = [&](int b, const char *set)
         {
            InterfaceSide made;
            made.body = b;
            made.surface = parts[b].contact_surface(parts[b].nodes_of(set));
            return made;
         };
         std::vector<Interface> interfaces(3);
         interfaces[0].name = "ground";
         interfaces[0].first = side(0, "BOTTOM");
         interfaces[1].name = "low";
         interfaces[1].first = side(0, "TOP");
         interfaces[1].second = side(1, "BOTTOM");
         interfaces[2].name = "high";
         interfaces[2].first = side(2, "BOTTOM");
         interfaces[2].second = side(1, "TOP");
         // 1. In contact: each face carries what lies above it, and each body is balanced.
         const Reduction loose = reduce(bodies, interfaces);
         ASSERT_EQ(loose.interfaces.size(), 3U);
         EXPECT_EQ(loose.interfaces[1].bodies[1], 1);
         EXPECT_TRUE(loose.interfaces[2].matching);
         const ContactState only_pressed =
            solved(loose.problem, 0.4, {Eigen::Vector2d(1, 0)}).front();
         for (const InterfaceReport &face : loose.interfaces)
         {
            EXPECT_NEAR(only_pressed.p.segment(face.first, face.nodes).sum(), 2 * pressure,
                        1e-13);
         }
         EXPECT_LT(
            loose.contact_forces(1, only_pressed.q, only_pressed.p).colwise().sum().norm(),
            1e-13);
         // 2. Tied at both faces: the block on the ground alone.
         interfaces[1].tied = interfaces[2].tied = true;
         const Reduction tied = reduce(bodies, interfaces);
         const CondensedBody one = on_surface(whole, "BOTTOM");
         const Reduction single = reduce(one, VectorXd::Zero(one.nodes()));
         ASSERT_EQ(tied.problem.nodes(), single.problem.nodes());
         const std::vector<VectorXd> loads = {Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1)};
         const ContactState expected = solved(single.problem, 0.2, loads).back(),
                            found = solved(tied.problem, 0.2, loads).back();
         const auto forces = [](const Reduction &of, const ContactState &state)
         {
            const ContactSurface &surface = of.bodies[0].surface;
            const MatrixXd its = of.contact_forces(
               0, state.q, state.p, of.tied_forces(state.v, state.w, state.multipliers));
            std::map<std::pair<double, double>, Vector3d> by_place;
            for (Eigen::Index i = 0; i < surface.size(); ++i)
            {
               const Vector3d &x = surface.nodes[i].position;
               if (x[1] == 0) { by_place[{x[0], x[2]}] = its.row(i); }
            }
            return by_place;
         };
         const auto before = forces(single, expected), after = forces(tied, found);
         ASSERT_EQ(before.size(), after.size());
         for (const auto &[place, force] : before)
         {
            EXPECT_LT((after.at(place) - force).norm(), 1e-10 * pressure);
         }
      }
   }
}

TEST(Surfaces, InterfacesThatMeetAtAnEdgeFormNoRing)
{
   // Two blocks side by side stand on a third one, and touch each other.
   NodalStiffness left = block({2, 1, 1}, {-1, 0, 0}, {1, 1, 1}, 1, 0.2),
                  right = block({2, 1, 1}, {0, 0, 0}, {1, 1, 1}, 1, 0.2),
                  base = block({4, 1, 1}, {-1, -1, 0}, {2, 1, 1}, 3, 0.2);
   for (int c : {1, 2, 3}) { base.fix(base.nodes_of("BOTTOM"), c); }
   std::vector<NodalStiffness *> all = {&left, &right, &base};
   const auto nodes_at = [](const NodalStiffness &body, double x, bool below)
   {
      Nodes found;
      for (const auto &[node, place] : body.places)
      {
         const bool on =
            below ? place[1] == 0 && (x < 0) == (place[0] < 0 || place[0] == 0) : place[0] == 0;
         if (on || (below && place[1] == 0 && place[0] == 0)) { found.push_back(node); }
      }
      return found;
   };
   for (NodalStiffness *body : {&left, &right})
   {
      body->add_surface_traction("P", body->nodes_of("TOP"), Vector3d(0, -1, 0));
   }
   left.add_surface_traction("S", left.nodes_of("TOP"), Vector3d(0.05, 0, 0));
   right.add_surface_traction("S", right.nodes_of("TOP"), Vector3d(-0.05, 0, 0));
   const ContactSurface left_down = left.contact_surface(left.nodes_of("BOTTOM")),
                        left_side = left.contact_surface(nodes_at(left, 0, false)),
                        right_down = right.contact_surface(right.nodes_of("BOTTOM")),
                        right_side = right.contact_surface(nodes_at(right, 0, false)),
                        base_left = base.contact_surface(nodes_at(base, -1, true)),
                        base_right = [&]
   {
      Nodes found;
      for (const auto &[node, place] : base.places)
      {
         if (place[1] == 0 && place[0] >= 0) { found.push_back(node); }
      }
      return base.contact_surface(found);
   }();
   std::vector<CondensedBody> bodies = {
      condense(left.body(), joined(std::vector<ContactSurface>{left_down, left_side})),
      condense(right.body(), joined(std::vector<ContactSurface>{right_down, right_side})),
      condense(base.body(), joined(std::vector<ContactSurface>{base_left, base_right}))};
   const auto interface = [](const char *name, int one, const ContactSurface &first, int other,
                             const ContactSurface &second)
   {
      Interface made;
      made.name = name;
      made.first.body = one;
      made.first.surface = first;
      made.second.body = other;
      made.second.surface = second;
      return made;
   };
   const std::vector<Interface> interfaces = {
      interface("left foot", 0, left_down, 2, base_left),
      interface("right foot", 1, right_down, 2, base_right),
      interface("between", 0, left_side, 1, right_side)};
   const Reduction reduction = reduce(bodies, interfaces);
   // The two nodes of the edge where all three meet close a ring.
   EXPECT_EQ(reduction.interfaces[2].in_rings.size(), 2U);
   EXPECT_EQ(reduction.problem.nodes(), left_down.size() + right_down.size() + 2);
   const ContactState state = pressed(reduction.problem, 0.3);
   const MatrixXd on_left = reduction.contact_forces(0, state.q, state.p),
                  on_right = reduction.contact_forces(1, state.q, state.p),
                  on_base = reduction.contact_forces(2, state.q, state.p);
   // Forces balance the loads, and the scene is its own mirror image.
   EXPECT_LT((on_left.colwise().sum() - Eigen::RowVector3d(-0.05, 1, 0)).norm(), 1e-12);
   EXPECT_LT((on_right.colwise().sum() - Eigen::RowVector3d(0.05, 1, 0)).norm(), 1e-12);
   EXPECT_LT((on_base.colwise().sum() - Eigen::RowVector3d(0, -2, 0)).norm(), 1e-12);
}

/// The same with other cells on each side. Wherever the nodes are, each node has one row, and
/// all bodies are in balance: no force is counted twice at the edge where the three meet.
TEST(Surfaces, InterfacesThatDoNotMatchShareAnEdge)
{
   NodalStiffness left = block({3, 2, 3}, {-1, 0, 0}, {1, 1, 1}, 1, 0.2),
                  right = block({2, 3, 2}, {0, 0, 0}, {1, 1, 1}, 1, 0.2),
                  base = block({8, 1, 5}, {-1, -1, 0}, {2, 1, 1}, 3, 0.2);
   for (int c : {1, 2, 3}) { base.fix(base.nodes_of("BOTTOM"), c); }
   const auto part =
      [](const NodalStiffness &body, const std::function<bool(double, double)> &on)
   {
      Nodes found;
      for (const auto &[node, place] : body.places)
      {
         if (on(place[0], place[1])) { found.push_back(node); }
      }
      return body.contact_surface(found);
   };
   for (NodalStiffness *body : {&left, &right})
   {
      body->add_surface_traction("P", body->nodes_of("TOP"), Vector3d(0, -1, 0));
   }
   left.add_surface_traction("S", left.nodes_of("TOP"), Vector3d(0.05, 0, 0));
   right.add_surface_traction("S", right.nodes_of("TOP"), Vector3d(-0.05, 0, 0));
   const auto beside = [](double x, double) { return x == 0; };
   const ContactSurface left_down = left.contact_surface(left.nodes_of("BOTTOM")),
                        right_down = right.contact_surface(right.nodes_of("BOTTOM")),
                        left_side = part(left, beside), right_side = part(right, beside),
                        base_left =
                           part(base, [](double x, double y) { return y == 0 && x <= 0; }),
                        base_right =
                           part(base, [](double x, double y) { return y == 0 && x >= 0; });
   const std::vector<CondensedBody> bodies = {
      condense(left.body(), joined({left_down, left_side})),
      condense(right.body(), joined({right_down, right_side})),
      condense(base.body(), joined({base_left, base_right}))};
   for (const SlaveSide feet : {SlaveSide::first, SlaveSide::second})
   {
      for (const SlaveSide between : {SlaveSide::first, SlaveSide::second})
      {
         std::vector<Interface> interfaces(3);
         interfaces[0] = {"left foot", {0, {}, left_down}, {2, {}, base_left}, feet};
         interfaces[1] = {"right foot", {1, {}, right_down}, {2, {}, base_right}, feet};
         interfaces[2] = {"between", {0, {}, left_side}, {1, {}, right_side}, between};
         const Reduction reduction = reduce(bodies, interfaces);
         const ReducedProblem &problem = reduction.problem;
         double area = problem.weights.sum();
         for (const InterfaceReport &face : reduction.interfaces) { area += face.left_out; }
         EXPECT_NEAR(area, 3, 1e-9);
         // Contact nodes of one body are at different places.
         std::set<std::array<int, 3>> taken;
         for (const InterfaceReport &face : reduction.interfaces)
         {
            for (Eigen::Index i = 0; i < face.nodes; ++i)
            {
               const auto dofs =
                  problem.dofs.row(face.first + i).segment(3 * face.bodies[0], 3).eval();
               EXPECT_TRUE(
                  taken.insert({1000 * face.bodies[0] + dofs[0], dofs[1], dofs[2]}).second);
            }
         }
         const ContactState state = pressed(problem, 0.3);
         const MatrixXd on_left = reduction.contact_forces(0, state.q, state.p),
                        on_right = reduction.contact_forces(1, state.q, state.p),
                        on_base = reduction.contact_forces(2, state.q, state.p);
         EXPECT_LT((on_left.colwise().sum() - Eigen::RowVector3d(-0.05, 1, 0)).norm(), 1e-11);
         EXPECT_LT((on_right.colwise().sum() - Eigen::RowVector3d(0.05, 1, 0)).norm(), 1e-11);
         EXPECT_LT((on_base.colwise().sum() - Eigen::RowVector3d(0, -2, 0)).norm(), 1e-11);
      }
   }
}

TEST(Surfaces, TwoBodiesAreOneCondensedInRelativeCoordinates)
{
   // The upper body's contact nodes are the lower one's and what they are apart. All else is
   // eliminated by a dense factor of both bodies at once.
   for (const int order : {1, 2})
   {
      NodalStiffness upper = block({2, 1, 2}, {0, 0, 0}, {2, 1, 2}, 1, 0.3, Solid::wedges,
                                   askew, order),
                     lower = block({2, 1, 2}, {0, -1, 0}, {2, 1, 2}, 4, 0.2, Solid::wedges,
                                   askew, order);
      for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
      upper.add_surface_traction("P", upper.nodes_of("TOP"), Vector3d(0.3, -1, 0.2));
      const CondensedBody above = on_surface(upper, "BOTTOM"), below = on_surface(lower, "TOP");
      const Pairing pairs = pair_surfaces(above.surface, below.surface);
      const ReducedProblem problem = reduce(above, below, pairs).problem;
      const ContactSurface &surface = above.surface;
      const auto n = surface.size(), one = upper.K.rows(), both = one + lower.K.rows();
      // 1. Coordinates: 3 n apart, then the lower body's that are free, then the upper one's.
      const MatrixXd B = surface.at_nodes(MatrixXd::Identity(n, n));
      std::vector<bool> contact(one, false);
      std::vector<Eigen::VectorXd> columns;
      for (int c : {0, 1, 2})
      {
         for (Eigen::Index j = 0; j < n; ++j)
         {
            VectorXd column = VectorXd::Zero(both);
            for (Eigen::Index i = 0; i < n; ++i)
            {
               column[surface.nodes[i].dofs[c]] = B(i, j);
               contact[surface.nodes[i].dofs[c]] = true;
            }
            columns.push_back(column);
         }
      }
      std::map<int, int> upper_of; // rows of the lower body that have one of the upper one
      for (Eigen::Index i = 0; i < n; ++i)
      {
         for (int c : {0, 1, 2})
         {
            upper_of[below.surface.nodes[pairs.partner[i]].dofs[c]] = surface.nodes[i].dofs[c];
         }
      }
      for (int row = 0; row < lower.K.rows(); ++row)
      {
         if (std::binary_search(lower.fixed.begin(), lower.fixed.end(), row)) { continue; }
         VectorXd column = VectorXd::Unit(both, one + row);
         if (upper_of.count(row) == 1) { column[upper_of[row]] = 1; }
         columns.push_back(column);
      }
      for (Eigen::Index row = 0; row < one; ++row)
      {
         if (!contact[row]) { columns.push_back(VectorXd::Unit(both, row)); }
      }
      const auto count = static_cast<Eigen::Index>(columns.size()), rest = count - 3 * n;
      MatrixXd T(both, count), K = MatrixXd::Zero(both, both);
      for (Eigen::Index k = 0; k < count; ++k) { T.col(k) = columns[k]; }
      K.topLeftCorner(one, one) = MatrixXd(upper.K);
      K.bottomRightCorner(both - one, both - one) = MatrixXd(lower.K);
      VectorXd F = VectorXd::Zero(both);
      F.head(one) = upper.loads[0].values;
      const MatrixXd A = T.transpose() * K * T;
      const VectorXd f = T.transpose() * F;
      const Eigen::LDLT<MatrixXd> inner(A.bottomRightCorner(rest, rest));
      const MatrixXd S =
         A.topLeftCorner(3 * n, 3 * n) -
         A.topRightCorner(3 * n, rest) * inner.solve(A.bottomLeftCorner(rest, 3 * n));
      const VectorXd g =
         f.head(3 * n) - A.topRightCorner(3 * n, rest) * inner.solve(f.tail(rest));
      // 2. In the frames of the problem.
      MatrixXd R = MatrixXd::Zero(3 * n, 3 * n);
      const Reduction reduction = reduce(above, below, pairs);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         for (int k = 0; k < 9; ++k)
         {
            R(k / 3 * n + i, k % 3 * n + i) = reduction.interfaces[0].frames(i, k);
         }
      }
      EXPECT_LT(difference(problem.K, MatrixXd(R * S * R.transpose())), 1e-12);
      VectorXd forces(3 * n);
      forces << problem.patterns[0].q, problem.patterns[0].p;
      EXPECT_LT(difference(forces, VectorXd(-R * g)), 1e-12);
      // 3. The product does the same without the second dense matrix.
      const CondensedBody joint = condense_joint(upper.body(), above.surface, lower.body(),
                                                 below.surface, pairs.partner);
      EXPECT_EQ(joint.S.rows(), 3 * n);
      EXPECT_EQ(joint.rigid_modes, 6);
      Reduction relative = reduce(joint, pairs.gap), both_bodies = reduction;
      const ReducedProblem &its = relative.problem;
      EXPECT_LT(difference(its.K, problem.K), 1e-12);
      EXPECT_LT(difference(its.patterns[0].p, problem.patterns[0].p), 1e-12);
      EXPECT_LT(difference(its.patterns[0].q, problem.patterns[0].q), 1e-12);
      EXPECT_LT(difference(its.weights, problem.weights), 1e-14);
      EXPECT_LT(difference(its.H, problem.H), 1e-12);
      EXPECT_EQ(its.rigid_motions.cols(), 6);
      VectorXd v(2 * n), w(n), load = VectorXd::Constant(1, 0.7);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         v[i] = std::sin(i + 1.0);
         v[n + i] = std::cos(3.0 * i);
         w[i] = std::sin(2.0 * i);
      }
      VectorXd apart(both);
      apart << both_bodies.displacement(0, v, w, load), both_bodies.displacement(1, v, w, load);
      EXPECT_LT(difference(relative.displacement(0, v, w, load), apart), 1e-11);
   }
   // Supports that hold contact nodes of both bodies or of the second one alone, loads of both,
   // and what cannot be.
   NodalStiffness upper = block({2, 1, 2}, {0, 0, 0}, {2, 1, 2}, 1, 0.3),
                  lower = block({2, 1, 2}, {0, -1, 0}, {2, 1, 2}, 4, 0.2);
   for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
   const auto side_of = [](const NodalStiffness &body, double x)
   {
      Nodes found;
      for (const auto &[node, place] : body.places)
      {
         if (place[0] == x) { found.push_back(node); }
      }
      return found;
   };
   const NodalStiffness free_upper = upper;
   upper.fix(side_of(upper, 0), 1);
   lower.fix(side_of(lower, 0), 1);
   lower.fix(side_of(lower, 2), 3);
   upper.add_surface_traction("P", upper.nodes_of("TOP"), {0.1, -1, 0.05});
   upper.add_forces("Q", upper.nodes_of("BOTTOM"), 3, 0.1);
   lower.add_forces("Q", lower.nodes_of("TOP"), 3, 0.2);
   lower.add_displacement("U", lower.nodes_of("BOTTOM"), 2, 0.3);
   const CondensedBody above = on_surface(upper, "BOTTOM"), below = on_surface(lower, "TOP");
   const Pairing pairs = pair_surfaces(above.surface, below.surface);
   const Reduction apart = reduce(above, below, pairs),
                   together = reduce(condense_joint(upper.body(), above.surface, lower.body(),
                                                    below.surface, pairs.partner),
                                     pairs.gap);
   EXPECT_EQ(together.problem.held, apart.problem.held);
   const std::vector<VectorXd> path = {Vector3d(1, 0, 0), Vector3d(1, 0.5, 0.01),
                                       Vector3d(1, -0.5, 0.02)};
   const std::vector<ContactState> one = solved(apart.problem, 0.3, path),
                                   other = solved(together.problem, 0.3, path);
   for (std::size_t k = 0; k < path.size(); ++k)
   {
      EXPECT_LT(difference(together.contact_forces(0, other[k].q, other[k].p),
                           apart.contact_forces(0, one[k].q, one[k].p)),
                1e-10);
   }
   const auto joined_by = [](const NodalStiffness &first, const NodalStiffness &second)
   {
      const ContactSurface on = first.contact_surface(first.nodes_of("BOTTOM")),
                           under = second.contact_surface(second.nodes_of("TOP"));
      return condense_joint(first.body(), on, second.body(), under,
                            pair_surfaces(on, under).partner);
   };
   NodalStiffness alone = upper, loose = lower, driven = upper;
   alone.fix(alone.nodes_of("BOTTOM"), 3);
   expect_input_error([&] { joined_by(alone, lower); }, "in the first body only");
   loose.fixed.clear();
   loose.loads.clear();
   expect_input_error([&] { joined_by(free_upper, loose); },
                      "rigid motion(s) of the second body");
   driven.add_displacement("D", side_of(driven, 0), 1, 0.1);
   expect_input_error([&] { joined_by(driven, lower); }, "moves the contact node");
}
