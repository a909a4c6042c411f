// Meshes with straight edges whose sides are curved: where their nodes go.
#include "elastic_support.hpp"

#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/smooth_sides.hpp>
#include <functional>

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

/// Nodes of every order lie on the circle that the vertices are on; the other side keeps its
/// chords, and no element folds.
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
         for (const SideChord &chord : found.chords)
         {
            // The body is outside of the circle.
            EXPECT_NEAR(chord.bend.begin, -half, 1e-13);
            EXPECT_NEAR(chord.bend.end, -half, 1e-13);
         }
         if (order == 1)
         {
            EXPECT_EQ(coordinates(mesh), before);
            continue;
         }
         for (const Vector2d &x : along(mesh, bottom)) { EXPECT_NEAR(x.norm(), 1, 1e-13); }
         for (const Vector2d &x : along(mesh, top))
         {
            EXPECT_LT(x.norm(), 2 + 1e-13);
            EXPECT_GT(x.norm(), 2 * std::cos(half) - 1e-13);
         }
         EXPECT_NO_THROW(check_elements(mesh));
         // Of a ring's quarter whose outer side is a polygon.
         const double expected = edges * 2 * std::sin(2 * half) - pi / 4;
         EXPECT_NEAR(area_of(mesh), expected, order == 2 ? 2e-5 : 2e-7) << order;
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
