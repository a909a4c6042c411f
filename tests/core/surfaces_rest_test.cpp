#include "blocks_of_cells.hpp"
#include "comparison.hpp"
#include "contact_laws.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
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
using cattaneo_test::on_surface;
using cattaneo_test::pressed;
using cattaneo_test::Solid;
using cattaneo_test::solved;

/// A block that stands on the origin's plane, clamped on top.
NodalStiffness hanging(Solid solid, int order, const Matrix3d &turn = Matrix3d::Identity())
{
   NodalStiffness body = block({3, 2, 2}, {-1, 0, -1}, {2, 1.2, 2}, 1, 0.3, solid, turn, order);
   return body;
}

} // namespace

TEST(Surfaces, OrderTwoReducesAsTheWholeStiffnessDoes)
{
   // The block's reduced energy is that of the whole body, whatever the unknowns, on curved
   // faces and where supports hold nodes.
   const auto bend = [](const Vector3d &x)
   { return Vector3d(x[0], x[1] + 0.1 * x[0] * (1 - x[0]), x[2]); };
   NodalStiffness body = block({2, 2, 2}, {0, 0, 0}, {1, 1, 1}, 1, 0.3, Solid::hexahedra,
                               Matrix3d::Identity(), 2, bend);
   const CondensedBody free = on_surface(body, "BOTTOM");
   EXPECT_EQ(free.rigid_modes, 6);
   EXPECT_LT(largest(free.S * free.rigid_motions({3, 2, 1})), 1e-11 * largest(free.S));
   EXPECT_GT(largest(free.surface.points() - free.surface.positions()), 1e-3);
   // Forces have the same moments about any point in both.
   const MatrixXd any = MatrixXd::Random(free.nodes(), 3),
                  nodal = free.surface.forces_at_nodes(any);
   Vector3d moment(0, 0, 0);
   for (Eigen::Index i = 0; i < free.nodes(); ++i)
   {
      moment += Vector3d(free.surface.points().row(i)).cross(Vector3d(any.row(i))) -
                Vector3d(free.surface.positions().row(i)).cross(Vector3d(nodal.row(i)));
   }
   EXPECT_LT(moment.norm(), 1e-13);
   body.add_forces("F", {body.nodes_of("TOP").front()}, 1, 1);
   Nodes side;
   for (int node : body.nodes_of("ALL"))
   {
      if (body.z.at(node) == 0) { side.push_back(node); }
   }
   body.fix(side, 3);
   for (int c : {1, 2, 3}) { body.fix(body.nodes_of("TOP"), c); }
   CondensedBody held = on_surface(body, "BOTTOM");
   EXPECT_EQ(held.rigid_modes, 0);
   EXPECT_LT(held.error_estimate(), 1e-10);
   VectorXd u = VectorXd::Random(held.S.rows());
   for (int row : held.held) { u[row] = 0; }
   const VectorXd field = held.recover(u, VectorXd::Zero(1));
   const VectorXd forces = body.K * field;
   EXPECT_NEAR(u.dot(held.S * u), field.dot(forces), 1e-12 * field.dot(forces));
   // Support of a middle alone is a relation between unknowns.
   const ContactSurface bottom = body.contact_surface(body.nodes_of("BOTTOM"));
   NodalStiffness odd = body;
   for (const SurfaceNode &node : bottom.nodes)
   {
      if (node.between[0] < 0 || node.position[2] != 0.5) { continue; }
      odd.fix({body.dofs[node.dofs[0]].node}, 1);
      break;
   }
   expect_input_error([&] { on_surface(odd, "BOTTOM"); }, "it must hold both ends as well");
}

