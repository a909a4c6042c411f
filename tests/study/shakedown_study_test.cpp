#include <cattaneo/reduced/reduced_file.hpp>
#include <extent.hpp>
#include <sstream>
#include <study/run_miniapp.hpp>
#include <utility>
#include <vector>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using cattaneo_test::meshes;
using Outcome = cattaneo_test::Run; // Run is a member of testing::Test
using cattaneo_test::run_miniapp;

TEST(ShakedownStudy, MeetsItsReferences)
{
   const Outcome run = run_miniapp("shakedown", "-load-ratios -transposed -lower");
   // The studies' notes, part A. Extremes lie between the 201 nodes: second order in their
   // spacing, of a part in two hundred.
   const double mesh = 7.5e-4;
   expect_values(run, {{"corner opens at λ", 0.865, 0.002, mesh},
                       {"full adhesion, f at λ = 0.4", 0.7256, 3e-4, mesh},
                       {"full adhesion, f at λ = 0.6", 1.1045, 3e-4, mesh},
                       {"full adhesion, f at λ = 0.8", 1.5752, 3e-4, mesh},
                       {"corner decides up to λ", 0.2815, 3e-4, mesh},
                       // "About": and the place of a flat maximum is of first order, half of
                       // the distance of the nodes there, 0.023.
                       {"x/a where the largest ratio is then", 0.635, 0.005, 0.012},
                       {"method 1, f", 0.8385, 1e-4, mesh},
                       {"exact, f", 0.805, 1e-3, 0},
                       {"exact with B transposed, f", 0.848, 5e-4, mesh},
                       {"method 2, least f", 0.783, 5e-4, mesh},
                       {"method 2, most f", 0.806, 5e-4, mesh},
                       {"exact, λ/f at R = -1, f = 0.85", 0.8040, 3e-4, mesh},
                       {"exact with B transposed, λ/f at R = -1, f = 0.85", 0.732, 5e-4, mesh},
                       {"exact, λ/f at R = -1, f = 1", 0.8059, 3e-4, mesh},
                       {"exact, λ/f at R = -0.5, f = 0.85", 0.9915, 5e-5, mesh},
                       {"method 1, λ/f at R = -1", 0.7273, 2e-4, mesh}});
   const auto &results = run.results;
   EXPECT_EQ(results["status"], "certified");
   EXPECT_LE(results["bound_lower"], results["friction_limit"]);
   EXPECT_LE(results["friction_limit"], results["bound_upper"]);
   EXPECT_LE(results["bound_upper"].get<double>() - results["bound_lower"].get<double>(), 1e-6);
   EXPECT_LE(results["violation"].get<double>(), 0);
   EXPECT_LE(results["method2_low"], results["method2_high"]);
   EXPECT_NE(results["limit_assumption"].get<std::string>().find("closed"), std::string::npos);
   EXPECT_FALSE(results["friction_limit_of_the_mesh"].get<bool>());
   // An admissible slip can empty a corner: nothing is proven of the lower limit, and said so.
   EXPECT_FALSE(results.contains("lower_limit"));
   EXPECT_NE(results["lower_limit_statement"].get<std::string>().find("no bound"),
             std::string::npos);
}

TEST(ShakedownStudy, SolvesWhatIsAskedFor)
{
   // One programme for one limit; what else may be asked has options.
   const Outcome load = run_miniapp("shakedown", "-nodes 33 -find load");
   ASSERT_EQ(load.code, 0) << load.output;
   EXPECT_EQ(load.results["counters"]["limit_solves"], 1);
   for (const char *key : {"load_ratio", "lower_limits_apart", "lower_limit"})
   {
      EXPECT_FALSE(load.results.contains(key)) << key;
   }
   // That it is a limit of some starts is said all the same.
   EXPECT_NE(load.results["lower_limit_statement"].get<std::string>().find("some starts"),
             std::string::npos);
   const Outcome friction = run_miniapp("shakedown", "-nodes 33 -find friction"),
                 both = run_miniapp("shakedown", "-nodes 33");
   EXPECT_FALSE(friction.results.contains("friction_limit_transposed"));
   EXPECT_EQ(both.results["counters"]["limit_solves"].get<int>(),
             friction.results["counters"]["limit_solves"].get<int>() + 1);
   // A ratio that is the limit just found is not found again.
   const Outcome ratios = run_miniapp("shakedown", "-nodes 33 -find load -load-ratios");
   EXPECT_EQ(ratios.results["counters"]["limit_solves"], 3);
}

