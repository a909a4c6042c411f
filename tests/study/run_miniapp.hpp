#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>
#include <vector>

namespace cattaneo_test
{

struct Run
{
   int code = -1;
   std::string output;     ///< stdout and stderr
   nlohmann::json results; ///< of --json; null if the file was not written
};

/// Runs a miniapp as a user would, with --json, in the source folder; `launcher` goes before
/// its name (mpiexec and its options), `folder` is where the miniapp is.
inline Run run_miniapp(const std::string &name, const std::string &options,
                       const std::string &launcher = "",
                       const std::string &folder = CATTANEO_MINIAPP_DIR)
{
   const std::string file = testing::TempDir() + name + ".json";
   std::remove(file.c_str());
   const std::string command = std::string("cd '") + CATTANEO_SOURCE_DIR + "' && " + launcher +
                               " '" + folder + "/" + name + "' " + options + " --json '" +
                               file + "' 2>&1";
   Run run;
   FILE *pipe = popen(command.c_str(), "r");
   if (!pipe) { return run; }
   char buffer[4096];
   std::size_t count = 0;
   while ((count = fread(buffer, 1, sizeof buffer, pipe)) > 0)
   {
      run.output.append(buffer, count);
   }
   const int status = pclose(pipe);
   run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
   std::ifstream in(file);
   if (in.good()) { run.results = nlohmann::json::parse(in); }
   std::remove(file.c_str());
   return run;
}

/// NaN where a study has none.
inline double number(const nlohmann::json &value)
{
   return value.is_number() ? value.get<double>() : std::nan("");
}

/// What a test expects of a value that a study prints. All of it is written in the test: what a
/// program says of its own references and errors grades nobody.
struct Expected
{
   std::string quantity; ///< its row of the study's table
   double value;         ///< of a source that owes the program nothing
   double spread;        ///< ± of that source
   double mesh;          ///< what mesh, read-out and increments of this run may add
};

/// The study ends well and its table has these values, each within ±(spread + mesh).
inline void expect_values(const Run &run, const std::vector<Expected> &expected)
{
   ASSERT_EQ(run.code, 0) << run.output;
   ASSERT_TRUE(run.results.contains("references")) << run.output;
   for (const Expected &one : expected)
   {
      int found = 0;
      for (const auto &row : run.results["references"])
      {
         if (row["quantity"] != one.quantity) { continue; }
         ++found;
         ASSERT_TRUE(row["computed"].is_number()) << one.quantity << ": " << row;
         EXPECT_NEAR(row["computed"].get<double>(), one.value, one.spread + one.mesh)
            << one.quantity;
      }
      EXPECT_GE(found, 1) << "no row of '" << one.quantity << "' in\n" << run.output;
   }
}

} // namespace cattaneo_test
