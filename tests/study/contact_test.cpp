// Cases of a user's own meshes, beside closed forms and studies that make the meshes.

#include "study/run_miniapp.hpp"

#include "common/punch.hpp"

#include <algorithm>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace
{

using Result = cattaneo_test::Run; // Run is hidden inside of tests by testing::Test::Run
using cattaneo_test::run_miniapp;
using nlohmann::json;
namespace fs = std::filesystem;

/// An empty folder of its own for each test, for the files it writes and reads.
class Contact : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "contact";
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }

   std::string write(const std::string &name, mfem::Mesh &mesh) const
   {
      std::ofstream out(folder + "/" + name);
      out.precision(17);
      mesh.Print(out);
      return name;
   }
   Result run(json keys, const std::string &options = "") const
   {
      keys["version"] = 2;
      std::ofstream(folder + "/case.json") << keys.dump();
      return run_miniapp("contact", "--case '" + folder + "/case.json' " + options);
   }

   std::string folder;
};

/// Columns of a CSV table of numbers; text becomes NaN.
std::map<std::string, std::vector<double>> table(const std::string &file)
{
   std::ifstream in(file);
   EXPECT_TRUE(in.good()) << file;
   std::string line, word;
   std::vector<std::string> names;
   std::getline(in, line);
   std::istringstream header(line);
   while (std::getline(header, word, ',')) { names.push_back(word); }
   std::map<std::string, std::vector<double>> columns;
   while (std::getline(in, line))
   {
      std::istringstream row(line);
      for (const std::string &name : names)
      {
         std::getline(row, word, ',');
         char *end = nullptr;
         const double value = std::strtod(word.c_str(), &end);
         columns[name].push_back(*end ? std::nan("") : value);
      }
   }
   return columns;
}

/// Moves the contact candidates onto a cylinder of radius 100, with curved elements: facets
/// cost K_T one per cent.
void lift_to_the_cylinder(const mfem::Vector &x, mfem::Vector &moved)
{
   moved = x;
   // And with them, to less, what is in the first layer: surfaces alone would fold its
   // elements.
   const double layer = 2 * 1.67 / 80;
   if (std::abs(x[0]) > 1.67 + 1e-9 || x[1] > layer) { return; }
   moved[1] += x[0] * x[0] / 200 * (1 - x[1] / layer);
}

