#include "study/run_miniapp.hpp"

#include "common/punch.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace
{

using cattaneo_test::expect_references_met;
using cattaneo_test::run_miniapp;

const double pi = std::acos(-1.0);

void expect_relative(const nlohmann::json &value, double expected, double tolerance)
{
   ASSERT_TRUE(value.is_number()) << value;
   EXPECT_NEAR(value.get<double>(), expected, tolerance * std::abs(expected));
}

TEST(Fretting, FiniteElementsMeetTheClosedForms)
{
   // The references carry K_N and K_T within 1 %, the slip zone within its read-out, and the
   // sheet's limits: d/d_exact = (1 + √(1 - Q/fP))/2 and the exact Hertz energy within 2 %.
   for (const char *options : {"-Q 50", "-Q 100 -lr 0", "-Q 150", "-Q 50 -nodes 201"})
   {
      const auto run = run_miniapp("fretting", std::string("-p fe ") + options);
      SCOPED_TRACE(options + run.output);
      expect_references_met(run, 13);
      const auto closed = run_miniapp("fretting", std::string("-p hertz ") + options);
      ASSERT_EQ(closed.code, 0) << closed.output;
      for (const char *key : {"k_n", "k_t_trailing", "k_t_leading", "edge_stress_range"})
      {
         expect_relative(run.results[key], closed.results[key], 0.01);
      }
      EXPECT_EQ(run.results["verdict"], closed.results["verdict"]);
      // The range of the cycle slips back over the zone of half the range.
      const auto &edge = run.results["fe"]["trailing"];
      EXPECT_EQ(edge["slides"], false);
      EXPECT_LE(edge["k_t"]["relative_error"].get<double>(), 0.02);
      EXPECT_GE(edge["k_t"]["nodes"].get<int>(), 4);
      EXPECT_EQ(run.results["fe"]["steady_cycle"].is_number(), true);
   }
}

TEST(Fretting, FiniteElementsWithBulkTensionMeetTheClosedForms)
{
   const auto run = run_miniapp("fretting", "-p fe -Q 50 -bs 10");
   SCOPED_TRACE(run.output);
   expect_references_met(run, 7);
   EXPECT_GT(run.results["k_t_trailing"].get<double>(),
             -run.results["k_t_leading"].get<double>());
   EXPECT_EQ(run.results["judged_edge"], "trailing");
}

TEST(Fretting, FiniteElementsTakeBulkInThePadAndTestRecords)
{
   // K_T feels the difference of both bulk stresses only.
   const auto both = run_miniapp("fretting", "-p fe -Q 50 -bs 10 -bp -20");
   expect_references_met(both, 5);
   const auto one = run_miniapp("fretting", "-p fe -Q 50 -bs 30");
   const double k_t = one.results["k_t_trailing"];
   EXPECT_NEAR(both.results["k_t_trailing"].get<double>(), k_t, 1e-6 * k_t);

   const std::string folder = testing::TempDir() + "cattaneo_fretting_records";
   std::filesystem::create_directories(folder);
   std::ofstream(folder + "/tests.csv") << "P,Q,bulk,cycles\n400,60,20,1e6\n300,40,0,2e5\n";
   run_miniapp("fretting", "-p fe -plot '" + folder + "' -rec '" + folder + "/tests.csv'");
   std::ifstream in(folder + "/records.csv");
   ASSERT_TRUE(in.good());
   std::string line, cell;
   std::getline(in, line);
   for (const char *test : {"-P 400 -Q 60 -bs 20", "-P 300 -Q 40 -bs 0"})
   {
      const auto closed_form = run_miniapp("fretting", test);
      ASSERT_TRUE(std::getline(in, line));
      std::istringstream row(line);
      // … threshold_x is the sixth, k_t_range the eighth.
      for (int k = 0; std::getline(row, cell, ','); ++k)
      {
         if (k != 5 && k != 7) { continue; }
         const double exact = closed_form.results[k == 5 ? "threshold_x" : "k_t_range"];
         EXPECT_NEAR(std::stod(cell), exact, 0.01 * exact) << line;
         EXPECT_NE(std::stod(cell), exact) << "not solved";
      }
   }
   std::filesystem::remove_all(folder);
}

TEST(Fretting, SampleDesignsHaveTheSheetsValues)
{
   auto run = run_miniapp("fretting", "-p kn -kn 4000 -kt 20 -f 0.6 -E 115 -m Ti6Al4V");
   ASSERT_EQ(run.code, 0) << run.output;
   expect_relative(run.results["slip_zone"], 1.0 / 60, 1e-12);
   expect_relative(run.results["energy_max"], 0.04385853871, 1e-9);
   expect_relative(run.results["energy_total"], 4.419477202e-4, 1e-9);
   expect_relative(run.results["edge_stress"], std::sqrt(8 * 0.6 * 4000 * 20), 1e-12);
   expect_relative(run.results["critical_length"], 25.783101e-3, 1e-7);
   EXPECT_TRUE(run.results["k_t_leading"].is_null());

   run = run_miniapp("fretting",
                     "-p flat-rounded -r 3 -b 3 -P 1000 -Q 20 -bs 20 -m Ti6Al4V -E 115");
   ASSERT_EQ(run.code, 0) << run.output;
   expect_relative(run.results["half_width"], 3.09387232416, 1e-10);
   expect_relative(run.results["k_n"], 4118.68289887, 1e-10);

   run = run_miniapp("fretting", "-P 400 -r 50 -Q 60 -bs 80 -m Al -f 0.7");
   ASSERT_EQ(run.code, 0) << run.output;
   expect_relative(run.results["critical_length"], 91.294654e-3, 1e-7);
   const double a = run.results["half_width"];
   expect_relative(run.results["k_n"], 400 / (pi * a) * std::sqrt(8 / a), 1e-12);
   expect_relative(run.results["k_t_trailing"],
                   60 / (pi * std::sqrt(2 * a)) + 20 * std::sqrt(a / 2), 1e-12);
   expect_relative(run.results["k_t_leading"],
                   -60 / (pi * std::sqrt(2 * a)) + 20 * std::sqrt(a / 2), 1e-12);

   // Fig. 2.7: X = K_N a0/ΔK_th = 0.2, curve A.
   const double threshold = 4.5 * std::sqrt(1000.0), length = std::pow(threshold / 500, 2) / pi;
   char options[128];
   for (const auto &[friction, ordinate] : {std::pair(0.3, 2.276629), std::pair(0.8, 1.178838)})
   {
      std::snprintf(options, sizeof options, "-p kn -kn %.12g -kt 20 -m Ti6Al4V -f %g",
                    0.2 * threshold / length, friction);
      run = run_miniapp("fretting", options);
      ASSERT_EQ(run.code, 0) << run.output;
      expect_relative(run.results["threshold_x"], 0.2, 1e-10);
      expect_relative(run.results["threshold_y"], ordinate, 1e-6);
   }
}

TEST(Fretting, BorderlineDesignsAreAnsweredAndSaid)
{
   // Nearly sliding: an answer, with a warning.
   auto run = run_miniapp("fretting", "-Q 279.99 -f 0.7");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["trust"], "not to be trusted");
   // No shear at all.
   run = run_miniapp("fretting", "-Q 0");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["slip_zone"], 0);
   EXPECT_EQ(run.results["verdict"], "arrests");
   // K_T < 0 at the leading edge; a0 much longer than d; plane stress.
   run = run_miniapp("fretting", "-Q 5 -sfl 10 -ps");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_LT(run.results["k_t_leading"].get<double>(), 0);
   EXPECT_NE(run.output.find("much longer than the slip zone"), std::string::npos);
   EXPECT_NE(run.output.find("plane stress"), std::string::npos);
   // Finite elements without shear: nothing slips.
   run = run_miniapp("fretting", "-p fe -Q 0");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["fe"]["trailing"]["slip_zone"], 0);
   // A slip zone of one spacing: the intensities hold, the rest is said not to.
   run = run_miniapp("fretting", "-p fe -Q 20");
   expect_references_met(run, 5);
   EXPECT_EQ(run.results["fe"]["trailing"]["resolved"], false);
   EXPECT_NE(run.output.find("not resolved"), std::string::npos);
}

