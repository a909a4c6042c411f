#include "expect_input_error.hpp"

#include <cattaneo/mesh/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

/// Meshes as Gmsh writes them: formats 4.1 and 2.2, as text and as binary numbers.

namespace
{

using namespace cattaneo;

/// Writes numbers as text or as bytes.
class Writer
{
public:
   Writer(const std::string &name, bool binary)
      : file_(testing::TempDir() + name), out_(file_, std::ios::binary), binary_(binary)
   {
      out_.precision(17);
   }
   std::string close()
   {
      out_.close();
      return file_;
   }
   Writer &text(const std::string &line)
   {
      out_ << line;
      return *this;
   }
   Writer &integers(std::initializer_list<std::int32_t> all) { return put(all); }
   Writer &large(std::initializer_list<std::uint64_t> all) { return put(all); }
   Writer &reals(std::initializer_list<double> all) { return put(all); }

private:
   template <class Number>
   Writer &put(std::initializer_list<Number> all)
   {
      for (Number x : all)
      {
         if (binary_) { out_.write(reinterpret_cast<const char *>(&x), sizeof x); }
         else { out_ << x << ' '; }
      }
      if (!binary_) { out_ << '\n'; }
      return *this;
   }
   std::string file_;
   std::ofstream out_;
   bool binary_;
};

const double half = 0.5;

/// A square of two triangles of order 1, and its boundary in two groups, of the lower side and
/// of the others.
std::string format_41(bool binary)
{
   Writer out(binary ? "binary41.msh" : "text41.msh", binary);
   out.text(std::string("$MeshFormat\n4.1 ") + (binary ? "1" : "0") + " 8\n");
   if (binary) { out.integers({1}).text("\n"); }
   out.text("$EndMeshFormat\n$PhysicalNames\n3\n1 5 \"lower side\"\n1 6 \"rest\"\n2 9 "
            "\"steel\"\n$EndPhysicalNames\n$Entities\n");
   out.large({1, 2, 1, 0});
   out.integers({1}).reals({0, 0, 0}).large({0});
   out.integers({1})
      .reals({0, 0, 0, 1, 0, 0})
      .large({1})
      .integers({5})
      .large({1})
      .integers({1});
   out.integers({2}).reals({0, 0, 0, 1, 1, 0}).large({1}).integers({-6}).large({0});
   out.integers({1})
      .reals({0, 0, 0, 1, 1, 0})
      .large({1})
      .integers({9})
      .large({2})
      .integers({1, -2});
   out.text("\n$EndEntities\n$Nodes\n");
   out.large({2, 4, 1, 40});
   // Curves may give parameters of their nodes.
   out.integers({1, 1, 1}).large({2}).large({1, 2});
   out.reals({0, 0, 0, 0}).reals({1, 0, 0, 1});
   out.integers({2, 1, 0}).large({2}).large({30, 40}).reals({1, 1, 0}).reals({0, 1, 0});
   out.text("\n$EndNodes\n$Elements\n");
   out.large({4, 7, 1, 7});
   out.integers({0, 1, 15}).large({1}).large({1, 1});
   out.integers({1, 1, 1}).large({1}).large({2, 1, 2});
   out.integers({1, 2, 1}).large({3}).large({3, 2, 30, 4, 30, 40, 5, 40, 1});
   out.integers({2, 1, 2}).large({2}).large({6, 1, 2, 30, 7, 1, 30, 40});
   out.text("\n$EndElements\n");
   return out.close();
}

/// The same in format 2.2.
std::string format_22()
{
   Writer out("binary22.msh", true);
   out.text("$MeshFormat\n2.2 1 8\n").integers({1}).text("\n$EndMeshFormat\n$Nodes\n4\n");
   out.integers({1}).reals({0, 0, 0}).integers({2}).reals({1, 0, 0});
   out.integers({30}).reals({1, 1, 0}).integers({40}).reals({0, 1, 0});
   out.text("\n$EndNodes\n$Elements\n6\n");
   out.integers({1, 4, 2}).integers({1, 5, 1, 1, 2}).integers({2, 6, 2, 2, 30});
   out.integers({3, 6, 2, 30, 40}).integers({4, 6, 2, 40, 1});
   out.integers({2, 2, 2}).integers({5, 9, 1, 1, 2, 30}).integers({6, 9, 1, 1, 30, 40});
   out.text("\n$EndElements\n");
   return out.close();
}

double area(mfem::Mesh &mesh)
{
   double sum = 0;
   for (int e = 0; e < mesh.GetNE(); ++e) { sum += mesh.GetElementVolume(e); }
   return sum;
}

TEST(GmshFile, IsReadInAllFormats)
{
   for (const std::string &file : {format_41(false), format_41(true), format_22()})
   {
      mfem::Mesh mesh = read_mesh(file);
      EXPECT_EQ(mesh.GetNE(), 2) << file;
      EXPECT_EQ(mesh.GetNV(), 4) << file;
      EXPECT_EQ(mesh.GetAttribute(0), 9);
      EXPECT_NEAR(area(mesh), 1, 1e-14);
      int lower = 0, rest = 0;
      for (int b = 0; b < mesh.GetNBE(); ++b)
      {
         lower += mesh.GetBdrAttribute(b) == 5;
         rest += mesh.GetBdrAttribute(b) == 6;
      }
      EXPECT_EQ(lower, 1);
      EXPECT_EQ(rest, 3);
   }
   const MeshNames names = mesh_names(format_41(true));
   EXPECT_EQ(names.boundary,
             (std::map<std::string, std::vector<int>>{{"lower_side", {5}}, {"rest", {6}}}));
   EXPECT_EQ(names.elements, (std::map<std::string, int>{{"steel", 9}}));
   EXPECT_TRUE(mesh_names(format_22()).boundary.empty());
}

/// The edge of a quadrilateral of 8 nodes is bent, its middle follows: x = -¼ Σ corners + ½ Σ
/// middles.
TEST(GmshFile, QuadrilateralsOf8NodesAreGivenTheirMiddle)
{
   Writer out("eight.msh", false);
   out.text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n");
   const double corner[8][2] = {{0, 0},    {2, 0}, {2, 2}, {0, 2},
                                {1, -0.2}, {2, 1}, {1, 2}, {0, 1}};
   for (int k = 0; k < 8; ++k)
   {
      out.text(std::to_string(k + 1) + " ").reals({corner[k][0], corner[k][1], 0});
   }
   out.text(
      "$EndNodes\n$Elements\n5\n1 16 2 1 1 1 2 3 4 5 6 7 8\n2 8 2 1 1 1 2 5\n3 8 2 2 2 2 3 "
      "6\n4 8 2 2 3 3 4 7\n5 8 2 2 4 4 1 8\n$EndElements\n");
   mfem::Mesh mesh = read_mesh(out.close());
   EXPECT_NEAR(area(mesh), 4 + 2.0 / 3 * 2 * 0.2, 1e-13); // a parabola of 2 by 0.2 below
   mfem::IntegrationPoint middle;
   middle.Set2(half, half);
   mfem::Vector x(2);
   mesh.GetElementTransformation(0)->Transform(middle, x);
   EXPECT_NEAR(x[0], 1, 1e-14);
   EXPECT_NEAR(x[1], 0.9, 1e-14);
}

TEST(GmshFile, RefusesWhatIsCutShort)
{
   for (const bool binary : {false, true})
   {
      const std::string whole = format_41(binary);
      std::stringstream text;
      text << std::ifstream(whole, std::ios::binary).rdbuf();
      const std::string all = text.str();
      for (std::size_t length = 20; length + 15 < all.size(); length += 13)
      {
         const std::string cut = testing::TempDir() + "cut.msh";
         std::ofstream(cut, std::ios::binary) << all.substr(0, length);
         EXPECT_THROW(read_mesh(cut), InputError) << length;
      }
   }
   Writer out("other.msh", false);
   out.text("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n");
   expect_input_error([file = out.close()] { read_mesh(file); }, "format 4.0, must be");
}

// Where something is in the plane changes nothing of whether it is joined.
TEST(GmshFile, NodesThatLieOnOneAnotherAreFoundAnywhere)
{
   for (const double away : {0.0, 1000.0, -1000.0})
   {
      mfem::Mesh joined = mfem::Mesh::MakeCartesian2D(3, 2, mfem::Element::QUADRILATERAL);
      mfem::Mesh cut(2, 8, 2);
      for (int copy : {0, 1})
      {
         for (int v = 0; v < 4; ++v) { cut.AddVertex(copy + v % 2 + away, v / 2 - away); }
         cut.AddQuad(4 * copy, 4 * copy + 1, 4 * copy + 3, 4 * copy + 2);
      }
      cut.FinalizeQuadMesh(1);
      for (int v = 0; v < joined.GetNV(); ++v)
      {
         joined.GetVertex(v)[0] += away;
         joined.GetVertex(v)[1] -= away;
      }
      EXPECT_EQ(unjoined_vertices(joined, "one", {}), "");
      EXPECT_NE(unjoined_vertices(cut, "two", {}).find("mesh 'two': 2 pairs of nodes"),
                std::string::npos);
   }
}

// MFEM turns elements that are numbered clockwise, and tells so in words that a run's output
// has no use for.
TEST(GmshFile, ElementsThatAreTurnedAreNothingToTell)
{
   const std::string file = testing::TempDir() + "clockwise.msh";
   std::ofstream(file) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 0 1 0\n"
                          "3 1 0 0\n$EndNodes\n$Elements\n2\n1 1 2 1 1 2 1\n"
                          "2 2 2 1 1 1 2 3\n$EndElements\n";
   testing::internal::CaptureStdout();
   mfem::Mesh mesh = read_mesh(file);
   mfem::out << "after";
   mfem::out.flush();
   EXPECT_EQ(testing::internal::GetCapturedStdout(), "after");
   EXPECT_NEAR(mesh.GetElementVolume(0), 0.5, 1e-15);
}

// Volumes are passed over by their number of nodes, and what they bound is no body of the
// plane.
TEST(GmshFile, VolumesAreRefusedAsWhatTheyAre)
{
   Writer out("volume.msh", true);
   out.text("$MeshFormat\n2.2 1 8\n").integers({1}).text("\n$EndMeshFormat\n$Nodes\n8\n");
   for (int k = 0; k < 8; ++k)
   {
      out.integers({k + 1}).reals({double(k % 2), double(k / 2 % 2), double(k / 4)});
   }
   out.text("\n$EndNodes\n$Elements\n1\n").integers({5, 1, 2});
   out.integers({1, 1, 1, 1, 2, 4, 3, 5, 6, 8, 7}).text("\n$EndElements\n");
   expect_input_error([file = out.close()] { read_mesh(file); },
                      "element 1, a hexahedron, but bodies must be plane");
}

} // namespace