TEST(Surfaces, ObstaclesMoveAsTheBodyWouldTheOtherWay)
{
   const double up = 0.01, aside = 0.002, turn = 0.003;
   for (const int order : {1, 2})
   {
      for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
      {
         const NodalStiffness body = hanging(solid, order);
         // 1. The plane comes up, moves aside and turns about z while the top is held.
         NodalStiffness held = body;
         for (int c : {1, 2, 3}) { held.fix(held.nodes_of("TOP"), c); }
         const CondensedBody condensed = on_surface(held, "BOTTOM");
         Reduction moves =
            reduce(condensed, gaps_to_plane(condensed.surface, {0, 0, 0}, {0, 1, 0}));
         moves.add_obstacle_motion(
            "U", [&](double, double y, double) { return aside - turn * y; },
            [&](double x, double, double) { return up + turn * x; }, aside / 2);
         const ContactState found = pressed(moves.problem, 0.3);
         // 2. The plane rests, and the top does the opposite.
         NodalStiffness other = body;
         for (int node : other.nodes_of("TOP"))
         {
            const Vector3d x = other.place(node);
            other.add_displacement("U", {node}, 1, -(aside - turn * x[1]));
            other.add_displacement("U", {node}, 2, -(up + turn * x[0]));
            other.add_displacement("U", {node}, 3, -aside / 2);
         }
         const CondensedBody rests = on_surface(other, "BOTTOM");
         const Reduction still = reduce(rests, VectorXd::Zero(rests.nodes()));
         const ContactState expected = pressed(still.problem, 0.3);
         EXPECT_GT(expected.p.sum(), 1e-3);
         EXPECT_LT(difference(found.p, expected.p), 1e-11);
         EXPECT_LT(difference(found.q, expected.q), 1e-11);
         // 3. A plate that is free to move up takes the force on it.
         Reduction plate = reduce(condensed, VectorXd::Zero(condensed.nodes()));
         plate.free_obstacles({{"P", 1, {{0, 0.0, 1.0}}}});
         const ContactState carried = pressed(plate.problem, 0.3);
         expect_relative(carried.p.sum(), 1, 1e-12);
      }
   }
}

TEST(Surfaces, CylindersAndHeightsAreAsFarAsClosedFormsSay)
{
   const NodalStiffness body = block({3, 1, 2}, {-1, 0.1, -1}, {2, 1, 2}, 1, 0.2);
   const ContactSurface surface = body.contact_surface(body.nodes_of("BOTTOM"));
   const VectorXd along = gaps_to_cylinder(surface, {0, -10, 3}, {0, 0, -2}, 10),
                  bore = gaps_to_cylinder(surface, {0, 10, 0}, {1, 0, 0}, -10.5);
   // Heights are of z; the block is turned so that its bottom looks along it.
   Matrix3d turn;
   turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
   const NodalStiffness turned =
      block({3, 1, 2}, {-1, 0.1, -1}, {2, 1, 2}, 1, 0.2, Solid::hexahedra, turn);
   const ContactSurface below = turned.contact_surface(turned.nodes_of("BOTTOM"));
   const VectorXd wavy =
      gaps_to_height(below, [](double x, double y) { return 0.02 * x * y - 0.01 * x; });
   for (Eigen::Index i = 0; i < surface.size(); ++i)
   {
      const Vector3d &x = surface.nodes[i].position, &z = below.nodes[i].position;
      EXPECT_NEAR(along[i], 0.1 + 10 - std::sqrt(100 - x[0] * x[0]), 1e-13);
      EXPECT_NEAR(bore[i], 0.1 - 10 + std::sqrt(10.5 * 10.5 - x[2] * x[2]), 1e-13);
      EXPECT_NEAR(wavy[i], 0.1 - 0.02 * z[0] * z[1] + 0.01 * z[0], 1e-13);
   }
   expect_input_error(
      [&] {
         gaps_to_cylinder(surface, {0, 0, 0}, {0, 1, 0}, 1);
      },
      "does not face the obstacle");
   expect_input_error([&] { gaps_to_cylinder(surface, {0, 0, 0}, {0, 0, 0}, 1); }, "no axis");
   expect_input_error([&] { gaps_to_height(below, [](double, double) { return HUGE_VAL; }); },
                      "is not a finite number");
   expect_input_error(
      [&] {
         gaps_to_cylinder(surface, {5, -1, 0}, {0, 0, 1}, 1);
      },
      "no node of the side faces the cylinder");
}