TEST(Fretting, BadOptionsAreOneSentenceAndExitCodeOne)
{
   for (const char *options : {"-p ball",
                               "-p kn",
                               "-p kn -kn 1",
                               "-p flat-rounded",
                               "-kn 3",
                               "-b 2",
                               "-f 0",
                               "-f -1",
                               "-P -1",
                               "-P 0",
                               "-Q 1000",
                               "-r 0",
                               "-lr 1",
                               "-lr -2",
                               "-m Unobtainium",
                               "-nu 0.5",
                               "-E 0",
                               "-kth 0",
                               "-sfl -1",
                               "-c best",
                               "-mf /nonexistent.json",
                               "-rec x.csv",
                               "-p fe -nodes 100",
                               "-p fe -order 0",
                               "-p fe -nodes 5",
                               "-p fe -Q 1000",
                               "--unknown",
                               "-Q many",
                               "-Q"})
   {
      const auto run = run_miniapp("fretting", options);
      EXPECT_EQ(run.code, 1) << options << "\n" << run.output;
      const std::size_t at = run.output.find("error: ");
      ASSERT_NE(at, std::string::npos) << options << "\n" << run.output;
      EXPECT_EQ(run.output.find('\n', at), run.output.size() - 1) << run.output;
      EXPECT_TRUE(run.results.is_null()) << options;
   }
   const auto help = run_miniapp("fretting", "-h");
   EXPECT_EQ(help.code, 0);
   EXPECT_EQ(help.output.find("nan"), std::string::npos);
}

