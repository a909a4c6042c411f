#include "elastic_support.hpp"

#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <numeric>

namespace
{

using namespace cattaneo;

using Points = std::vector<std::array<double, 2>>;
using Cells = std::vector<std::vector<int>>;

mfem::Mesh mesh_of(const Points &points, const Cells &cells, int space = 2, double z = 0)
{
   mfem::Mesh mesh(2, static_cast<int>(points.size()), static_cast<int>(cells.size()), 0,
                   space);
   for (const auto &point : points)
   {
      const double x[] = {point[0], point[1], z};
      mesh.AddVertex(x);
   }
   for (std::size_t k = 0; k < cells.size(); ++k)
   {
      const int attribute = static_cast<int>(k) + 1;
      if (cells[k].size() == 3) { mesh.AddTriangle(cells[k].data(), attribute); }
      else { mesh.AddQuad(cells[k].data(), attribute); }
   }
   mesh.FinalizeTopology();
   mesh.Finalize(false, false);
   return mesh;
}

mfem::Mesh one(const Points &points)
{
   std::vector<int> all(points.size());
   std::iota(all.begin(), all.end(), 0);
   return mesh_of(points, {all});
}

void expect_sound(mfem::Mesh mesh)
{
   EXPECT_NO_THROW(check_elements(mesh));
}

void expect_fault(mfem::Mesh mesh, const std::string &part)
{
   expect_input_error([&] { check_elements(mesh); }, part);
}

TEST(ElementCheck, ElementsWithoutAreaAreNamed)
{
   expect_fault(one({{0, 0}, {1, 1}, {3, 3}}), "element 0 (attribute 1, centre (1.33333");
   expect_fault(one({{0, 0}, {1, 0}, {1, 0}, {0, 0}}), "has no area");
   // In a row of three the second.
   const Points row = {{0, 0}, {1, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {1, 1}, {2, 1}};
   expect_fault(mesh_of(row, {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}}),
                "element 1 (attribute 2, centre (1, 0.5)) of the mesh has no area");
   // What is left of an area far from the origin is round-off; thin is not flat.
   const double far = 1e9;
   expect_fault(one({{far, far}, {far + 1, far + 1}, {far + 3, far + 3 + 1e-7}}), "no area");
   expect_sound(one({{0, 0}, {1, 0}, {1, 1e-9}, {0, 1e-9}}));
   expect_sound(one({{0, 0}, {1, 0}, {0, 1e-9}}));
   expect_sound(one({{0, 0}, {1e8, 0}, {1e8, 1e-8}, {0, 1e-8}}));
}

TEST(ElementCheck, SidesThatAreParallelToRoundOffEncloseNoArea)
{
   const auto needle = [](double height) {
      return mesh_of({{0, 0}, {1, 0}, {2, height}, {1, height}}, {{0, 1, 2, 3}});
   };
   for (const double sound : {1.0, 1e-6, 1e-10}) { expect_sound(needle(sound)); }
   expect_fault(needle(1e-13), "has no area");
}

TEST(ElementCheck, StraightElementsInsideOutAreNamed)
{
   expect_fault(one({{0, 0}, {0, 1}, {1, 0}}), "is turned over");
   expect_fault(one({{0, 0}, {0, 1}, {1, 1}, {1, 0}}), "number its nodes counterclockwise");
   // A quadrilateral is the image of a square as long as it is convex: the last corner against
   // the line between its neighbours, which x + y = 1 is.
   for (const double c : {0.6, 0.501}) { expect_sound(one({{0, 0}, {1, 0}, {c, c}, {0, 1}})); }
   for (const double c : {0.5, 0.499, 0.1})
   {
      expect_fault(one({{0, 0}, {1, 0}, {c, c}, {0, 1}}), "is folded over");
   }
   expect_fault(one({{0, 0}, {1, 0}, {0, 1}, {1, 1}}), "is folded over"); // a bow tie
}

TEST(ElementCheck, NodesDrawnAcrossAnEdgeAreFoundWhateverTheReaderTurns)
{
   // The fourth node belongs beyond the edge from 1 to 2.
   const Cells cells = {{0, 1, 2}, {2, 1, 3}};
   expect_sound(mesh_of({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, cells));
   const Points drawn = {{0, 0}, {1, 0}, {0, 1}, {0.3, 0.3}};
   expect_fault(mesh_of(drawn, cells), "element 1 (attribute 2");
   mfem::Mesh turned = mesh_of(drawn, {{0, 1, 2}, {1, 2, 3}}); // as a reader leaves it
   expect_fault(std::move(turned),
                "element 0 (attribute 1, centre (0.333333, 0.333333)) and element 1 "
                "(attribute 2, centre (0.433333, 0.433333)) of the mesh lie on the same "
                "side");
   // Numbered clockwise throughout and turned by the reader: nothing is wrong.
   expect_sound(mesh_of({{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {{1, 2, 0}, {3, 2, 1}}));
}

/// The unit square or triangle as one element of second order, with its nodes moved.
template <class Move>
mfem::Mesh curved(bool triangle, Move move)
{
   const Points square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, corner = {{0, 0}, {1, 0}, {0, 1}};
   mfem::Mesh mesh = one(triangle ? corner : square);
   mesh.SetCurvature(2);
   mesh.Transform(
      [&](const mfem::Vector &x, mfem::Vector &y)
      {
         y.SetSize(2);
         const std::array<double, 2> moved = move(x(0), x(1));
         y(0) = moved[0];
         y(1) = moved[1];
      });
   return mesh;
}

TEST(ElementCheck, CurvedElementsInsideOutAreNamed)
{
   // The middle node of an edge at m: the determinant falls to 4m - 1 at one end of the edge.
   const auto along = [](bool triangle, double m)
   {
      return curved(triangle,
                    [=](double x, double y)
                    {
                       const double other = triangle ? 1 - x - y : 1 - x;
                       return std::array<double, 2>{x + 4 * (m - 0.5) * x * other, y};
                    });
   };
   for (const bool triangle : {false, true})
   {
      expect_sound(along(triangle, 0.251));
      expect_sound(along(triangle, 0.749));
      for (const double m : {0.2, 0.249, 0.25, 0.751})
      {
         expect_fault(along(triangle, m), "is folded over");
      }
   }
   // An edge that bulges into the element by h: 1 - 4 h x (1 - x), lowest half way between the
   // corners, where it is 1 - h; the corners have 1.
   const auto bulged = [](double h)
   {
      return curved(false,
                    [=](double x, double y) {
                       return std::array<double, 2>{x, y + 4 * h * x * (1 - x) * (1 - y)};
                    });
   };
   expect_sound(bulged(0.999));
   expect_fault(bulged(1.0), "is folded over");
   expect_fault(bulged(1.001), "element 0 (attribute 1");
   // Mirrored: negative everywhere.
   expect_fault(curved(false,
                       [](double x, double y) {
                          return std::array<double, 2>{-x + 0.1 * x * (1 - x), y};
                       }),
                "is turned over");
}

TEST(ElementCheck, MeshesOutOfThePlaneAreNamed)
{
   const Points square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
   expect_fault(mesh_of(square, {{0, 1, 2, 3}}, 3, 0.25),
                "of dimension 2 in space of dimension 3, both must be 2, or both 3; element 0 "
                "(attribute 1, "
                "centre (0.5, 0.5)) is at z = 0.25: turn the mesh into the xy plane");
   // Where several elements are out of the plane, the message names the farthest.
   mfem::Mesh slope = mesh_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {2, 1}},
                              {{0, 1, 2, 3}, {1, 4, 5, 2}}, 3, 0.25);
   slope.GetVertex(0)[2] = slope.GetVertex(3)[2] = -1.75;
   expect_fault(std::move(slope), "element 0 (attribute 1, centre (0.5, 0.5)) is at z = -0.75");
   const Points steps = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0},
                         {0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}};
   mfem::Mesh stairs =
      mesh_of(steps, {{0, 1, 6, 5}, {1, 2, 7, 6}, {2, 3, 8, 7}, {3, 4, 9, 8}}, 3, 0.0);
   for (const auto &[vertex, z] : {std::pair(0, 2.0), {3, 8.0}, {8, 4.0}})
   {
      stairs.GetVertex(vertex)[2] = z; // means of elements: 0.5, 0, 3, 3
   }
   stairs.GetVertex(9)[2] = -1; // 0.5, 0, 3, 2.75
   expect_fault(std::move(stairs), "element 2 (attribute 3, centre (2.5, 0.5)) is at z = 3");
}