TEST(Surfaces, DecksOfAbaqusHaveSolidsAndTheirFaces)
{
   // One hexahedron of 8 and of 20 nodes, clamped on top, on its face S3.
   for (const int order : {1, 2})
   {
      NodalStiffness body = block({1, 1, 1}, {0, 0, 0}, {2, 1, 3}, 7, 0.3, Solid::hexahedra,
                                  Matrix3d::Identity(), order);
      std::ofstream deck("surfaces_deck.inp"), matrix("surfaces_deck.mtx");
      deck << "*NODE\n";
      for (const auto &[node, place] : body.places)
      {
         deck << node + 1 << ", " << place[0] << ", " << place[1] << ", " << body.z[node]
              << "\n";
      }
      deck << "*ELEMENT, TYPE=" << (order == 1 ? "C3D8" : "C3D20R") << ", ELSET=CUBE\n"
           << "11, 1, 2, 4, 3, 5, 6, 8, 7";
      for (int node = 8; order == 2 && node < 20; ++node)
      {
         deck << (node == 13 ? ",\n" : ", ") << node + 1;
      }
      deck << "\n*SURFACE, NAME=LOW\nCUBE, S3\n*NSET, NSET=UP\n";
      for (int node : body.nodes_of("TOP")) { deck << node + 1 << "\n"; }
      deck << "*STEP\n*BOUNDARY\nUP, 1, 3\n*CLOAD\n1, 3, 2.5\n*END STEP\n";
      deck.close();
      matrix.precision(17);
      for (int row = 0; row < body.K.rows(); ++row)
      {
         for (NodalStiffness::Matrix::InnerIterator e(body.K, row); e; ++e)
         {
            if (e.col() > row) { continue; }
            const NodeDof &one = body.dofs[row], &other = body.dofs[e.col()];
            matrix << one.node + 1 << "," << one.direction << "," << other.node + 1 << ","
                   << other.direction << "," << e.value() << "\n";
         }
      }
      matrix.close();
      const NodalStiffness read = read_stiffness("surfaces_deck.mtx");
      EXPECT_EQ(read.formulation, Formulation::space);
      EXPECT_EQ(read.faces.size(), 6U);
      EXPECT_EQ(read.nodes_of("LOW").size(), order == 1 ? 4U : 8U);
      for (int c : {1, 2, 3}) { body.fix(body.nodes_of("TOP"), c); }
      body.add_forces("CLOAD1", {0}, 3, 2.5);
      EXPECT_EQ(read.fixed.size(), body.fixed.size());
      const CondensedBody expected = on_surface(body, "BOTTOM"),
                          found = on_surface(read, "LOW");
      EXPECT_LT(std::abs(found.S.trace() - expected.S.trace()), 1e-12 * expected.S.trace());
      EXPECT_LT(std::abs(found.S.norm() - expected.S.norm()), 1e-12 * expected.S.norm());
      // The same nodes, perhaps in another order.
      for (Eigen::Index i = 0; i < expected.nodes(); ++i)
      {
         Eigen::Index k = 0;
         while ((found.surface.nodes[k].position - expected.surface.nodes[i].position).norm() >
                1e-12)
         {
            ASSERT_LT(++k, found.nodes());
         }
         EXPECT_NEAR(found.patterns.at(0).p[k], expected.patterns.at(0).p[i], 1e-12);
      }
   }
   std::ofstream("surfaces_deck.inp", std::ios::app) << "*SURFACE, NAME=NO\nCUBE, S7\n";
   expect_input_error([] { read_stiffness("surfaces_deck.mtx"); }, "of solids to S6");
   std::filesystem::remove("surfaces_deck.inp");
   std::filesystem::remove("surfaces_deck.mtx");
}

