#include "comparison.hpp"
#include "contact_laws.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Nodes = NodalStiffness::Nodes;

/// Which solids a block is made of: every cell one hexahedron, two wedges, or six tetrahedra.
enum class Solid
{
   hexahedra,
   wedges,
   tetrahedra
};

/// Gradients of the functions of an element by its parameters, a row each.
MatrixXd gradients(std::size_t nodes, int dimension, const Vector3d &at)
{
   MatrixXd G(nodes, dimension);
   if (dimension == 2 || nodes == 8) // bilinear or trilinear on -1 to 1
   {
      const double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
      for (std::size_t a = 0; a < nodes; ++a)
      {
         for (int c = 0; c < dimension; ++c)
         {
            double g = 0.5 * corner[a][c];
            for (int k = 0; k < dimension; ++k)
            {
               if (k != c) { g *= 0.5 * (1 + corner[a][k] * at[k]); }
            }
            G(a, c) = g;
         }
      }
      return G;
   }
   if (nodes == 4) // linear
   {
      G << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
      return G;
   }
   // A triangle 0 <= s, t, s + t <= 1 times a line from -1 to 1.
   const double L[] = {1 - at[0] - at[1], at[0], at[1]}, by_s[] = {-1, 1, 0},
                by_t[] = {-1, 0, 1};
   for (int a = 0; a < 6; ++a)
   {
      const double side = a < 3 ? -1 : 1, share = 0.5 * (1 + side * at[2]);
      G.row(a) << share * by_s[a % 3], share * by_t[a % 3], 0.5 * side * L[a % 3];
   }
   return G;
}

/// Points (and weights) that integrate the stiffness of a straight element.
std::vector<std::pair<Vector3d, double>> rule(std::size_t nodes, int dimension)
{
   const double g = 1 / std::sqrt(3.0);
   std::vector<std::pair<Vector3d, double>> points;
   if (dimension == 3 && nodes == 4) { return {{Vector3d::Constant(0.25), 1.0 / 6}}; }
   if (dimension == 3 && nodes == 6)
   {
      for (double z : {-g, g})
      {
         for (const auto &[s, t] :
              {std::pair(1 / 6., 1 / 6.), {2 / 3., 1 / 6.}, {1 / 6., 2 / 3.}})
         {
            points.push_back({{s, t, z}, 1.0 / 6});
         }
      }
      return points;
   }
   for (double x : {-g, g})
   {
      for (double y : {-g, g})
      {
         if (dimension == 2) { points.push_back({{x, y, 0}, 1}); }
         for (double z : {-g, g})
         {
            if (dimension == 3) { points.push_back({{x, y, z}, 1}); }
         }
      }
   }
   return points;
}

/// Assembles isotropic elements, in the plane those of plane strain.
NodalStiffness::Matrix stiffness(const std::vector<Nodes> &elements,
                                 const std::vector<Vector3d> &places, int d, double E,
                                 double nu)
{
   const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
   std::vector<Eigen::Triplet<double>> entries;
   for (const Nodes &element : elements)
   {
      const std::size_t n = element.size();
      MatrixXd x(n, d), K = MatrixXd::Zero(d * n, d * n);
      for (std::size_t a = 0; a < n; ++a) { x.row(a) = places[element[a]].head(d).transpose(); }
      for (const auto &[at, weight] : rule(n, d))
      {
         const MatrixXd G = gradients(n, d, at), J = x.transpose() * G, B = G * J.inverse();
         const double volume = weight * std::abs(J.determinant());
         for (std::size_t a = 0; a < n; ++a)
         {
            for (std::size_t b = 0; b < n; ++b)
            {
               MatrixXd block = lambda * B.row(a).transpose() * B.row(b) +
                                mu * B.row(b).transpose() * B.row(a);
               block += mu * B.row(a).dot(B.row(b)) * MatrixXd::Identity(d, d);
               K.block(d * a, d * b, d, d) += volume * block;
            }
         }
      }
      for (Eigen::Index i = 0; i < K.rows(); ++i)
      {
         for (Eigen::Index j = 0; j < K.cols(); ++j)
         {
            entries.emplace_back(d * element[i / d] + i % d, d * element[j / d] + j % d,
                                 K(i, j));
         }
      }
   }
   const auto size = d * static_cast<Eigen::Index>(places.size());
   NodalStiffness::Matrix K(size, size);
   K.setFromTriplets(entries.begin(), entries.end());
   return K;
}

/** A block of cells, at `from`, with sets BOTTOM (least y), TOP and SIDES (least and largest
   z), and turned about the origin after that. Axes of a block that is not turned: x along, y
   up, z through the thickness. */
