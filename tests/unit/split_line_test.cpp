// Meshes that are cut along a line of Gmsh.

#include "expect_input_error.hpp"

#include <cattaneo/mesh/mesh_file.hpp>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace
{

using namespace cattaneo;

/// A square of side 2 of 4 × 4 quadrilaterals, of order 1 or 2, on a line "crack" along y = 1
/// from x = 0 to `end`, which runs to the right, or piece by piece to and fro.
std::string square(int order, double end, bool one_way = true)
{
   const int n = 4 * order + 1;
   const auto node = [&](int i, int j) { return i + n * j + 1; };
   std::ostringstream out;
   out
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"rim\"\n1 7 \"crack\"\n"
         "2 1 \"body\"\n$EndPhysicalNames\n$Nodes\n"
      << n * n << '\n';
   for (int j = 0; j < n; ++j)
   {
      for (int i = 0; i < n; ++i)
      {
         out << node(i, j) << ' ' << 2.0 * i / (n - 1) << ' ' << 2.0 * j / (n - 1) << " 0\n";
      }
   }
   std::ostringstream elements;
   int count = 0;
   // From one corner by `order` steps of (di, dj).
   const auto line = [&](int group, int i, int j, int di, int dj)
   {
      elements << ++count << (order == 1 ? " 1 2 " : " 8 2 ") << group << ' ' << group << ' '
               << node(i, j) << ' ' << node(i + order * di, j + order * dj);
      if (order == 2) { elements << ' ' << node(i + di, j + dj); }
      elements << '\n';
   };
   for (int k = 0; k < n - 1; k += order)
   {
      line(1, k, 0, 1, 0);
      line(1, n - 1, k, 0, 1);
      line(1, k, n - 1, 1, 0);
      line(1, 0, k, 0, 1);
      if (2.0 * k / (n - 1) >= end) { continue; }
      const bool backward = !one_way && k > 0;
      line(7, backward ? k + order : k, (n - 1) / 2, backward ? -1 : 1, 0);
   }
   for (int j = 0; j < n - 1; j += order)
   {
      for (int i = 0; i < n - 1; i += order)
      {
         elements << ++count << (order == 1 ? " 3" : " 10") << " 2 1 1";
         const int h = order / 2, w = order;
         const std::vector<std::array<int, 2>> at =
            order == 1 ? std::vector<std::array<int, 2>>{{0, 0}, {w, 0}, {w, w}, {0, w}}
                       : std::vector<std::array<int, 2>>{{0, 0}, {w, 0}, {w, w}, {0, w}, {h, 0},
                                                         {w, h}, {h, w}, {0, h}, {h, h}};
         for (const auto &[di, dj] : at) { elements << ' ' << node(i + di, j + dj); }
         elements << '\n';
      }
   }
   out << "$EndNodes\n$Elements\n" << count << '\n' << elements.str() << "$EndElements\n";
   const std::string file = testing::TempDir() + "split.msh";
   std::ofstream(file) << out.str();
   return file;
}

/// Elements that can be reached from the first one through their sides.
int reached(mfem::Mesh &mesh)
{
   const mfem::Table &neighbours = mesh.ElementToElementTable();
   std::vector<int> found{0};
   std::vector<bool> seen(mesh.GetNE(), false);
   seen[0] = true;
   for (std::size_t k = 0; k < found.size(); ++k)
   {
      for (int m = 0; m < neighbours.RowSize(found[k]); ++m)
      {
         const int other = neighbours.GetRow(found[k])[m];
         if (!seen[other]) { found.push_back(other); }
         seen[other] = true;
      }
   }
   return static_cast<int>(found.size());
}

class SplitLine : public testing::TestWithParam<int>
{
};

TEST_P(SplitLine, ThroughABodyLeavesTwo)
{
   const std::string file = square(GetParam(), 2);
   const MeshPart part{"", "", "crack"};
   mfem::Mesh whole = read_mesh(file), mesh = read_mesh(file, nullptr, part);
   EXPECT_EQ(reached(whole), 16);
   EXPECT_EQ(reached(mesh), 8);
   EXPECT_EQ(mesh.GetNV(), whole.GetNV() + 5);
   const MeshNames names = mesh_names(file, part);
   EXPECT_EQ(names.boundary.count("crack"), 0u);
   std::map<std::string, int> edges;
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      int element = 0, info = 0;
      mesh.GetBdrElementAdjacentElement(i, element, info);
      mfem::Vector centre(2);
      mesh.GetElementCenter(element, centre);
      for (const char *lip : {"crack+", "crack-"})
      {
         if (mesh.GetBdrAttribute(i) != names.boundary.at(lip).at(0)) { continue; }
         ++edges[lip];
         // The left of a line to the right is above it.
         EXPECT_NEAR(centre(1), lip[5] == '+' ? 1.25 : 0.75, 1e-14);
      }
   }
   EXPECT_EQ(edges["crack+"], 4);
   EXPECT_EQ(edges["crack-"], 4);
   // A boundary edge is one of the boundary now: none is within the body.
   EXPECT_EQ(mesh.GetNBE(), 16 + 8);
   // Two lips: as many edges as of two rectangles of 4 × 2.
   EXPECT_EQ(mesh.GetNEdges(), 2 * (4 * 3 + 5 * 2));
}

TEST_P(SplitLine, EndsAtATipWithinTheBody)
{
   const std::string file = square(GetParam(), 1);
   mfem::Mesh whole = read_mesh(file), mesh = read_mesh(file, nullptr, {"", "", "crack"});
   EXPECT_EQ(reached(mesh), 16);
   EXPECT_EQ(mesh.GetNV(), whole.GetNV() + 2); // not the tip at x = 1
   EXPECT_EQ(mesh.GetNEdges(), whole.GetNEdges() + 2);
   double area = 0;
   for (int e = 0; e < mesh.GetNE(); ++e) { area += mesh.GetElementVolume(e); }
   EXPECT_NEAR(area, 4, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Orders, SplitLine, testing::Values(1, 2));

TEST(SplitLine, WhatCannotBeSplitIsNamed)
{
   const std::string file = square(1, 2);
   expect_input_error(
      [&] {
         read_mesh(file, nullptr, {"", "", "gap"});
      },
      "no line 'gap' to split, must be one of crack, rim");
   expect_input_error([&] { mesh_names(file, {"", "", "gap"}); }, "no line 'gap'");
   expect_input_error(
      [&] {
         read_mesh(file, nullptr, {"", "", "rim"});
      },
      "two edges of the line 'rim' begin at node");
   expect_input_error(
      [&] {
         read_mesh(square(1, 2, false), nullptr, {"", "", "crack"});
      },
      "two edges of the line 'crack' end at node");
   const std::string mfem =
      std::string(CATTANEO_SOURCE_DIR) + "/tests/fuzz/cases/block/block.mesh";
   expect_input_error(
      [&] {
         read_mesh(mfem, nullptr, {"", "", "1"});
      },
      "only Gmsh's files name lines");
}

} // namespace
