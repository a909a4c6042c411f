#include "study/run_miniapp.hpp"

#include <cmath>

namespace
{

using cattaneo_test::expect_values;
using cattaneo_test::Expected;
using cattaneo_test::run_miniapp;

// 101 nodes over ±1.67 b: edges are read out to a tenth of the spacing.
const double read_out = 0.1 * 2 * 1.67 / 100;

TEST(Hertz, HalfPlanesMeetTheClosedFormsAtBothOrders)
{
   for (const auto &[order, domain] :
        {std::pair{"1", "0"}, {"2", "0"}, {"1", "1e4"}, {"2", "1e4"}})
   {
      const auto run = run_miniapp("hertz", std::string("--shear '0.3 0.6 0.9' -order ") +
                                               order + " -domain " + domain);
      SCOPED_TRACE(run.output);
      // Closed forms. Peak: what the studies' notes measured of bilinear and quadratic
      // elements.
      const double peak = order[0] == '1' ? 2e-3 : 8e-5;
      expect_values(run,
                    {{"peak pressure / p0 Hertz", 1, 0, peak},
                     {"half-width / b Hertz", 1, 0, read_out},
                     {"stick half-width / b, Q/fP = 0.3", std::sqrt(1 - 0.3), 0, read_out},
                     {"stick half-width / b, Q/fP = 0.6", std::sqrt(1 - 0.6), 0, read_out},
                     {"stick half-width / b, Q/fP = 0.9", std::sqrt(1 - 0.9), 0, read_out}});
      // Half-planes have no mesh. Of two equal bodies one is factored.
      const bool meshed = domain[0] == '1';
      EXPECT_EQ(run.results["counters"]["assemblies"], meshed ? 2 : 0);
      EXPECT_EQ(run.results["counters"]["factorisations"], meshed ? 1 : 0);
   }
}

TEST(Hertz, TractionsConvergeToTheClosedForms)
{
   // Mean over the line: of first order at least; single steps vary with where the edge of
   // contact lies in its element.
   for (const std::string domain : {"0", "1000"})
   {
      double coarse = 0, fine = 0;
      for (const char *nodes : {"51", "451"})
      {
         const auto run = run_miniapp("hertz", "-domain " + domain + " -nodes " + nodes);
         ASSERT_EQ(run.code, 0) << run.output;
         coarse = fine;
         fine = run.results["pressure_deviation_mean"];
         EXPECT_NEAR(run.results["levels"][0]["stick_half_width"].get<double>(),
                     std::sqrt(1 - 0.6), 3.34 / (std::stod(nodes) - 1) * 0.15);
      }
      EXPECT_LT(fine, coarse / 9);
   }
}

TEST(Hertz, BlockMeetsTheReferencesAtBothOrders)
{
   for (const char *order : {"1", "2"})
   {
      for (const char *ratio : {"0.4", "0.8"})
      {
         const auto run = run_miniapp("hertz", std::string("-body block --shear '' -ratio ") +
                                                  ratio + " -order " + order);
         SCOPED_TRACE(run.output);
         const bool narrow = std::string(ratio) == "0.4";
         expect_values(run, {{"half-width / b Hertz", narrow ? 0.989 : 0.959, 0.003, read_out},
                             {"peak pressure / p0 Hertz", narrow ? 1.011 : 1.047, 0.003, 0}});
      }
   }
}

TEST(Hertz, CoupledContactGrowsNodeByNodeHoweverItIsCut)
{
   // The block's contact advances from one change of state to the next: a single increment
   // comes to what twenty come to.
   const auto once = run_miniapp("hertz", "-body block --shear '' -increments 1"),
              often = run_miniapp("hertz", "-body block --shear '' -increments 20");
   ASSERT_EQ(once.code, 0) << once.output;
   EXPECT_EQ(once.results["counters"]["increments"], 1);
   EXPECT_GT(once.results["counters"]["newton_steps"].get<int>(), 15);
   for (const char *of : {"half_width", "peak_pressure"})
   {
      EXPECT_NEAR(once.results[of].get<double>(), often.results[of].get<double>(), 1e-12);
   }
}

TEST(Hertz, BadOptionsAreOneSentenceAndExitCodeOne)
{
   for (const char *options : {"-body ball", "-ratio 1.5", "-span 0.5", "-nodes 8", "-domain 5",
                               "-friction -1", "-poisson 0.7", "--unknown"})
   {
      const auto run = run_miniapp("hertz", options);
      EXPECT_EQ(run.code, 1) << options << "\n" << run.output;
      EXPECT_NE(run.output.find("error:"), std::string::npos) << run.output;
      EXPECT_TRUE(run.results.is_null()) << options;
   }
}

/// Without friction there is no f P that Q could be a share of: it is pressed alone.
TEST(Hertz, FrictionlessIsPressedAlone)
{
   const auto run = run_miniapp("hertz", "-friction 0");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_TRUE(run.results["levels"].empty()) << run.results["levels"];
   for (const auto &row : run.results["references"])
   {
      EXPECT_EQ(row["quantity"].get<std::string>().find("Q/fP"), std::string::npos) << row;
   }
   EXPECT_NEAR(run.results["half_width"].get<double>(), 1, 0.01);
   EXPECT_EQ(run_miniapp("hertz", "-friction 0 -shear 0.3").code, 1);
}

/// At Q = f P nothing sticks but the node where the mesh ends: it says nothing within its
/// spacing, 2 * 1.67 b over 100 intervals.
TEST(Hertz, StickOfOneNodeIsKnownToASpacing)
{
   const auto run = run_miniapp("hertz", "-shear 1");
   ASSERT_EQ(run.code, 0) << run.output;
   int found = 0;
   for (const auto &row : run.results["references"])
   {
      if (row["quantity"] != "stick half-width / b, Q/fP = 1") { continue; }
      ++found;
      EXPECT_LE(row["computed"].get<double>(), 0.0334);
      EXPECT_GE(row["mesh"].get<double>(), 0.0333);
      EXPECT_FALSE(row["outside"].get<bool>()) << row;
   }
   EXPECT_EQ(found, 1) << run.output;
}

} // namespace