namespace
{

/// A block of elements of order 3, hexahedra of 64 nodes or tetrahedra of 20, which share all
/// nodes, with sets and faces BOTTOM and TOP.
NodalStiffness cubic_block(std::array<int, 3> cells, const Vector3d &from, const Vector3d &size,
                           double E, bool hexahedra, const Matrix3d &turn)
{
   using Place = std::array<int, 3>; // in thirds of cells
   const auto [nx, ny, nz] = cells;
   const auto number = [nx = 3 * nx + 1, ny = 3 * ny + 1](const Place &at)
   { return at[0] + nx * (at[1] + ny * at[2]); };
   NodalStiffness made;
   made.formulation = Formulation::space;
   std::vector<Vector3d> places((3 * nx + 1) * (3 * ny + 1) * (3 * nz + 1));
   std::vector<std::pair<std::vector<Place>, bool>> solids; // corners
   for (int i = 0; i <= 3 * nx; ++i)
   {
      for (int j = 0; j <= 3 * ny; ++j)
      {
         for (int k = 0; k <= 3 * nz; ++k)
         {
            const int id = number({i, j, k});
            const Vector3d share(i / (3. * nx), j / (3. * ny), k / (3. * nz));
            places[id] = turn * (from + share.cwiseProduct(size));
            made.places[id] = places[id].head(2);
            made.z[id] = places[id][2];
            for (int c = 1; c <= 3; ++c) { made.dofs.push_back({id, c}); }
            if (j == 0) { made.sets["BOTTOM"].push_back(id); }
            if (j == 3 * ny) { made.sets["TOP"].push_back(id); }
         }
      }
   }
   std::sort(made.dofs.begin(), made.dofs.end());
   const int corner[8][3] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                             {0, 0, 3}, {3, 0, 3}, {3, 3, 3}, {0, 3, 3}};
   std::vector<std::vector<Place>> of_solids;
   for (int cell = 0; cell < nx * ny * nz; ++cell)
   {
      std::vector<Place> all;
      for (const auto &at : corner)
      {
         all.push_back({3 * (cell % nx) + at[0], 3 * (cell / nx % ny) + at[1],
                        3 * (cell / nx / ny) + at[2]});
      }
      if (hexahedra)
      {
         of_solids.push_back(all);
         continue;
      }
      const int way[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
      for (const auto &[s, t] : way) { of_solids.push_back({all[0], all[s], all[t], all[6]}); }
   }
   // 1. Monomials at the nodes of one element, whose parameters are thirds.
   std::vector<Place> thirds;
   for (int i = 0; i <= 3; ++i)
   {
      for (int j = 0; j <= 3; ++j)
      {
         for (int k = 0; k <= 3; ++k)
         {
            if (hexahedra || i + j + k <= 3) { thirds.push_back({i, j, k}); }
         }
      }
   }
   const auto n = static_cast<Eigen::Index>(thirds.size());
   const auto power = [](double x, int of) { return of < 0 ? 0 : std::pow(x, of); };
   const auto monomial = [&](const Place &of, const Vector3d &at)
   { return power(at[0], of[0]) * power(at[1], of[1]) * power(at[2], of[2]); };
   MatrixXd values(n, n);
   for (Eigen::Index m = 0; m < n; ++m)
   {
      for (Eigen::Index a = 0; a < n; ++a)
      {
         values(m, a) =
            monomial(thirds[m], Vector3d(thirds[a][0], thirds[a][1], thirds[a][2]) / 3);
      }
   }
   const Eigen::PartialPivLU<MatrixXd> basis(values);
   // 2. Four points a direction; of tetrahedra one side of a cube is a point.
   const double inner = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)),
                outer = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2)),
                one[] = {(1 - outer) / 2, (1 - inner) / 2, (1 + inner) / 2, (1 + outer) / 2},
                large = (18 + std::sqrt(30.)) / 72, small = (18 - std::sqrt(30.)) / 72,
                its[] = {small, large, large, small};
   std::vector<std::pair<MatrixXd, double>> points; // gradients by parameters, weight
   for (int k = 0; k < 64; ++k)
   {
      const double a = one[k / 16], b = one[k / 4 % 4], c = one[k % 4],
                   cube = its[k / 16] * its[k / 4 % 4] * its[k % 4];
      Vector3d at(a, b, c);
      double weight = cube;
      if (!hexahedra)
      {
         at = {a, (1 - a) * b, (1 - a) * (1 - b) * c};
         weight *= (1 - a) * (1 - a) * (1 - b);
      }
      MatrixXd slopes(n, 3);
      for (Eigen::Index m = 0; m < n; ++m)
      {
         for (int d = 0; d < 3; ++d)
         {
            Place lower = thirds[m];
            slopes(m, d) = lower[d] * monomial((--lower[d], lower), at);
         }
      }
      points.emplace_back(basis.solve(slopes), weight);
   }
   // 3. Elements are parallelepipeds or straight tetrahedra; Poisson's ratio is 0.
   std::vector<Eigen::Triplet<double>> entries;
   for (const std::vector<Place> &solid : of_solids)
   {
      const int along[3] = {1, hexahedra ? 3 : 2, hexahedra ? 4 : 3};
      Matrix3d J;
      std::vector<int> ids;
      for (int d = 0; d < 3; ++d)
      {
         J.col(d) = places[number(solid[along[d]])] - places[number(solid[0])];
      }
      for (const Place &at : thirds)
      {
         Place here = solid[0];
         for (int d = 0; d < 3; ++d)
         {
            for (int c = 0; c < 3; ++c)
            {
               here[c] += at[d] * (solid[along[d]][c] - solid[0][c]) / 3;
            }
         }
         ids.push_back(number(here));
      }
      for (const auto &[slopes, weight] : points)
      {
         const MatrixXd B = slopes * J.inverse();
         const double volume = weight * std::abs(J.determinant());
         for (Eigen::Index a = 0; a < n; ++a)
         {
            for (Eigen::Index b = 0; b < n; ++b)
            {
               const Matrix3d block = 0.5 * E * volume *
                                      (B.row(b).transpose() * B.row(a) +
                                       B.row(a).dot(B.row(b)) * MatrixXd::Identity(3, 3));
               for (int c = 0; c < 9; ++c)
               {
                  entries.emplace_back(3 * ids[a] + c / 3, 3 * ids[b] + c % 3,
                                       block(c / 3, c % 3));
               }
            }
         }
      }
      // 4. Faces on top and bottom, by their corners.
      std::vector<std::vector<int>> sides = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
      if (hexahedra) { sides = {{0, 1, 5, 4}, {3, 7, 6, 2}}; }
      for (const std::vector<int> &side : sides)
      {
         const Place &a = solid[side[0]], &b = solid[side[1]], &c = solid[side[2]];
         if (a[1] != b[1] || b[1] != c[1] || a[1] % (3 * ny) != 0) { continue; }
         const auto at = [&](int i, int j)
         {
            // From the first corner along the first edge and the last one.
            const Place &last = solid[side.back()];
            Place here = a;
            for (int d = 0; d < 3; ++d)
            {
               here[d] += (i * (b[d] - a[d]) + j * (last[d] - a[d])) / 3;
            }
            return number(here);
         };
         if (hexahedra)
         {
            made.faces.push_back({at(0, 0), at(3, 0), at(3, 3), at(0, 3), at(1, 0), at(2, 0),
                                  at(3, 1), at(3, 2), at(2, 3), at(1, 3), at(0, 2), at(0, 1),
                                  at(1, 1), at(2, 1), at(2, 2), at(1, 2)});
         }
         else
         {
            made.faces.push_back({at(0, 0), at(3, 0), at(0, 3), at(1, 0), at(2, 0), at(2, 1),
                                  at(1, 2), at(0, 2), at(0, 1), at(1, 1)});
         }
      }
   }
   const auto rows = static_cast<Eigen::Index>(3 * places.size());
   made.K.resize(rows, rows);
   made.K.setFromTriplets(entries.begin(), entries.end());
   return made;
}

} // namespace