TEST(ShakedownStudy, MarchesLoseWhatTheReferencesSay)
{
   // The finer mesh takes most of the time: ./test --all. Second order in the spacing.
   for (const int nodes : meshes({101}, {201}))
   {
      const Outcome run =
         run_miniapp("shakedown", "-march -cycles 140 -nodes " + std::to_string(nodes));
      const double mesh = 30.0 / (nodes * nodes);
      expect_values(run,
                    {{"first loss from zero slip", 0.340, 1e-3, mesh},
                     // An optimal slip dissipates nothing.
                     {"first loss from optimal slip", 0, 0, 1e-15},
                     {"first loss from negative optimal slip", 0.827, 0.02 * 0.827, mesh}});
      for (const auto &march : run.results["marches"])
      {
         // A few nodes at the trailing corner open in every cycle and slip for ever, unless the
         // march starts from the optimal slip: the loss of the others dies out.
         const bool optimal = march["start"] == "optimal";
         EXPECT_EQ(march["outcome"], optimal ? "shaken down" : "moves only at nodes that open");
         EXPECT_EQ(march["opened_nodes"].get<int>() == 0, optimal);
         EXPECT_LT(march["opened_nodes"].get<int>(), 10);
         if (march["start"] != "optimal")
         {
            // The resolved mesh's rate, 0.88 to 0.89 a cycle, with what corner nodes add.
            EXPECT_NEAR(march["decay"].get<double>(), 0.885, 0.05);
         }
      }
   }
}

TEST(ShakedownStudy, BoundAndMarchNameWhatTheyAreOf)
{
   // 0.1 % above the bound for a contact that stays closed a march goes on slipping only at
   // nodes that open, which the bound does not know.
   const Outcome run = run_miniapp(
      "shakedown", "-nodes 65 -friction 0.804 -find load -reversal -0.5 -march -cycles 170");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_LT(run.results["load_limit_upper"].get<double>(), 0.8);
   EXPECT_NE(run.output.find("Where nodes open the bounds above do not apply"),
             std::string::npos);
   for (const auto &march : run.results["marches"])
   {
      EXPECT_EQ(march["outcome"], "moves only at nodes that open");
      EXPECT_GT(march["opened_nodes"].get<int>(), 0);
      EXPECT_GT(march["opened_loss"].get<double>(), 0);
   }
}

TEST(ShakedownStudy, AdhesionMapEndsWhereTheCornerOpens)
{
   const Outcome run = run_miniapp("shakedown", "-nodes 129 -find friction -adhesion-map");
   ASSERT_EQ(run.code, 0) << run.output;
   // The trailing corner opens at λ = 0.865(2) (independent reference).
   for (const auto &point : run.results["adhesion_map"])
   {
      const bool open = point["load_factor"].get<double>() > 0.87;
      EXPECT_EQ(point["open"].get<bool>(), open) << point;
      EXPECT_EQ(point["friction"].is_null(), open) << point;
   }
   EXPECT_NE(run.output.find(" 0.875           open"), std::string::npos) << run.output;
   // The forces of the corner's own node: 0.59 to 0.77, by the mesh; the tractions: 0.5431.
   const double at_node = run.results["corner_node_ratio"];
   EXPECT_GT(at_node, 0.59);
   EXPECT_LT(at_node, 0.77);
}

