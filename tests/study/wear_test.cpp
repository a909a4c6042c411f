#include "study/run_miniapp.hpp"

#include <gtest/gtest.h>

namespace
{

using cattaneo_test::run_miniapp;

TEST(WearStudy, OptionsOfThePadAreNotForAReducedProblem)
{
   const std::string reduced =
      "--reduced problems/hertz.json --history 'P=0; P=1; Q=.2; Q=-.2; Q=.2' --cycle-start 2 "
      "--cycles 1 ";
   EXPECT_EQ(run_miniapp("wear", reduced).code, 0);
   for (const char *of_pad : {"--profile flat", "--flat 0.6", "--poisson 0.2", "--nodes 101",
                              "--order 1", "--shear 0.2"})
   {
      const auto refused = run_miniapp("wear", reduced + of_pad);
      EXPECT_EQ(refused.code, 1) << of_pad;
      EXPECT_NE(refused.output.find("of the pad"), std::string::npos) << refused.output;
   }
}

} // namespace