NodalStiffness block(std::array<int, 3> cells, const Vector3d &from, const Vector3d &size,
                     double E, double nu, Solid solid = Solid::hexahedra,
                     const Matrix3d &turn = Matrix3d::Identity())
{
   NodalStiffness made;
   made.formulation = Formulation::space;
   const auto [nx, ny, nz] = cells;
   const auto number = [nx = nx, ny = ny](int i, int j, int k)
   { return i + (nx + 1) * (j + (ny + 1) * k); };
   std::vector<Vector3d> places;
   std::vector<Nodes> elements;
   for (int k = 0; k <= nz; ++k)
   {
      for (int j = 0; j <= ny; ++j)
      {
         for (int i = 0; i <= nx; ++i)
         {
            const int id = number(i, j, k);
            const Vector3d share(double(i) / nx, double(j) / ny, double(k) / nz);
            places.push_back(turn * (from + share.cwiseProduct(size)));
            made.places[id] = places.back().head(2);
            made.z[id] = places.back()[2];
            for (int c = 1; c <= 3; ++c) { made.dofs.push_back({id, c}); }
            if (j == 0) { made.sets["BOTTOM"].push_back(id); }
            if (j == ny) { made.sets["TOP"].push_back(id); }
            made.sets["ALL"].push_back(id);
            if (i == nx || j == ny || k == nz) { continue; }
            const int a = id, b = number(i + 1, j, k), c = number(i + 1, j + 1, k),
                      e = number(i, j + 1, k);
            const Nodes low{a, b, c, e},
               high{number(i, j, k + 1), number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1),
                    number(i, j + 1, k + 1)};
            if (solid == Solid::hexahedra)
            {
               elements.push_back(
                  {low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]});
            }
            else if (solid == Solid::wedges) // triangles below and above
            {
               elements.push_back({low[0], high[0], low[1], low[3], high[3], low[2]});
               elements.push_back({low[1], high[0], high[1], low[2], high[3], high[2]});
            }
            else // around the diagonal of the cell
            {
               const int way[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
               const Nodes all{low[0],  low[1],  low[2],  low[3],
                               high[0], high[1], high[2], high[3]};
               for (const auto &[s, t] : way)
               {
                  elements.push_back({all[0], all[s], all[t], all[6]});
               }
            }
         }
      }
   }
   made.K = stiffness(elements, places, 3, E, nu);
   made.faces = outer_faces(elements);
   return made;
}

/// The plane block of the same cells.
NodalStiffness plane_block(int nx, int ny, const Vector3d &from, const Vector3d &size, double E,
                           double nu)
{
   NodalStiffness made;
   std::vector<Vector3d> places;
   std::vector<Nodes> elements;
   for (int j = 0; j <= ny; ++j)
   {
      for (int i = 0; i <= nx; ++i)
      {
         const int id = i + (nx + 1) * j;
         const Vector3d share(double(i) / nx, double(j) / ny, 0);
         places.push_back(from + share.cwiseProduct(size));
         made.places[id] = places.back().head(2);
         for (int c : {1, 2}) { made.dofs.push_back({id, c}); }
         if (j == 0) { made.sets["BOTTOM"].push_back(id); }
         if (j == ny) { made.sets["TOP"].push_back(id); }
         if (i < nx && j < ny) { elements.push_back({id, id + 1, id + nx + 2, id + nx + 1}); }
      }
   }
   made.K = stiffness(elements, places, 2, E, nu);
   made.edges = outer_edges(elements, made.places);
   return made;
}

CondensedBody on_surface(const NodalStiffness &body, const std::string &set)
{
   return condense(body.body(), body.contact_surface(body.nodes_of(set)));
}

CondensedBody on_line(const NodalStiffness &body, const std::string &set)
{
   return condense(body.body(), body.contact_line(body.nodes_of(set)));
}

/// States at the ends of increments from loads to loads, which must all converge.
std::vector<ContactState> solved(ReducedProblem problem, double friction,
                                 const std::vector<VectorXd> &loads)
{
   set_friction(problem, friction);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   cattaneo_test::LawChecker laws(problem, state);
   std::vector<ContactState> all;
   for (const VectorXd &each : loads)
   {
      const VectorXd before = state.v;
      EXPECT_EQ(solver.solve(state, each).status, FrictionStatus::converged);
      EXPECT_LE(laws.violation(before, state), 1) << laws.what();
      all.push_back(state);
   }
   return all;
}