TEST(ElementCheck, SolidsAreChecked)
{
   using Type = mfem::Element::Type;
   const auto moved = [](Type type, int order, int vertex, const std::array<double, 3> &to)
   {
      mfem::Mesh mesh = mfem::Mesh::MakeCartesian3D(1, 1, 1, type);
      if (vertex >= 0)
      {
         for (int c = 0; c < 3; ++c) { mesh.GetVertex(vertex)[c] = to[c]; }
      }
      if (order > 1) { mesh.SetCurvature(order); }
      return mesh;
   };
   for (const Type type : {Type::HEXAHEDRON, Type::WEDGE, Type::TETRAHEDRON})
   {
      for (const int order : {1, 2, 3}) { expect_sound(moved(type, order, -1, {})); }
   }
   // The corner (1, 1, 1) of a cube is drawn along the diagonal. There the determinant is that
   // of three edges, 3 t - 2 if the corner is at t.
   expect_sound(moved(Type::HEXAHEDRON, 1, 7, {0.67, 0.67, 0.67}));
   expect_fault(moved(Type::HEXAHEDRON, 1, 7, {0.66, 0.66, 0.66}), "is folded over");
   expect_fault(moved(Type::HEXAHEDRON, 2, 7, {0.66, 0.66, 0.66}),
                "element 0 (attribute 1, centre (0.");
   // The quadratic map x + 4 h x (1 - x) turns back at an end of x from h = 1/4 on. All
   // coefficients are of one sign up to there.
   const auto bulged = [&](Type type, double h)
   {
      mfem::Mesh mesh = moved(type, 2, -1, {});
      mesh.Transform(
         [h](const mfem::Vector &x, mfem::Vector &y)
         {
            y = x;
            y[0] += 4 * h * x[0] * (1 - x[0]);
         });
      return mesh;
   };
   for (const Type type : {Type::HEXAHEDRON, Type::WEDGE, Type::TETRAHEDRON})
   {
      expect_sound(bulged(type, 0.2499));
      expect_fault(bulged(type, 0.2501), "is folded over");
      expect_sound(bulged(type, -0.2499));
      expect_fault(bulged(type, -0.2501), "is folded over");
   }
   // A determinant that is positive at all corners, and negative at the middle of an edge.
   mfem::Mesh waist = moved(Type::HEXAHEDRON, 2, -1, {});
   waist.Transform(
      [](const mfem::Vector &x, mfem::Vector &y)
      {
         y = x;
         const double w = 16 * x[1] * (1 - x[1]) * x[2] * (1 - x[2]);
         y[0] = x[0] * (1 - 1.01 * w) + 0.505 * w;
      });
   expect_fault(std::move(waist), "is folded over");
   mfem::Mesh mirrored = moved(Type::HEXAHEDRON, 1, -1, {}),
              flat = moved(Type::WEDGE, 1, -1, {});
   for (int v = 0; v < 8; ++v)
   {
      mirrored.GetVertex(v)[0] *= -1;
      flat.GetVertex(v)[2] = 0;
   }
   expect_fault(std::move(mirrored), "is turned inside out");
   expect_fault(std::move(flat), "has no volume");
   // Two cubes of which the second lies within the first.
   mfem::Mesh pair = mfem::Mesh::MakeCartesian3D(2, 1, 1, Type::HEXAHEDRON);
   for (int v = 0; v < pair.GetNV(); ++v)
   {
      if (pair.GetVertex(v)[0] > 0.9) { pair.GetVertex(v)[0] = 0.1; }
   }
   expect_fault(std::move(pair), "is turned inside out");
   expect_fault(mfem::Mesh::MakeCartesian3D(1, 1, 1, Type::PYRAMID), "is a pyramid");
}