TEST(Fretting, SquarePunchIsACornerWithIntensitiesOfItsOwn)
{
   using namespace cattaneo;
   double before[2] = {0, 0};
   for (const int nodes : {101, 201})
   {
      miniapp::PunchOptions options;
      options.half_plane = true;
      options.nodes = nodes;
      options.domain = 1e3;
      miniapp::Punch punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(
         problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      const auto edges = fretting::contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      double found[2];
      for (const auto &edge : edges)
      {
         EXPECT_TRUE(edge.complete);
         EXPECT_THROW(edge.near_edge(), InputError);
         const fretting::CornerFit fit =
            fretting::fit_corner(fretting::corner_modes(fretting::Corner{pi / 2, pi}),
                                 fretting::edge_tractions(problem, state, edge));
         // Symmetric: both corners alike, K_II included, as shear counts into the contact.
         if (edge.side > 0)
         {
            found[0] = fit.k_one.value;
            found[1] = fit.k_two.value;
         }
         else
         {
            EXPECT_NEAR(fit.k_one.value, found[0], 1e-6 * found[0]);
            EXPECT_NEAR(fit.k_two.value, found[1], 1e-5);
         }
         EXPECT_LT(fit.k_one.relative_error, 0.02);
         EXPECT_GT(fit.k_one.value, 0);
      }
      if (nodes == 201)
      {
         EXPECT_NEAR(found[0], before[0], 0.01 * before[0]);
         EXPECT_NEAR(found[1], before[1], 0.02 * found[0]);
      }
      std::copy(found, found + 2, before);
      RecordProperty("k_one", std::to_string(found[0]));
   }
}

TEST(Fretting, SquarePunchOnARigidPlaneHasItsOwnExponent)
{
   using namespace cattaneo;
   const fretting::CornerModes modes =
      fretting::corner_modes(fretting::RigidCorner{pi / 2, 0.3});
   double before = 0;
   for (const int nodes : {101, 201})
   {
      miniapp::PunchOptions options;
      options.nodes = nodes;
      options.grading = 1e-3;
      miniapp::Punch punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      march(problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}),
            state);
      const auto edges = fretting::contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      const fretting::EdgeTractions tractions =
         fretting::edge_tractions(problem, state, edges[0]);
      const fretting::CornerFit fit = fretting::fit_corner(modes, tractions);
      EXPECT_LT(fit.k_one.relative_error, 0.02);
      EXPECT_EQ(fit.k_two.nodes, 0);
      if (nodes == 201) { EXPECT_NEAR(fit.k_one.value, before, 0.005 * before); }
      before = fit.k_one.value;
      // Pressure and shear fall as r^{λ-1} with the mode's ratio: a slope over a decade, far
      // from the element at the corner and from the middle of the punch.
      std::vector<std::size_t> near;
      for (std::size_t i = 0; i < tractions.position.size(); i++)
      {
         const double r = tractions.position[i] - tractions.edge;
         if (r > 2e-3 && r < 2e-2) { near.push_back(i); }
      }
      ASSERT_GT(near.size(), 6u);
      const std::size_t i = near.front(), k = near.back();
      const double slope = std::log(tractions.pressure[k] / tractions.pressure[i]) /
                           std::log((tractions.position[k] - tractions.edge) /
                                    (tractions.position[i] - tractions.edge));
      EXPECT_NEAR(slope, modes.one.eigenvalue - 1, 0.01);
      EXPECT_NEAR(tractions.shear[i] / tractions.pressure[i], modes.one.shear, 0.01);
   }
}

} // namespace
