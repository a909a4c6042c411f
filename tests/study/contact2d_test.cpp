#include "study/run_miniapp.hpp"

#include "common/punch.hpp"

#include <algorithm>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <vector>

namespace
{

using cattaneo_test::Run; // hidden inside of tests by testing::Test::Run
using cattaneo_test::run_miniapp;
using nlohmann::json;
namespace fs = std::filesystem;

/// An empty folder of its own for each test, for the files it writes and reads.
class Contact2D : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "contact2d";
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }

   std::string write(const std::string &name, const std::string &text) const
   {
      std::ofstream(folder + "/" + name) << text;
      return folder + "/" + name;
   }

   std::string write(const std::string &name, mfem::Mesh &mesh) const
   {
      std::ofstream out(folder + "/" + name);
      out.precision(17);
      mesh.Print(out);
      return folder + "/" + name;
   }

   std::string folder;
};

Run contact2d(const std::string &options)
{
   return run_miniapp("contact2d", options);
}

/// States of the zones from the start of the line to its end.
std::vector<std::string> states(const Run &run)
{
   std::vector<std::string> list;
   for (const auto &zone : run.results["zones"]) { list.push_back(zone["state"]); }
   return list;
}

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

/// A pad 4 wide and 2 high, of so many elements along a bottom y = curvature x².
mfem::Mesh pad(int elements, double curvature, double grading = 1)
{
   std::vector<double> x, y;
   for (int k = 0; k <= elements; ++k)
   {
      x.push_back(-2 + 4 * std::pow(static_cast<double>(k) / elements, grading));
   }
   for (int k = 0; k <= elements / 2; ++k) { y.push_back(4.0 * k / elements); }
   mfem::Mesh mesh = cattaneo::rectangle_mesh(x, y);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *at = mesh.GetVertex(v);
      at[1] += (1 - at[1] / 2) * curvature * at[0] * at[0];
   }
   return mesh;
}

TEST_F(Contact2D, DovetailCarriesItsLoadOnTheFlank)
{
   const auto run = contact2d("--case meshes/dovetail.json --csv '" + folder + "/dovetail'");
   ASSERT_EQ(run.code, 0) << run.output;
   const json &r = run.results;
   EXPECT_EQ(r["status"], "converged");
   // The neck is pulled by 200 on a half-width of 5 - √2.
   const double load = 200 * (5 - std::sqrt(2.0));
   EXPECT_NEAR(r["contact_force"][1].get<double>(), -load, 1e-9 * load);
   // The flank is inclined by 45°: friction lies between its two bounds.
   const double ratio =
      r["contact_force"][0].get<double>() / r["contact_force"][1].get<double>();
   EXPECT_GT(ratio, (1 - 0.3) / (1 + 0.3) * 0.98);
   EXPECT_LT(ratio, 1.0);
   EXPECT_EQ(states(run).front(), "separation");
   EXPECT_EQ(states(run).back(), "separation");
   EXPECT_NEAR(r["zones"].back()["to"].get<double>(), 5.4, 0.005);
   EXPECT_LT(std::abs(r["energy_imbalance"].get<double>()), 1e-4); // increments
   EXPECT_LT(r["largest_residual"].get<double>(), 1e-12);
   EXPECT_GE(r["steady_cycle"], 1);
   ASSERT_EQ(r["dissipation"].size(), r["steady_cycle"]); // it ends there
   for (double loss : r["dissipation"]) { EXPECT_GT(loss, 0); }
   EXPECT_EQ(r["counters"]["assemblies"], 2);
   EXPECT_EQ(r["counters"]["factorisations"], 2);
   EXPECT_EQ(r["counters"]["field_recoveries"], 0);

   const auto history = table(folder + "/dovetail_history.csv");
   EXPECT_EQ(history.at("time").size(), r["counters"]["increments"].get<std::size_t>());
   const auto &losses = history.at("dissipation");
   const double total = std::accumulate(losses.begin(), losses.end(), 0.0);
   EXPECT_NEAR(total, r["total_dissipation"].get<double>(), 1e-12 * total);
}

/// Of nodes that are paired one to one no body comes first: on curved lines that part, frames,
/// gaps and areas are those between both. Cases with the names of their bodies exchanged.
TEST_F(Contact2D, PairedBodiesMayBeNamedInEitherOrder)
{
   for (const std::string name : {"dovetail", "rounded_punch"})
   {
      const std::string file = "meshes/" + name + ".json";
      json keys, exchanged;
      std::ifstream(CATTANEO_SOURCE_DIR "/" + file) >> keys;
      for (auto &[key, value] : keys.items())
      {
         if (key.substr(0, 4) == "mesh")
         {
            value = CATTANEO_SOURCE_DIR "/meshes/" + value.get<std::string>();
         }
         const std::string other = key.back() == '1' ? "2" : key.back() == '2' ? "1" : "";
         exchanged[other.empty() ? key : key.substr(0, key.size() - 1) + other] = value;
      }
      const auto one = contact2d("--case " + file),
                 two = contact2d("--case '" + write("exchanged.json", exchanged.dump()) + "'");
      ASSERT_EQ(one.code, 0) << one.output;
      ASSERT_EQ(two.code, 0) << two.output;
      EXPECT_EQ(one.results["warnings"].size(), 0u) << one.output;
      const double force = one.results["contact_force"][1];
      for (int c : {0, 1})
      {
         EXPECT_NEAR(one.results["contact_force"][c].get<double>(),
                     -two.results["contact_force"][c].get<double>(), 1e-9 * std::abs(force));
      }
      for (const char *key : {"peak_pressure", "total_dissipation"})
      {
         const double value = one.results[key];
         EXPECT_NEAR(two.results[key].get<double>() / value, 1, 1e-9) << name << " " << key;
      }
      const json &losses = one.results["dissipation"], &others = two.results["dissipation"];
      ASSERT_EQ(losses.size(), others.size()) << name;
      for (std::size_t k = 0; k < losses.size(); ++k)
      {
         EXPECT_NEAR(others[k].get<double>() / losses[k].get<double>(), 1, 1e-9) << name;
      }
   }
}

/// One force at two places is a couple: where these are far apart, it is said.
TEST_F(Contact2D, NodesThatArePairedFarOffOneAnother)
{
   for (double grading : {1.05, 1.01})
   {
      std::vector<double> x;
      double most = 0; // of what nodes stand off by, in distances of nodes
      for (int k = 0; k <= 8; ++k)
      {
         x.push_back(-2 + 4 * std::pow(k / 8.0, grading));
         most = std::max(most, std::abs(x[k] - (-2 + 0.5 * k)) / 0.5);
      }
      mfem::Mesh upper = pad(8, 0), lower = cattaneo::rectangle_mesh(x, {-2, -1, 0});
      const auto run = contact2d("--mesh1 '" + write("upper.mesh", upper) + "' --mesh2 '" +
                                 write("lower.mesh", lower) +
                                 "' --contact1 1 --contact2 3 --load1 'P pressure 3 1e-3' "
                                 "--support2 1:xy --pairing 0.4 --order 1");
      ASSERT_EQ(run.code, 0) << run.output;
      const json &warnings = run.results["warnings"];
      ASSERT_EQ(warnings.size(), most > 0.1 ? 1u : 0u) << run.output;
      if (warnings.empty()) { continue; }
      const std::string words = warnings[0], about = "lie up to ";
      ASSERT_NE(words.find(about), std::string::npos) << words;
      // Of the shorter one of the two distances, which is a few per cent less.
      EXPECT_NEAR(std::stod(words.substr(words.find(about) + about.size())) / most, 1, 0.2);
   }
}