TEST(Surfaces, FacesOfOrderThreeAreTakenAsTheyAre)
{
   const double E = 3, pressure = 0.02;
   for (const bool hexahedra : {false, true})
   {
      NodalStiffness upper = cubic_block({2, 1, 1}, {0, 0, 0}, {2, 1, 1}, E, hexahedra, askew),
                     lower =
                        cubic_block({2, 1, 1}, {0, -1, 0}, {2, 1, 1}, 2 * E, hexahedra, askew);
      // 1. Weights of a corner, a node of an edge and one inside, over the area of a face:
      // those of the rule of three eighths, and of its like on triangles.
      const std::vector<int> face = upper.faces[0];
      const ContactSurface alone = upper.contact_surface(std::vector<std::vector<int>>{face});
      const double area = hexahedra ? 1 : 0.5, corner = hexahedra ? 1. / 64 : 1. / 30,
                   edge = hexahedra ? 3. / 64 : 3. / 40, inside = hexahedra ? 9. / 64 : 9. / 20;
      const Eigen::Index corners = hexahedra ? 4 : 3;
      for (Eigen::Index i = 0; i < alone.size(); ++i)
      {
         const double share = i < corners ? corner : i < 3 * corners ? edge : inside;
         EXPECT_NEAR(alone.nodes[i].weight, share * area, 1e-14);
      }
      // 2. The other way round it is the same face.
      std::vector<int> round = face;
      std::reverse(round.begin(), round.begin() + corners);
      std::reverse(round.begin() + corners, round.begin() + 3 * corners);
      std::rotate(round.begin() + corners, round.begin() + corners + 2,
                  round.begin() + 3 * corners);
      std::reverse(round.begin() + 3 * corners, round.end());
      const ContactSurface other = upper.contact_surface(std::vector<std::vector<int>>{round});
      const auto dofs_around = [](const ContactSurface &surface)
      {
         std::vector<std::array<int, 3>> dofs;
         for (Eigen::Index node : surface.faces[0])
         {
            dofs.push_back(surface.nodes[node].dofs);
         }
         const auto first = static_cast<std::ptrdiff_t>(
            std::min_element(dofs.begin(), dofs.begin() + (dofs.size() == 10 ? 3 : 4)) -
            dofs.begin());
         return std::pair(dofs[first], dofs);
      };
      // Seen from the body both turn counter-clockwise; each node beside the same corner.
      EXPECT_EQ(dofs_around(alone).first, dofs_around(other).first);
      for (const ContactSurface *each : {&alone, &other})
      {
         const std::vector<Eigen::Index> &nodes = each->faces[0];
         const auto at = [&](Eigen::Index k) { return each->nodes[nodes[k]].position; };
         EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).dot(each->nodes[0].normal()), 0);
         for (Eigen::Index e = 0; e < corners; ++e)
         {
            const Vector3d step = (at((e + 1) % corners) - at(e)) / 3;
            EXPECT_LT((at(corners + 2 * e) - at(e) - step).norm(), 1e-14);
            EXPECT_LT((at(corners + 2 * e + 1) - at(e) - 2 * step).norm(), 1e-14);
         }
         for (Eigen::Index k = 3 * corners; k < static_cast<Eigen::Index>(nodes.size()); ++k)
         {
            const Eigen::Index own = k - 3 * corners;
            Vector3d inner = (at(0) + at(1) + at(2)) / 3;
            if (hexahedra)
            {
               const Vector3d next = at((own + 1) % 4) - at(own),
                              back = at((own + 3) % 4) - at(own);
               inner = at(own) + next / 3 + back / 3;
            }
            EXPECT_LT((at(k) - inner).norm(), 1e-14);
         }
      }
      // 3. A pressure goes through matching faces.
      for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
      upper.add_surface_traction("P", upper.nodes_of("TOP"),
                                 Vector3d(-pressure * askew.col(1)));
      const CondensedBody above = on_surface(upper, "BOTTOM"), below = on_surface(lower, "TOP");
      expect_relative(above.surface.weights().sum(), 2, 1e-13);
      Reduction reduction = reduce(above, below, pair_surfaces(above.surface, below.surface));
      const ContactState state =
         solved(reduction.problem, 0.5, {VectorXd::Constant(1, 1)}).front();
      EXPECT_LT(largest(state.p - pressure * reduction.problem.weights), 1e-12 * pressure);
      EXPECT_LT(largest(state.q), 1e-12 * pressure);
      const VectorXd u = reduction.displacement(0, state.v, state.w, state.multipliers);
      const double down = pressure * (1 / E + 1 / (2 * E));
      for (int node : upper.nodes_of("TOP"))
      {
         EXPECT_LT((u.segment(3 * node, 3) + down * askew.col(1)).norm(), 1e-11 * down);
      }
      // 4. Nodes elsewhere than at thirds have other functions.
      NodalStiffness lobatto = upper;
      const int moved = face[corners];
      const Vector3d step = 0.06 * (lobatto.place(face[1]) - lobatto.place(face[0])),
                     at = lobatto.place(moved) - step;
      lobatto.places[moved] = at.head(2);
      lobatto.z[moved] = at[2];
      expect_input_error([&] { lobatto.contact_surface(std::vector<std::vector<int>>{face}); },
                         "must be at thirds of the face");
   }
}

