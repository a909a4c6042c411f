// Meshes with straight edges whose sides are curved: where their nodes go.
#include "elastic_support.hpp"

#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/mesh/smooth_sides.hpp>
#include <fstream>
#include <functional>
#include <set>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Vector2d;
using Place = std::function<Vector2d(double, double)>;

const double pi = std::acos(-1.0);

/// The unit square with its vertices moved, of straight edges.
mfem::Mesh moved(int along, int into, mfem::Element::Type type, const Place &place)
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(along, into, type, true);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      const Vector2d to = place(x[0], x[1]);
      x[0] = to[0];
      x[1] = to[1];
   }
   return mesh;
}

/// A quarter of a ring: its bottom has radius 1, its top radius 2.
mfem::Mesh ring(int edges, int rows, mfem::Element::Type type)
{
   return moved(edges, rows, type,
                [=](double s, double t)
                {
                   const double angle = (1 - s) * pi / 2, r = 1 + t;
                   return Vector2d(r * std::cos(angle), r * std::sin(angle));
                });
}

/// Places of a mesh's nodes along its boundary of an attribute.
std::vector<Vector2d> along(mfem::Mesh &mesh, int attribute)
{
   std::vector<Vector2d> all;
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      if (mesh.GetBdrAttribute(i) != attribute) { continue; }
      mfem::IsoparametricTransformation edge;
      mesh.GetBdrElementTransformation(i, &edge);
      for (int k = 0; k < edge.GetPointMat().Width(); ++k)
      {
         all.emplace_back(edge.GetPointMat()(0, k), edge.GetPointMat()(1, k));
      }
   }
   return all;
}

double area_of(mfem::Mesh &mesh)
{
   double sum = 0;
   for (int e = 0; e < mesh.GetNE(); ++e) { sum += mesh.GetElementVolume(e); }
   return sum;
}

std::vector<double> coordinates(mfem::Mesh &mesh)
{
   std::vector<double> all;
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      all.insert(all.end(), {mesh.GetVertex(v)[0], mesh.GetVertex(v)[1]});
   }
   if (const mfem::GridFunction *nodes = mesh.GetNodes())
   {
      all.insert(all.end(), nodes->begin(), nodes->end());
   }
   return all;
}

/// Nodes of every order lie on the circles that the vertices are on, of the side in contact and
/// of the free one, and no element folds.
TEST(CurveSides, MoveNodesOntoCircles)
{
   const int edges = 6;
   const double half = pi / 4 / edges; // of the angle that an edge spans
   for (const auto type : {mfem::Element::QUADRILATERAL, mfem::Element::TRIANGLE})
   {
      for (int order = 1; order <= 5; ++order)
      {
         mfem::Mesh mesh = ring(edges, 3, type);
         const std::vector<double> before = coordinates(mesh);
         const SmoothSides found = curve_sides(mesh, order, {bottom});
         EXPECT_EQ(found.edges, edges);
         EXPECT_EQ(found.chords.size(), std::size_t(edges));
         EXPECT_NEAR(found.most, 1 - std::cos(half), 1e-14);
         EXPECT_EQ(found.moved, order > 1);
         EXPECT_TRUE(found.folding.empty());
         EXPECT_EQ(found.free_edges, order > 1 ? edges : 0);
         EXPECT_EQ(found.free_chords, order > 1 ? 0 : edges);
         for (const SideChord &chord : found.chords)
         {
            // The body is outside of the circle.
            EXPECT_NEAR(chord.bend.begin, -half, 1e-13);
            EXPECT_NEAR(chord.bend.end, -half, 1e-13);
         }
         if (order == 1)
         {
            EXPECT_EQ(coordinates(mesh), before);
            // Both sides have chords: the wall is that of the circles but for their difference.
            ASSERT_TRUE(found.thinned);
            EXPECT_NEAR(found.thinned->wall, std::cos(half), 1e-12);
            EXPECT_NEAR(found.thinned->wall + found.thinned->off, 1, 1e-12);
            continue;
         }
         EXPECT_FALSE(found.thinned);
         for (const Vector2d &x : along(mesh, bottom)) { EXPECT_NEAR(x.norm(), 1, 1e-13); }
         for (const Vector2d &x : along(mesh, top)) { EXPECT_NEAR(x.norm(), 2, 1e-12); }
         EXPECT_NO_THROW(check_elements(mesh));
         // Area of a quarter of a ring, as exact as elements of this order follow circles.
         EXPECT_NEAR(area_of(mesh), 3 * pi / 4, order == 2 ? 1e-4 : 1e-6) << order;
      }
   }
}