const Matrix3d askew =
   (Eigen::AngleAxisd(0.7, Vector3d::UnitX()) * Eigen::AngleAxisd(-1.1, Vector3d::UnitY()) *
    Eigen::AngleAxisd(0.4, Vector3d::UnitZ()))
      .toRotationMatrix();

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
      for (const Matrix3d &turn : {Matrix3d(Matrix3d::Identity()), askew})
      {
         NodalStiffness upper = block({3, 2, 2}, {0, 0, 0}, {3, height, 2}, E, 0, solid, turn),
                        lower = block({3, 2, 2}, {0, -1, 0}, {3, 1, 2}, 2 * E, 0, solid, turn);
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

TEST(Surfaces, ExtrudedPlaneProblemIsThePlaneOne)
{
   // A block is pressed on another one and sheared to and fro, in plane strain.
   const Vector3d low(0, -1, 0), up(0, 0, 0);
   const double friction = 0.4, thick = 0.7;
   const std::vector<Eigen::Vector2d> path = {{1, 0},    {1, 0.2}, {1, 0.3},
                                              {1, 0.36}, {1, 0.1}, {1, -0.33}};
   NodalStiffness above = plane_block(6, 3, up, {3, 2, 0}, 2, 0.3),
                  below = plane_block(6, 3, low, {3, 1, 0}, 5, 0.2);
   for (int c : {1, 2}) { below.fix(below.nodes_of("BOTTOM"), c); }
   above.add_traction("P", above.nodes_of("TOP"), Eigen::Vector2d(0, -1));
   above.add_traction("Q", above.nodes_of("TOP"), Eigen::Vector2d(1, 0));
   const CondensedBody one = on_line(above, "BOTTOM"), two = on_line(below, "TOP");
   const Reduction plane = reduce(one, two, pair_lines(one.line, two.line));
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
      // Turned so that x, y, z are y, z, x, and so on: supports stay along axes.
      Matrix3d turn = Matrix3d::Identity();
      for (int way = 0; way < 3; ++way)
      {
         Matrix3d next;
         next << 0, 0, 1, 1, 0, 0, 0, 1, 0;
         if (way > 0) { turn = next * turn; }
         NodalStiffness upper = block({6, 3, layers}, up, {3, 2, thick}, 2, 0.3,
                                      Solid::hexahedra, turn),
                        lower = block({6, 3, layers}, low, {3, 1, thick}, 5, 0.2,
                                      Solid::hexahedra, turn);
         int through = 0;
         turn.col(2).maxCoeff(&through);
         for (NodalStiffness *body : {&upper, &lower})
         {
            body->fix(body->nodes_of("ALL"), through + 1);
         }
         for (int c : {1, 2, 3}) { lower.fix(lower.nodes_of("BOTTOM"), c); }
         upper.add_surface_traction("P", upper.nodes_of("TOP"), Vector3d(-turn.col(1)));
         upper.add_surface_traction("Q", upper.nodes_of("TOP"), Vector3d(turn.col(0)));
         const CondensedBody first = on_surface(upper, "BOTTOM"),
                             second = on_surface(lower, "TOP");
         const Reduction reduction =
            reduce(first, second, pair_surfaces(first.surface, second.surface));
         const ReducedProblem &problem = reduction.problem;
         ASSERT_EQ(problem.nodes(), n * (layers + 1));
         EXPECT_EQ(problem.held.size(), static_cast<std::size_t>(problem.nodes()));
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
               EXPECT_EQ(force[2], 0);
               EXPECT_NEAR(states[k].w[i], expected[k].w[m], 1e-10 * largest(expected[k].w));
            }
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

TEST(Surfaces, MatrixMarketFilesKeepBodiesInSpace)
{
   NodalStiffness body = block({2, 1, 1}, {0, 0, 0}, {2, 1, 1}, 1, 0.3, Solid::wedges, askew);
   for (int c : {1, 2, 3}) { body.fix(body.nodes_of("TOP"), c); }
   body.add_forces("F", {0}, 3, 2.5);
   const std::string file = "surfaces_test.mtx";
   write_matrix_market(file, body);
   const NodalStiffness read = read_stiffness(file);
   EXPECT_EQ(read.formulation, Formulation::space);
   EXPECT_EQ(read.z, body.z);
   EXPECT_EQ(read.faces, body.faces);
   EXPECT_EQ(read.fixed, body.fixed);
   EXPECT_LT(difference(MatrixXd(read.K), MatrixXd(body.K)), 1e-15);
   EXPECT_EQ(read.loads.at(0).values, body.loads.at(0).values);
   const MatrixXd S = on_surface(body, "BOTTOM").S;
   EXPECT_LT(difference(on_surface(read, "BOTTOM").S, S), 1e-13);
   expect_input_error([&] { write_abaqus("surfaces_test.inp", body); }, "is in space");
   std::filesystem::remove(file);
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
      "has 2 nodes, must have 3 or 4");
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