TEST_F(Contact, EdgesOfAHertzContactHaveTheClosedForms)
{
   using namespace cattaneo;
   // A cylinder of radius 100 that touches a half-plane over |x| < 1, E* = 1/2. A block that
   // stands for a half-plane has a remote tension of the order of Q/domain, which K_T feels,
   // unless the other body has the same.
   const double radius = 100, friction = 0.5, share = 0.3;
   const fretting::HertzContact hertz =
      fretting::hertz_contact(std::acos(-1.0) / (8 * radius), radius, 0.5);
   ASSERT_NEAR(hertz.half_width, 1, 1e-12);
   const double P = hertz.peak_pressure * std::acos(-1.0) / 2;
   const double k_t = fretting::shear_intensities(1, share * friction * P, 0).trailing;
   // The sheet: the slip zone is underestimated by this factor.
   const double factor = 0.5 * (1 + std::sqrt(1 - share));
   const double energy =
      0.5 * fretting::hertz_slip_energy(friction, P, share, 0.5); // of one edge
   const double near =
      fretting::slip_energy_total({hertz.k_n, k_t, friction}, 2 * k_t, 0.5) / energy;
   for (const bool meshed : {true, false})
   {
      const double domain = meshed ? 1e3 : 1e5;
      // Equal blocks have no coupling at all; that of unlike discretisations is of their error.
      const auto line = graded_to_ends(1.67, meshed ? 80 : 240, 1);
      const double h = line[1] - line[0];
      std::vector<std::string> files;
      for (const double turn : {-1.0, 1.0})
      {
         mfem::Mesh mesh = half_plane_mesh(line, graded(0, 1.67, h, 1.25, 0.3),
                                           ring_scales(1.67, domain, h, 1.25));
         for (int v = 0; v < mesh.GetNV(); ++v)
         {
            double *x = mesh.GetVertex(v);
            x[0] *= turn;
            x[1] *= turn;
         }
         if (turn < 0)
         {
            mesh.SetCurvature(2);
            mesh.Transform(lift_to_the_cylinder);
         }
         files.push_back(write(turn < 0 ? "pad.mesh" : "plane.mesh", mesh));
      }
      const double p = P / (2 * domain), turn = -1.5 * P / (domain * domain);
      json keys{{"edges", {1, 2, 3}},
                {"cycle-start", 1},
                {"cycles", meshed ? 3 : 2},
                // Advancing contact goes from node to node, of which the half-plane's has 481.
                {"stepping", meshed ? "exact" : "fixed"}};
      keys["bodies"]["pad"] = {{"mesh", files[0]},
                               {"young", 0.91},
                               {"poisson", 0.3},
                               {"load",
                                {"P pressure 3 " + cattaneo::exact_text(p),
                                 "Q traction 3 " + cattaneo::exact_text(p) + " 0",
                                 "Q pressure 3 " + cattaneo::exact_text(turn) + "*x"}}};
      json below{{"young", 0.91}, {"poisson", 0.3}};
      if (meshed)
      {
         below.update({{"mesh", files[1]}, {"support", "3:xy"}});
         keys["bodies"]["plane"] = below;
      }
      else { keys["bodies"]["plane"]["half-plane"] = below; }
      keys["interfaces"]["contact"] = {{"between", {"pad:1", meshed ? "plane:1" : "plane"}},
                                       {"friction", friction}};
      if (meshed) { keys["interfaces"]["contact"]["pairing"] = 0.01; }
      const std::string peak = cattaneo::exact_text(share * friction);
      keys["history"] = {"P=0", "P=1", "Q=" + peak, "Q=-" + peak, "Q=0"};
      const auto run = this->run(keys);
      ASSERT_EQ(run.code, 0) << run.output;
      const auto &edges = run.results["edges"];
      ASSERT_EQ(edges.size(), 2u) << run.output;
      for (const auto &edge : edges)
      {
         EXPECT_FALSE(edge["complete"].get<bool>());
         EXPECT_NEAR(edge["k_n"]["value"].get<double>(), hertz.k_n, 0.01 * hertz.k_n);
         EXPECT_NEAR(std::abs(edge["k_t"]["value"].get<double>()), k_t, 0.01 * k_t);
         EXPECT_NEAR(edge["k_t_range"].get<double>(), 2 * k_t, 0.02 * k_t);
         const double d = edge["slip_zone"];
         EXPECT_NEAR(d, 1 - std::sqrt(1 - share), 0.2 * h);
         EXPECT_NEAR(edge["slip_zone_predicted"].get<double>() / d, factor, 0.05);
         EXPECT_NEAR(edge["energy"].get<double>(), energy, 0.03 * energy);
         EXPECT_NEAR(edge["energy_predicted"].get<double>() / energy, near, 0.05 * near);
      }
      EXPECT_NEAR(run.results["peak_pressure"].get<double>(), hertz.peak_pressure,
                  0.01 * hertz.peak_pressure);
   }
}

TEST_F(Contact, CornersHaveIntensitiesOfTheirOwn)
{
   // A square block on a similar one, bonded by friction, and on a rigid line.
   const auto x = cattaneo::graded_to_ends(1, 60, 0.02);
   const double smallest = x[1] - x[0];
   const auto depth = cattaneo::graded(0, 1, smallest, 1.3, 0.2);
   mfem::Mesh block = cattaneo::rectangle_mesh(x, cattaneo::graded(0, 2, smallest, 1.3, 0.2));
   mfem::Mesh plane =
      cattaneo::half_plane_mesh(x, depth, cattaneo::ring_scales(1, 1e3, smallest, 1.3));
   json keys{{"history", {"P=0", "P=1", "Q=0.1"}}, {"edges", {1, 2}}};
   keys["bodies"]["block"] = {
      {"mesh", write("block.mesh", block)},
      {"young", 0.91},
      {"poisson", 0.3},
      {"load", {"P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"}}};
   keys["interfaces"]["contact"] = {{"between", {"block:1"}}, {"friction", 3}};
   // On another body, by what is said of that.
   const auto on = [&](const json &below)
   {
      json both = keys;
      both["bodies"]["below"] = below;
      const bool meshed = below.contains("mesh");
      both["interfaces"]["contact"]["between"].push_back(meshed ? "below:1" : "below");
      if (meshed) { both["interfaces"]["contact"]["pairing"] = 1e-6; }
      return run(both);
   };
   json body{{"mesh", write("plane.mesh", plane)},
             {"young", 0.91},
             {"poisson", 0.3},
             {"support", "3:xy"}};
   const json half_plane{{"half-plane", {{"young", 0.91}, {"poisson", 0.3}}}};
   for (const json &below : {body, half_plane})
   {
      const auto similar = on(below);
      ASSERT_EQ(similar.code, 0) << similar.output;
      ASSERT_EQ(similar.results["edges"].size(), 2u) << similar.output;
      for (const auto &edge : similar.results["edges"])
      {
         EXPECT_TRUE(edge["complete"].get<bool>());
         EXPECT_FALSE(edge.contains("k_n"));
         EXPECT_NE(edge["notes"][0].get<std::string>().find("corner"), std::string::npos);
         ASSERT_TRUE(edge.contains("k_one")) << edge["notes"];
         EXPECT_NEAR(edge["eigenvalues"][0].get<double>(), 0.544483736782, 1e-9);
         EXPECT_NEAR(edge["eigenvalues"][1].get<double>(), 0.908529189846, 1e-9);
         EXPECT_NEAR(edge["least_friction"].get<double>(), 0.543075578837, 1e-9);
         EXPECT_GT(edge["k_one"]["value"].get<double>(), 0);
         EXPECT_LT(edge["k_one"]["relative_error_estimate"].get<double>(), 0.02);
      }
   }
   const auto rigid = run(keys);
   ASSERT_EQ(rigid.code, 0) << rigid.output;
   for (const auto &edge : rigid.results["edges"])
   {
      ASSERT_EQ(edge["eigenvalues"].size(), 1u) << edge["notes"];
      EXPECT_NEAR(edge["eigenvalues"][0].get<double>(), 0.7112, 1e-4);
      EXPECT_LT(edge["k_one"]["relative_error_estimate"].get<double>(), 0.05);
   }
   // Another material has exponents that are not known; the edge is refused all the same.
   body["young"] = 2;
   const auto other = on(body);
   ASSERT_EQ(other.code, 0) << other.output;
   for (const auto &edge : other.results["edges"])
   {
      EXPECT_FALSE(edge.contains("k_one"));
      ASSERT_EQ(edge["notes"].size(), 2u);
      EXPECT_NE(edge["notes"][1].get<std::string>().find("material"), std::string::npos);
   }
}

