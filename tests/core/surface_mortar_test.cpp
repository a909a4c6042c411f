#include "comparison.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Geometry>
#include <cattaneo/reduced/surface_mortar.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Where a point (x, y) of the unit square lies.
using Shape = std::function<Vector3d(const Vector2d &)>;

/// How many faces, of how many nodes, on the unit square. Of `distorted` ones the nodes inside
/// are off a grid.
struct Grid
{
   int along, across, nodes;
   bool distorted = false;
   double by = 0.1; ///< of a cell
};

std::string name(const Grid &grid)
{
   return std::to_string(grid.along) + "x" + std::to_string(grid.across) + " of " +
          std::to_string(grid.nodes) + (grid.distorted ? " distorted" : "");
}

/// The surface of a body that lies over it (into +z) or under it. Nodes in the middle of edges
/// and faces are between the corners in the square.
ContactSurface surface(const Grid &grid, const Shape &shape, bool above)
{
   std::map<std::pair<int, int>, int> number; // of places, in half cells
   std::vector<Vector2d> places;
   const auto corner = [&](int i, int j)
   {
      Vector2d at(double(i) / grid.along, double(j) / grid.across);
      const bool inside = i > 0 && j > 0 && i < grid.along && j < grid.across;
      if (grid.distorted && inside)
      {
         at += grid.by * Vector2d(std::sin(3 * i + 5 * j) / grid.along,
                                  std::cos(2 * i + 7 * j) / grid.across);
      }
      return at;
   };
   const auto node = [&](int i, int j)
   {
      const auto [at, is_new] = number.emplace(std::pair(i, j), int(places.size()));
      if (is_new)
      {
         places.push_back((corner(i / 2, j / 2) + corner((i + 1) / 2, j / 2) +
                           corner(i / 2, (j + 1) / 2) + corner((i + 1) / 2, (j + 1) / 2)) /
                          4);
      }
      return at->second;
   };
   std::vector<std::vector<int>> faces;
   for (int i = 0; i < 2 * grid.along; i += 2)
   {
      for (int j = 0; j < 2 * grid.across; j += 2)
      {
         const std::vector<int> corners{node(i, j), node(i + 2, j), node(i + 2, j + 2),
                                        node(i, j + 2)};
         if (grid.nodes == 4) { faces.push_back(corners); }
         if (grid.nodes == 3)
         {
            faces.push_back({corners[0], corners[1], corners[2]});
            faces.push_back({corners[0], corners[2], corners[3]});
         }
         if (grid.nodes < 6) { continue; }
         const std::vector<int> middles{node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2),
                                        node(i, j + 1)};
         if (grid.nodes == 6)
         {
            // The middle of the diagonal is that of two of the four corners.
            const int middle = node(i + 1, j + 1);
            places[middle] = (places[corners[0]] + places[corners[2]]) / 2;
            faces.push_back(
               {corners[0], corners[1], corners[2], middles[0], middles[1], middle});
            faces.push_back(
               {corners[0], corners[2], corners[3], middle, middles[2], middles[3]});
            continue;
         }
         std::vector<int> face = corners;
         face.insert(face.end(), middles.begin(), middles.end());
         if (grid.nodes == 9) { face.push_back(node(i + 1, j + 1)); }
         faces.push_back(face);
      }
   }
   return surface_of(
      faces,
      [&](int id)
      {
         SurfaceNode made;
         made.dofs = {3 * id, 3 * id + 1, 3 * id + 2};
         made.position = shape(places[id]);
         return made;
      },
      [&](std::size_t) { return Vector3d(0, 0, above ? 1 : -1); }, "test");
}

/// The unit square stretched to lengths, moved and turned in its plane.
Shape rectangle(double a, double b, const Vector2d &from = {0, 0}, double angle = 0)
{
   const Eigen::Rotation2Dd turn(angle);
   return [=](const Vector2d &x)
   {
      const Vector2d at = from + turn * Vector2d(a * x[0], b * x[1]);
      return Vector3d(at[0], at[1], 0);
   };
}

const std::vector<Grid> grids = {{2, 3, 3}, {3, 2, 4}, {2, 3, 6}, {3, 2, 8}, {2, 2, 9}};