TEST_F(Contact2D, WhatHasNoMeshesCannotBeShown)
{
   for (const char *program :
        {"fretting", "march -reduced problems/hertz.json",
         "shakedown -reduced problems/hertz.json", "contact2d -case meshes/calculix/laps.json"})
   {
      const std::string words = program;
      const std::size_t end = std::min(words.find(' '), words.size());
      const auto run = run_miniapp(words.substr(0, end), words.substr(end) + " --check");
      EXPECT_EQ(run.code, 1) << program;
      EXPECT_NE(run.output.find("error: option --check: this run has no scene of meshes\n"),
                std::string::npos)
         << run.output;
      EXPECT_TRUE(run.results.is_null()) << program;
   }
}

TEST_F(Contact2D, RoundedPunchHasTheContactWidthOfTheClosedForm)
{
   const std::string pressed = "--case meshes/rounded_punch.json --history 'P=0; P=1' "
                               "--cycle-start -1 --cycles 1 --csv '" +
                               folder + "/punch'";
   const auto run = contact2d(pressed);
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_NEAR(run.results["contact_force"][0].get<double>(), 0, 1e-7);
   EXPECT_NEAR(run.results["contact_force"][1].get<double>(), 600, 1e-7);
   // Ciavarella, Hills & Monno (1998): P R/(a² E*) = (ε - sin ε cos ε)/(2 cos² ε), b = a/cos ε.
   const double right = 600 * 5 / (9 * 0.5 * 210e3 / (1 - 0.09));
   double low = 0, high = 1;
   while (high - low > 1e-12)
   {
      const double e = 0.5 * (low + high);
      const double left = (e - std::sin(e) * std::cos(e)) / (2 * std::pow(std::cos(e), 2));
      (left < right ? low : high) = e;
   }
   const double b = 3 / std::cos(low);
   double from = 1e9, to = -1e9;
   for (const auto &zone : run.results["zones"])
   {
      if (zone["state"] == "separation") { continue; }
      from = std::min(from, zone["from"].get<double>());
      to = std::max(to, zone["to"].get<double>());
   }
   EXPECT_NEAR(0.5 * (to - from), b, 0.0031); // a spacing of the nodes, 0.2 / 64
   // The meshes are symmetric on the contact line, but not inside.
   const auto nodes = table(folder + "/punch_nodes.csv");
   const auto &p = nodes.at("p"), &q = nodes.at("q");
   ASSERT_EQ(p.size(), 257u);
   double skew = 0, total = 0;
   for (std::size_t i = 0; i < p.size(); ++i)
   {
      const std::size_t mirrored = p.size() - 1 - i;
      skew += std::abs(p[i] - p[mirrored]) + std::abs(q[i] + q[mirrored]);
      total += p[i];
   }
   EXPECT_LT(skew, 0.02 * total);
}

