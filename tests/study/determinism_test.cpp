// The same input gives the same bits, run by run, as separate processes.

#include "run_miniapp.hpp"

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
   Run run = run_miniapp("contact", "--case meshes/dovetail.json --save-state '" + file + "'",
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
   // Another number of threads changes the order of the factorisation's sums.
   for (const char *name : {"total_dissipation", "peak_pressure"})
   {
      const double a = one.results[name], b = two.results[name];
      EXPECT_NEAR(a, b, 1e-10 * std::abs(a)) << name;
   }
   EXPECT_EQ(one.state["status"], two.state["status"]);
}

} // namespace
