// The same studies on one, two and three ranks: the numbers of the JSON agree.

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

bool has(const std::string &key, std::initializer_list<const char *> words)
{
   for (const char *word : words)
   {
      if (key.find(word) != std::string::npos) { return true; }
   }
   return false;
}

/// Numbers agree to `tolerance` of themselves (of the largest in their list); times may differ,
/// and with a tolerance also how much work was done and what round-off was left.
void expect_equal(const json &a, const json &b, double tolerance, const std::string &path,
                  double scale = 0)
{
   ASSERT_EQ(a.type(), b.type()) << path;
   if (a.is_object())
   {
      ASSERT_EQ(a.size(), b.size()) << path;
      for (const auto &[key, value] : a.items())
      {
         // What a picture shows are these numbers again, beside the options, as those of MPI.
         if (has(key, {"seconds"}) || key == "shown") { continue; }
         if (tolerance > 0 && has(key, {"counters", "residual", "error", "asymmetry",
                                        "imbalance", "memory", "slip_change", "work_minus_d"}))
         {
            continue;
         }
         ASSERT_TRUE(b.contains(key)) << path << "/" << key;
         // What may cancel is measured by what it is a part of: tangential forces by the normal
         // one, components and moments of a force by that force (lengths are about 1 here).
         const auto size = [&](const char *x, const char *y)
         { return std::hypot(a[x].get<double>(), a[y].get<double>()); };
         double whole = 0;
         if (key == "tangential" && value.is_number() && a.contains("normal"))
         {
            whole = std::abs(a["normal"].get<double>());
         }
         if (value.is_number() && a.contains("force_x") && a["force_x"].is_number())
         {
            if (has(key, {"force_", "moment"})) { whole = size("force_x", "force_y"); }
            if (has(key, {"about_"})) { whole = std::max(1.0, size("about_x", "about_y")); }
         }
         expect_equal(value, b[key], tolerance, path + "/" + key, whole);
      }
   }
   else if (a.is_array())
   {
      ASSERT_EQ(a.size(), b.size()) << path;
      for (const json &value : a)
      {
         if (value.is_number()) { scale = std::max(scale, std::abs(value.get<double>())); }
      }
      for (std::size_t k = 0; k < a.size(); ++k)
      {
         expect_equal(a[k], b[k], tolerance, path + "/" + std::to_string(k), scale);
      }
   }
   else if (a.is_number_float())
   {
      const double x = a.get<double>(), y = b.get<double>();
      EXPECT_LE(std::abs(x - y), tolerance * std::max(scale, std::abs(x)))
         << path << ": " << x << " and " << y;
   }
   else { EXPECT_EQ(a, b) << path; }
}

struct Study
{
   const char *name, *options;
};

std::ostream &operator<<(std::ostream &out, const Study &study)
{
   return out << study.name << " " << study.options;
}

class OnRanks : public testing::TestWithParam<Study>
{
};

} // namespace

// Bodies that fit a factor are not distributed: the same bits.
TEST_P(OnRanks, GiveTheSameNumbers)
{
   const Study &study = GetParam();
   const cattaneo_test::Run alone = run_miniapp(study.name, study.options, ranks(1));
   ASSERT_EQ(alone.code, 0) << alone.output;
   ASSERT_FALSE(alone.results.empty());
   for (int count : {2, 3})
   {
      SCOPED_TRACE(std::to_string(count) + " ranks");
      const cattaneo_test::Run shared = run_miniapp(study.name, study.options, ranks(count));
      ASSERT_EQ(shared.code, 0) << shared.output;
      expect_equal(alone.results, shared.results, 0, "");
   }
}

