#include "extent.hpp"
#include "study/run_miniapp.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mfem.hpp>
#include <sstream>

/// contact on meshes with straight edges along curved sides, beside closed forms.

namespace
{

using Result = cattaneo_test::Run; // Run is hidden inside of tests by testing::Test::Run
using cattaneo_test::run_miniapp;
using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Places by two numbers from 0 to 1, along the side and into the body.
using Map = std::function<std::array<double, 2>(double, double)>;

constexpr double nu = 0.3, modulus = 1 / (1 - nu * nu); ///< of Young's modulus 1

class SmoothSides : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "smooth_sides";
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }

   /// A body of straight edges, or with the nodes of its quadratic elements on the curves;
   /// attributes 1 (the side), 2, 3 (opposite of it) and 4, turned about the origin.
   void mesh(const std::string &name, int along, int into, const Map &map, bool curved = false,
             double turned = 0, mfem::Element::Type type = mfem::Element::QUADRILATERAL) const
   {
      mfem::Mesh made = mfem::Mesh::MakeCartesian2D(along, into, type, true);
      if (curved) { made.SetCurvature(2); }
      // MFEM 4.6 takes no lambda that captures.
      mfem::VectorFunctionCoefficient place(
         2,
         [&](const mfem::Vector &x, mfem::Vector &y)
         {
            const auto at = map(x(0), x(1));
            y(0) = std::cos(turned) * at[0] - std::sin(turned) * at[1];
            y(1) = std::sin(turned) * at[0] + std::cos(turned) * at[1];
         });
      made.Transform(place);
      std::ofstream out(folder + "/" + name);
      out.precision(17);
      made.Print(out);
   }
   Result run(const json &keys) const
   {
      json all{{"version", 2}};
      all.update(keys);
      std::ofstream(folder + "/case.json") << all.dump();
      const Result got =
         run_miniapp("contact", "--case '" + folder + "/case.json' --csv '" + folder + "/out'");
      EXPECT_EQ(got.code, 0) << got.output;
      return got;
   }
   /// Column p of the nodes: pressures.
   std::vector<double> pressures() const
   {
      std::ifstream file(folder + "/out_nodes.csv");
      std::string line, word;
      std::getline(file, line);
      std::istringstream header(line);
      std::size_t column = 0;
      while (std::getline(header, word, ',') && word != "p") { ++column; }
      std::vector<double> all;
      while (std::getline(file, line))
      {
         std::istringstream row(line);
         for (std::size_t k = 0; k <= column; ++k) { std::getline(row, word, ','); }
         all.push_back(std::stod(word));
      }
      return all;
   }
   static std::string listed(const Result &got, const char *key)
   {
      std::string all;
      if (got.results.contains(key))
      {
         for (const auto &one : got.results[key]) { all += one.get<std::string>() + '\n'; }
      }
      return all;
   }
   /// What chords are told to change, of the largest pressure; 0 without them.
   static double told(const Result &got, const std::string &what)
   {
      const std::string key = "chords_" + what + "_pressure_change_estimate";
      return got.results.contains(key) ? got.results[key].get<double>() : 0;
   }

   std::string folder;
};

json body(const std::string &mesh, const std::string &support, const std::string &load = "")
{
   json made{{"mesh", mesh}, {"young", 1.0}, {"poisson", nu}};
   if (!support.empty()) { made["support"] = support; }
   if (!load.empty()) { made["load"] = load; }
   return made;
}

/// A quarter of two rings with an interference at radius 1, n edges of the inner one, two
/// thirds more of the outer one.
json rings(int order)
{
   json keys{{"order", order}, {"history", {"P=0", "P=1"}}, {"increments", 1}};
   keys["bodies"] = {{"in", body("in.mesh", "2:x 4:y")},
                     {"out", body("out.mesh", "2:y 4:x", "P pressure 3 1e-12")}};
   keys["interfaces"]["fit"] = {{"between", {"in:1", "out:1"}}, {"friction", 0}};
   return keys;
}

