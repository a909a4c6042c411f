#include "comparison.hpp"
#include "study/run_miniapp.hpp"

#include "common/punch.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using cattaneo_test::run_miniapp;

void expect_relative(const nlohmann::json &value, double expected, double tolerance)
{
   ASSERT_TRUE(value.is_number()) << value;
   EXPECT_NEAR(value.get<double>(), expected, tolerance * std::abs(expected));
}

/// A cylinder on a half-plane under P, ±Q (or R Q) and bulk stresses, by the formulas of Hertz,
/// Mindlin, Nowell and Hills, and of the near edge: N, mm, MPa.
struct CylinderOnHalfPlane
{
   double Q, load_ratio = -1, bulk = 0;
   int nodes = 101;
   double P = 400, R = 100, f = 0.7, E = 74000, nu = 0.3; // of the aluminium alloys

   double modulus() const { return E / (2 * (1 - nu * nu)); }
   double a() const { return std::sqrt(4 * P * R / (pi * modulus())); }
   double k_n() const { return P / (pi * a()) * std::sqrt(8 / a()); }
   double k_t(int edge) const
   {
      return edge * Q / (pi * std::sqrt(2 * a())) + bulk / 4 * std::sqrt(a() / 2);
   }
   double spacing() const { return 2 * 1.67 * a() / (nodes - 1); } // of nodes over ±1.67 a

   /// Edge and both intensities at both edges. Edges are read out to a tenth of the spacing;
   /// intensities, fitted over the nodes near an edge, to 1 %.
   std::vector<Expected> intensities() const
   {
      std::vector<Expected> list{{"half width a, mm", a(), 0, 0.1 * spacing()}};
      for (const int edge : {1, -1})
      {
         const std::string where = edge > 0 ? ", trailing edge" : ", leading edge";
         const double scale = std::max(std::abs(k_t(1)), std::abs(k_t(-1)));
         list.push_back({"K_N, MPa/sqrt(mm)" + where, k_n(), 0, 0.01 * k_n()});
         list.push_back({"K_T, MPa sqrt(mm)" + where, k_t(edge), 0, 0.01 * scale});
      }
      return list;
   }
   /// Slip zones too; they end at two edges. Bulk stress shifts the stick zone.
   std::vector<Expected> with_slip() const
   {
      std::vector<Expected> list = intensities();
      const double p0 = 2 * P / (pi * a()), shift = a() * bulk / (4 * f * p0);
      const double slip = a() * (1 - std::sqrt(1 - Q / (f * P)));
      list.push_back({"slip zone d, mm, trailing edge", slip + shift, 0, 0.2 * spacing()});
      list.push_back({"slip zone d, mm, leading edge", slip - shift, 0, 0.2 * spacing()});
      return list;
   }
   /// And, without bulk stress, the loss of a cycle, and what the near edge makes of it.
   std::vector<Expected> with_energy() const
   {
      std::vector<Expected> list = with_slip();
      const double x = Q / (f * P), y = 0.5 * (1 - load_ratio) * x;
      const double energy = 2 * f * P * f * P / (pi * modulus()) *
                            ((1 - y) * std::log(1 - y) + y - y * y / 2); // of one edge
      const double range = (1 - load_ratio) * k_t(1);
      const double predicted = pi / 3 * std::pow(range, 3) / (f * k_n() * modulus());
      const double factor = 0.5 * (1 + std::sqrt(1 - x));
      const double slip = a() * (1 - std::sqrt(1 - x));
      for (const std::string where : {", trailing edge", ", leading edge"})
      {
         // Quotients: of K_T by K_N, 2 %, and a slip zone; and of K_T³ by K_N, 4 %, and a loss.
         list.push_back({"predicted / computed d" + where, factor, 0,
                         factor * (0.02 + 0.2 * spacing() / slip)});
         list.push_back({"energy per cycle, N" + where, energy, 0, 0.02 * energy});
         list.push_back({"predicted / computed energy" + where, predicted / energy, 0,
                         0.06 * predicted / energy});
      }
      return list;
   }
};