TEST(ShakedownStudy, OnlyDundursConstantsOfABlockAndItsPlaneMatter)
{
   // Three pairs with α = 0 and β = (1/(1-ν) - 1/(1-ν'))/4 = -1/16: by Dundurs' theorem one
   // and the same contact. What differs is the mesh's, a tenth of its own error of 30/64².
   std::vector<nlohmann::json> rows;
   for (const auto &[block, plane] : {std::pair{0.0, 0.2}, {0.2, 1 / 3.0}, {1 / 3.0, 3 / 7.0}})
   {
      std::ostringstream options;
      options.precision(17);
      options << "-nodes 65 -find load -poisson " << block << " -mismatch 1 -mismatch-poisson "
              << plane;
      const Outcome run = run_miniapp("shakedown", options.str());
      ASSERT_EQ(run.code, 0) << run.output;
      rows.push_back(run.results["mismatch"][0]);
      EXPECT_NEAR(rows.back()["alpha"].get<double>(), 0, 1e-15);
      EXPECT_NEAR(rows.back()["beta"].get<double>(), -1 / 16.0, 1e-15);
      for (const char *key : {"friction_limit", "load_limit", "load_limit_reversed"})
      {
         const double first = rows[0][key];
         EXPECT_NEAR(rows.back()[key].get<double>(), first, 7e-4) << key;
      }
      const double coupling = rows[0]["coupling"];
      EXPECT_NEAR(rows.back()["coupling"].get<double>(), coupling, 7e-3 * coupling);
   }
   // Another β is another contact, and a soft plane under a block is two half-planes' |β|.
   const Outcome run = run_miniapp("shakedown", "-nodes 65 -find load -mismatch '1e-4 1' "
                                                "-mismatch-poisson '0 0.2'");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &other = run.results["mismatch"];
   EXPECT_GT(
      std::abs(other[2]["load_limit"].get<double>() - rows[0]["load_limit"].get<double>()),
      5e-3);
   for (const int k : {0, 1})
   {
      const double beta = other[k]["beta"];
      EXPECT_NEAR(beta, k == 0 ? 0.5 : 0.375, 2e-4); // (1-2ν)/(2-2ν) on a rigid block
      EXPECT_NEAR(other[k]["coupling"].get<double>(), beta, 0.02);
   }
}

TEST(ShakedownStudy, SaysWhichLimitsAreOfTheMesh)
{
   // Below the corner's ratio of tractions, 0.5431, the corner decides; above, the inside does.
   for (const double friction : {0.3, 0.5, 0.6, 0.85})
   {
      const Outcome run =
         run_miniapp("shakedown",
                     "-nodes 65 -find load -reversal -1 -friction " + std::to_string(friction));
      ASSERT_EQ(run.code, 0) << run.output;
      const bool by_corner = friction < 0.543;
      EXPECT_EQ(run.results["load_limit_of_the_mesh"].get<bool>(), by_corner) << friction;
      EXPECT_EQ(run.output.find("no limit of the bodies") != std::string::npos, by_corner);
   }
}

TEST(ShakedownStudy, LimitOfASavedBlockOnARigidPlane)
{
   // README's: decided inside the contact, so that it converges with the mesh.
   const std::string file = testing::TempDir() + "shakedown_block.json";
   std::vector<double> limits;
   for (const char *nodes : {"51", "101", "201"})
   {
      const Outcome block = run_miniapp("square_punch", std::string("-obstacle rigid -nodes ") +
                                                           nodes + " -save '" + file + "'");
      ASSERT_EQ(block.code, 0) << block.output;
      const Outcome run = run_miniapp(
         "shakedown", "-reduced '" + file + "' -friction 0.8 -find load -reversal -1");
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_FALSE(run.results["load_limit_of_the_mesh"].get<bool>()) << run.output;
      limits.push_back(run.results["load_limit"]);
   }
   std::remove(file.c_str());
   EXPECT_NEAR(limits[1], limits[2], 2e-3 * limits[2]);
   EXPECT_LT(std::abs(limits[2] - limits[1]), 0.5 * std::abs(limits[1] - limits[0]));
}