/// A sleeve of a fiftieth of its radius, whose chords of ten degrees take a fifth of the wall:
/// curved, it has the wall of the circles, also in layers that are thinner than an arc is high.
/// Where chords are kept it is said how much the wall misses.
TEST(CurveSides, ThinWallsHaveTheirThickness)
{
   const int edges = 9;
   const double wall = 0.02;
   for (int layers : {1, 2, 6})
   {
      mfem::Mesh mesh = moved(edges, layers, mfem::Element::QUADRILATERAL,
                              [=](double s, double t)
                              {
                                 const double angle = (1 - s) * pi / 2, r = 1 + wall * t;
                                 return Vector2d(r * std::cos(angle), r * std::sin(angle));
                              });
      const SmoothSides found = curve_sides(mesh, 2, {bottom});
      EXPECT_TRUE(found.moved);
      EXPECT_EQ(found.free_edges, edges);
      EXPECT_FALSE(found.thinned);
      EXPECT_NO_THROW(check_elements(mesh));
      const double area = pi / 4 * ((1 + wall) * (1 + wall) - 1);
      EXPECT_NEAR(area_of(mesh), area, 1e-3 * area) << layers;
   }
   // Linear elements keep their chords, here of 22.5 degrees on both sides of a wall of 1.
   mfem::Mesh mesh = moved(2, 1, mfem::Element::QUADRILATERAL,
                           [=](double s, double t)
                           {
                              const double angle = (1 - s) * pi / 4, r = 1 + t;
                              return Vector2d(r * std::cos(angle), r * std::sin(angle));
                           });
   std::vector<int> curves(mesh.GetNBE(), 7);
   const SmoothSides linear = curve_sides(mesh, 1, {left}, curves);
   ASSERT_TRUE(linear.thinned);
   const double chord = std::cos(pi / 16);
   EXPECT_NEAR(linear.thinned->wall, chord, 1e-12);
   EXPECT_NEAR(linear.thinned->off, 1 - chord, 1e-12);
}

/// A curve goes on as its mirror image beyond planes that supports hold, and only there: an
/// ellipse's half whose end edges are then those of the whole.
TEST(CurveSides, GoOnAsImagesAtPlanesThatAreHeld)
{
   const int n = 12;
   const auto half = [=](double s, double t)
   {
      const double angle = (s - 0.5) * pi, r = 1 - 0.5 * t;
      return Vector2d(2 * r * std::sin(angle), -r * std::cos(angle));
   };
   SidePolygon whole;
   whole.loop = true;
   for (int k = 0; k < 2 * n; ++k)
   {
      const double angle = (k / double(n) - 0.5) * pi;
      whole.vertices.emplace_back(2 * std::sin(angle), -std::cos(angle));
   }
   const std::vector<EdgeBend> all = smooth_curve(whole);
   for (bool held : {false, true})
   {
      mfem::Mesh mesh = moved(n, 2, mfem::Element::QUADRILATERAL, half);
      const SmoothSides found = curve_sides(
         mesh, 1, {bottom}, {}, held ? std::vector<int>{left, right} : std::vector<int>());
      ASSERT_EQ(found.chords.size(), std::size_t(n));
      double off = 0;
      for (const SideChord &chord : found.chords)
      {
         for (int k = 0; k < n; ++k)
         {
            if ((chord.from - whole.vertices[k]).norm() > 1e-12) { continue; }
            off = std::max(off, std::abs(chord.bend.begin - all[k].begin) +
                                   std::abs(chord.bend.end - all[k].end));
         }
      }
      if (held) { EXPECT_LT(off, 1e-12); }
      else { EXPECT_GT(off, 1e-3); }
   }
}

/// A part of a ring between the radii 1 and 2 in Gmsh's format 4.1, one row of quadrilaterals
/// over edges of so many degrees. Group 1 is the hole, whose edges are on these curves.
std::string gmsh_file(const std::vector<int> &curves, double degrees)
{
   const int n = static_cast<int>(curves.size()), other = 100; // the curve of all other sides
   const std::set<int> own(curves.begin(), curves.end());
   const std::string name = testing::TempDir() + "curve_sides.msh";
   std::ofstream out(name);
   out.precision(17);
   out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 " << own.size() + 1 << " 1 0\n";
   for (int curve : own) { out << curve << " 0 0 0 2 2 0 1 1 0\n"; }
   out << other << " 0 0 0 2 2 0 1 2 0\n1 0 0 0 2 2 0 1 3 0\n$EndEntities\n";
   out << "$Nodes\n1 " << 2 * n + 2 << " 1 " << 2 * n + 2 << "\n2 1 0 " << 2 * n + 2 << "\n";
   for (int k = 1; k <= 2 * n + 2; ++k) { out << k << "\n"; }
   for (int radius : {1, 2})
   {
      for (int k = 0; k <= n; ++k)
      {
         const double angle = k * degrees * pi / 180;
         out << radius * std::cos(angle) << " " << radius * std::sin(angle) << " 0\n";
      }
   }
   out << "$EndNodes\n$Elements\n"
       << own.size() + 2 << " " << 3 * n + 2 << " 1 " << 3 * n + 2 << "\n";
   int number = 0;
   for (int curve : own)
   {
      out << "1 " << curve << " 1 " << std::count(curves.begin(), curves.end(), curve) << "\n";
      for (int k = 0; k < n; ++k)
      {
         if (curves[k] == curve) { out << ++number << " " << k + 1 << " " << k + 2 << "\n"; }
      }
   }
   out << "1 " << other << " 1 " << n + 2 << "\n";
   out << ++number << " 1 " << n + 2 << "\n";
   out << ++number << " " << n + 1 << " " << 2 * n + 2 << "\n";
   for (int k = 0; k < n; ++k)
   {
      out << ++number << " " << n + 2 + k << " " << n + 3 + k << "\n";
   }
   out << "2 1 3 " << n << "\n";
   for (int k = 0; k < n; ++k)
   {
      out << ++number << " " << k + 1 << " " << n + 2 + k << " " << n + 3 + k << " " << k + 2
          << "\n";
   }
   out << "$EndElements\n";
   return name;
}

