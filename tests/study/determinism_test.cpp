// The same input gives the same bits, run by run, as separate processes.

#include "run_miniapp.hpp"

#include <extent.hpp>

#include <cmath>

namespace
{

using cattaneo_test::Run;
using cattaneo_test::run_miniapp;

/// Without what is measured in seconds.
void drop_times(nlohmann::json &value)
{
   if (!value.is_structured()) { return; }
   for (auto item = value.begin(); item != value.end();)
   {
      if (value.is_object() && item.key().find("seconds") != std::string::npos)
      {
         item = value.erase(item);
         continue;
      }
      drop_times(*item);
      ++item;
   }
}

struct Result
{
   nlohmann::json results, state;
};

/// Two meshes, coupled contact, two cycles; the last state has every double to the last bit.
Result dovetail(int threads)
{
   const std::string file = testing::TempDir() + "determinism.json";
   const std::string environment = "OPENBLAS_NUM_THREADS=" + std::to_string(threads) +
                                   " OMP_NUM_THREADS=" + std::to_string(threads);
   Run run = run_miniapp("contact2d", "--case meshes/dovetail.json --save-state '" + file + "'",
                         environment);
   EXPECT_EQ(run.code, 0) << run.output;
   drop_times(run.results);
   std::ifstream in(file);
   Result result{run.results, nlohmann::json::parse(in)};
   std::remove(file.c_str());
   return result;
}

TEST(Determinism, TheSameThreadsGiveTheSameBits)
{
   const Result one = dovetail(1), two = dovetail(2);
   const Result one_again = dovetail(1), two_again = dovetail(2);
   ASSERT_TRUE(one.results.contains("total_dissipation"));
   ASSERT_FALSE(one.results.contains("seconds"));
   ASSERT_GT(one.state["v"].size(), 10u);
   EXPECT_EQ(one.results.dump(), one_again.results.dump());
   EXPECT_EQ(one.state.dump(), one_again.state.dump());
   EXPECT_EQ(two.results.dump(), two_again.results.dump());
   EXPECT_EQ(two.state.dump(), two_again.state.dump());
   // So small a problem is done by one thread, however many there are.
   EXPECT_EQ(one.results.dump(), two.results.dump());
   EXPECT_EQ(one.state.dump(), two.state.dump());
}

TEST(Determinism, ThreadsThatShareLargeFactorsGiveTheSameBitsAgain)
{
   // 3,002 unknowns, whose factors two threads share. Half a minute: ./test --all.
   if (cattaneo_test::extent() != cattaneo_test::Extent::full)
   {
      GTEST_SKIP() << "CATTANEO_STRESS=full runs it";
   }
   std::vector<std::string> found;
   for (int k = 0; k < 2; ++k)
   {
      cattaneo_test::Run run = run_miniapp("hertz", "-nodes 1501", "OPENBLAS_NUM_THREADS=2");
      ASSERT_EQ(run.code, 0) << run.output;
      drop_times(run.results);
      found.push_back(run.results.dump());
   }
   EXPECT_EQ(found[0], found[1]);
}

} // namespace