// Of a block on a half-plane whose friction bends. The expected limits are those of a linear
// programme of the saved matrices (slip of the nodes and λ; at both ends of the cycle p >= 0
// and -0.75 p, -(0.4 w + 0.25 p) <= q <= the same or 0.5 p, w the weights), solved by HiGHS.
TEST(ShakedownStudy, OtherLawsOfFrictionHaveALargestLoad)
{
   const std::string file = testing::TempDir() + "shakedown_law.json",
                     of_file = "-reduced '" + file + "' ", law = "-strength '.8 .6 2 .9' ";
   const auto limit = [](const std::string &options)
   {
      const Outcome run = run_miniapp("shakedown", options);
      EXPECT_EQ(run.code, 0) << run.output;
      EXPECT_EQ(run.results["load_limit_status"], "certified") << run.output;
      return run.results["load_limit"].get<double>();
   };
   EXPECT_NEAR(limit("-nodes 33 -find load " + law + "-save '" + file + "'"), 0.44296957130609,
               1e-8);
   EXPECT_NEAR(limit(of_file), 0.44296957130609, 1e-8);
   EXPECT_NEAR(limit(of_file + "-reversal -1 -strength-backward '1 .5' " + law),
               0.35052341700053, 1e-8);
   // Coulomb's takes its place only where it is said.
   const std::string coulomb = "-find load -friction 0.5 -nodes 33";
   EXPECT_NEAR(limit(of_file + "-find load -friction 0.5"), limit(coulomb), 1e-10);
   run_miniapp("shakedown", coulomb + " -save '" + file + "'");
   EXPECT_NEAR(limit(of_file), limit(coulomb), 1e-10);
   for (const auto &[options, words] :
        {std::pair<std::string, std::string>("-find friction ", "must be load"),
         {"-map ", "knows Coulomb's law alone"},
         {"-friction 0.3 ", "two laws of friction"},
         {"-strength-backward '1 .5 2 2' ", "steeper"}})
   {
      const Outcome run = run_miniapp("shakedown", "-nodes 9 " + law + options);
      EXPECT_EQ(run.code, 1) << options;
      EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
   }
   cattaneo::ReducedProblem problem = cattaneo::load_reduced_problem(file);
   problem.friction[0] = 0.4;
   cattaneo::save(problem, file);
   const Outcome several = run_miniapp("shakedown", of_file);
   EXPECT_EQ(several.code, 1);
   EXPECT_NE(several.output.find("from 0.4 to 0.5"), std::string::npos) << several.output;
   cattaneo::set_friction(problem, 0);
   cattaneo::save(problem, file);
   const Outcome none = run_miniapp("shakedown", of_file);
   EXPECT_EQ(none.code, 1);
   EXPECT_NE(none.output.find("has no friction"), std::string::npos) << none.output;
   std::remove(file.c_str());
}

TEST(ShakedownStudy, ConvergesWithTheMesh)
{
   const Outcome run = run_miniapp(
      "shakedown", "-domain 1e4 -find friction -nodes 65 -mesh-study \"65 129 257\"");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &study = run.results["mesh_study"];
   // Second order in the size of the elements: differences fall by about four.
   const auto value = [&](int k) { return study[k]["load_limit_reversed"].get<double>(); };
   const double ratio = (value(1) - value(0)) / (value(2) - value(1));
   EXPECT_GT(ratio, 3) << run.output;
   EXPECT_LT(ratio, 5) << run.output;
   const double limit = (value(2) + (value(2) - value(1)) / 3) / 0.85;
   EXPECT_NEAR(limit, 0.8040, 3e-4);
   // The degree of coupling does not follow the number of nodes.
   EXPECT_NEAR(study[0]["coupling"].get<double>(), study[2]["coupling"].get<double>(), 0.01);
   // Without a mesh below there is less error on each mesh of the block.
   const Outcome itself =
      run_miniapp("shakedown", "-find friction -nodes 65 -mesh-study \"65 129 257\"");
   for (int k = 0; k < 3; ++k)
   {
      const double found = itself.results["mesh_study"][k]["load_limit_reversed"];
      EXPECT_LT(std::abs(found / 0.85 - 0.8040), std::abs(value(k) / 0.85 - 0.8040) + 5e-5);
      if (k == 2) { EXPECT_NEAR(found / 0.85, 0.8040, 3e-4); }
   }
}