TEST_F(Contact2D, RoundedPunchReachesASteadyCycle)
{
   const auto run =
      contact2d("--case meshes/rounded_punch.json --edges '1 2 3' --csv '" + folder + "/of'");
   ASSERT_EQ(run.code, 0) << run.output;
   // What is printed of the edges is a file as well.
   std::ifstream file(folder + "/of_edges.csv");
   std::string head, first, last, none;
   std::getline(std::getline(std::getline(file, head), first), last);
   EXPECT_EQ(head.rfind("edge,position,", 0), 0u) << head;
   for (const char *key : {",x,", ",k_n.value,", ",k_t.window.1,", ",slip_zone,", ",energy,"})
   {
      EXPECT_NE(head.find(key), std::string::npos) << key << " " << head;
   }
   EXPECT_EQ(first.rfind("first,", 0), 0u) << first;
   EXPECT_EQ(last.rfind("last,", 0), 0u) << last;
   EXPECT_FALSE(std::getline(file, none));
   EXPECT_GT(run.results["steady_cycle"], 0);
   EXPECT_EQ(run.results["steady_period"], 1);
   EXPECT_GT(run.results["dissipation"].back(), 0);
   EXPECT_LT(std::abs(run.results["energy_imbalance"].get<double>()), 1e-4); // increments
   // Each number of an error is a bound or an estimate, by its own name.
   EXPECT_TRUE(run.results.contains("loss_error_bound")) << run.output;
   EXPECT_NE(run.output.find("± (estimate)"), std::string::npos) << run.output;
   for (const auto &zone : run.results["zones"])
   {
      EXPECT_TRUE(zone.contains("from_error_estimate") && zone.contains("to_error_estimate"));
   }
   for (const auto &[key, value] : run.results.items())
   {
      EXPECT_FALSE(key.size() > 6 && key.compare(key.size() - 6, 6, "_error") == 0) << key;
   }
   // Pressed alike at both edges. For two half-planes the closed form gives 3,693; the sides of
   // the punch and of the block are away by half a contact and by several.
   ASSERT_EQ(run.results["edges"].size(), 2u);
   for (const int e : {0, 1})
   {
      // To 3 %, thrice what a fit over the nodes near an edge is wrong by elsewhere; and it
      // must know itself to a tenth, or it is of no use.
      const auto &fitted = run.results["edges"][e]["k_n"];
      EXPECT_NEAR(fitted["value"].get<double>(), 3693, 0.03 * 3693);
      EXPECT_LT(fitted["relative_error_estimate"].get<double>(), 0.1);
   }
   // Sheared alike, too: what K_T of one has more than that of the other is of the shear that
   // pressing left, which points outward at both and has none; each must know that of itself.
   double k_t[2], wrong[2];
   for (const int e : {0, 1})
   {
      const auto &fitted = run.results["edges"][e]["k_t"];
      k_t[e] = fitted["value"].get<double>();
      wrong[e] = std::abs(k_t[e]) * fitted["relative_error_estimate"].get<double>();
   }
   EXPECT_LT(std::abs(k_t[0] + k_t[1]), wrong[0] + wrong[1]);
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

TEST_F(Contact2D, EdgesOfAHertzContactHaveTheClosedForms)
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
      char loads[200];
      std::snprintf(loads, sizeof loads,
                    "P pressure 3 %.16g; Q traction 3 %.16g 0; Q pressure 3 %.16g*x",
                    P / (2 * domain), P / (2 * domain), -1.5 * P / (domain * domain));
      // Advancing contact goes from node to node, of which the half-plane's has 481.
      char rest[300];
      std::snprintf(rest, sizeof rest,
                    "' -young1 .91 -contact1 1 -friction %g -pairing .01 -history 'P=0; P=1; "
                    "Q=%g; Q=%g; Q=0' -cycle-start 1 -cycles %d -stepping %s "
                    "-edges '1 2 3'",
                    friction, share * friction, -share * friction, meshed ? 3 : 2,
                    meshed ? "advancing" : "fixed");
      const std::string below =
         meshed
            ? " -mesh2 '" + files[1] + "' -young2 .91 -contact2 1 -support2 3:xy"
            : " -case '" +
                 write("half.json", R"({"half-plane": {"young": 0.91, "poisson": 0.3}})") + "'";
      const auto run = contact2d("-mesh1 '" + files[0] + "' -load1 '" + loads + rest + below);
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

TEST_F(Contact2D, CornersHaveIntensitiesOfTheirOwn)
{
   // A square block on a similar one, bonded by friction, and on a rigid line.
   const auto x = cattaneo::graded_to_ends(1, 60, 0.02);
   const double smallest = x[1] - x[0];
   const auto depth = cattaneo::graded(0, 1, smallest, 1.3, 0.2);
   mfem::Mesh block = cattaneo::rectangle_mesh(x, cattaneo::graded(0, 2, smallest, 1.3, 0.2));
   mfem::Mesh plane =
      cattaneo::half_plane_mesh(x, depth, cattaneo::ring_scales(1, 1e3, smallest, 1.3));
   const std::string pad = "-mesh1 '" + write("block.mesh", block) +
                           "' -young1 0.91 -contact1 1 -load1 'P pressure 3 0.5; Q traction 3 "
                           "0.5 0; Q pressure 3 -3*x' -friction 3 -history 'P=0; P=1; Q=0.1' "
                           "-edges '1 2' ";
   const std::string body =
      "-mesh2 '" + write("plane.mesh", plane) + "' -contact2 1 -support2 3:xy ";
   for (const std::string &below :
        {body + "-young2 0.91", std::string("-half-plane-young 0.91 -half-plane-poisson 0.3")})
   {
      const auto similar = contact2d(pad + below);
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
   const auto rigid = contact2d(pad);
   ASSERT_EQ(rigid.code, 0) << rigid.output;
   for (const auto &edge : rigid.results["edges"])
   {
      ASSERT_EQ(edge["eigenvalues"].size(), 1u) << edge["notes"];
      EXPECT_NEAR(edge["eigenvalues"][0].get<double>(), 0.7112, 1e-4);
      EXPECT_LT(edge["k_one"]["relative_error_estimate"].get<double>(), 0.05);
   }
   // Another material has exponents that are not known; the edge is refused all the same.
   const auto other = contact2d(pad + body + "-young2 2");
   ASSERT_EQ(other.code, 0) << other.output;
   for (const auto &edge : other.results["edges"])
   {
      EXPECT_FALSE(edge.contains("k_one"));
      ASSERT_EQ(edge["notes"].size(), 2u);
      EXPECT_NE(edge["notes"][1].get<std::string>().find("material"), std::string::npos);
   }
}

/// A block on a half-plane that has no mesh: what forces do to the contact is known, how far
/// they move is relative to a depth.
TEST_F(Contact2D, DisplacementsOnAHalfPlaneAreRelativeToADepth)
{
   const auto x = cattaneo::graded_to_ends(1, 20, 0.1);
   mfem::Mesh whole = cattaneo::rectangle_mesh(x, {0, 0.1, 0.3, 1, 2});
   const std::string file = write("whole.mesh", whole);
   const auto pressed = [&](const std::string &options, const std::string &half_plane)
   {
      return contact2d("-mesh1 '" + file + "' -young1 0.91 -contact1 1 -friction 0.4 -case '" +
                       write("half.json", R"({"half-plane": {"young": 0.91, "poisson": 0.3)" +
                                             half_plane + "}}") +
                       "' -csv '" + folder + "/run' " + options);
   };
   const std::string forces =
      "-load1 'P pressure 3 0.5; Q traction 3 0.5 0; Q pressure 3 -3*x' -history 'P=0; P=1; "
      "Q=0.2'";
   const auto without = pressed(forces, "");
   ASSERT_EQ(without.code, 0) << without.output;
   const std::string column = "displacement P";
   EXPECT_EQ(table(folder + "/run_history.csv").count(column), 0u);
   double sunk[2];
   for (const int k : {0, 1})
   {
      const auto run = pressed(forces, k == 0 ? R"(, "depth": 100)" : R"(, "depth": 1000)");
      ASSERT_EQ(run.code, 0) << run.output;
      const auto history = table(folder + "/run_history.csv");
      ASSERT_EQ(history.count(column), 1u);
      sunk[k] = history.at(column).back();
      // The contact does not know of it.
      EXPECT_NEAR(run.results["peak_pressure"].get<double>(),
                  without.results["peak_pressure"].get<double>(), 1e-9);
      for (std::size_t zone = 0; zone < run.results["zones"].size(); ++zone)
      {
         EXPECT_NEAR(run.results["zones"][zone]["to"].get<double>(),
                     without.results["zones"][zone]["to"].get<double>(), 1e-9);
      }
   }
   // P = 1, E' = 1: 2/π ln(D₂/D₁).
   EXPECT_NEAR(sunk[1] - sunk[0], 2 / std::acos(-1.0) * std::log(10.0), 1e-9);

   // A prescribed displacement or a support needs the depth: 0.1 is more than what P = 0.1
   // does.
   const std::string moved = "-load1 'D displacement-y 3 -0.1' -history 'D=0; D=1'";
   for (const std::string &held : {moved, forces + " -support1 3:x"})
   {
      const auto refused = pressed(held, "");
      EXPECT_EQ(refused.code, 1) << refused.output;
      EXPECT_NE(refused.output.find("half-plane-depth must state it"), std::string::npos)
         << refused.output;
   }
   const auto given =
      pressed(moved + " -paraview '" + folder + "/fields'", R"(, "depth": 1000)");
   ASSERT_EQ(given.code, 0) << given.output;
   for (const char *name : {"body1", "body2", "contact"})
   {
      EXPECT_TRUE(fs::exists(folder + "/fields/" + name + "/" + name + ".pvd")) << name;
   }
   const auto refused = pressed(forces + " -paraview '" + folder + "/fields'", "");
   EXPECT_NE(refused.output.find("half-plane-depth must state it"), std::string::npos);
}

/// Half of the block, held on its plane of symmetry, presses as the whole does; also where its
/// face is curved, so that the last edge before the plane of symmetry leans.
TEST_F(Contact2D, APlaneOfSymmetryGoesOnInTheHalfPlane)
{
   const auto x = cattaneo::graded_to_ends(1, 20, 0.1);
   const std::vector<double> y = {0, 0.1, 0.3, 1, 2}, right(x.begin() + 10, x.end());
   const std::string options =
      " -young1 0.91 -contact1 1 -friction 0.4 -load1 'P pressure 3 0.05' -half-plane-young 2 "
      "-half-plane-poisson 0.2 -csv '" +
      folder + "/run'";
   for (const double curvature : {0.0, 0.5})
   {
      std::vector<double> p[2];
      for (const int k : {0, 1})
      {
         mfem::Mesh mesh = cattaneo::rectangle_mesh(k == 0 ? x : right, y);
         for (int v = 0; v < mesh.GetNV(); ++v)
         {
            double *at = mesh.GetVertex(v);
            at[1] += 0.5 * curvature * at[0] * at[0] * (1 - at[1] / 2);
         }
         const auto run = contact2d("-mesh1 '" + write("block.mesh", mesh) + "'" +
                                    (k == 0 ? "" : " -support1 4:x") + options);
         ASSERT_EQ(run.code, 0) << run.output;
         p[k] = table(folder + "/run_nodes.csv").at("p");
      }
      ASSERT_EQ(p[0].size(), 41u);
      ASSERT_EQ(p[1].size(), 21u);
      EXPECT_GT(p[0][20], 0.02);
      EXPECT_EQ(p[0][0] == 0, curvature > 0);
      for (std::size_t i = 0; i < 21; ++i) { EXPECT_NEAR(p[1][i], p[0][20 + i], 1e-6); }
   }
}

TEST_F(Contact2D, EqualsTheSquarePunch)
{
   for (const double domain : {-1.0, 0.0, 1e4}) // on a rigid line, a half-plane and a block
   {
      const bool half_plane = domain >= 0;
      miniapp::PunchOptions options;
      options.nodes = 41;
      options.half_plane = half_plane;
      options.domain = std::max(domain, 0.0);
      const miniapp::Scene punch = miniapp::make_punch(options);
      std::string own = "--mesh1 '" + write("block.mesh", *punch.meshes[0]) +
                        "' --contact1 '1[-1<x<1]' --young1 0.91 --friction 0.3 --load1 "
                        "'P pressure 3 0.5; Q traction 3 0.5 0; Q pressure 3 -3*x' "
                        "--history 'P=0; P=1; Q=0.24; Q=0; Q=-0.24; Q=0' --cycle-start 1 "
                        "--cycles 3 --increments 40";
      if (domain == 0) { own += " --half-plane-young 0.91 --half-plane-poisson 0.3"; }
      if (domain > 0)
      {
         own += " --mesh2 '" + write("plane.mesh", *punch.meshes[1]) +
                "' --contact2 1 --young2 0.91 --support2 3:xy";
      }
      const auto mine = contact2d(own);
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
      const auto pressed = contact2d(own + " --frames 1 --csv '" + folder + "/punch'");
      const auto nodes = table(folder + "/punch_nodes.csv");
      EXPECT_NEAR(*std::max_element(nodes.at("p").begin(), nodes.at("p").begin() + 41),
                  other.results["peak_pressure"].get<double>(),
                  1e-8 * other.results["peak_pressure"].get<double>());
      EXPECT_NEAR(nodes.at("slip")[40], other.results["slip_edge"].get<double>(), 1e-9);
   }
}

TEST_F(Contact2D, FieldsAreRecoveredForFramesOnly)
{
   const auto run = contact2d("--case meshes/rounded_punch.json --cycles 1 --frames '1 2' "
                              "--paraview '" +
                              folder + "/fields'");
   ASSERT_EQ(run.code, 0) << run.output;
   // Two frames and the last state, two bodies.
   EXPECT_EQ(run.results["counters"]["field_recoveries"], 6);
   for (const char *name : {"body1", "body2", "contact"})
   {
      const std::string pvd = folder + "/fields/" + name + "/" + name + ".pvd";
      std::ifstream in(pvd);
      ASSERT_TRUE(in.good()) << pvd;
      std::stringstream text;
      text << in.rdbuf();
      int sets = 0;
      for (std::string line; std::getline(text, line);)
      {
         sets += line.find("<DataSet") != std::string::npos;
      }
      EXPECT_EQ(sets, 3) << pvd;
   }
}

TEST_F(Contact2D, ARunCutInTwoGivesTheSameBits)
{
   // With this friction it settles in many cycles.
   const std::string run = "--case meshes/dovetail.json --friction 0.5 --cycles ";
   const std::string state = " '" + folder + "/state.json'";
   const auto whole = contact2d(run + "4");
   const auto first = contact2d(run + "2 --save-state" + state);
   const auto second = contact2d(run + "4 --load-state" + state);
   ASSERT_EQ(whole.code, 0) << whole.output;
   ASSERT_EQ(first.code, 0) << first.output;
   ASSERT_EQ(second.code, 0) << second.output;
   ASSERT_EQ(whole.results["dissipation"].size(), 4u) << whole.output;
   for (const char *key : {"time", "loads", "peak_pressure", "contact_force", "zones",
                           "total_dissipation", "steady_cycle", "status"})
   {
      EXPECT_EQ(whole.results[key], second.results[key]) << key;
   }
   EXPECT_EQ(second.results["first_cycle"], 3);
   EXPECT_EQ(second.results["dissipation"][0], whole.results["dissipation"][2]);
   EXPECT_EQ(second.results["dissipation"][1], whole.results["dissipation"][3]);

   const auto other =
      contact2d(run + "4 --history 'P=0; P=0.5; P=0.6; P=0.5' --load-state" + state);
   EXPECT_EQ(other.code, 1);
   EXPECT_NE(other.output.find("the saved state has the load multipliers"), std::string::npos)
      << other.output;
}

TEST_F(Contact2D, GrossSlidingIsAnOutcomeWithItsLoad)
{
   miniapp::PunchOptions options;
   options.nodes = 21;
   const miniapp::Scene punch = miniapp::make_punch(options);
   const auto run =
      contact2d("--mesh1 '" + write("block.mesh", *punch.meshes[0]) +
                "' --contact1 1 --friction 0.3 --load1 'P pressure 3 0.5; "
                "Q traction 3 0.5 0; Q pressure 3 -3*x' --history 'P=0; P=1; Q=0.4'");
   EXPECT_EQ(run.code, 2) << run.output;
   ASSERT_TRUE(run.results.is_object());
   EXPECT_EQ(run.results["status"], "gross sliding");
   EXPECT_NEAR(run.results["event_loads"]["Q"].get<double>(), 0.3, 1e-4);
   EXPECT_NE(run.output.find("gross sliding"), std::string::npos);
}

TEST_F(Contact2D, BadInputIsOneSentenceAndLeavesNoFile)
{
   const std::string block = "--mesh1 meshes/rounded_punch.msh --contact1 3 ";
   const std::string pressed = block + "--load1 'P pressure 2 1' ";
   const std::string pair = "--case meshes/dovetail.json ";
   const std::string laps = "--matrix meshes/calculix/laps.sti --contact1 UPPER_FACE ";
   mfem::Mesh solid = mfem::Mesh::MakeCartesian3D(2, 2, 2, mfem::Element::HEXAHEDRON);
   const std::string in_space = write("solid.mesh", solid);
   const std::string text = write("text.mesh", "not a mesh\n");
   const std::string truncated =
      write("short.mesh", "MFEM mesh v1.0\n\ndimension\n2\n\nelements\n");
   const std::string gmsh4 = write("new.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
   const auto case_file = [&](const std::string &name, const std::string &contents)
   { return "--case '" + write(name, contents) + "'"; };
   struct Bad
   {
      std::string options;
      std::vector<std::string> words; ///< that the message must hold
   };
   const std::vector<Bad> table = {
      {"--mesh1 nowhere.msh --contact1 3", {"body 1", "nowhere.msh", "cannot be read"}},
      {"", {"mesh1 is empty"}},
      {pressed + "-half-plane-young 1", {"half-plane-poisson", "together"}},
      {pressed + "-half-plane-depth 1", {"half-plane-depth", "only"}},
      {pressed + "-half-plane-young 1 -half-plane-poisson 0.5",
       {"half-plane-poisson is 0.5", "between -1 and 0.5"}},
      {pressed + "-half-plane-young 1 -half-plane-poisson 0.3 -half-plane-depth 1",
       {"depth 1", "at least twice the length"}},
      {pair + "-half-plane-young 1 -half-plane-poisson 0.3", {"mesh2", "both given"}},
      {laps, {"has 2 bodies (LOWER, UPPER)", "name the contact of 1"}},
      {laps + "--contact2 3", {"option contact2 names the set '3'", "no other body"}},
      {laps + "--contact2 UPPER_FACE", {"names the set 'UPPER_FACE'", "no other body"}},
      {laps + "--contact2 LOWER_FACE --young2 3", {"--young2", "has in itself"}},
      {laps + "--mesh1 nowhere.msh", {"goes without meshes"}},
      {laps + "--contact2 LOWER_FACE --order 1", {"its elements are known"}},
      {laps + "--contact2 LOWER_FACE --edges '1 2' --friction 1",
       {"--edges", "materials", "not known of a matrix"}},
      {laps + "--contact2 LOWER_FACE --support2 WALL:z",
       {"body 2 ('LOWER')", "support2 'WALL:z'", "SET:xy"}},
      {laps + "--contact2 LOWER_FACE --load1 'P traction X 1 0'",
       {"body 1 ('UPPER')", "there is no set 'X'"}},
      {laps + "--contact2 LOWER_FACE", {"without the option paraview"}},
      {"--matrix nowhere.sti --contact1 A", {"cannot read file 'nowhere.inp'"}},
      {case_file("half.json", R"({"mesh1": "a", "half-plane": {"young": 1}})"),
       {"key 'half-plane' has no 'poisson'"}},
      {case_file("inner.json", R"({"half-plane": {"young": 1, "poisson": 0.3, "width": 2}})"),
       {"key 'half-plane'", "unknown key 'width'", "young, poisson, depth"}},
      {case_file("twice_inside.json",
                 R"({"half-plane": {"young": 1, "poisson": 0, "young": 2}})"),
       {"key 'young' is there twice"}},
      {"--mesh1 '" + in_space + "' --contact1 1", {"solid.mesh", "dimension 3", "must be 2"}},
      {"--mesh1 '" + text + "' --contact1 1", {"text.mesh", "must begin with", "not a mesh"}},
      {"--mesh1 '" + truncated + "' --contact1 1",
       {"short.mesh", "ends where the number of elements should be"}},
      {"--mesh1 '" + gmsh4 + "' --contact1 1", {"new.msh", "mesh file has no nodes"}},
      {"--mesh1 meshes/rounded_punch.msh --contact1 9",
       {"contact line", "attribute 9", "2, 3, 4"}},
      {"--mesh1 meshes/rounded_punch.msh", {"contact1 is empty"}},
      {block + "--load1 'P pressure 7 1'", {"pressure 'P'", "attribute 7", "2, 3, 4"}},
      {block + "--support1 8:x", {"fix", "attribute 8", "2, 3, 4"}},
      {"--mesh1 meshes/rounded_punch.msh --contact1 '3[7<x<8]'",
       {"no boundary elements", "7 <= x"}},
      {"--mesh1 meshes/rounded_punch.msh --contact1 '3[x<8]'",
       {"contact1", "3[x<8]", "3[-1<x<1]"}},
      {case_file("twice.json", R"({"friction": 0.1, "mesh1": "a.msh", "friction": 0.3})"),
       {"twice.json", "key 'friction'", "twice"}},
      {pair + "--pairing 1e-6",
       {"pairing", "without a partner", "body 1 (81 nodes)", "body 2"}},
      {pressed + "--friction -0.25", {"friction", "-0.25", "not be negative"}},
      {pressed + "--friction nan", {"friction", "nan", "not a number"}},
      {pressed + "--friction 1e999", {"friction", "1e999", "not a number"}},
      {pressed + "--increments 2.5", {"increments", "2.5", "not an integer"}},
      {pressed + "--young1 nan", {"young1", "nan", "not a number"}},
      {pressed + "--young1 -1", {"Young's modulus", "-1"}},
      {pressed + "--young1 '1 2' --poisson1 '0.1 0.2 0.3'", {"young1", "2 and 3 values"}},
      {pressed + "--poisson1 0.5", {"Poisson's ratio", "0.5", "below 0.5"}},
      {pressed + "--order 0", {"order", "0", "1 to 8"}},
      {pressed + "--increments 0", {"increments", "0", "at least 1"}},
      {pressed + "--gap wide", {"gap", "wide", "geometry, closed"}},
      {pressed + "--stepping fast", {"stepping", "fast", "advancing, fixed"}},
      {pressed + "--support1 3:xy", {"contact dofs are fixed", "one at least must be free"}},
      {pressed + "--support1 2", {"support1 '2'", "must be"}},
      {pressed + "--support1 2:z", {"support1 '2:z'", "x, y or xy"}},
      {pressed + "--support1 @1:x", {"@1", "must be a point"}},
      {pressed + "--contact2 3", {"without a mesh2"}},
      {block, {"no load"}},
      {block + "--load1 'P pressure 2'",
       {"P pressure 2", "3 words", "PATTERN pressure WHERE p"}},
      {block + "--load1 'P push 2 1'", {"kind 'push'", "pressure, traction, body-force"}},
      {block + "--load1 'P pressure 2 nan'", {"'nan'", "a function of x and y"}},
      {block + "--load1 'P pressure 2 1*z'", {"'1*z'", "a function of x and y"}},
      {block + "--load1 'P pressure 2 1; P displacement-x 4 1'",
       {"load pattern 'P'", "displacement"}},
      {pressed + "--history 'P=0; Q=1'", {"history 'Q=1'", "no load pattern 'Q'", "P"}},
      {pressed + "--history 'P=0; P=one'", {"history", "'one'", "not a number"}},
      {pressed + "--history 'P=1; P=2'", {"history", "first point", "must be 0"}},
      {pressed + "--history 'P=0'", {"1 points", "at least 2"}},
      {pressed + "--history 'P=0 P=1'",
       {"history 'P=0 P=1'", "'P' is there twice", "P=0; P=1"}},
      {pressed + "--history 'P=0; P=1,P=1'", {"history 'P=1,P=1'", "'P' is there twice"}},
      {pressed + "--poisson1 '0.1 0.2'", {"poisson1", "2 values", "1 to 1"}},
      {pressed + "--young1 '1 2 3'", {"young1", "3 values", "1 to 1"}},
      {pressed + "--support1 @70,5:x", {"@70,5:x", "outside of the body", "reaches from"}},
      {pressed + "--increments 99999999999",
       {"--increments", "99999999999", "at most 2147483647"}},
      {pressed + "--friction --order 2", {"--friction", "has no value"}},
      {pressed + "--save '" + folder + "/out/state.json'",
       {"--save", "--save-state", "state.json", "name another"}},
      {pressed + "--save meshes/rounded_punch.msh", {"--save", "rounded_punch.msh", "--mesh1"}},
      {pressed + "--history 'P=0; P=1; P=2' --cycle-start 1",
       {"load 'P' is 2 at the end of the cycle", "1 at its start"}},
      {pressed + "--cycle-start -2", {"cycle-start", "-2", "at least -1"}},
      {pressed + "--cycle-start 4", {"cycle starts at point 4", "0 to 0"}},
      {pressed + "--history 'P=0; P=1; P=0' --cycle-start 0 --cycles 0",
       {"cycles is 0", "at least 1"}},
      {pressed + "--cycles 0", {"cycles", "is 0", "at least 1"}},
      {pressed + "--cycles 3", {"--cycles is 3", "no cycle", "--cycle-start"}},
      {pressed + "--friction 0.3 --edges '1 0.5'", {"edges", "0.5", "after", "1"}},
      {pressed + "--frames 2", {"frames", "time 2", "from 0 to 1"}},
      {pressed + "--load-state nowhere.json", {"nowhere.json", "cannot read"}},
      {pressed + "--wrong 3", {"Unrecognized option", "--wrong"}},
      {pressed + "--friction", {"--friction", "has no value"}},
      {"--case nowhere.json", {"nowhere.json", "cannot read"}},
      {case_file("broken.json", "{\"order\": 2"), {"broken.json", "is not JSON"}},
      {case_file("list.json", "[1, 2]"), {"list.json", "array", "must be an object"}},
      {case_file("unknown.json", "{\"yung1\": 2}"),
       {"unknown.json", "'yung1'", "mesh1, young1"}},
      {case_file("type1.json", "{\"friction\": \"0.3\"}"),
       {"'friction'", "\"0.3\"", "a number"}},
      {case_file("type2.json", "{\"order\": 1.5}"), {"'order'", "1.5", "an integer"}},
      {case_file("type3.json", "{\"young1\": [1, \"2\"]}"), {"'young1'", "array of numbers"}},
      {case_file("type4.json", "{\"load1\": {\"P\": 1}}"), {"'load1'", "array of strings"}},
      {case_file("type5.json", "{\"contact1\": 1.5}"),
       {"'contact1'", "1.5", "positive integer"}},
      {case_file("type7.json", "{\"contact1\": [1, -3]}"),
       {"'contact1'", "array of positive integers"}},
      {case_file("version.json", "{\"version\": 3}"), {"'version' is 3", "must be 1 or 2"}},
      {case_file("versions.json", "{\"version\": [1]}"), {"'version' is array", "must be 1"}},
      {case_file("order_twice.json", "{\"order\": 1, \"order\": 2}"),
       {"'order'", "twice", "once"}},
      {case_file("type6.json", "{\"plane-stress\": 1}"), {"'plane-stress'", "true or false"}},
      {case_file("path.json", "{\"mesh1\": \"no.msh\", \"contact1\": \"3\"}"),
       {folder + "/no.msh"}},
   };
   fs::create_directories(folder + "/out");
   for (const Bad &bad : table)
   {
      const auto run =
         contact2d(bad.options + " --csv '" + folder + "/out/t' --paraview '" + folder +
                   "/out/fields' --save-state '" + folder + "/out/state.json'");
      const std::size_t at = run.output.find("error:");
      EXPECT_EQ(run.code, 1) << bad.options << "\n" << run.output;
      if (at == std::string::npos)
      {
         ADD_FAILURE() << "no message for " << bad.options << "\n" << run.output;
         continue;
      }
      const std::string message = run.output.substr(at);
      EXPECT_EQ(message.find('\n'), message.size() - 1) << "one line: " << message;
      for (const std::string &word : bad.words)
      {
         EXPECT_NE(message.find(word), std::string::npos)
            << bad.options << "\nshould say '" << word << "': " << message;
      }
      EXPECT_TRUE(run.results.is_null()) << bad.options;
      EXPECT_TRUE(fs::is_empty(folder + "/out")) << bad.options;
      fs::remove_all(folder + "/out");
      fs::create_directories(folder + "/out");
   }
   for (const char *options : {"--json /nowhere/r.json", "--csv /nowhere/r",
                               "--paraview meshes/README.md/r", "--save-state /nowhere/s"})
   {
      const std::string option = options;
      const std::string program = std::string("'") + CATTANEO_MINIAPP_DIR + "/contact2d' ";
      const std::string command = "cd '" + std::string(CATTANEO_SOURCE_DIR) + "' && " +
                                  program + pressed + option +
                                  " 2>&1 >/dev/null | grep -q 'no folder'";
      EXPECT_EQ(std::system(command.c_str()), 0) << option;
   }
}

/// Two squares side by side over 0 < x < 2, 0 < y < 1 as Gmsh writes them: nodes are "x y z",
/// elements "type tags … nodes …".
std::string gmsh(const std::vector<std::string> &nodes,
                 const std::vector<std::string> &elements)
{
   std::ostringstream text;
   const auto section = [&](const char *name, const std::vector<std::string> &lines)
   {
      text << "$" << name << "\n" << lines.size() << "\n";
      for (std::size_t k = 0; k < lines.size(); ++k)
      {
         text << k + 1 << " " << lines[k] << "\n";
      }
      text << "$End" << name << "\n";
   };
   text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
   section("Nodes", nodes);
   section("Elements", elements);
   return text.str();
}

const std::vector<std::string> two_squares = {"0 0 0", "1 0 0", "2 0 0",
                                              "0 1 0", "1 1 0", "2 1 0"};
const std::vector<std::string> their_boundary = {"1 2 1 5 1 2", "1 2 1 5 2 3", "1 2 2 6 3 6",
                                                 "1 2 3 7 6 5", "1 2 3 7 5 4", "1 2 4 8 4 1"};
const std::vector<std::string> their_surface = {"3 2 1 9 1 2 5 4", "3 2 1 9 2 3 6 5"};

std::vector<std::string> joined(std::vector<std::string> list,
                                const std::vector<std::string> &more)
{
   list.insert(list.end(), more.begin(), more.end());
   return list;
}

TEST_F(Contact2D, MistakesInGmshNameTheirRemedy)
{
   const std::vector<std::string> whole = joined(their_boundary, their_surface);
   const auto with = [&](const std::vector<std::string> &more) { return joined(whole, more); };
   std::vector<std::string> ungrouped = whole, unjoined_nodes = two_squares;
   ungrouped[3] = "1 2 0 7 6 5";
   std::vector<std::string> bare_surface = whole;
   bare_surface[7] = "3 2 0 9 2 3 6 5";
   // The second square has its own nodes on the line between them.
   for (const char *node : {"1 0 0", "1 1e-12 0", "1 1 0"}) { unjoined_nodes.push_back(node); }
   unjoined_nodes.erase(unjoined_nodes.begin() + 6);
   const std::vector<std::string> unjoined = {
      "1 2 1 5 1 2", "1 2 1 5 7 3", "1 2 2 6 3 6",     "1 2 3 7 6 8",
      "1 2 3 7 5 4", "1 2 4 8 4 1", "3 2 1 9 1 2 5 4", "3 2 1 9 7 3 6 8"};
   struct Mistake
   {
      std::string name, text;
      std::vector<std::string> words;
   };
   const std::string body = gmsh(two_squares, whole);
   const auto of_format = [&](const std::string &format)
   { return std::string(body).replace(body.find("2.2 0 8"), 7, format); };
   const std::vector<Mistake> mistakes = {
      {"curve.msh",
       gmsh(two_squares, ungrouped),
       {"element 4, of curve 7", "no physical group", "Physical Curve(1) = {7};", "SaveAll"}},
      {"surface.msh",
       gmsh(two_squares, bare_surface),
       {"element 8, of surface 9", "no physical group", "Physical Surface(1) = {9};"}},
      {"lines.msh",
       gmsh(two_squares, their_boundary),
       {"no triangles or quadrilaterals", "Plane Surface", "gmsh -2"}},
      {"areas.msh",
       gmsh(two_squares, their_surface),
       {"no boundary elements", "Physical Curve"}},
      {"solid.msh",
       gmsh(two_squares, with({"4 2 1 1 1 2 4 3"})),
       {"element 9, a tetrahedron", "plane", "gmsh -2", "no volume"}},
      {"eight.msh",
       gmsh(two_squares, with({"16 2 1 1 1 3 6 4 2 5 1 3"})),
       {"element 9 of order 2", "must be 1"}},
      {"format4.msh", of_format("4.0 0 8"), {"format 4.0", "4.1 or 2.2", "gmsh -2"}},
      {"mixed.msh", of_format("4.1 0 8"), {"$Nodes"}},
      {"binary.msh", of_format("2.2 1 8"), {"order of bytes", "ASCII"}},
      {"block.geo", "Point(1) = {0, 0, 0};\n", {"geometry", "gmsh -2 NAME.geo makes a mesh"}},
      {"groups.msh",
       gmsh(two_squares, with({"1 2 7 5 2 1"})),
       {"one edge twice", "element 1 of attribute 1", "element 9 of attribute 7",
        "one physical group"}},
      {"twice.msh", gmsh(two_squares, with({"1 2 1 5 1 2"})), {"one edge twice"}},
      {"unjoined.msh",
       gmsh(unjoined_nodes, unjoined),
       {"contact line", "two nodes lie on one another", "not joined", "Coherence Mesh"}},
   };
   for (const Mistake &mistake : mistakes)
   {
      const auto run = contact2d("--mesh1 '" + write(mistake.name, mistake.text) +
                                 "' --contact1 1 --load1 'P pressure 3 1'");
      EXPECT_EQ(run.code, 1) << mistake.name << run.output;
      const std::size_t at = run.output.find("error:");
      ASSERT_NE(at, std::string::npos) << mistake.name << run.output;
      const std::string message = run.output.substr(at);
      EXPECT_EQ(message.find('\n'), message.size() - 1) << "one line: " << message;
      for (const std::string &word : mistake.words)
      {
         EXPECT_NE(message.find(word), std::string::npos)
            << mistake.name << " should say '" << word << "': " << message;
      }
      EXPECT_TRUE(run.results.is_null()) << mistake.name;
   }
   const auto right = contact2d("--mesh1 '" + write("right.msh", body) +
                                "' --contact1 1 --load1 'P pressure 3 1'");
   EXPECT_EQ(right.code, 0) << right.output;
}

TEST_F(Contact2D, AnOutputIsNeverWrittenOverAnInput)
{
   const std::string text = gmsh(two_squares, joined(their_boundary, their_surface));
   const std::string mesh = write("body.msh", text);
   for (const char *option : {"--csv", "--save", "--save-state", "--paraview"})
   {
      const auto run =
         contact2d("--mesh1 '" + mesh + "' --contact1 1 --load1 'P pressure 3 1' " + option +
                   " '" + folder + "/../contact2d/body.msh'");
      // A prefix is not the name of a file.
      EXPECT_EQ(run.code, option == std::string("--csv") ? 0 : 1) << run.output;
      std::ifstream in(mesh);
      std::stringstream now;
      now << in.rdbuf();
      EXPECT_EQ(now.str(), text) << option;
   }
}

TEST_F(Contact2D, ANumberStandsForAListOfOne)
{
   write("body.msh", gmsh(two_squares, joined(their_boundary, their_surface)));
   const std::string rest = R"(, "mesh1": "body.msh", "load1": "P pressure 3 1"})";
   const auto force = [&](const std::string &contact)
   {
      const auto run =
         contact2d("--case '" + write("case.json", "{\"contact1\": " + contact + rest) + "'");
      EXPECT_EQ(run.code, 0) << run.output;
      return run.results["contact_force"];
   };
   const json expected = force("\"1\"");
   EXPECT_EQ(force("1"), expected);
   EXPECT_EQ(force("[1]"), expected);
}

TEST_F(Contact2D, LinesThatDoNotPairAreToldWhatWouldDo)
{
   mfem::Mesh upper = cattaneo::rectangle_mesh({-1, -0.5, 0, 0.5, 1}, {0.2, 0.7, 1.2});
   const auto run = [&](std::vector<double> x, std::vector<double> y, const std::string &rest)
   {
      mfem::Mesh lower = cattaneo::rectangle_mesh(x, y);
      return contact2d("--mesh1 '" + write("upper.mesh", upper) + "' --mesh2 '" +
                       write("lower.mesh", lower) +
                       "' --order 1 --contact1 1 --contact2 3 --support2 1:xy "
                       "--load1 'P pressure 3 1' " +
                       rest);
   };
   // Nodes 0.01 beside those of the other line, whose distance is 0.5, and 0.2 below them.
   const std::vector<double> beside = {-0.99, -0.49, 0.01, 0.51, 1.01}, below = {-1, -0.5, 0};
   const auto refused = run(beside, below, "");
   EXPECT_EQ(refused.code, 1) << refused.output;
   EXPECT_NE(refused.output.find("option pairing: "), std::string::npos) << refused.output;
   EXPECT_NE(refused.output.find("the nearest nodes are 0.20025 apart"), std::string::npos)
      << refused.output; // √(0.2² + 0.01²)
   const std::string says = "a tolerance of ";
   const std::size_t at = refused.output.find(says);
   ASSERT_NE(at, std::string::npos) << refused.output;
   const std::string tolerance = refused.output.substr(
      at + says.size(), refused.output.find(' ', at + says.size()) - at - says.size());
   // 0.01 of 0.5, rounded up to two digits.
   EXPECT_GE(std::stod(tolerance), 0.02);
   EXPECT_LE(std::stod(tolerance), 0.021);
   EXPECT_EQ(run(beside, below, "--pairing " + tolerance).code, 0) << tolerance;
   const auto longer = run({-2, -1, -0.5, 0, 0.5, 1, 2}, below, "");
   EXPECT_EQ(longer.code, 1);
   EXPECT_NE(longer.output.find("no tolerance would pair all"), std::string::npos)
      << longer.output;
   EXPECT_NE(longer.output.find("line 2 from (-2, 0) to (2, 0)"), std::string::npos)
      << longer.output;
}

/// Far above the critical friction a pad that is pressed and sheared goes on, and says of all
/// that follows that it is one of several.
TEST_F(Contact2D, WhatIsNotUniqueIsSaidOfAllThatFollows)
{
   mfem::Mesh mesh = pad(8, 0);
   const auto run = contact2d("--mesh1 '" + write("pad.mesh", mesh) +
                              "' --contact1 1 --load1 'P pressure 3 1;Q traction 3 1 0' "
                              "--history 'P=0;P=1;Q=0.1' --friction 20");
   ASSERT_EQ(run.code, 2) << run.output;
   const json &r = run.results;
   EXPECT_EQ(r["status"], "not unique");
   EXPECT_EQ(r["time"], 2);
   const json &first = r["not_unique"];
   EXPECT_EQ(first["time"], 0); // since when they touch
   EXPECT_EQ(first["time"], r["event_time"]);
   EXPECT_EQ(first["loads"], r["event_loads"]);
   EXPECT_EQ(first["message"], r["message"]);
   EXPECT_NE(r["message"].get<std::string>().find("critical value"), std::string::npos);
   EXPECT_NE(run.output.find("Not unique: from time "), std::string::npos) << run.output;
   EXPECT_NE(run.output.find("At time 2, one of several states: "), std::string::npos);
   EXPECT_EQ(run.output.find("Ended with"), std::string::npos) << run.output;
}

TEST_F(Contact2D, AnUnsupportedBodyIsRefused)
{
   // The second of two separate squares touches neither support nor contact.
   mfem::Mesh mesh(2, 8, 2, 2);
   const double corners[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1},
                                 {5, 0}, {6, 0}, {6, 1}, {5, 1}};
   for (const auto &corner : corners) { mesh.AddVertex(corner[0], corner[1]); }
   mesh.AddQuad(0, 1, 2, 3);
   mesh.AddQuad(4, 5, 6, 7);
   mesh.AddBdrSegment(0, 1, 1);
   mesh.AddBdrSegment(2, 3, 2);
   mesh.FinalizeQuadMesh(0, 0, true);
   const auto run = contact2d("--mesh1 '" + write("two.mesh", mesh) +
                              "' --contact1 1 --load1 'P pressure 2 1'");
   EXPECT_EQ(run.code, 1) << run.output;
   EXPECT_NE(run.output.find("unsupported body"), std::string::npos) << run.output;
   EXPECT_TRUE(run.results.is_null());
}

TEST_F(Contact2D, TheDocumentedCaseIsTheOneShipped)
{
   const auto content = [](const std::string &file)
   {
      std::ifstream in(std::string(CATTANEO_SOURCE_DIR) + "/" + file);
      std::stringstream text;
      text << in.rdbuf();
      return text.str();
   };
   const std::string guide = content("docs/contact2d.md");
   const std::size_t from = guide.find("```json\n") + 8;
   EXPECT_EQ(guide.substr(from, guide.find("```", from) - from),
             content("meshes/rounded_punch.json"));
}

TEST_F(Contact2D, OptionsOverrideTheCaseFile)
{
   const auto run = contact2d("--case meshes/dovetail.json --friction 0 --order 1 --cycles 1");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["counters"]["tangential_unknowns"], 0);
   EXPECT_EQ(run.results["total_dissipation"], 0);
   EXPECT_EQ(run.results["contact_nodes"], 41);
   // Without friction the flank of 45° carries as much sideways as upward, but for its ends.
   EXPECT_NEAR(run.results["contact_force"][0].get<double>() /
                  run.results["contact_force"][1].get<double>(),
               1.0, 0.02);
}

TEST_F(Contact2D, SaysWhatAccuracyMaterialsFarApartLeave)
{
   // A hard sole under a soft block that is pushed down at its top: in uniform compression the
   // block's stiffness is that of its layers in series, as nothing contracts sideways.
   mfem::Mesh mesh = cattaneo::rectangle_mesh({0, 1, 2, 3}, {0, 0.5, 1, 1.5, 2});
   for (int e = 0; e < mesh.GetNE(); ++e) { mesh.SetAttribute(e, e < 6 ? 1 : 2); }
   mesh.SetAttributes();
   const std::string file = write("layers.mesh", mesh);
   const auto pushed = [&](const std::string &hard)
   {
      return contact2d("--mesh1 '" + file + "' --contact1 1 --young1 '" + hard +
                       " 1' --poisson1 0 --friction 0.3 --support1 3:x "
                       "--load1 'D displacement-y 3 -0.1'");
   };
   double before = 0;
   for (const double hard : {1.0, 1e6, 1e12})
   {
      const auto run = pushed(std::to_string(hard));
      ASSERT_EQ(run.code, 0) << run.output;
      const double force = run.results["contact_force"][1];
      const double error = std::abs(force / (3 * 0.1 / (1 + 1 / hard)) - 1);
      const double estimate = run.results["condensation_error_estimate"];
      EXPECT_LE(error, estimate) << hard;
      EXPECT_GE(estimate, before) << hard;
      before = estimate;
      const bool warned =
         run.output.find("warning: the stiffness of the contact may be wrong") !=
         std::string::npos;
      EXPECT_EQ(warned, hard > 1e9) << run.output;
      ASSERT_EQ(run.results["warnings"].size(), hard > 1e9 ? 1u : 0u) << run.output;
   }
   EXPECT_GT(before, 1e-6);
}

/// Nothing but the contact holds a pad that is pressed onto a line: it may rock on its lowest
/// node, and slide without friction. The line bears the whole load all the same.
TEST_F(Contact2D, APadThatOnlyTheContactHoldsComesToRest)
{
   for (double curvature : {0.02, 0.1})
   {
      mfem::Mesh mesh = pad(20, curvature);
      const std::string file = write("pad.mesh", mesh);
      for (double pressure : {0.005, 0.02, 0.3})
      {
         for (double friction : {0.0, 0.4})
         {
            std::ostringstream options;
            options << "--mesh1 '" << file << "' --contact1 1 --load1 'P pressure 3 1' "
                    << "--young1 100 --history 'P=0;P=" << pressure << "' --friction "
                    << friction;
            const auto run = contact2d(options.str());
            ASSERT_EQ(run.code, 0) << options.str() << run.output;
            const double force = run.results["contact_force"][1];
            EXPECT_NEAR(force, 4 * pressure, 1e-9 * pressure) << options.str();
         }
      }
   }
}

/// Pressed evenly without friction a pad widens about its middle, on any mesh.
TEST_F(Contact2D, SlipOfAFreeBodyIsCountedFromItsMiddle)
{
   for (double grading : {1.0, 1.5})
   {
      for (int order : {1, 2})
      {
         mfem::Mesh mesh = pad(20, 0, grading);
         const auto run = contact2d("--mesh1 '" + write("pad.mesh", mesh) +
                                    "' --contact1 1 --load1 'P pressure 3 1' --order " +
                                    std::to_string(order));
         ASSERT_EQ(run.code, 0) << run.output;
         const json &zones = run.results["zones"];
         ASSERT_EQ(zones.size(), 2u) << run.output;
         EXPECT_NEAR(zones[0]["to"].get<double>(), 2,
                     zones[0]["to_error_estimate"].get<double>());
      }
   }
}

/// The front edge of a flat pad in full stick slips over 1e-4 at f = 0.33 (graded meshes of 140
/// and 220 elements); uniform meshes show more, and must say by how much.
TEST_F(Contact2D, BordersNextToACornerSayTheirDoubt)
{
   for (int elements : {12, 20, 40})
   {
      mfem::Mesh mesh = pad(elements, 0);
      const auto run = contact2d("--mesh1 '" + write("pad.mesh", mesh) +
                                 "' --contact1 1 --load1 'P pressure 3 1;Q traction 3 1 0' "
                                 "--history 'P=0;P=1;Q=0.165' --friction 0.33");
      ASSERT_EQ(run.code, 0) << run.output;
      for (const json &zone : run.results["zones"])
      {
         // Slip ahead of the stick; what lies at the other corner is a zone of its own.
         if (zone["state"] == "stick") { break; }
         const double to = zone["to"], error = zone["to_error_estimate"];
         EXPECT_LE(to - 1e-4, error) << elements << run.output;
      }
   }
}

TEST_F(Contact2D, WarnsOfASideThatBears)
{
   mfem::Mesh mesh = pad(16, 0);
   const std::string options =
      "--mesh1 '" + write("pad.mesh", mesh) + "' --load1 'P pressure 3 1' --contact1 ";
   const auto around = contact2d(options + "1,4");
   // A pad that is pressed so much that its side bears turns there, and closes a large gap.
   ASSERT_EQ(around.results["warnings"].size(), 3u) << around.output;
   const std::string warning = around.results["warnings"][0];
   EXPECT_NE(warning.find("name no boundary around a corner"), std::string::npos) << warning;
   EXPECT_EQ(contact2d(options + "1").results["warnings"].size(), 0u);
}

TEST_F(Contact2D, WarnsOfElementsThatMissTheCurvesOfTheirMesh)
{
   for (const bool curved : {false, true})
   {
      mfem::Mesh mesh = pad(4, 0);
      mesh.SetCurvature(2); // straight sides may be said by many nodes
      if (curved)
      {
         mesh.Transform(
            [](const mfem::Vector &from, mfem::Vector &to)
            {
               to = from;
               to(1) *= 1 + 0.05 * from(0) * from(0);
            });
      }
      const std::string options = "--mesh1 '" + write("curved.mesh", mesh) +
                                  "' --load1 'P pressure 3 1e-3' --contact1 1 --order ";
      const auto lower = contact2d(options + "1"), same = contact2d(options + "2");
      ASSERT_EQ(lower.code, 0) << lower.output;
      EXPECT_EQ(same.results["warnings"].size(), 0u) << same.output;
      ASSERT_EQ(lower.results["warnings"].size(), curved ? 1u : 0u) << lower.output;
      if (!curved) { continue; }
      const std::string warning = lower.results["warnings"][0];
      EXPECT_NE(warning.find("curved.mesh' is curved, elements of order 1"), std::string::npos);
      EXPECT_NE(warning.find("use option -order 2"), std::string::npos) << warning;
   }
}

TEST_F(Contact2D, WarnsOfALineThatIsNamedTooShort)
{
   // A block on a block of the same width, pressed as a whole: of the joint only the middle is
   // named, or all of it, up to the blocks' corners.
   std::vector<double> x, y;
   for (int k = 0; k <= 16; ++k) { x.push_back(-2 + 0.25 * k); }
   for (int k = 0; k <= 4; ++k) { y.push_back(0.25 * k); }
   mfem::Mesh upper = cattaneo::rectangle_mesh(x, y);
   for (double &height : y) { height -= 1; }
   mfem::Mesh lower = cattaneo::rectangle_mesh(x, y);
   const std::string meshes = "--mesh1 '" + write("upper.mesh", upper) + "' --mesh2 '" +
                              write("lower.mesh", lower) +
                              "' --support2 1:xy --friction 0.3 --load1 'P pressure 3 1e-3' ";
   const auto part = contact2d(meshes + "--contact1 '1[-1<x<1]' --contact2 '3[-1<x<1]'");
   ASSERT_EQ(part.code, 0) << part.output;
   ASSERT_EQ(part.results["warnings"].size(), 2u) << part.output;
   const std::string first = part.results["warnings"][0], last = part.results["warnings"][1];
   EXPECT_NE(first.find("first node of piece 1 of the line 'contact' (node 0 at (-1, 0)"),
             std::string::npos)
      << first;
   EXPECT_NE(last.find("at (1, 0)"), std::string::npos) << last;
   EXPECT_NE(part.output.find("warning: " + first), std::string::npos) << part.output;
   const auto whole = contact2d(meshes + "--contact1 1 --contact2 3");
   ASSERT_EQ(whole.code, 0) << whole.output;
   EXPECT_EQ(whole.results["warnings"].size(), 0u) << whole.output;
}

} // namespace
