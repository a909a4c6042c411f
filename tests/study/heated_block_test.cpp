#include "run_miniapp.hpp"

namespace
{

using cattaneo_test::run_miniapp;

TEST(HeatedBlock, BadOptionsAreOneSentenceAndExitCodeOne)
{
   for (const char *options : {"-n 0", "-n -3", "-o 0", "-o -1", "-nu 0.5", "-nu -1", "-E 0"})
   {
      const auto run = run_miniapp("heated_block", options);
      EXPECT_EQ(run.code, 1) << options << run.output;
      EXPECT_NE(run.output.find("heated_block: option --"), std::string::npos)
         << options << run.output;
      EXPECT_TRUE(run.results.is_null()) << options;
   }
}

/// It grows by (1 + nu) alpha dT h = 0.0065 toward a plane at 1: nothing presses.
TEST(HeatedBlock, SaysThatItDoesNotReachThePlane)
{
   const auto run = run_miniapp("heated_block", "-g 1");
   EXPECT_EQ(run.code, 0) << run.output;
   EXPECT_NE(run.output.find("does not reach the plane"), std::string::npos) << run.output;
   EXPECT_EQ(run.output.find("pressure from"), std::string::npos) << run.output;
}

/// Friction so large has several answers from the first contact on, which is at no gap the
/// first load.
TEST(HeatedBlock, SaysWhereItIsNotUnique)
{
   const auto run = run_miniapp("heated_block", "-f 1e6");
   EXPECT_EQ(run.code, 2) << run.output;
   EXPECT_NE(run.output.find("from heat = "), std::string::npos) << run.output;
   EXPECT_NE(run.output.find("at node "), std::string::npos) << run.output;
}

} // namespace
