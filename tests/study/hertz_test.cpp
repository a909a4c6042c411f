#include "study/run_miniapp.hpp"

namespace
{

using cattaneo_test::expect_references_met;
using cattaneo_test::run_miniapp;

TEST(Hertz, HalfPlanesMeetTheClosedFormsAtBothOrders)
{
   for (const char *order : {"1", "2"})
   {
      const auto run =
         run_miniapp("hertz", std::string("--shear '0.3 0.6 0.9' -order ") + order);
      SCOPED_TRACE(run.output);
      expect_references_met(run, 5);
      // Two equal bodies: one factorisation. Uncoupled normal loading: one increment.
      EXPECT_EQ(run.results["counters"]["assemblies"], 2);
      EXPECT_EQ(run.results["counters"]["factorisations"], 1);
   }
}

TEST(Hertz, TractionsConvergeToTheClosedForms)
{
   // Mean over the line: of first order at least; single steps vary with where the edge of
   // contact lies in its element.
   double coarse = 0, fine = 0;
   for (const char *nodes : {"51", "451"})
   {
      const auto run = run_miniapp("hertz", std::string("-domain 1000 -nodes ") + nodes);
      ASSERT_EQ(run.code, 0) << run.output;
      coarse = fine;
      fine = run.results["pressure_deviation_mean"];
      EXPECT_NEAR(run.results["levels"][0]["stick_half_width"].get<double>(),
                  run.results["levels"][0]["cattaneo_mindlin"].get<double>(),
                  3.34 / (std::stod(nodes) - 1) * 0.15);
   }
   EXPECT_LT(fine, coarse / 9);
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
         expect_references_met(run, 2);
      }
   }
}

TEST(Hertz, CoupledContactNeedsManyIncrements)
{
   // The block's contact advances a layer of nodes at a time; forcing one step is wrong, and
   // the march does not allow it.
   const auto run = run_miniapp("hertz", "-body block --shear '' -increments 1");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_GT(run.results["counters"]["increments"].get<int>(), 15);
}

TEST(Hertz, BadOptionsAreOneSentenceAndExitCodeOne)
{
   for (const char *options : {"-body ball", "-ratio 1.5", "-span 0.5", "-nodes 8", "-domain 0",
                               "-friction -1", "-poisson 0.7", "--unknown"})
   {
      const auto run = run_miniapp("hertz", options);
      EXPECT_EQ(run.code, 1) << options << "\n" << run.output;
      EXPECT_NE(run.output.find("error:"), std::string::npos) << run.output;
      EXPECT_TRUE(run.results.is_null()) << options;
   }
}

} // namespace
