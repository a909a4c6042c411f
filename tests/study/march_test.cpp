#include "study/run_miniapp.hpp"

#include <filesystem>
#include <sstream>

namespace
{

using cattaneo_test::run_miniapp;
namespace fs = std::filesystem;

/// An empty folder of its own for each test.
class March : public testing::Test
{
protected:
   void SetUp() override
   {
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }

   std::string contents(const std::string &name) const
   {
      std::ostringstream text;
      text << std::ifstream(folder + name).rdbuf();
      return text.str();
   }

   const std::string folder = testing::TempDir() + "march/";
};

/// Cut in two it leaves the files of one that was not, and the same results to the last bit.
TEST_F(March, ARunCutInTwoLeavesTheSameFiles)
{
   const std::string run = "-reduced problems/hertz.json -csv '" + folder,
                     loads = "' -history 'P=0; P=1; Q=.2", state = "state.json'";
   const auto whole =
      run_miniapp("march", run + "whole" + loads + "; Q=-.2' -frames '1.5 2 2.5'");
   const auto first = run_miniapp("march", run + "cut" + loads + "' -frames 1.5 -save-state '" +
                                              folder + state);
   const auto second = run_miniapp(
      "march", run + "cut" + loads + "; Q=-.2' -frames 2.5 -load-state '" + folder + state);
   ASSERT_EQ(whole.code, 0) << whole.output;
   ASSERT_EQ(first.code, 0) << first.output;
   ASSERT_EQ(second.code, 0) << second.output;
   for (const char *table : {"_history.csv", "_nodes.csv", "_zones_in_time.csv"})
   {
      EXPECT_GT(contents(std::string("cut") + table).size(), 5000) << table;
      EXPECT_TRUE(contents(std::string("cut") + table) ==
                  contents(std::string("whole") + table))
         << table;
   }
   EXPECT_EQ(second.results["zones"], whole.results["zones"]);
   EXPECT_EQ(second.results["total_dissipation"], whole.results["total_dissipation"]);
   // Under another name there is nothing of the first part to go on with.
   const std::string begins = "Zones in time begin at 2,";
   EXPECT_EQ(second.output.find(begins), std::string::npos);
   const auto alone =
      run_miniapp("march", run + "alone" + loads + "; Q=-.2' -load-state '" + folder + state);
   ASSERT_EQ(alone.code, 0) << alone.output;
   EXPECT_NE(alone.output.find(begins), std::string::npos) << alone.output;
   EXPECT_EQ(alone.output.find("The table of cycles begins"), std::string::npos);
   // Nor of its cycles.
   const std::string cycled = run + "cycled" + loads + "; Q=-.2; Q=.2' -cycle-start 2 -cycles ";
   const auto one = run_miniapp("march", cycled + "1 -save-state '" + folder + state);
   ASSERT_EQ(one.code, 0) << one.output;
   std::filesystem::remove(folder + "/cycled_cycles.csv"); // it was killed before it wrote them
   const auto two = run_miniapp("march", cycled + "3 -load-state '" + folder + state);
   EXPECT_NE(two.output.find("The table of cycles begins after cycle 1,"), std::string::npos)
      << two.output;
}

/// Forces on held nodes, of which round-off has left the reduced problem something, have no
/// loop; the others have theirs.
TEST_F(March, ALoadOnHeldNodesHasNoLoop)
{
   nlohmann::json problem;
   std::ifstream(std::string(CATTANEO_SOURCE_DIR) + "/problems/hertz.json") >> problem;
   nlohmann::json &patterns = problem.at("patterns"), held = patterns.at(0);
   held["name"] = "held";
   for (const char *forces : {"q", "p"})
   {
      for (nlohmann::json &force : held.at(forces).at("values"))
      {
         force = 1e-17 * force.get<double>();
      }
   }
   patterns.push_back(held);
   const auto H = problem.at("H").at("values").get<std::vector<double>>();
   const double left = 3e-19;
   problem["H"] = {{"rows", 3},
                   {"cols", 3},
                   {"values", {H[0], H[1], left, H[2], H[3], left, left, left, left}}};
   std::ofstream(folder + "held.json") << problem;
   const auto run = run_miniapp("march", "-reduced '" + folder + "held.json' -cycle-start 1 " +
                                            "-cycles 2 -history 'P=0; P=1; P=1 Q=.2 held=1; "
                                            "P=1 Q=-.2 held=-1; P=1 Q=0 held=0'");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_NE(run.output.find("load held moves nothing that it acts on"), std::string::npos)
      << run.output;
   const auto &cycle = run.results["cycles"].back();
   EXPECT_EQ(cycle["work held"], 0);
   EXPECT_TRUE(cycle["stiffness held"].is_null()) << cycle;
   EXPECT_TRUE(cycle["loss_factor held"].is_null()) << cycle;
   EXPECT_GT(cycle["stiffness Q"], 0);
   EXPECT_NEAR(cycle["work Q"].get<double>() / cycle["dissipation"].get<double>(), 1, 0.01);
}

/// Of a cycle within which a march is taken up the record has the rest alone: it is left out,
/// and those after it are the same as of a march that was not cut.
TEST_F(March, ACycleThatIsTakenUpWithinIsLeftOut)
{
   const std::string run = "-reduced problems/square_punch.json -increments 20 -history "
                           "'P=0; P=1; Q=.16; Q=-.16",
                     cycles = "; Q=.16' -cycle-start 2 -cycles 4",
                     state = folder + "state.json'";
   const auto whole = run_miniapp("march", run + cycles);
   const auto first = run_miniapp("march", run + "' -save-state '" + state);
   const auto second = run_miniapp("march", run + cycles + " -load-state '" + state);
   ASSERT_EQ(whole.code, 0) << whole.output;
   ASSERT_EQ(first.code, 0) << first.output;
   ASSERT_EQ(second.code, 0) << second.output;
   const auto &all = whole.results["cycles"], &rest = second.results["cycles"];
   ASSERT_GT(all.size(), 1u);
   ASSERT_EQ(rest.size(), all.size() - 1);
   EXPECT_EQ(second.results["first_cycle"], 2);
   EXPECT_EQ(whole.results["first_cycle"], 1);
   for (std::size_t k = 0; k < rest.size(); ++k) { EXPECT_EQ(rest[k], all[k + 1]); }
   EXPECT_NE(second.output.find("cycle 1 was taken up within it"), std::string::npos);
}

/// The thesis' method node by node comes to the forces of the other, which it shares no step
/// with.
TEST_F(March, MethodsAgree)
{
   const std::string run = "-reduced problems/square_punch.json -history 'P=0; P=1; Q=0.1' "
                           "-increments 5 -frames all -csv '" +
                           folder;
   const auto automatic = run_miniapp("march", run + "a'"),
              sweeps = run_miniapp("march", run + "g' -method gauss-seidel");
   ASSERT_EQ(automatic.code, 0) << automatic.output;
   ASSERT_EQ(sweeps.code, 0) << sweeps.output;
   EXPECT_EQ(sweeps.results["counters"]["dense_factorisations"], 0);
   EXPECT_GT(sweeps.results["counters"]["sweeps"], 100);
   for (const char *key : {"normal_force", "tangential_force", "total_dissipation"})
   {
      const double value = automatic.results[key];
      EXPECT_NEAR(sweeps.results[key].get<double>(), value, 1e-8 * std::abs(value)) << key;
   }
   // It says where it was not given enough of them.
   const auto stopped = run_miniapp("march", run + "s' -method gauss-seidel -max-sweeps 2");
   EXPECT_EQ(stopped.code, 2) << stopped.output;
   EXPECT_EQ(stopped.results["status"], "stalled");
}

TEST_F(March, BadInputIsOneSentence)
{
   const std::string hertz = "-reduced problems/hertz.json ";
   const std::pair<std::string, std::vector<std::string>> bad[] = {
      {"", {"option reduced", "must name"}},
      {"-reduced nowhere.json", {"cannot read", "nowhere.json"}},
      {"-reduced meshes/dovetail.json", {"dovetail.json", "not a reduced problem"}},
      {hertz + "-friction -1", {"option --friction", "-1", "not be negative"}},
      {hertz + "-method newton", {"option --method", "'newton'", "gauss-seidel"}},
      {hertz + "-tolerance 0", {"option --tolerance", "positive"}},
      {hertz + "-history 'P=0; R=1'", {"history 'R=1'", "no load pattern 'R'", "P, Q"}},
      {hertz + "-frames 2", {"frames", "time 2", "from 0 to 1"}},
      {hertz + "-load-state problems/hertz.json", {"problems/hertz.json"}},
      {hertz + "-save problems/hertz.json", {"--save", "name another"}}};
   for (const auto &[options, words] : bad)
   {
      const auto run = run_miniapp("march", options);
      EXPECT_EQ(run.code, 1) << options << "\n" << run.output;
      const std::size_t at = run.output.find("error:");
      ASSERT_NE(at, std::string::npos) << options << "\n" << run.output;
      EXPECT_EQ(run.output.find('\n', at), run.output.size() - 1) << run.output;
      for (const std::string &word : words)
      {
         EXPECT_NE(run.output.find(word, at), std::string::npos) << word << ": " << run.output;
      }
   }
}

/// Of a punch with a shear strength that ends no node bears more, and its corners bear that;
/// one way more than the other where it is said; and Q is carried all the same.
TEST_F(March, LawsOfFrictionThatBendOrDifferByWay)
{
   const auto shears = [&](const std::string &law, const std::string &time)
   {
      const auto run = run_miniapp(
         "march", "--reduced problems/punch_on_half_plane.json --history 'P=0; P=1; Q=0.25; "
                  "Q=-0.25' --csv '" +
                     folder + "m' --frames 2 " + law);
      EXPECT_EQ(run.code, 0) << run.output;
      EXPECT_NEAR(cattaneo_test::number(run.results["tangential_force"]), 0.25, 1e-10);
      // q is the ninth column of the nodes, p the eighth.
      std::istringstream rows(contents("m_nodes.csv"));
      std::vector<std::pair<double, double>> all;
      std::string row;
      std::getline(rows, row);
      EXPECT_EQ(row, "time,node,arc_length,x,y,state,p,q,slip,opening");
      while (std::getline(rows, row))
      {
         std::istringstream cells(row);
         std::vector<std::string> cell(10);
         for (std::string &one : cell) { std::getline(cells, one, ','); }
         if (cell[0] == time) { all.emplace_back(std::stod(cell[6]), std::stod(cell[7])); }
      }
      EXPECT_EQ(all.size(), 41u);
      return all;
   };
   double most = 0;
   for (const auto &[p, q] : shears("--strength '0.75 0.3 1 0.3'", "3"))
   {
      EXPECT_LE(std::abs(q), std::min(0.4 * p, 0.3) + 1e-9);
      most = std::max(most, q);
   }
   EXPECT_NEAR(most, 0.3, 1e-9);
   double forward = 0, backward = 0;
   const std::string ways = "--strength '1 0.4' --strength-backward '1 0.28'";
   for (const auto &[p, q] : shears(ways, "2")) { forward = std::max(forward, -q / p); }
   for (const auto &[p, q] : shears(ways, "3")) { backward = std::max(backward, q / p); }
   EXPECT_NEAR(forward, 0.4, 1e-9);
   EXPECT_NEAR(backward, 0.28, 1e-9);
   for (const auto &[options, words] :
        {std::pair<std::string, std::string>("--strength '1 0.4 2'", "in turn"),
         {"--strength '1 0.4' --friction 0.3", "two laws of friction"},
         {"--strength-backward '1 0.4'", "goes with --strength"},
         {"--strength '2 0.4 1 0.5'", "must grow"}})
   {
      const auto run =
         run_miniapp("march", "--reduced problems/hertz.json --history 'P=0; P=1' " + options);
      EXPECT_EQ(run.code, 1) << options;
      EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
   }
}

/// The first cycle of a shear on what was only pressed leaves slip that was not there before.
TEST_F(March, CyclesThatAreNotSteadyAreCalledSo)
{
   const std::string loads = "-reduced problems/hertz.json -history "
                             "'P=0; P=1; Q=0.1; Q=-0.1; Q=0' -cycle-start 1 -cycles ";
   const auto once = run_miniapp("march", loads + "1"),
              more = run_miniapp("march", loads + "4");
   EXPECT_EQ(once.code, 0) << once.output;
   EXPECT_NE(once.output.find("not steady after cycle 1"), std::string::npos) << once.output;
   EXPECT_EQ(more.code, 0) << more.output;
   EXPECT_EQ(more.output.find("not steady"), std::string::npos) << more.output;
   EXPECT_NE(more.output.find("steady from cycle"), std::string::npos) << more.output;
}

// Equal bodies that are pressed and let go as far as 0.5 lose nothing (B = 0), and a loop that
// encloses nothing has no loss factor; the secant of the load is that of its elastic way.
TEST_F(March, ALoopThatLosesNothingHasNoLossFactor)
{
   const auto run =
      run_miniapp("march", "-reduced problems/hertz.json -cycle-start 1 -cycles 2 "
                           "-history 'P=0; P=1; P=0.5; P=1'");
   ASSERT_EQ(run.code, 0) << run.output;
   for (const auto &cycle : run.results["cycles"])
   {
      EXPECT_EQ(cycle["work P"], 0) << cycle;
      EXPECT_EQ(cycle["external_work"], 0) << cycle;
      EXPECT_TRUE(cycle["loss_factor P"].is_null()) << cycle;
      EXPECT_GT(cycle["stiffness P"], 0) << cycle;
   }
}

// Equal bodies in partial slip are steady from the first cycle on; a march that is cut after it
// says the same as one that is not, also where nothing is left of it.
TEST_F(March, IsSteadyFromTheSameCycleWhereverItWasCut)
{
   const std::string run = "-reduced problems/hertz.json -history 'P=0; P=1; Q=.2; Q=-.2; "
                           "Q=.2' -cycle-start 2 -cycles ",
                     state = folder + "steady.json'";
   const auto whole = run_miniapp("march", run + "4");
   EXPECT_EQ(whole.results["steady_cycle"], 1);
   ASSERT_EQ(run_miniapp("march", run + "1 -save-state '" + state).code, 0);
   for (const char *cycles : {"4", "1"})
   {
      const auto rest = run_miniapp("march", run + cycles + " -load-state '" + state);
      EXPECT_EQ(rest.code, 0) << rest.output;
      EXPECT_EQ(rest.results["steady_cycle"], 1) << rest.output;
      EXPECT_EQ(rest.results["steady_period"], 1);
      const bool said = rest.output.find("nothing was left to march") != std::string::npos;
      EXPECT_EQ(said, std::string(cycles) == "1") << rest.output;
   }
}

// Sweeps that are too few find no increment, however short.
TEST_F(March, IncrementsThatStallAreSaidToBePassedOnlyWhereTheyAre)
{
   const auto run = run_miniapp("march", "-reduced problems/hertz.json -history 'P=0; P=1; "
                                         "Q=0.2' -method gauss-seidel -max-sweeps 1");
   EXPECT_EQ(run.code, 2);
   EXPECT_EQ(run.results["event_time"], 0);
   EXPECT_NE(run.output.find("increments stalled and shorter ones were tried"),
             std::string::npos)
      << run.output;
   EXPECT_EQ(run.output.find("passed by shorter"), std::string::npos) << run.output;
}

} // namespace
