#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>

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

} // namespace cattaneo_test
