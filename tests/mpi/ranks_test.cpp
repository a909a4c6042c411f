// The same studies on one, two and three ranks: the numbers of the JSON agree to 2e-9.
// (The reduced stiffness agrees to 1e-12; reading edges between nodes and the loss of a cycle
// multiply that.)

#include <cmath>
#include <gtest/gtest.h>
#include <run_miniapp.hpp>

using namespace cattaneo_test;
using nlohmann::json;

namespace
{

std::string ranks(int count)
{
   return std::string(MPIEXEC) + " -n " + std::to_string(count) + " --oversubscribe";
}

/// How much work was done, how long it took and what round-off was left may differ.
bool may_differ(const std::string &key)
{
   static const char *const words[] = {"seconds", "counters",    "residual",
                                       "error",   "asymmetry",   "imbalance",
                                       "memory",  "slip_change", "work_minus_d"};
   for (const char *word : words)
   {
      if (key.find(word) != std::string::npos) { return true; }
   }
   return false;
}

void expect_equal(const json &a, const json &b, const std::string &path)
{
   ASSERT_EQ(a.type(), b.type()) << path;
   if (a.is_object())
   {
      ASSERT_EQ(a.size(), b.size()) << path;
      for (const auto &[key, value] : a.items())
      {
         if (may_differ(key)) { continue; }
         ASSERT_TRUE(b.contains(key)) << path << "/" << key;
         expect_equal(value, b[key], path + "/" + key);
      }
   }
   else if (a.is_array())
   {
      ASSERT_EQ(a.size(), b.size()) << path;
      for (std::size_t k = 0; k < a.size(); ++k)
      {
         expect_equal(a[k], b[k], path + "/" + std::to_string(k));
      }
   }
   else if (a.is_number_float())
   {
      const double x = a.get<double>(), y = b.get<double>();
      EXPECT_LE(std::abs(x - y), 2e-9 * std::max(1e-3, std::abs(x)))
         << path << ": " << x << " and " << y;
   }
   else { EXPECT_EQ(a, b) << path; }
}

struct Study
{
   const char *name, *options;
};

class OnRanks : public testing::TestWithParam<Study>
{
};

} // namespace

TEST_P(OnRanks, GiveTheSameNumbers)
{
   const Study &study = GetParam();
   const cattaneo_test::Run alone = run_miniapp(study.name, study.options);
   ASSERT_EQ(alone.code, 0) << alone.output;
   for (int count : {2, 3})
   {
      SCOPED_TRACE(std::to_string(count) + " ranks");
      const cattaneo_test::Run shared = run_miniapp(study.name, study.options, ranks(count));
      ASSERT_EQ(shared.code, 0) << shared.output;
      expect_equal(alone.results, shared.results, "");
   }
}

INSTANTIATE_TEST_SUITE_P(Studies, OnRanks,
                         testing::Values(Study{"square_punch", "-order 1 -nodes 33"},
                                         Study{"square_punch",
                                               "-obstacle half-plane -nodes 33 -domain 50"},
                                         Study{"hertz", "-nodes 41 -domain 50"},
                                         Study{"lap_joint", "-spacing 0.05 -increments 8"}));

TEST(Ranks, AnErrorOnOneEndsAllWithOneMessage)
{
   for (const char *who : {"0", "1", "-1"})
   {
      SCOPED_TRACE(who);
      const std::string command =
         ranks(2) + " '" + ERROR_ON_ONE_RANK + "' " + who + " 2>&1; echo \"exit $?\"";
      FILE *pipe = popen(command.c_str(), "r");
      ASSERT_TRUE(pipe);
      std::string output;
      char buffer[4096];
      for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
      {
         output.append(buffer, n);
      }
      pclose(pipe);
      const auto first = output.find("error: the mesh is bad");
      EXPECT_NE(first, std::string::npos) << output;
      EXPECT_EQ(output.find("error: the mesh is bad", first + 1), std::string::npos) << output;
      EXPECT_NE(output.find("exit 1"), std::string::npos) << output;
   }
}
