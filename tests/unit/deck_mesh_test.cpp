#include "expect_input_error.hpp"

#include <Eigen/Core>
#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <fstream>
#include <gtest/gtest.h>

// Meshes in decks of ABAQUS and CalculiX.
namespace
{

using namespace cattaneo;

std::string written(const std::string &text, const std::string &name = "deck.inp")
{
   const std::string file = testing::TempDir() + name;
   std::ofstream(file) << text;
   return file;
}

/// Two squares of one side, below 1 2 3, above 4 5 6.
const std::string nodes =
   "*Node, nset=all\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 0., 1.\n5, 1., 1.\n6, 2., 1.\n";
const std::string squares = "*Element, type=CPE4R, elset=left\n7, 1, 2, 5, 4\n"
                            "*Element, type=CPE4I, elset=right\n 12, 2, 3,\n6, 5\n";

double area(const std::string &file)
{
   mfem::Mesh mesh = read_mesh(file);
   double sum = 0;
   for (int e = 0; e < mesh.GetNE(); ++e) { sum += mesh.GetElementVolume(e); }
   return sum;
}

/// Lengths of the edges that a name has, in a mesh of straight edges.
double length(const std::string &file, const std::string &name)
{
   mfem::Mesh mesh = read_mesh(file);
   const std::vector<int> attributes = mesh_names(file).boundary.at(name);
   double sum = 0;
   for (int b = 0; b < mesh.GetNBE(); ++b)
   {
      if (std::find(attributes.begin(), attributes.end(), mesh.GetBdrAttribute(b)) ==
          attributes.end())
      {
         continue;
      }
      mfem::Array<int> ends;
      mesh.GetBdrElementVertices(b, ends);
      const double *x = mesh.GetVertex(ends[0]), *y = mesh.GetVertex(ends[1]);
      sum += std::hypot(x[0] - y[0], x[1] - y[1]);
   }
   return sum;
}

TEST(DeckMesh, HasSetsAndSurfacesAsParts)
{
   const std::string file =
      written(nodes + squares +
              "*Nset, nset=bottom, generate\n1, 3, 1\n*Nset, nset=corner\n1, 2\n"
              "*Elset, elset=both, generate\n7, 12, 5\n*Elset, elset=more\nboth\n"
              "*Surface, name=top, type=ELEMENT\nmore, S3\n*Surface, name=round\nboth\n"
              "*Surface, name=nodes, type=NODE\nbottom\n*Nset, nset=row, elset=left\n"
              "*Nset, nset=single\n5\n*Element, type=T3D2, elset=line\n20, 4, 1\n");
   mfem::Mesh mesh = read_mesh(file);
   EXPECT_EQ(mesh.GetNE(), 2);
   EXPECT_EQ(mesh.GetNBE(), 6);
   EXPECT_DOUBLE_EQ(area(file), 2);
   EXPECT_EQ(length(file, "BOTTOM"), 2);
   EXPECT_EQ(length(file, "NODES"), 2);
   EXPECT_EQ(length(file, "CORNER"), 1);
   EXPECT_EQ(length(file, "TOP"), 2);
   EXPECT_EQ(length(file, "ROUND"), 6);
   EXPECT_EQ(length(file, "LINE"), 1);
   EXPECT_EQ(length(file, "ROW"), 3);
   EXPECT_EQ(length(file, "SINGLE"), 0); // no edge
   const MeshNames names = mesh_names(file);
   EXPECT_FALSE(names.numbered);
   EXPECT_FALSE(names.axisymmetric);
   const BodyTerms terms{names.boundary, names.numbered};
   EXPECT_EQ(boundary_part("load", "bottom[0<x<1]", terms).attributes.size(), 2u);
   // Edges of two names are there once.
   EXPECT_EQ(boundary_part("load", "top,round", terms).attributes.size(),
             boundary_part("load", "round", terms).attributes.size());
   expect_input_error([&] { boundary_part("load", "single", terms); },
                      "SINGLE is no part of the boundary: it must be whole edges");
   expect_input_error([&] { boundary_part("load", "1", terms); },
                      "there is no part of the boundary '1', must be one of: ALL, BOTTOM");
   expect_input_error([&] { boundary_part("load", "<side", terms); }, "names are ALL, BOTTOM");
   expect_input_error([&] { boundary_part("load", "side", terms); },
                      "'side': there is no part of the boundary 'side', must be one of: ALL");
}

/// Sections are the attributes of materials, in their order.
TEST(DeckMesh, HasTheSectionsAsAttributes)
{
   const std::string sections = "*Solid Section, elset=right, material=b\n1.,\n"
                                "*Solid Section, elset=left, material=a\n";
   mfem::Mesh mesh = read_mesh(written(nodes + squares + sections));
   EXPECT_EQ(mesh.GetAttribute(0), 2);
   EXPECT_EQ(mesh.GetAttribute(1), 1);
   EXPECT_EQ(read_mesh(written(nodes + squares)).GetAttribute(1), 1);
   const std::string loaded =
      written(nodes + squares + "*Boundary\nall, 1, 2\n*Step\n*Cload\n1, 1, 2.\n*End step\n");
   EXPECT_EQ(mesh_names(loaded).passed_over, "*BOUNDARY, *CLOAD, *STEP");
}

/// Order 2: 8 nodes with a bent side (a parabola of 2 by 0.2 below), and a triangle of 6.
TEST(DeckMesh, HasCurvedSides)
{
   const std::string file = written(
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 2\n4, 0, 2\n5, 1, -0.2\n6, 2, 1\n7, 1, 2\n8, 0, 1\n"
      "9, 4, 1\n10, 3, 0.5\n11, 3, 1.5\n99, 7, 7\n*ELEMENT, TYPE=CAX8R\n1,1,2,3,4,5,6,7,8\n"
      "*ELEMENT, TYPE=CAX6\n2, 2, 9, 3, 10, 11, 6\n*NSET, NSET=LOW\n1, 5, 2\n"
      "*NSET, NSET=ENDS\n1, 2\n",
      "curved.INP");
   EXPECT_NEAR(area(file), 4 + 2.0 / 3 * 2 * 0.2 + 2, 1e-13);
   const MeshNames names = mesh_names(file);
   EXPECT_TRUE(names.axisymmetric);
   EXPECT_EQ(names.boundary.at("LOW").size(), 1u);
   EXPECT_TRUE(names.boundary.at("ENDS").empty()); // without the middle
}

/// Gmsh calls its quadrilaterals of 9 nodes M3D9: two unit squares, the middle of one moved.
TEST(DeckMesh, HasQuadrilateralsOf9Nodes)
{
   const std::string file = written(
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, .5, 0\n6, 1, .5\n7, .5, 1\n8, 0, .5\n"
      "9, .5, .6\n10, 2, 0\n11, 2, 1\n12, 1.5, 0\n13, 2, .5\n14, 1.5, 1\n15, 1.5, .5\n"
      "*ELEMENT, type=T3D3, ELSET=Line1\n1, 1, 2, 5\n"
      "*ELEMENT, type=M3D9, ELSET=Surface1\n2,1,2,3,4,5,6,7,8,9\n3,2,10,11,3,12,13,14,6,15\n");
   EXPECT_NEAR(area(file), 2, 1e-14);
   EXPECT_EQ(length(file, "LINE1"), 1);
   mfem::Mesh mesh = read_mesh(file);
   EXPECT_EQ(mesh.GetNBE(), 6);
   mfem::IntegrationPoint middle;
   middle.Set2(0.5, 0.5);
   mfem::Vector x;
   mesh.GetElementTransformation(0)->Transform(middle, x);
   EXPECT_DOUBLE_EQ(x(1), 0.6);
}

/// A layer as thin as its side is bent: each middle is nearer to that of the opposite side.
TEST(DeckMesh, HasThinBentElements)
{
   const std::string file =
      written("*NODE\n1, -3, 0\n2, 3, 0\n3, 3, .2\n4, -3, .2\n5, 0, .2\n6, 3, .1\n7, 0, .4\n"
              "8, -3, .1\n*ELEMENT, TYPE=CPE8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n");
   EXPECT_NEAR(area(file), 6 * 0.2, 1e-13);
   expect_input_error(
      [&]
      {
         read_mesh(written("*NODE\n1, -3, 0\n2, 3, 0\n3, 3, .2\n4, -3, .2\n5, 0, .2\n"
                           "6, 3, .1\n7, 0, .4\n8, -3, .1\n"
                           "*ELEMENT, TYPE=CPE8\n1, 1, 2, 3, 4, 7, 6, 5, 8\n"));
      },
      "element 1: node 7 is not between its corners 1 and 2");
}

TEST(DeckMesh, RefusesInOneSentenceWithTheLine)
{
   const auto says = [](const std::string &text, const char *part)
   {
      const std::string file = written(text);
      expect_input_error([&] { read_mesh(file); }, part);
   };
   const std::string both = nodes + squares;
   says(nodes, "has no elements, must have CPS, CPE or CAX");
   says(both + "*ELEMENT, TYPE=C3D8\n30, 1, 2, 3, 4, 5, 6, 1, 2\n",
        "line 14: element 30 is a C3D8, must be a CPS, CPE or CAX");
   says(both + "*ELEMENT, TYPE=CPE4\n7, 1, 2, 5, 4\n", "line 14: element 7 is there a second");
   says(both + "*ELEMENT, TYPE=CPE4\n8, 1, 2, 5\n",
        "element 8 is a CPE4 of 3 nodes, must have 4");
   says(both + "*ELEMENT, TYPE=CPE4\n8, 1, 2, 5, 9\n", "element 8 has node 9, which *NODE");
   says(both + "*ELEMENT, TYPE=CAX4\n8, 1, 2, 5, 4\n",
        "line 14: there are plane elements and those of CAX4, must be of one kind");
   says(both + "*ELEMENT, TYPE=T3D2\n8, 2, 5\n", "a line (T3D2), must be an edge");
   says(both + "*ELEMENT, TYPE=T3D2, ELSET=T\n8, 1, 2\n*SOLID SECTION, ELSET=T\n*SOLID "
               "SECTION, ELSET=LEFT\n*SOLID SECTION, ELSET=RIGHT\n",
        "is a T3D2 with a *SOLID SECTION");
   says(both + "*SURFACE, NAME=A\n7, S2\n",
        "line 14: face S2 of element 7 of surface 'A' is not on the boundary of the body");
   says(both + "*SURFACE, NAME=A\n7, S5\n",
        "surface 'A' has face S5 of element 7, but a CPE4R has no such face");
   says(both + "*SURFACE, NAME=A\nnone, S1\n", "line 14: there is no element set 'none'");
   says(both + "*ELSET, ELSET=A\n8\n", "line 14: there is no element 8");
   says(both + "*ELSET, ELSET=A, GENERATE\n7, 8\n", "must be between elements that are there");
   says(both + "*SOLID SECTION, ELSET=LEFT\n", "element 12 is in no *SOLID SECTION");
   says(both + "*TIE, NAME=A\n", "*TIE joins sides of bodies, must be left out");
   says(both + "*TIE, NAME=A\n",
        "an interface between these sides in the case joins them, with the key 'tied'");
   says(both + "*EQUATION\n2\n", "an interface that is tied");
   says(both + "*KINEMATIC COUPLING\n", "moves nodes as one block");
   says(both + "*RIGID BODY\n", "a guide in the case does (key 'guides')");
   says(both + "*ELEMENT\n9, 1, 2, 3\n", "*ELEMENT has no TYPE, must have one");
   says(both + "*INCLUDE, INPUT=deck.inp\n", "is within that file itself, must name another");
   says(both + "*ELGEN\n7, 2, 3, 1\n", "line 13: *ELGEN generates or moves nodes or elements");
   says("*NODE\n1, 0., 0., 1.\n2, 1., 0.\n3, 1., 1.\n*ELEMENT, TYPE=CPE3\n1, 1, 2, 3\n",
        "node 2 is at z = 0, the first one at 1");
   says("*INCLUDE, INPUT=none.inp\n", "none.inp'");
}

/// What a pre-processor exports: parts with numbers and sets of their own, instances that are
/// moved and turned, sets and surfaces of the assembly.
const std::string assembly =
   "*Heading\n** PARTS\n*Part, name=Plate\n" + nodes + squares +
   "*Nset, nset=Set-1, generate\n1, 3, 1\n*Elset, elset=Set-1\n7, 12\n"
   "*Solid Section, elset=Set-1, material=Steel\n,\n*End Part\n"
   "*Part, name=Wedge\n*Node\n1, 0., 0.\n2, 2., 0.\n3, 0., 1.\n4, 1., 0.\n5, 1., .5\n"
   "6, 0., .5\n*Element, type=CPE6M\n1, 1, 2, 3, 4, 5, 6\n*Elset, elset=all\n1\n"
   "*Solid Section, elset=all, material=Brass\n,\n*End Part\n"
   "** ASSEMBLY\n*Assembly, name=Assembly\n*Instance, name=Plate-1, part=Plate\n"
   "*End Instance\n"
   "*Instance, name=Plate-2, part=Plate\n10., 1., 0.\n"
   "10., 1., 0., 10., 1., 1., 90.\n*End Instance\n"
   "*Instance, name=Wedge-1, part=Wedge\n0., 5., 3.\n*End Instance\n"
   "*Node\n1, 7., 7., 7.\n*Nset, nset=point\n1\n"
   "*Nset, nset=Set-1, instance=Plate-1\n4, 5, 6\n"
   "*Elset, elset=_top_S3, internal, instance=Plate-2\n7, 12\n"
   "*Elset, elset=_top_S2, internal, instance=Wedge-1\n1\n"
   "*Surface, type=ELEMENT, name=top\n_top_S3, S3\n_top_S2, S2\n"
   "*Surface, type=ELEMENT, name=left\nPlate-1.left, S4\n"
   "*Nset, nset=corner\nPlate-2.1, Plate-2.4\n*End Assembly\n"
   "*Material, name=Steel\n*Elastic\n210000., 0.3\n*Material, name=Brass\n*Elastic\n"
   "100000., 0.34\n110000., 0.34, 100.\n"
   "*Surface Interaction, name=dry\n*Friction\n0.3,\n"
   "*Contact Pair, interaction=dry\ntop, left\n*Boundary\nSet-1, 2, 2\n*Step\n*Static\n"
   "*Dsload\ntop, P, 3.\n*Output, field\n*End Step\n";

TEST(DeckMesh, HasInstancesAsBodies)
{
   const std::string file = written(assembly, "assembly.inp");
   const auto bounds = [&](const char *part)
   {
      mfem::Vector low, high;
      mfem::Mesh mesh = read_mesh(file, nullptr, {part});
      mesh.GetBoundingBox(low, high);
      return Eigen::Vector4d(low(0), low(1), high(0), high(1));
   };
   EXPECT_EQ(bounds("plate-1"), Eigen::Vector4d(0, 0, 2, 1));
   // Moved by (10, 1), then turned by a quarter about the place where (0, 0) is now.
   EXPECT_LT((bounds("plate-2") - Eigen::Vector4d(9, 1, 10, 3)).norm(), 1e-14);
   EXPECT_EQ(bounds("wedge-1"), Eigen::Vector4d(0, 5, 2, 6));
   EXPECT_EQ(read_mesh(file, nullptr, {"", "WEDGE-1"}).GetNE(), 1);
   // The assembly's set is the one of the plain name.
   const MeshNames first = mesh_names(file, {"PLATE-1"});
   EXPECT_EQ(first.boundary.count("SET-1"), 1u);
   EXPECT_EQ(first.boundary.count("PLATE-1.SET-1"), 1u);
   EXPECT_NE(first.boundary.at("SET-1"), first.boundary.at("PLATE-1.SET-1"));
   EXPECT_EQ(first.boundary.count("LEFT"), 1u);
   EXPECT_EQ(first.boundary.count("TOP"), 0u);
   EXPECT_EQ(first.boundary.count("POINT"), 0u);
   EXPECT_EQ(mesh_names(file, {"PLATE-2"}).boundary.at("TOP").size(), 1u);
   EXPECT_EQ(mesh_names(file, {"PLATE-2"}).boundary.at("CORNER").size(), 1u);
   EXPECT_EQ(mesh_names(file, {"WEDGE-1"}).boundary.at("TOP").size(), 1u);
   EXPECT_EQ(first.passed_over,
             "*BOUNDARY, *CONTACT PAIR, *DSLOAD, *FRICTION, *OUTPUT, *STATIC, *STEP, *SURFACE "
             "INTERACTION");
   ASSERT_EQ(first.materials.size(), 1u);
   EXPECT_EQ(first.materials[0].young, 210000);
   EXPECT_EQ(first.materials[0].poisson, 0.3);
   EXPECT_EQ(first.plane_elements, std::set<std::string>{"CPE"});
   // It changes with temperature.
   EXPECT_EQ(mesh_names(file, {"WEDGE-1"}).materials.at(0).young, 0);
   expect_input_error([&] { read_mesh(file); },
                      "has 3 instances, PLATE-1, PLATE-2, WEDGE-1: each body must name one");
   expect_input_error([&] { read_mesh(file, nullptr, {"Plate"}); },
                      "has no instance and no set of elements 'Plate', must be one of: "
                      "PLATE-1, PLATE-2, WEDGE-1");
   std::string askew = assembly;
   askew.replace(askew.find("10., 1., 1., 90."), 16, "10., 2., 1., 90.");
   expect_input_error([&] { read_mesh(written(askew), nullptr, {"Plate-2"}); },
                      "has the direction (0, 1, 1), must be along z");
}

/// Two bodies of one deck that share nodes 2 and 5, of different orders.
TEST(DeckMesh, HasSetsOfElementsAsBodies)
{
   const std::string file =
      written(nodes + "8, 1.5, 0.\n10, 1.5, .5\n11, 1., .5\n" +
              "*Element, type=CPE4, elset=left\n7, 1, 2, 5, 4\n"
              "*Element, type=CPE6, elset=right\n8, 2, 3, 5, 8, 10, 11\n"
              "*Nset, nset=bottom\n1, 2, 8, 3\n*Surface, name=seam\nleft, S2\nright, S3\n");
   // As one body it would have the seam inside, and elements of two orders.
   expect_input_error([&] { read_mesh(file); },
                      "of surface 'SEAM' is not on the boundary of the body");
   EXPECT_EQ(read_mesh(file, nullptr, {"left"}).GetNE(), 1);
   EXPECT_DOUBLE_EQ(read_mesh(file, nullptr, {"right"}).GetElementVolume(0), 0.5);
   for (const char *part : {"left", "right"})
   {
      const MeshNames names = mesh_names(file, {part});
      EXPECT_EQ(names.boundary.at("BOTTOM").size(), 1u) << part;
      EXPECT_EQ(names.boundary.at("SEAM").size(), 1u) << part;
   }
}

} // namespace