TEST(Fretting, FiniteElementsMeetTheClosedForms)
{
   const std::pair<const char *, CylinderOnHalfPlane> cases[] = {
      {"-f 0.7 -Q 50", {50}},
      {"-f 0.7 -Q 100 -lr 0", {100, 0}},
      {"-f 0.7 -Q 150", {150}},
      {"-f 0.7 -Q 50 -nodes 201", {50, -1, 0, 201}}};
   for (const auto &[options, expected] : cases)
   {
      const auto run = run_miniapp("fretting", std::string("-p fe ") + options);
      SCOPED_TRACE(options + run.output);
      expect_values(run, expected.with_energy());
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
      EXPECT_LE(edge["k_t"]["relative_error_estimate"].get<double>(), 0.02);
      EXPECT_GE(edge["k_t"]["nodes"].get<int>(), 4);
      EXPECT_EQ(run.results["fe"]["steady_cycle"].is_number(), true);
   }
}

TEST(Fretting, FiniteElementsWithBulkTensionMeetTheClosedForms)
{
   const auto run = run_miniapp("fretting", "-p fe -f 0.7 -Q 50 -bs 10");
   SCOPED_TRACE(run.output);
   expect_values(run, CylinderOnHalfPlane{50, -1, 10}.with_slip());
   EXPECT_GT(run.results["k_t_trailing"].get<double>(),
             -run.results["k_t_leading"].get<double>());
   EXPECT_EQ(run.results["judged_edge"], "trailing");
}

TEST(Fretting, FiniteElementsTakeBulkInThePadAndTestRecords)
{
   // K_T feels the difference of both bulk stresses only.
   const auto both = run_miniapp("fretting", "-p fe -f 0.7 -Q 50 -bs 10 -bp -20");
   expect_values(both, CylinderOnHalfPlane{50, -1, 30}.intensities());
   const auto one = run_miniapp("fretting", "-p fe -f 0.7 -Q 50 -bs 30");
   const double k_t = one.results["k_t_trailing"];
   EXPECT_NEAR(both.results["k_t_trailing"].get<double>(), k_t, 1e-6 * k_t);

   const std::string folder = testing::TempDir() + "cattaneo_fretting_records";
   std::filesystem::create_directories(folder);
   std::ofstream(folder + "/tests.csv") << "P,Q,bulk,cycles\n400,60,20,1e6\n300,40,0,2e5\n";
   run_miniapp("fretting", "-p fe -csv '" + folder + "/all' -rec '" + folder + "/tests.csv'");
   std::string line, cell;
   // All that is printed line by line is a file as well: edges, and how far to trust it.
   for (const auto &[file, head, rows] : {std::tuple{"/all_edges.csv", "edge,position,", 2},
                                          {"/all_validity.csv", "measure,value,trust,text", 5}})
   {
      std::ifstream list(folder + file);
      std::getline(list, line);
      EXPECT_EQ(line.rfind(head, 0), 0u) << file << ": " << line;
      int count = 0;
      while (std::getline(list, line)) { ++count; }
      EXPECT_GE(count, rows) << file;
   }
   std::ifstream in(folder + "/all_records.csv");
   ASSERT_TRUE(in.good());
   std::getline(in, line);
   for (const char *test : {"-P 400 -Q 60 -bs 20", "-P 300 -Q 40 -bs 0"})
   {
      const auto closed_form = run_miniapp("fretting", test);
      ASSERT_TRUE(std::getline(in, line));
      std::istringstream row(line);
      // … threshold_x is the seventh, k_t_range the ninth.
      for (int k = 0; std::getline(row, cell, ','); ++k)
      {
         if (k != 6 && k != 8) { continue; }
         const double exact = closed_form.results[k == 6 ? "threshold_x" : "k_t_range"];
         EXPECT_NEAR(std::stod(cell), exact, 0.01 * exact) << line;
         EXPECT_NE(std::stod(cell), exact) << "not solved";
      }
   }
   std::filesystem::remove_all(folder);
}