/// Gmsh's curves tell arcs of few edges from a chamfer, and facets from an arc of as many
/// edges.
TEST(CurveSides, FollowTheCurvesOfAFile)
{
   struct
   {
      std::vector<int> curves;
      double degrees;
      bool known, round;
   } const sides[] = {{{5, 5, 5}, 20, true, true},            // one curve
                      {{5, 6, 7}, 20, true, false},           // facets
                      {{5, 6, 7, 8, 9, 10}, 10, true, false}, // more of them
                      {{5, 6, 7, 8, 9, 10}, 10, false, true}, // an arc, if nothing is known
                      {{5, 5, 5, 5, 6, 7}, 10, true, true},   // it goes on
                      {{5, 5, 5, 9, 9, 9}, 15, true, true}};
   for (const auto &side : sides)
   {
      const int n = static_cast<int>(side.curves.size());
      const double sagitta = 1 - std::cos(side.degrees * pi / 360);
      std::vector<int> curves;
      mfem::Mesh mesh = read_mesh(gmsh_file(side.curves, side.degrees), &curves);
      ASSERT_EQ(static_cast<int>(curves.size()), mesh.GetNBE());
      const SmoothSides found =
         curve_sides(mesh, 2, {1}, side.known ? curves : std::vector<int>());
      const std::string what = std::to_string(n) + (side.known ? " edges" : " edges, no file");
      EXPECT_EQ(found.edges, side.round ? n : 0) << what;
      EXPECT_EQ(found.moved, side.round) << what;
      EXPECT_NEAR(found.most, side.round ? sagitta : 0, 1e-14) << what;
      for (const Vector2d &x : along(mesh, 1))
      {
         if (side.round) { EXPECT_NEAR(x.norm(), 1, 1e-13) << what; }
      }
   }
}

/// Bodies of straight edges between which gaps are those of the circles, or as meshed those of
/// the polygons: a shaft of radius 1 in a hole of radius 1.01, its vertices amid the edges of
/// the hole.
TEST(CurveSides, GapsAreOfCurvesUnlessAsMeshed)
{
   const int edges = 8;
   const double half = pi / 4 / edges, clearance = 0.01;
   const auto quarter = [=](double from, double to, bool inside)
   {
      return [=](double s, double t)
      {
         const double angle = (inside ? s : 1 - s) * pi / 2, r = from + (to - from) * t;
         return Vector2d(r * std::cos(angle), r * std::sin(angle));
      };
   };
   for (int order = 1; order <= 3; ++order)
   {
      mfem::Mesh shaft =
                    moved(2 * edges, 2, mfem::Element::QUADRILATERAL, quarter(1, 0.5, true)),
                 hole = moved(edges, 2, mfem::Element::QUADRILATERAL,
                              quarter(1 + clearance, 2, false));
      ElasticBody in(shaft, order, Material{1, 0.3}), out(hole, order, Material{1, 0.3});
      for (ElasticBody *body : {&in, &out})
      {
         body->fix(top, 0);
         body->fix(top, 1);
      }
      for (const bool as_meshed : {false, true})
      {
         BoundaryInterface fit{"fit", {0, bottom}, {1, bottom}};
         fit.slave = SlaveSide::first;
         fit.as_meshed = as_meshed;
         const Reduction reduction = reduce({{"in", &in}, {"out", &out}}, {fit});
         const VectorXd &gap = reduction.problem.gap;
         if (!as_meshed)
         {
            // The mean over functions that see some of both sides of a node.
            EXPECT_LT((gap.array() - clearance).abs().maxCoeff(), 5e-5) << order;
            EXPECT_GT(reduction.interfaces[0].curved.cwiseAbs().maxCoeff(), 1e-4);
            continue;
         }
         // A chord of the hole is nearer by its height, one of the shaft farther by its own.
         const double of_hole = (1 + clearance) * (1 - std::cos(half));
         EXPECT_LT(gap.minCoeff(), clearance - 0.5 * of_hole) << order;
         EXPECT_GT((gap.array() - clearance).abs().maxCoeff(), 0.5 * of_hole) << order;
         // The estimate of what chords leave unknown of it.
         const VectorXd chords = reduction.interfaces[0].chords;
         EXPECT_LT(
            (gap + chords - VectorXd::Constant(gap.size(), clearance)).cwiseAbs().maxCoeff(),
            0.1 * of_hole)
            << order;
      }
   }
}

} // namespace