TEST_F(Contact, EqualsTheSquarePunch)
{
   for (const double domain : {-1.0, 0.0, 1e4}) // on a rigid line, a half-plane and a block
   {
      const bool half_plane = domain >= 0;
      miniapp::PunchOptions options;
      options.nodes = 41;
      options.half_plane = half_plane;
      options.domain = std::max(domain, 0.0);
      const miniapp::Scene punch = miniapp::make_punch(options);
      json keys{{"history", {"P=0", "P=1", "Q=0.24", "Q=0", "Q=-0.24", "Q=0"}},
                {"cycle-start", 1},
                {"cycles", 3},
                {"increments", 40}};
      keys["bodies"]["block"] = {
         {"mesh", write("block.mesh", *punch.meshes[0])},
         {"young", 0.91},
         {"poisson", 0.3},
         {"load", {"P pressure 3 0.5", "Q traction 3 0.5 0", "Q pressure 3 -3*x"}}};
      json &face = keys["interfaces"]["contact"];
      face = {{"between", {"block:1[-1<x<1]"}}, {"friction", 0.3}};
      json plane{{"young", 0.91}, {"poisson", 0.3}};
      if (domain == 0)
      {
         keys["bodies"]["plane"]["half-plane"] = plane;
         face["between"].push_back("plane");
      }
      if (domain > 0)
      {
         plane.update({{"mesh", write("plane.mesh", *punch.meshes[1])}, {"support", "3:xy"}});
         keys["bodies"]["plane"] = plane;
         face["between"].push_back("plane:1");
         face["pairing"] = 1e-6;
      }
      const auto mine = run(keys);
      const auto other = run_miniapp(
         "square_punch", std::string("--nodes 41 --friction 0.3 --shear '' --cycles 3 "
                                     "--amplitude 0.8 --obstacle ") +
                            (half_plane ? "half-plane" : "rigid") + " --domain " +
                            std::to_string(options.domain));
      ASSERT_EQ(mine.code, 0) << mine.output;
      ASSERT_EQ(other.code, 0) << other.output;
      EXPECT_EQ(mine.results["dofs"], other.results["dofs"]);
      EXPECT_EQ(mine.results["contact_nodes"], other.results["contact_nodes"]);
      const json &losses = mine.results["dissipation"],
                 &expected = other.results["dissipation"];
      ASSERT_EQ(losses.size(), expected.size());
      for (std::size_t k = 0; k < losses.size(); ++k)
      {
         EXPECT_NEAR(losses[k].get<double>(), expected[k].get<double>(),
                     1e-8 * expected[k].get<double>());
      }
      run(keys, "--frames 1 --csv '" + folder + "/punch'");
      const auto nodes = table(folder + "/punch_nodes.csv");
      EXPECT_NEAR(*std::max_element(nodes.at("p").begin(), nodes.at("p").begin() + 41),
                  other.results["peak_pressure"].get<double>(),
                  1e-8 * other.results["peak_pressure"].get<double>());
      EXPECT_NEAR(nodes.at("slip")[40], other.results["slip_edge"].get<double>(), 1e-9);
   }
}

} // namespace
