//  benchmark_size: time and memory of whole studies with thousands of contact nodes
//
//  The miniapp contact on two blocks of one row of quadratic elements each, of different
//  materials, pressed together and sheared to and fro in two cycles; the miniapp hertz, a pad
//  like what it is pressed on, where friction does not change the contact; and its block on a
//  half-plane, where it does: contact advances from one change of state to the next.
//  Everything that they do is included: meshes, condensation, march, bounds of uniqueness,
//  critical friction, output. Each is a process of its own, run once.

#include "common/measure.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

namespace
{

/// 2 long and 0.2 high on either side of y = 0; boundary 1 is below, 3 above.
std::string block(int nodes, bool upper)
{
   std::vector<double> x;
   for (int i = 0; i < nodes; i += 2) { x.push_back(2.0 * i / (nodes - 1)); }
   const mfem::Mesh mesh =
      cattaneo::rectangle_mesh(x, upper ? std::vector<double>{0, 0.2} : std::vector{-0.2, 0.0});
   std::ostringstream text;
   text.precision(17);
   mesh.Print(text);
   return text.str();
}

/// @return the command that solves it
std::vector<std::string> pair_of_blocks(int nodes, const std::filesystem::path &folder)
{
   for (const bool upper : {true, false})
   {
      cattaneo::write_whole(folder / (upper ? "upper.mesh" : "lower.mesh"),
                            block(nodes, upper));
   }
   nlohmann::json scene{{"version", 2},
                        {"history", {"P=0", "P=1", "Q=0.3", "Q=-0.3", "Q=0.3"}},
                        {"cycle-start", 2},
                        {"cycles", 2}};
   scene["bodies"]["upper"] = {{"mesh", "upper.mesh"},
                               {"young", 1},
                               {"poisson", 0.3},
                               {"load", {"P pressure 3 0.001", "Q traction 3 0.001 0"}}};
   scene["bodies"]["lower"] = {
      {"mesh", "lower.mesh"}, {"young", 2}, {"poisson", 0.2}, {"support", "1:xy"}};
   // Nodes match, one to one.
   scene["interfaces"]["face"] = {
      {"between", {"upper:1", "lower:3"}}, {"friction", 0.5}, {"pairing", 1e-6}};
   const std::string file = folder / "case.json";
   cattaneo::write_whole(file, scene.dump(3) + '\n');
   return {miniapp_program("contact"), "--case", file};
}

struct Study
{
   const char *name;
   std::function<std::vector<std::string>(int nodes)> command;
};

void table(const std::vector<int> &nodes, const std::vector<int> &threads,
           const std::filesystem::path &folder)
{
   const Study studies[] = {
      {"pair of blocks", [&](int n) { return pair_of_blocks(n, folder); }},
      {"like bodies",
       [](int n) -> std::vector<std::string> {
          return {miniapp_program("hertz"), "-nodes", std::to_string(n)};
       }},
      {"advancing pad", [](int n) -> std::vector<std::string> {
          return {miniapp_program("hertz"), "-body", "block", "-nodes", std::to_string(n)};
       }}};
   std::printf("%-16s %8s %8s %10s %12s %8s %14s\n", "study", "nodes", "threads", "seconds",
               "processor s", "GB", "times faster");
   for (const Study &study : studies)
   {
      for (const int n : nodes)
      {
         const std::vector<std::string> command = study.command(n);
         double first = 0;
         for (const int count : threads)
         {
            const Measured found = whole_process(command, count);
            first = first > 0 ? first : found.wall;
            std::printf("%-16s %8d %8d %10.2f %12.2f %8.2f %14.2f\n", study.name, n, count,
                        found.wall, found.cpu, found.megabytes / 1024, first / found.wall);
            std::fflush(stdout);
         }
      }
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         std::vector<double> nodes{1001, 2001}, threads{1, 2};
         miniapp::Options args("benchmarks/benchmark_size.cpp", argc, argv);
         args.add(&nodes, "nodes", "Contact nodes of each study, odd numbers.");
         args.add(&threads, "threads", "Threads of the dense linear algebra.");
         args.parse();
         for (const double n : nodes)
         {
            cattaneo::require(n >= 11 && std::fmod(n, 2) == 1, "-nodes has ", n,
                              ", it must have odd numbers of at least 11");
         }
         for (const double n : threads)
         {
            cattaneo::require(n >= 1 && n == std::floor(n), "-threads has ", n,
                              ", it must have positive whole numbers");
         }
         const std::filesystem::path folder =
            std::filesystem::temp_directory_path() / ("size_" + std::to_string(getpid()));
         const std::shared_ptr<void> removed(nullptr, [&](void *)
                                             { std::filesystem::remove_all(folder); });
         std::filesystem::create_directory(folder);
         table({nodes.begin(), nodes.end()}, {threads.begin(), threads.end()}, folder);
         return 0;
      });
}