/// MFEM leaves out coordinates that are the same for all nodes: there is no second one to
/// print.
TEST(ElementCheck, AMeshWithoutThicknessIsSaidInOneSentence)
{
   for (const int order : {1, 2})
   {
      mfem::Mesh flat(2, 4, 1, 0, 1);
      for (const double x : {0., 1., 1., 0.}) { flat.AddVertex(&x); }
      flat.AddQuad(0, 1, 2, 3);
      flat.FinalizeQuadMesh(1, 0, true);
      if (order > 1) { flat.SetCurvature(order, false, 1); }
      EXPECT_EQ(unjoined_vertices(flat, "flat"), "");
      EXPECT_EQ(missed_curves(flat, 1, "flat"), "");
      std::string said;
      try
      {
         check_elements(flat);
      }
      catch (const InputError &error)
      {
         said = error.what();
      }
      EXPECT_EQ(
         said,
         "elastic body: the mesh is of dimension 2 in space of dimension 1, both must "
         "be 2, or both 3: all of its nodes lie on one line, its elements have no thickness; "
         "nodes must differ in x and in y");
   }
}

TEST(ElementCheck, AMeshWithoutEdgesSaysHowToMakeThem)
{
   mfem::Mesh mesh(2, 4, 1, 0);
   for (const auto &[x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
   {
      mesh.AddVertex(x, y);
   }
   mesh.AddQuad(0, 1, 2, 3);
   mesh.FinalizeQuadMesh(0, 0, false);
   expect_input_error([&] { check_elements(mesh); }, "the mesh has no edges");
}

TEST(ElementCheck, BodiesAreCheckedBeforeAnythingIsAssembled)
{
   mfem::Mesh mesh = support::block("quads", 4, 3);
   EXPECT_NO_THROW(ElasticBody(mesh, 2, Material{}));
   for (const char *kind : {"triangles", "nonconforming"})
   {
      mfem::Mesh other = support::block(kind, 4, 3);
      EXPECT_NO_THROW(ElasticBody(other, 1, Material{}));
   }
   const int vertex = mesh.GetElement(5)->GetVertices()[0];
   mesh.GetVertex(vertex)[0] += 100;
   expect_input_error([&] { ElasticBody(mesh, 2, Material{}); }, "is folded over");
   // An operator of one's own does not make the mesh better.
   mfem::H1_FECollection collection(1, 2);
   mfem::FiniteElementSpace space(&mesh, &collection, 2);
   mfem::SparseMatrix K(space.GetTrueVSize());
   K.Finalize();
   expect_input_error([&] { ElasticBody(space, K); }, "is folded over");
}

} // namespace