Map arc(double radius, double into)
{
   return [=](double s, double t)
   {
      const double r = radius + into * t, angle = M_PI / 2 * (into < 0 ? s : 1 - s);
      return std::array<double, 2>{r * std::cos(angle), r * std::sin(angle)};
   };
}

/// Lamé's pressure in a shrink fit, of every order, everywhere closed, with a note; as meshed
/// the pressure is that of polygons, and what is said of it is right to a factor of two.
TEST_F(SmoothSides, OfAShrinkFitHaveLamesPressure)
{
   const double inner = 0.5, outer = 2, d = 1e-3;
   const double lame =
      d * modulus /
      ((outer * outer + 1) / (outer * outer - 1) + (1 + inner * inner) / (1 - inner * inner));
   for (int edges : cattaneo_test::meshes({9, 18}, {6, 36, 60}))
   {
      for (int order = 1; order <= 4; ++order)
      {
         mesh("in.mesh", edges, 6, arc(1 + d, inner - 1 - d));
         mesh("out.mesh", edges * 5 / 3, 8, arc(1, outer - 1));
         json keys = rings(order);
         const Result smooth = run(keys);
         double wrong = 0;
         for (double p : pressures()) { wrong = std::max(wrong, std::abs(p / lame - 1)); }
         EXPECT_LT(wrong, order > 1 ? 0.02 : 0.6 / edges) << order << " " << edges;
         EXPECT_NE(listed(smooth, "notes").find("are taken for chords of smooth curves"),
                   std::string::npos)
            << smooth.output;
         EXPECT_EQ(listed(smooth, "warnings"), "");
         keys["geometry"] = "as meshed";
         const Result polygons = run(keys);
         EXPECT_EQ(listed(polygons, "notes"), "");
         double off = 0, most = 0;
         for (double p : pressures())
         {
            off = std::max(off, std::abs(p - lame));
            most = std::max(most, p);
         }
         if (most == 0)
         {
            EXPECT_NE(listed(polygons, "warnings").find("nothing bears, and the curves may"),
                      std::string::npos);
            continue;
         }
         // Of the node that is wrong most, and of the largest pressure.
         for (const auto &[what, is] :
              {std::make_pair("node", off / most), std::make_pair("peak", 1 - lame / most)})
         {
            const double said = told(polygons, what);
            EXPECT_LT(said, std::max(2 * is, 0.1)) << what << order << " " << edges;
            if (is > 0.1) { EXPECT_GT(said, is / 2) << what << order << " " << edges; }
         }
      }
   }
}

/// A cylinder on a block, turned as a whole: the pressure of the mesh with curved edges, node
/// for node; half of it at its plane of symmetry too.
TEST_F(SmoothSides, OfACylinderHaveHertzPressure)
{
   const double w = 0.5, load = 4e-3;
   for (bool half : {false, true})
   {
      for (int order : {2, 3})
      {
         std::vector<double> found[2];
         for (bool curved : {true, false})
         {
            const double turned = half ? 0 : 0.7;
            mesh(
               "u.mesh", half ? 20 : 40, 8,
               [=](double s, double t)
               {
                  const double x = w * (half ? s : 2 * s - 1), low = 1 - std::sqrt(1 - x * x);
                  return std::array<double, 2>{x, low + (0.9 - low) * t};
               },
               curved, turned);
            mesh(
               "l.mesh", half ? 24 : 48, 8,
               [=](double s, double t) {
                  return std::array<double, 2>{0.55 * (half ? 1 - s : 1 - 2 * s), -0.6 * t};
               },
               false, turned);
            json keys{{"order", order}, {"history", {"P=0", "P=1"}}, {"increments", 1}};
            std::ostringstream on_axis;
            on_axis.precision(17);
            on_axis << "@" << -0.9 * std::sin(turned) << "," << 0.9 * std::cos(turned) << ":x";
            keys["bodies"] = {{"u", body("u.mesh", half ? "4:x" : on_axis.str(),
                                         "P pressure 3 " + std::to_string(load))},
                              {"l", body("l.mesh", half ? "3:xy 2:x" : "3:xy")}};
            keys["interfaces"]["i"] = {{"between", {"u:1", "l:1"}}, {"friction", 0}};
            const Result got = run(keys);
            found[curved] = pressures();
            EXPECT_EQ(listed(got, "notes").empty(), curved) << got.output;
         }
         const double most = *std::max_element(found[1].begin(), found[1].end());
         // Hertz, of a cylinder that is pressed by the load over its width.
         EXPECT_NEAR(most, std::sqrt(2 * w * load * modulus / 2 / M_PI), 0.05 * most);
         ASSERT_EQ(found[0].size(), found[1].size());
         for (std::size_t i = 0; i < found[0].size(); ++i)
         {
            EXPECT_NEAR(found[0][i], found[1][i], 2e-3 * most) << half << order << " " << i;
         }
      }
   }
}