/// Stresses of the closed forms of Hertz, Cattaneo and Mindlin round the cycle, averaged over
/// the depth, through the same criteria: tractions and kernels alone are the study's.
TEST(Fretting, CriticalPlanesUnderAHertzContactAreThoseOfTheClosedForms)
{
   using namespace cattaneo::fretting;
   const CylinderOnHalfPlane contact{100};
   const double depth = 0.1, p0 = 2 * contact.P / (pi * contact.a());
   FatigueMaterial material;
   material.young = contact.E;
   material.poisson = contact.nu;
   material.fatigue_limit = {124, 124};
   material.shear_yield = {270, 270};
   const auto stress = [&](double Q, double x, double y) -> Eigen::RowVector4d
   {
      const InPlaneStress s = hertz_stress(contact.f, Q / (contact.f * contact.P), x, y);
      return p0 * Eigen::RowVector4d(s.xx, s.yy, contact.nu * (s.xx + s.yy), s.xy);
   };
   // Down from Q to -Q and up again: what is taken back slips as the first loading did, with
   // twice the friction.
   const auto cycle = [&](double x, double y)
   {
      const Eigen::RowVector4d pressed = stress(0, x, y),
                               peak = stress(contact.Q, x, y) - pressed;
      const int parts = 20;
      StressCycle result(2 * parts, 4);
      for (int k = 0; k < parts; ++k)
      {
         const Eigen::RowVector4d back =
            2 * (stress((k + 1.0) / parts * contact.Q, x, y) - pressed);
         result.row(k) = pressed + peak - back;
         result.row(k + parts) = pressed - peak + back;
      }
      return result;
   };
   const StressCycle plain = plain_fatigue_cycle(material);
   const auto run = run_miniapp("fretting", "-p fe -Q 100 --averaging-depth 0.1");
   ASSERT_EQ(run.code, 0) << run.output;
   const std::pair<PlaneCriterion, const char *> criteria[] = {
      {PlaneCriterion::findley, "findley"},
      {PlaneCriterion::smith_watson_topper, "smith_watson_topper"},
      {PlaneCriterion::fatemi_socie, "fatemi_socie"}};
   const auto share = [&](PlaneCriterion criterion, double x, double below)
   {
      StressCycle averaged = StressCycle::Zero(40, 4);
      const int parts = 100;
      for (int k = 0; k < parts; ++k)
      {
         // Closest at the surface, where stresses change fastest.
         const double from = std::pow(k / (1.0 * parts), 2),
                      to = std::pow((k + 1) / (1.0 * parts), 2);
         averaged += (to - from) * cycle(x, below / contact.a() * 0.5 * (from + to));
      }
      return critical_plane(criterion, averaged, material).value /
             critical_plane(criterion, plain, material).value;
   };
   EXPECT_GE(run.results["planes"].size(), 61);
   for (const auto &row : run.results["planes"])
   {
      for (const auto &[criterion, key] : criteria)
      {
         const double expected = share(criterion, row["x"], depth);
         // Shares are up to 2; the edges of stick and contact lie inside of elements.
         EXPECT_NEAR(row[key].get<double>(), expected, 0.01) << key << " at " << row["x"];
      }
   }
   // The severest place is found between the places of the figure, and the mesh's own ± holds.
   const auto fine = run_miniapp("fretting", "-p fe -Q 100 -nodes 201 --averaging-depth 0.05");
   ASSERT_EQ(fine.code, 0) << fine.output;
   for (std::size_t c = 0; c < 3; ++c)
   {
      double expected = 0;
      for (double x = -1.03; x < -0.9; x += 0.002)
      {
         expected = std::max(expected, share(criteria[c].first, x, 0.05));
      }
      const auto &row = fine.results["critical_planes"][2 * c];
      const double error = row["error_estimate"];
      EXPECT_LT(error, 0.05 * expected) << row;
      EXPECT_NEAR(row["share"].get<double>(), expected, error) << row;
   }
   // Above the mesh's resolution, and within the contact, there is no answer to be had.
   for (const char *strange : {"0.01", "1e6"})
   {
      const auto refused =
         run_miniapp("fretting", std::string("-p fe -Q 100 --averaging-depth ") + strange);
      EXPECT_EQ(refused.code, 1);
      EXPECT_NE(refused.output.find("must be from the spacing of the contact nodes"),
                std::string::npos)
         << refused.output;
   }
}