/// Rows are of a translation, and unknowns of a linear displacement stay so.
void expect_linear(const SurfaceMortar &found, const ContactSurface &slave,
                   const ContactSurface &master, double tolerance)
{
   const MatrixXd own = found.own, other = found.other;
   EXPECT_LT(largest(own.rowwise().sum().array() - 1), 1e-14);
   EXPECT_LT(largest(other.rowwise().sum().array() - 1), 1e-14);
   EXPECT_LT(largest(own * slave.points() - other * master.points()), tolerance);
   EXPECT_LT(largest(found.gap), tolerance);
   EXPECT_GT(found.weights.minCoeff(), 0);
}

/// ∫ψ_i N_m of all rows: a constant pressure is that on the master.
VectorXd on_master(const SurfaceMortar &found)
{
   return found.other.transpose() * found.weights;
}

} // namespace

TEST(SurfaceMortar, OfCoveredFacesReproducesPlacesAndPressure)
{
   for (const Grid &one : grids)
   {
      for (const Grid &its : grids)
      {
         for (const bool distorted : {false, true})
         {
            Grid first = one, second = {its.along + 2, its.across + 3, its.nodes, distorted};
            first.distorted = distorted;
            const ContactSurface slave = surface(first, rectangle(3, 2), true),
                                 master = surface(second, rectangle(3, 2), false);
            const SurfaceMortar found = mortar(slave, master);
            SCOPED_TRACE(name(first) + " on " + name(second));
            ASSERT_EQ(Index(found.nodes.size()), slave.size());
            EXPECT_TRUE(found.free_surface.empty());
            EXPECT_EQ(found.left_out, 0);
            EXPECT_TRUE(MatrixXd(found.own).isIdentity(1e-14));
            expect_linear(found, slave, master, 1e-13);
            EXPECT_TRUE(is_within(slave, master));
            // Functions of distorted quadrilaterals are no polynomials of the place.
            const double tolerance = distorted ? 1e-11 : 1e-13;
            EXPECT_LT(largest(found.weights - slave.weights()), tolerance);
            EXPECT_LT(largest(on_master(found) - master.weights()), tolerance);
            EXPECT_LT(largest(found.normal.col(2).array() - 1), 1e-14);
         }
      }
   }
}

/// Quadrilaterals that are far from parallelograms take more points.
TEST(SurfaceMortar, OfStronglyDistortedFacesReproducesPressure)
{
   for (const int nodes : {4, 8, 9})
   {
      for (const double by : {0.15, 0.25})
      {
         SCOPED_TRACE(std::to_string(nodes) + " nodes by " + std::to_string(by));
         const ContactSurface slave = surface({3, 2, nodes, true, by}, rectangle(3, 2), true),
                              master = surface({5, 4, nodes, true, by}, rectangle(3, 2), false);
         const SurfaceMortar found = mortar(slave, master);
         expect_linear(found, slave, master, 1e-12);
         EXPECT_LT(largest(found.weights - slave.weights()), 1e-11);
         EXPECT_LT(largest(on_master(found) - master.weights()), 1e-11);
      }
   }
}

/// Two masters side by side meet within faces of the slave. A constant pressure on both has the
/// forces that it has on the whole slave, and each of them its own area.
TEST(SurfaceMortar, OfMastersThatMeetWithinFacesKeepsTheForcesOfAPressure)
{
   for (const Grid &one : grids)
   {
      for (const Grid &its : grids)
      {
         for (const double seam : {0.29, 0.43, 0.5, 0.74})
         {
            SCOPED_TRACE(name(one) + " on " + name(its) + " to " + std::to_string(seam));
            const ContactSurface slave = surface(one, rectangle(1, 2), true),
                                 left = surface(its, rectangle(seam, 2), false),
                                 right = surface(its, rectangle(1 - seam, 2, {seam, 0}), false);
            const SurfaceMortar first = mortar(slave, left),
                                second = mortar(slave, right, first.nodes);
            expect_linear(first, slave, left, 1e-12);
            expect_linear(second, slave, right, 1e-12);
            EXPECT_EQ(first.given_away, 0);
            EXPECT_NEAR(first.weights.sum(), 2 * seam, 1e-12);
            EXPECT_NEAR(second.weights.sum(), 2 * (1 - seam), 1e-12);
            const VectorXd forces =
               first.own.transpose() * first.weights + second.own.transpose() * second.weights;
            EXPECT_LT(largest(forces - slave.weights()), 1e-12);
            EXPECT_LT(largest(on_master(first) - left.weights()), 1e-12);
            EXPECT_LT(largest(on_master(second) - right.weights()), 1e-12);
         }
      }
   }
}