/// Elements along the side that are thinner than the arc is high take the next ones with them.
TEST_F(SmoothSides, DoNotFoldThinElements)
{
   const auto thin = [](double radius, double into)
   { return [=](double s, double t) { return arc(radius, into)(s, t * t * t * t); }; };
   mesh("in.mesh", 9, 10, thin(1.001, -0.5));
   mesh("out.mesh", 15, 10, thin(1, 1));
   json keys = rings(2);
   const Result got = run(keys);
   EXPECT_NE(listed(got, "notes").find("smooth curves"), std::string::npos) << got.output;
   const std::vector<double> p = pressures();
   const double least = *std::min_element(p.begin(), p.end()),
                most = *std::max_element(p.begin(), p.end());
   EXPECT_GT(least, 0.9 * most) << got.output;
}

/// Layers of triangles, too: vertices stay where they are. Lamé's pressure everywhere, with
/// as many edges on both sides, which meet at vertices, and with others.
TEST_F(SmoothSides, DoNotFoldThinTriangles)
{
   const auto thin = [](double radius, double into)
   {
      return [=](double s, double t)
      { return arc(radius, into)(s, t < 0.1 ? 0.06 * t : 0.006 + (t - 0.1) * 0.994 / 0.9); };
   };
   const double inner = 0.5, outer = 2, d = 1e-3;
   const double lame =
      d * modulus /
      ((outer * outer + 1) / (outer * outer - 1) + (1 + inner * inner) / (1 - inner * inner));
   for (int others : {8, 6})
   {
      for (int order : {2, 3})
      {
         mesh("in.mesh", 8, 10, thin(1 + d, inner - 1 - d), false, 0, mfem::Element::TRIANGLE);
         mesh("out.mesh", others, 10, thin(1, outer - 1), false, 0, mfem::Element::TRIANGLE);
         const Result got = run(rings(order));
         for (double p : pressures())
         {
            EXPECT_NEAR(p, lame, 0.05 * lame) << order << got.output;
         }
      }
   }
}

/// An element with two edges on a circle has no angle between them once they are curved: these
/// edges stay straight, with the gaps of the circle, and the others do not.
TEST_F(SmoothSides, OnlyEdgesBesideFoldingElementsStayStraight)
{
   const double outer = 2, d = 1e-3;
   const double lame = d * modulus / ((outer * outer + 1) / (outer * outer - 1) + 1);
   const auto disc = [=](double s, double t)
   {
      return std::array<double, 2>{(1 + d) * s * std::sqrt(1 - t * t / 2),
                                   (1 + d) * t * std::sqrt(1 - s * s / 2)};
   };
   for (int order : {2, 3})
   {
      mesh("in.mesh", 6, 6, disc);
      mesh("out.mesh", 20, 8, arc(1, outer - 1));
      json keys = rings(order);
      keys["bodies"]["in"] = body("in.mesh", "1:y 4:x");
      keys["interfaces"]["fit"]["between"] = {"in:2,3", "out:1"};
      const Result got = run(keys);
      EXPECT_NE(listed(got, "notes").find("elements beside 2 of the 12 of in would fold"),
                std::string::npos)
         << got.output;
      for (double p : pressures()) { EXPECT_NEAR(p, lame, 0.1 * lame) << order << got.output; }
   }
}

} // namespace