// Another version of MFEM, built with other flags.
TEST_P(OnRanks, AgreesWithTheSerialFlavour)
{
   const char *serial = std::getenv("CATTANEO_SERIAL_MINIAPPS");
   if (!serial || !*serial)
   {
      GTEST_SKIP() << "CATTANEO_SERIAL_MINIAPPS does not name the miniapps of a serial build";
   }
   const Study &study = GetParam();
   const cattaneo_test::Run alone = run_miniapp(study.name, study.options, "", serial);
   const cattaneo_test::Run shared = run_miniapp(study.name, study.options, ranks(2));
   ASSERT_EQ(alone.code, 0) << alone.output;
   ASSERT_EQ(shared.code, 0) << shared.output;
   expect_equal(alone.results, shared.results, 1e-10, "");
}

INSTANTIATE_TEST_SUITE_P(
   Studies, OnRanks,
   testing::Values(
      Study{"square_punch", "-order 1 -nodes 33"},
      Study{"square_punch", "-obstacle half-plane -nodes 33 -cycles 2"},
      Study{"hertz", "-nodes 41"}, Study{"hertz", "-nodes 41 -body block -shear none"},
      Study{"plane_receding", "-spacing 0.1 -corner 0.02 -friction 0.7 -unload 0.5"},
      Study{"axisymmetric_receding", "-spacing 0.1 -torque 0.5"},
      Study{"lap_joint", "-spacing 0.05 -increments 8"}, Study{"shakedown", "-nodes 17"},
      Study{"fretting", "--pad fe --shear-load 50 --nodes 41"},
      Study{"contact", "-case meshes/rounded_punch.json"},
      Study{"contact", "-case meshes/bolted_joint.json -order 1 -cycles 1"}));

class Distributed : public testing::TestWithParam<Study>
{
};

// And where they are: iterations leave an error of their own, which edges that are read between
// nodes and the loss of a cycle multiply.
TEST_P(Distributed, GiveTheSameNumbersClosely)
{
   const Study &study = GetParam();
   const cattaneo_test::Run alone = run_miniapp(study.name, study.options, ranks(1));
   ASSERT_EQ(alone.code, 0) << alone.output;
   const cattaneo_test::Run shared =
      run_miniapp(study.name, std::string(study.options) + " -direct-dofs 0", ranks(2));
   ASSERT_EQ(shared.code, 0) << shared.output;
   EXPECT_GT(shared.results["counters"]["krylov_iterations"], 0);
   expect_equal(alone.results, shared.results, 2e-9, "");
}

INSTANTIATE_TEST_SUITE_P(
   Studies, Distributed,
   testing::Values(Study{"square_punch", "-order 1 -nodes 33"},
                   Study{"square_punch", "-obstacle half-plane -nodes 17 -domain 50"},
                   Study{"hertz", "-nodes 21 -domain 50"},
                   Study{"lap_joint", "-spacing 0.1 -increments 8"},
                   Study{"axisymmetric_receding", "-spacing 0.2 -torque 0.5"}));

TEST(Ranks, AnErrorOnOneEndsAllWithOneMessage)
{
   const std::pair<const char *, const char *> errors[] = {
      {"0", "error: the mesh is bad"},
      {"1", "error: the mesh is bad"},
      {"all", "error: the mesh is bad"},
      {"mesh", "must be finite"}, // of rank 1
      {"iterations", "error: condense: 1 iterations of conjugate gradients"}};
   for (const auto &[what, message] : errors)
   {
      SCOPED_TRACE(what);
      const std::string command =
         ranks(2) + " '" + ERROR_ON_ONE_RANK + "' " + what + " 2>&1; echo \"exit $?\"";
      FILE *pipe = popen(command.c_str(), "r");
      ASSERT_TRUE(pipe);
      std::string output;
      char buffer[4096];
      for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
      {
         output.append(buffer, n);
      }
      pclose(pipe);
      const auto first = output.find(message);
      EXPECT_NE(first, std::string::npos) << output;
      EXPECT_EQ(output.find("error: ", output.find("error: ") + 1), std::string::npos)
         << output;
      EXPECT_NE(output.find("exit 1"), std::string::npos) << output;
   }
}