/// Tests of several materials, pads and frictions in one file are those of each alone.
TEST(Fretting, RecordsHoldMaterialsAndPadsOfTheirOwn)
{
   const std::string folder = testing::TempDir() + "cattaneo_fretting_materials",
                     head = "series,material,pad,friction,yield,P,radius,flat,Q,bulk,cycles\n";
   std::filesystem::create_directories(folder);
   const auto correlated = [&](const std::string &rows)
   {
      std::ofstream(folder + "/tests.csv") << head << rows;
      return run_miniapp("fretting", "-rec '" + folder + "/tests.csv'");
   };
   const auto both = correlated("a,Al,,0.7,,800,200,,60,30,1e7\n"
                                "b,Ti6Al4V,flat-rounded,0.5,500,1000,3,3,110,70,1.4e6\n");
   ASSERT_EQ(both.code, 0) << both.output;
   const char *alone[] = {
      "-m Al -f 0.7 -P 800 -r 200 -Q 60 -bs 30",
      "-m Ti6Al4V -f 0.5 -k 500 -p flat-rounded -P 1000 -r 3 -b 3 -Q 110 -bs 70"};
   for (int k : {0, 1})
   {
      const auto one = run_miniapp("fretting", alone[k]);
      const auto &row = both.results["records"][k];
      for (const char *key : {"edge_stress_range", "threshold_x", "design_y", "k_t_range"})
      {
         expect_relative(row[key], one.results[key], 1e-12);
      }
      expect_relative(row["yield_load"],
                      one.results["yield_ratio_full"].get<double>() /
                         one.results["friction"].get<double>(),
                      1e-12);
   }
   const std::pair<const char *, const char *> wrong[] = {
      {"a,Al,,,,800,200,,60,30,1e7\n", "needs its friction"},
      {"a,Al,ball,0.7,,800,200,,60,30,1e7\n", "the pad is 'ball', must be hertz"},
      {"a,Unobtainium,,0.7,,800,200,,60,30,1e7\n", "line 2"}};
   for (const auto &[rows, words] : wrong)
   {
      const auto refused = correlated(rows);
      EXPECT_EQ(refused.code, 1);
      EXPECT_NE(refused.output.find(words), std::string::npos) << refused.output;
   }
   std::filesystem::remove_all(folder);
}

/// Without bulk stress K_T is in proportion to Q, energy to Q² (largest) and Q³ (in all).
TEST(Fretting, LevelsDivideBrokenFromLastingTests)
{
   const std::string folder = testing::TempDir() + "cattaneo_fretting_levels";
   std::filesystem::create_directories(folder);
   const auto levels = [&](const std::string &rows, const std::string &options = "")
   {
      std::ofstream(folder + "/tests.csv") << "Q,cycles,runout\n" << rows;
      return run_miniapp("fretting", "-P 400 -f 0.7 -bs 0 -rec '" + folder + "/tests.csv' " +
                                        options + " -csv '" + folder + "/t'");
   };
   // Any level between 20 and 30 has the run-out of 40 on its wrong side, between 40 and 50
   // the broken 30: the first gap is the wider one.
   const auto run = levels("20,1e7,1\n40,1e7,1\n10,1e7,1\n30,1e6,0\n50,5e5,0\n60,4e5,0\n");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &tests = run.results["records"], &dividing = run.results["dividing_levels"];
   ASSERT_EQ(dividing.size(), 5u);
   const auto middle = [&](const char *key)
   { return std::sqrt(tests[0][key].get<double>() * tests[3][key].get<double>()); };
   const std::pair<int, const char *> measures[] = {
      {0, "edge_stress_range"}, {2, "k_t_range"}, {3, "energy_max"}, {4, "energy_total"}};
   for (const auto &[row, key] : measures)
   {
      expect_relative(dividing[row]["level"], middle(key), 1e-12);
      EXPECT_EQ(dividing[row]["wrong"], 1) << key;
      EXPECT_EQ(dividing[row]["tests"], 6) << key;
   }
   EXPECT_EQ(dividing[1]["wrong"], 1);
   expect_relative(dividing[2]["level"], tests[2]["k_t_range"].get<double>() * std::sqrt(6.0),
                   1e-12);
   expect_relative(dividing[3]["level"], tests[2]["energy_max"].get<double>() * 6, 1e-12);
   // The other way round no level is better than to call all tests one; of one kind none is
   // sought.
   const auto reversed = levels("10,1e6,0\n20,1e6,0\n30,1e7,1\n40,1e7,1\n");
   EXPECT_TRUE(reversed.results["dividing_levels"][2]["level"].is_null());
   EXPECT_EQ(reversed.results["dividing_levels"][2]["wrong"], 2);
   EXPECT_FALSE(levels("10,1e6,0\n20,1e6,0\n").results.contains("dividing_levels"));
   // The threshold of R = -1 at R = 0.5, reduced to the same largest value: by 4.
   const auto pulsating = levels("10,1e6,0\n20,1e7,1\n", "-lr 0.5");
   std::ifstream in(folder + "/t_mode_two.csv");
   double measured = 0, reduced = 0;
   for (std::string line; std::getline(in, line);)
   {
      const double y = std::atof(line.substr(line.rfind(',') + 1).c_str());
      if (line.rfind("mode II threshold,", 0) == 0) { measured = y; }
      if (line.rfind("reduced to R = 0.5 at most,", 0) == 0) { reduced = y; }
   }
   EXPECT_GT(measured, 0);
   EXPECT_NEAR(reduced, measured / 4, 1e-6 * measured);
   std::filesystem::remove_all(folder);
}