TEST(Surfaces, LoadsMoveContactNodes)
{
   // A block with pressure on top, whose side at x = 0 is moved along x, contact nodes among
   // it.
   for (const int order : {1, 2})
   {
      for (const Solid solid : {Solid::hexahedra, Solid::tetrahedra})
      {
         NodalStiffness body =
            block({2, 2, 2}, {0, 0, 0}, {2, 1, 2}, 3, 0.3, solid, Matrix3d::Identity(), order);
         Nodes side;
         for (int node : body.nodes_of("ALL"))
         {
            if (body.places[node][0] == 0) { side.push_back(node); }
         }
         for (int c : {2, 3}) { body.fix(body.nodes_of("TOP"), c); }
         body.add_displacement("U", side, 1, 0.5);
         body.add_displacement("V", body.nodes_of("TOP"), 2, -2);
         body.add_forces("F", {side[1], body.nodes_of("TOP").back()}, 1, 0.25);
         body.add_forces("F", body.nodes_of("BOTTOM"), 2, 0.1);
         CondensedBody condensed = on_surface(body, "BOTTOM");
         ASSERT_GT(condensed.moved.size(), 0);
         EXPECT_TRUE(condensed.moves(0, 0));
         const ContactSurface &surface = condensed.surface;
         const Eigen::Index n = condensed.nodes();
         Eigen::VectorXd unknowns(3 * n);
         for (Eigen::Index k = 0; k < 3 * n; ++k) { unknowns[k] = std::sin(k + 1.0); }
         for (int row : condensed.held) { unknowns[row] = 0; }
         const Vector3d loads(0.7, -0.3, 1.1);
         const VectorXd u = condensed.recover(unknowns, loads);
         // 1. Supports are where the loads move them, unknowns are those given.
         for (int node : side) { EXPECT_NEAR(u[3 * node], 0.7 * 0.5, 1e-13); }
         for (int node : body.nodes_of("TOP")) { EXPECT_NEAR(u[3 * node + 1], 0.6, 1e-13); }
         MatrixXd at(n, 3);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            for (int c : {0, 1, 2}) { at(i, c) = u[surface.nodes[i].dofs[c]]; }
         }
         at = surface.of_nodes(at);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            const Vector3d local = surface.nodes[i].frame * at.row(i).transpose();
            for (int k : {0, 1, 2})
            {
               const auto row = static_cast<int>(k * n + i);
               if (std::count(condensed.held.begin(), condensed.held.end(), row) > 0)
               {
                  continue;
               }
               EXPECT_NEAR(local[k], unknowns[row], 1e-12);
            }
         }
         // 2. Forces of the contact are those that K u lacks; conjugates are the work of all on
         // the fields that loads alone would give.
         VectorXd external = VectorXd::Zero(body.K.rows());
         MatrixXd each(body.K.rows(), 3);
         VectorXd f = condensed.S * unknowns, g = condensed.H * loads;
         for (int k : {0, 1, 2})
         {
            const bool force = condensed.patterns[k].control == Control::force;
            VectorXd its(3 * n);
            its << condensed.patterns[k].q, condensed.patterns[k].p;
            f += loads[k] * its;
            g[k] += (force ? -1 : 1) * its.dot(unknowns);
            if (force) { external += loads[k] * body.loads[k].values; }
            each.col(k) = condensed.recover(VectorXd::Zero(3 * n), Vector3d::Unit(k));
         }
         MatrixXd forces(n, 3);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            const Vector3d local(f[i], f[n + i], f[2 * n + i]);
            forces.row(i) = surface.nodes[i].frame.transpose() * local;
         }
         forces = surface.forces_at_nodes(forces);
         VectorXd contact = VectorXd::Zero(body.K.rows());
         for (Eigen::Index i = 0; i < n; ++i)
         {
            for (int c : {0, 1, 2}) { contact[surface.nodes[i].dofs[c]] = forces(i, c); }
         }
         const VectorXd left = body.K * u - external - contact;
         for (Eigen::Index row = 0; row < left.size(); ++row)
         {
            const bool fixed =
               std::binary_search(body.fixed.begin(), body.fixed.end(), static_cast<int>(row));
            if (!fixed) { EXPECT_NEAR(left[row], 0, 1e-11); }
         }
         const VectorXd inner = body.K * u - external;
         for (int k : {0, 1})
         {
            const double work = each.col(k).dot(inner);
            EXPECT_NEAR(g[k], work, 1e-11 * (1 + std::abs(work)));
         }
         EXPECT_NEAR(g[2], body.loads[2].values.dot(u), 1e-11);
      }
   }
   // A flat face that is moved down presses as an obstacle that is moved up.
   NodalStiffness base = block({3, 2, 3}, {0, -1, 0}, {1, 1, 1}, 2, 0.3),
                  press = block({3, 1, 3}, {0, 0, 0}, {1, 1, 1}, 1, 0.3);
   for (int c : {1, 2, 3}) { base.fix(base.nodes_of("BOTTOM"), c); }
   for (int c : {1, 2, 3}) { press.fix(press.nodes_of("TOP"), c); }
   press.add_displacement("U", press.nodes_of("BOTTOM"), 2, -0.01);
   const CondensedBody below = on_surface(base, "TOP"), above = on_surface(press, "BOTTOM");
   const Reduction met = reduce(below, above, pair_surfaces(below.surface, above.surface));
   Reduction rigid = reduce(below, VectorXd::Zero(below.nodes()));
   rigid.add_obstacle_motion("U", 0.0, -0.01, 0.0);
   const VectorXd full = VectorXd::Constant(1, 1);
   const ContactState one = solved(met.problem, 0, {full})[0],
                      other = solved(rigid.problem, 0, {full})[0];
   EXPECT_GT(other.p.sum(), 1e-3);
   EXPECT_LT(difference(one.p, other.p), 1e-12);
   // Along the surface, on what cannot follow, the law of friction would have to know its slip.
   NodalStiffness slid = block({2, 1, 2}, {0, 0, 0}, {1, 1, 1}, 1, 0.3);
   slid.fix(slid.nodes_of("TOP"), 2);
   slid.add_displacement("U", slid.nodes_of("BOTTOM"), 1, 0.01);
   slid.fix(slid.nodes_of("TOP"), 3);
   const CondensedBody sliding = on_surface(slid, "BOTTOM");
   expect_input_error([&] { reduce(sliding, VectorXd::Zero(sliding.nodes())); },
                      "the other side cannot follow");
}
