#include "blocks_of_cells.hpp"

#include "contact_laws.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Nodes = NodalStiffness::Nodes;

namespace
{

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

} // namespace

NodalStiffness block(std::array<int, 3> cells, const Vector3d &from, const Vector3d &size,
                     double E, double nu, Solid solid, const Matrix3d &turn, int order,
                     const std::function<Vector3d(const Vector3d &)> &bend)
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

ContactState pressed(const ReducedProblem &problem, double friction)
{
   return solved(problem, friction, {VectorXd::Ones(Eigen::Index(problem.patterns.size()))})[0];
}

const Matrix3d askew =
   (Eigen::AngleAxisd(0.7, Vector3d::UnitX()) * Eigen::AngleAxisd(-1.1, Vector3d::UnitY()) *
    Eigen::AngleAxisd(0.4, Vector3d::UnitZ()))
      .toRotationMatrix();

} // namespace cattaneo_test