/// A single face, of which another interface has the nodes at x = 0. On the rest of the face
/// ∫(1 - x) dA belonged to them.
TEST(SurfaceMortar, NodesOfOtherInterfacesGiveAwayTheirArea)
{
   const ContactSurface slave = surface({1, 1, 4}, rectangle(1, 2), true),
                        left = surface({2, 3, 4}, rectangle(0.43, 2), false),
                        right = surface({3, 2, 4}, rectangle(0.57, 2, {0.43, 0}), false);
   const SurfaceMortar first = mortar(slave, left), second = mortar(slave, right, first.nodes);
   EXPECT_EQ(first.nodes.size(), 2U);
   EXPECT_EQ(second.nodes.size(), 2U);
   EXPECT_NEAR(second.given_away, 2 * 0.5 * 0.57 * 0.57, 1e-14);
   EXPECT_LT(largest(second.weights.array() - 0.57), 1e-14);
}

TEST(SurfaceMortar, OfMatchingSurfacesIsThePairing)
{
   // On a curved shell each node faces itself.
   const Shape shell = [](const Vector2d &x)
   { return Vector3d(x[0], x[1], 0.1 * x[0] * x[0] + 0.05 * x[0] * x[1]); };
   for (const Grid &grid : grids)
   {
      SCOPED_TRACE(name(grid));
      const ContactSurface slave = surface(grid, shell, true),
                           master = surface(grid, shell, false);
      const SurfaceMortar found = mortar(slave, master);
      ASSERT_EQ(Index(found.nodes.size()), slave.size());
      MatrixXd P = found.other;
      for (Index i = 0; i < slave.size(); ++i)
      {
         for (Index m = 0; m < master.size(); ++m)
         {
            const bool same =
               (slave.nodes[i].position - master.nodes[m].position).norm() < 1e-12;
            P(i, m) -= same;
         }
      }
      EXPECT_LT(largest(P), 1e-12);
      EXPECT_LT(largest(found.gap), 1e-14);
      // In the planes of curved faces of order 2 edges are curved, those of the polygons are
      // not.
      EXPECT_LT(difference(found.weights, slave.weights()), grid.nodes < 6 ? 1e-6 : 1e-3);
      EXPECT_LT(largest(found.turn), 1e-7);
   }
}

/// The master's edges cut faces of the slave. A constant pressure on the covered part gives the
/// master its weights, which is the area that it has on the slave.
TEST(SurfaceMortar, OfFacesThatAreCoveredInPartKeepsAConstantPressure)
{
   for (const Grid &one : grids)
   {
      for (const Grid &its : grids)
      {
         SCOPED_TRACE(name(one) + " on " + name(its));
         const Grid fine{2 * one.along + 3, 2 * one.across + 2, one.nodes};
         const ContactSurface slave = surface(fine, rectangle(3, 2), true),
                              master =
                                 surface(its, rectangle(1.3, 1.1, {0.9, 0.5}, 0.3), false);
         const SurfaceMortar found = mortar(slave, master);
         EXPECT_FALSE(is_within(slave, master));
         EXPECT_TRUE(is_within(master, slave));
         expect_linear(found, slave, master, 1e-12);
         EXPECT_FALSE(found.free_surface.empty());
         // A corner of the master may cover less than 1e-4 of a face.
         EXPECT_LT(found.left_out, 1e-4 * 6 / double(slave.faces.size()));
         EXPECT_NEAR(found.weights.sum() + found.left_out, 1.3 * 1.1, 1e-12);
         EXPECT_LT(largest(on_master(found) - master.weights()), found.left_out + 1e-12);
      }
   }
}

/// Two rectangles that overlap at a corner: the weights are those of the overlap, and a node
/// that is taken by another interface gives its share to the others.
TEST(SurfaceMortar, NodesWithoutARowGiveTheirShareToOthers)
{
   for (const Grid &one : grids)
   {
      for (const Grid &its : grids)
      {
         SCOPED_TRACE(name(one) + " on " + name(its));
         const Grid fine{one.along + 3, one.across + 3, one.nodes};
         const ContactSurface slave = surface(fine, rectangle(2, 2), true),
                              master = surface(its, rectangle(2, 2, {0.55, 0.85}), false);
         // All nodes of one edge.
         std::vector<int> without;
         for (Index i = 0; i < slave.size(); ++i)
         {
            if (slave.nodes[i].position[0] > 2 - 1e-9) { without.push_back(int(i)); }
         }
         const SurfaceMortar found = mortar(slave, master, without);
         expect_linear(found, slave, master, 1e-11);
         for (int node : without)
         {
            EXPECT_EQ(std::count(found.nodes.begin(), found.nodes.end(), node), 0);
         }
         EXPECT_NEAR(found.weights.sum() + found.left_out, 1.45 * 1.15, 1e-12);
         EXPECT_LT(found.left_out, 1e-4 * 4);
      }
   }
}

