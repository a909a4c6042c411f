#include "comparison.hpp"
#include "contact_laws.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/condense_joint.hpp>
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
#include <fstream>
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

/// Which solids a block is made of: every cell one hexahedron, two wedges, or six tetrahedra.
enum class Solid
{
   hexahedra,
   wedges,
   tetrahedra
};

/// Edges of a solid with so many corners: those of 4, 6 and 8.
std::vector<std::pair<int, int>> edges_of(std::size_t corners)
{
   if (corners == 4) { return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}; }
   if (corners == 6)
   {
      return {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
   }
   return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
           {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
}

/// Parameters of the corners of a solid.
std::vector<Vector3d> corners_of(std::size_t corners)
{
   if (corners == 4) { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }
   if (corners == 6)
   {
      return {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
   }
   return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
           {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
}

/// Gradients of the functions of order 2 of a solid with so many corners: those of its
/// monomials that are 1 at a node and 0 at the others.
MatrixXd quadratic_gradients(std::size_t corners, const Vector3d &at)
{
   std::vector<Vector3d> nodes = corners_of(corners);
   for (const auto &[a, b] : edges_of(corners)) { nodes.push_back((nodes[a] + nodes[b]) / 2); }
   std::vector<std::array<int, 3>> powers;
   for (int i = 0; i <= 2; ++i)
   {
      for (int j = 0; j <= 2; ++j)
      {
         for (int k = 0; k <= 2; ++k)
         {
            const int squares = (i == 2) + (j == 2) + (k == 2);
            const bool has = corners == 4   ? i + j + k <= 2
                             : corners == 6 ? i + j <= 2 && (k < 2 || i + j <= 1)
                                            : squares <= 1;
            if (has) { powers.push_back({i, j, k}); }
         }
      }
   }
   const auto n = static_cast<Eigen::Index>(nodes.size());
   EXPECT_EQ(powers.size(), nodes.size());
   const auto power = [](double x, int of) { return of < 0 ? 0 : std::pow(x, of); };
   MatrixXd values(n, n), slopes(n, 3);
   for (Eigen::Index m = 0; m < n; ++m)
   {
      const std::array<int, 3> &of = powers[m];
      for (Eigen::Index a = 0; a < n; ++a)
      {
         values(m, a) =
            power(nodes[a][0], of[0]) * power(nodes[a][1], of[1]) * power(nodes[a][2], of[2]);
      }
      for (int c = 0; c < 3; ++c)
      {
         double slope = of[c] * power(at[c], of[c] - 1);
         for (int d = 0; d < 3; ++d) { slope *= d == c ? 1 : power(at[d], of[d]); }
         slopes(m, c) = slope;
      }
   }
   return values.lu().solve(slopes);
}

/// Gradients of the functions of an element by its parameters, a row each.
MatrixXd gradients(std::size_t nodes, int dimension, const Vector3d &at)
{
   MatrixXd G(nodes, dimension);
   if (nodes == 10 || nodes == 15 || nodes == 20)
   {
      return quadratic_gradients(nodes == 10 ? 4 : nodes == 15 ? 6 : 8, at);
   }
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
   if (nodes == 10 || nodes == 15 || nodes == 20)
   {
      // Three points a direction on 0 to 1; of triangles and tetrahedra one side of a square or
      // a cube is a point.
      const double far = std::sqrt(0.15), one[] = {0.5 - far, 0.5, 0.5 + far},
                   its[] = {5. / 18, 8. / 18, 5. / 18};
      for (int k = 0; k < 27; ++k)
      {
         const int i = k / 9, j = k / 3 % 3, l = k % 3;
         const double a = one[i], b = one[j], c = one[l], w = its[i] * its[j] * its[l];
         if (nodes == 20) { points.push_back({{2 * a - 1, 2 * b - 1, 2 * c - 1}, 8 * w}); }
         else if (nodes == 15)
         {
            points.push_back({{a, (1 - a) * b, 2 * c - 1}, 2 * (1 - a) * w});
         }
         else
         {
            const double left = (1 - a) * (1 - b);
            points.push_back({{a, (1 - a) * b, left * c}, (1 - a) * left * w});
         }
      }
      return points;
   }
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
                     const Matrix3d &turn = Matrix3d::Identity(), int order = 1,
                     const std::function<Vector3d(const Vector3d &)> &bend = {})
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
   if (order == 2)
   {
      // Middles of edges belong to the sets that have both ends.
      std::map<std::pair<int, int>, int> known;
      const auto has = [&made](const std::string &set, int node)
      { return std::count(made.sets[set].begin(), made.sets[set].end(), node) > 0; };
      for (Nodes &element : elements)
      {
         const Nodes corners = element;
         for (const auto &[a, b] : edges_of(corners.size()))
         {
            const std::pair<int, int> ends = std::minmax(corners[a], corners[b]);
            const auto id = static_cast<int>(places.size());
            const auto [at, is_new] = known.emplace(ends, id);
            element.push_back(at->second);
            if (!is_new) { continue; }
            places.push_back((places[ends.first] + places[ends.second]) / 2);
            made.places[id] = places.back().head(2);
            made.z[id] = places.back()[2];
            for (int c = 1; c <= 3; ++c) { made.dofs.push_back({id, c}); }
            for (const char *set : {"BOTTOM", "TOP", "ALL"})
            {
               if (has(set, ends.first) && has(set, ends.second))
               {
                  made.sets[set].push_back(id);
               }
            }
         }
      }
   }
   for (std::size_t node = 0; node < places.size() && bend; ++node)
   {
      places[node] = bend(places[node]);
      made.places[static_cast<int>(node)] = places[node].head(2);
      made.z[static_cast<int>(node)] = places[node][2];
   }
   made.K = stiffness(elements, places, 3, E, nu);
   made.faces = outer_faces(elements, [&places](int node) { return places[node]; });
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

namespace
{

/// The forces of a problem whose single increment goes to loads of 1.
ContactState pressed(const ReducedProblem &problem, double friction)
{
   return solved(problem, friction, {VectorXd::Ones(Eigen::Index(problem.patterns.size()))})[0];
}

/// A block that stands on the origin's plane, clamped on top.
NodalStiffness hanging(Solid solid, int order, const Matrix3d &turn = Matrix3d::Identity())
{
   NodalStiffness body = block({3, 2, 2}, {-1, 0, -1}, {2, 1.2, 2}, 1, 0.3, solid, turn, order);
   return body;
}

} // namespace

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