TEST(Fretting, ThresholdsAreTheSheets)
{
   // Fig. 2.7: X = K_N a0/ΔK_th = 0.2, curve A.
   const double threshold = 4.5 * std::sqrt(1000.0), length = std::pow(threshold / 500, 2) / pi;
   char options[128];
   for (const auto &[friction, ordinate] : {std::pair(0.3, 2.276629), std::pair(0.8, 1.178838)})
   {
      std::snprintf(options, sizeof options, "-p kn -kn %.12g -kt 20 -m Ti6Al4V -f %g",
                    0.2 * threshold / length, friction);
      const auto run = run_miniapp("fretting", options);
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
   run = run_miniapp("fretting", "-p fe -f 0.7 -Q 20");
   expect_values(run, CylinderOnHalfPlane{20}.intensities());
   EXPECT_EQ(run.results["fe"]["trailing"]["resolved"], false);
   EXPECT_NE(run.output.find("not resolved"), std::string::npos);
}

/// Both edges of a contact feel the same where Q goes fully to and fro: the trailing one is
/// judged, whatever the last digits, and -Q is the mirror image of Q.
TEST(Fretting, EdgesThatFeelTheSameAreNotChosenByRoundOff)
{
   for (const char *load : {"30", "40"})
   {
      const std::string options = "-p fe -b 1 -Q ";
      const auto there = run_miniapp("fretting", options + load),
                 back = run_miniapp("fretting", options + "-" + load);
      for (const auto *run : {&there, &back})
      {
         ASSERT_EQ(run->code, 0) << run->output;
         EXPECT_EQ(run->results["judged_edge"], "trailing");
      }
      const double stress = there.results["edge_stress"];
      EXPECT_GT(stress, 0);
      expect_relative(back.results["edge_stress"], -stress, 1e-6);
   }
}

/// f P = 0.7 * 400 N/mm bears no more shear than 280 N/mm: an outcome, not bad input.
TEST(Fretting, SlidingIsAnAnswerWithItsLoad)
{
   for (const char *pad : {"hertz", "fe"})
   {
      const auto run = run_miniapp("fretting", std::string("-Q 300 -f 0.7 -p ") + pad);
      EXPECT_EQ(run.code, 2) << run.output;
      EXPECT_EQ(run.results["status"], "gross sliding") << run.results;
      EXPECT_NE(run.output.find("fP = 280 N/mm"), std::string::npos) << run.output;
   }
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
                               "-Q none",
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
                               "-p fe -Q 1e3x",
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
      miniapp::Scene punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(
         problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      const auto edges = contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      double found[2];
      for (const auto &edge : edges)
      {
         EXPECT_TRUE(edge.complete);
         EXPECT_THROW(fretting::near_edge(edge), InputError);
         const fretting::CornerFit fit =
            fretting::fit_corner(fretting::corner_modes(fretting::Corner{pi / 2, pi}),
                                 edge_tractions(problem, state, edge));
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
      miniapp::Scene punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      march(problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}),
            state);
      const auto edges = contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      const EdgeTractions tractions = edge_tractions(problem, state, edges[0]);
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