TEST(SurfaceMortar, GapsOfConcentricSpheresConvergeWithTheMesh)
{
   const auto cap = [](double radius)
   {
      return [radius](const Vector2d &x)
      {
         const Vector3d at(x[0] - 0.5, x[1] - 0.5, -1);
         return Vector3d(radius * at.normalized());
      };
   };
   const double gap = 0.01;
   for (const int nodes : {3, 4, 6, 8, 9})
   {
      SCOPED_TRACE(nodes);
      std::vector<double> errors;
      for (const int cells : {4, 8})
      {
         const ContactSurface slave = surface({cells, cells, nodes}, cap(1), true);
         const SurfaceMortar found =
            mortar(slave, surface({cells + 1, cells + 2, nodes}, cap(1 + gap), false));
         errors.push_back(largest(found.gap.array() - gap));
         // Away from the rim, where normals are those of one side only, the estimate is most of
         // the error.
         double most = 0, left = 0;
         for (std::size_t i = 0; i < found.nodes.size() && nodes < 6 && cells == 8; ++i)
         {
            const Vector3d x = slave.nodes[found.nodes[i]].position;
            if ((x / x[2]).head(2).cwiseAbs().maxCoeff() > 0.3) { continue; }
            const double off = found.gap[Index(i)] - gap;
            most = std::max(most, std::abs(off));
            left = std::max(left, std::abs(off + found.chords[Index(i)]));
         }
         EXPECT_LE(left, 0.25 * most);
         if (nodes >= 6) { EXPECT_EQ(largest(found.chords), 0); }
         EXPECT_LT(largest(found.turn), std::sqrt(0.5) / cells); // half a diagonal of a face
      }
      // Chords are off by h²/8R; faces of order 2 by less.
      EXPECT_LT(errors[0], nodes < 6 ? 0.01 : 0.001);
      EXPECT_LT(errors[1], 0.4 * errors[0]);
   }
}

TEST(SurfaceMortar, TurnedSurfacesHaveTheSameMatrices)
{
   const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.4, Vector3d::UnitX()) * Eigen::AngleAxisd(0.3, Vector3d::UnitY()))
         .toRotationMatrix();
   const Shape flat = rectangle(3, 2), part = rectangle(1.5, 1, {0.8, 0.4}, 0.2);
   const auto turned = [&turn](const Shape &shape)
   { return [&turn, shape](const Vector2d &x) { return Vector3d(turn * shape(x)); }; };
   const Grid one{4, 3, 8}, its{3, 2, 6};
   const SurfaceMortar found = mortar(surface(one, flat, true), surface(its, part, false)),
                       again = mortar(surface(one, turned(flat), true),
                                      surface(its, turned(part), false));
   ASSERT_EQ(found.nodes, again.nodes);
   EXPECT_LT(largest(MatrixXd(found.own) - MatrixXd(again.own)), 1e-12);
   EXPECT_LT(largest(MatrixXd(found.other) - MatrixXd(again.other)), 1e-12);
   EXPECT_LT(largest(found.weights - again.weights), 1e-13);
}

TEST(SurfaceMortar, SurfacesThatDoNotMeetAreRefused)
{
   const ContactSurface slave = surface({2, 2, 4}, rectangle(1, 1), true),
                        beside = surface({2, 2, 4}, rectangle(1, 1, {3, 0}), false),
                        behind = surface({2, 2, 4}, rectangle(1, 1), true),
                        small = surface({1, 1, 4}, rectangle(0.1, 0.1, {0.2, 0.2}), false);
   ContactSurface bare = slave;
   bare.faces.clear();
   expect_input_error([&] { mortar(slave, beside); }, "the sides do not face each other");
   expect_input_error([&] { mortar(slave, behind); }, "the sides do not face each other");
   expect_input_error([&] { mortar(slave, small); }, "make the other side the slave");
   expect_input_error([&] { mortar(bare, beside); }, "has no faces");
   const SurfaceMortar turned =
      mortar(surface({1, 1, 4}, rectangle(0.1, 0.1, {0.2, 0.2}), true),
             surface({2, 2, 4}, rectangle(1, 1), false));
   EXPECT_EQ(turned.nodes.size(), 4U);
}