TEST(ShakedownStudy, LowerLimitIsProvenForLittleFriction)
{
   const Outcome run =
      run_miniapp("shakedown", "-nodes 65 -find load -friction 0.55 -starts 2 -cycles 60");
   ASSERT_EQ(run.code, 0) << run.output;
   const double lower = run.results["lower_limit"];
   EXPECT_GT(lower, 0);
   EXPECT_LT(lower, run.results["load_limit"].get<double>());
   // No march contradicts it.
   EXPECT_GE(run.results["quiet_up_to"].get<double>(), lower);
}

TEST(ShakedownStudy, LowerLimitButForTheCornersIsProven)
{
   const Outcome run =
      run_miniapp("shakedown", "-nodes 33 -find load -lower -starts 4 -cycles 60");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &apart = run.results["lower_limits_apart"];
   ASSERT_GE(apart.size(), 3u) << run.output;
   // The more is set apart, the more is proven of the rest.
   double before = 0;
   int compared = 0;
   for (const auto &row : apart)
   {
      EXPECT_GT(row["load_factor"].get<double>(), before) << row;
      before = row["load_factor"];
      EXPECT_LE(before, run.results["load_limit"].get<double>());
      // With the least pressures of each vertex by HiGHS, linear programmes of their own, the
      // condition holds at the vertices up to 0.251 and 0.624. It must hold between them too,
      // with multipliers that are the same for all loads: a sixth less.
      const double distance = row["distance"];
      const double sharpest = std::abs(distance - 0.005) < 1e-9  ? 0.2514
                              : std::abs(distance - 0.02) < 1e-9 ? 0.6245
                                                                 : 0;
      if (sharpest == 0) { continue; }
      ++compared;
      EXPECT_LE(before, sharpest) << row;
      EXPECT_GT(before, 0.83 * sharpest) << row;
   }
   EXPECT_EQ(compared, 2);
   // Corner nodes open and slip on from some starts, far below.
   EXPECT_LT(run.results["opens_at"].get<double>(), 0.2);
   EXPECT_GT(run.results["opens_at"].get<double>(), 0);
}

TEST(ShakedownStudy, ReadsWhatItSaves)
{
   const std::string file = testing::TempDir() + "shakedown_study.json";
   const Outcome punch = run_miniapp("shakedown", "-domain 1e4 -nodes 33 -save '" + file + "'");
   const Outcome saved = run_miniapp("shakedown", "-reduced '" + file + "'");
   ASSERT_EQ(punch.code, 0) << punch.output;
   ASSERT_EQ(saved.code, 0) << saved.output;
   EXPECT_EQ(punch.results["friction_limit"], saved.results["friction_limit"]);
   EXPECT_EQ(punch.results["load_limit"], saved.results["load_limit"]);
   // A contact that stays closed everywhere is its own closed part.
   const Outcome closed = run_miniapp(
      "shakedown", "-reduced '" + file + "' -closed -lambda-max 0.2 -reversal -0.5");
   EXPECT_EQ(closed.results["closed_nodes"], 33) << closed.output;
   // The part is a problem of its own, whose sums are rounded elsewhere.
   EXPECT_NEAR(closed.results["load_limit"].get<double>(),
               saved.results["load_limit"].get<double>(), 1e-13);
   std::remove(file.c_str());
}

TEST(ShakedownStudy, LimitOfASavedLapJoint)
{
   // Pinched and pulled: the contact recedes. Below the limit the whole joint, whose open nodes
   // are free to close, shakes down from the optimal slip; above it does not.
   const std::string file = testing::TempDir() + "shakedown_lap_joint.json";
   double limit = 0;
   for (const char *spacing : {"0.04", "0.02"})
   {
      const Outcome joint =
         run_miniapp("lap_joint", std::string("-load 0.01 -increments 5 -spacing ") + spacing +
                                     " -save '" + file + "'");
      ASSERT_EQ(joint.code, 0) << joint.output;
      const Outcome run = run_miniapp(
         "shakedown", "-reduced '" + file +
                         "' -held 'bolt 1, w = 1' -cycled T -closed -find load -friction 0.2 "
                         "-lambda-max 0.01 -reversal 0 -cycles 30");
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_LT(run.results["closed_nodes"].get<int>(),
                joint.results["contact_nodes"].get<int>());
      EXPECT_GE(run.results["smallest_open_gap"].get<double>(), 0);
      const auto &whole = run.results["whole_contact"];
      ASSERT_EQ(whole.size(), 2u);
      EXPECT_EQ(whole[0]["outcome"], "shaken down") << run.output;
      EXPECT_EQ(whole[1]["outcome"], "cyclic slip") << run.output;
      // Stuck shear is singular at a receding edge: no mesh has the last word, and it says so.
      EXPECT_TRUE(run.results["load_limit_of_the_mesh"].get<bool>()) << run.output;
      EXPECT_NE(run.output.find("no limit of the bodies"), std::string::npos);
      const double own = run.results["load_limit"];
      if (limit > 0) { EXPECT_LT(own, 0.75 * limit); }
      limit = own;
   }
   std::remove(file.c_str());
}

TEST(ShakedownStudy, RefusesBadOptions)
{
   for (const char *options : {"-friction 0", "-lambda-max -1", "-reversal 2", "-find all",
                               "-corner 0.7", "-held X -nodes 9", "-reduced missing.json"})
   {
      const Outcome run = run_miniapp("shakedown", options);
      EXPECT_EQ(run.code, 1) << options;
      EXPECT_NE(run.output.find("error:"), std::string::npos) << options;
   }
   // Nothing sticks under a pull: an outcome, not an error.
   const Outcome run = run_miniapp("shakedown", "-nodes 9 -held Q -cycled P");
   EXPECT_EQ(run.code, 2) << run.output;
}

// A body that P presses slides where Q is f P: the outcome of the marches is that of the run,
// whatever is proven of the limit.
TEST(ShakedownStudy, MarchesThatSlideSayAtWhichLoads)
{
   const Outcome run = run_miniapp("shakedown", "-nodes 41 -find load -friction 0.85 -march "
                                                "-cycles 3 -lambda-max 0.9");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_EQ(run.results["load_limit_status"], "certified");
   EXPECT_EQ(run.results["status"], "gross sliding");
   const std::string message = run.results["message"];
   EXPECT_NE(message.find("from zero, optimal, negative optimal slip"), std::string::npos)
      << message;
   ASSERT_EQ(run.results["marches"].size(), 3u);
   // Bisection, to a millionth.
   EXPECT_NEAR(run.results["event_loads"]["Q"], 0.85, 1e-6);
   for (const auto &march : run.results["marches"])
   {
      EXPECT_EQ(march["event_loads"]["P"], 1);
      EXPECT_NEAR(march["event_loads"]["Q"], 0.85, 1e-6);
   }
   EXPECT_NE(run.output.find("(P = 1, Q = 0.85): the loads exceed"), std::string::npos)
      << run.output;
}

} // namespace
