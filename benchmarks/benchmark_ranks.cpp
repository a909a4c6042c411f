//  benchmark_ranks: condensation on several ranks, time, iterations and memory against dofs
//
//  A block of quadratic elements, held at the top, with a few contact nodes in the middle of
//  its lower side, condensed by the factor of one rank and by conjugate gradients with
//  BoomerAMG on all of them, one solve a contact dof. -weak multiplies the dofs by the number
//  of ranks.
//  docs/ranks.md explains what comes out; the largest there is -elements "112 224 354 500".
//
//     ./run --mpi benchmark_ranks -np 1
//     ./run --mpi benchmark_ranks -np 2
//     ./run --mpi benchmark_ranks -np 2 -weak

#include <cattaneo/contact/condense_body.hpp>
#include <common/miniapp.hpp>
#include <common/options.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>

using namespace cattaneo;
using nlohmann::ordered_json;

#ifdef MFEM_USE_MPI

namespace
{

/// Forgets the peak of memory so far, where the system allows.
void forget_peak()
{
   std::ofstream("/proc/self/clear_refs") << 5;
}

/// Peak of this rank's memory, MB; NaN where the system does not tell.
double peak()
{
   std::ifstream status("/proc/self/status");
   for (std::string word; status >> word;)
   {
      double kilobytes = 0;
      if (word == "VmHWM:" && status >> kilobytes) { return kilobytes / 1024; }
   }
   return std::numeric_limits<double>::quiet_NaN();
}

struct Options
{
   std::vector<double> sizes;
   std::string method;
   bool weak;
   int nodes;
};

/// A column of S, for the listed numbers of elements a side.
ordered_json condensation(const Options &options)
{
   ordered_json list = ordered_json::array();
   std::printf("%5s %9s  %-10s %8s %10s %9s %8s\n", "ranks", "dofs", "method", "seconds",
               "s/column", "its/col", "MB/rank");
   for (double side : options.sizes)
   {
      const int ranks = mfem::Mpi::WorldSize(), columns = static_cast<int>(side),
                rows = columns * (options.weak ? ranks : 1);
      mfem::Mesh whole = mfem::Mesh::MakeCartesian2D(
         columns, rows, mfem::Element::QUADRILATERAL, true, 1.0, double(rows) / columns);
      mfem::ParMesh mesh(MPI_COMM_WORLD, whole);
      whole.Clear();
      ElasticBody body(mesh, 2, Material{1.0, 0.3});
      for (int component : {0, 1}) { body.fix(3, component); }
      const double half = (options.nodes - 1) / 4.0 / columns * (1 + 1e-6),
                   middle = (columns / 2) / double(columns) +
                            ((options.nodes - 1) / 2 % 2 ? 0.5 / columns : 0.0);
      const ContactLine line =
         contact_line(body, BoundaryPart({1}, 0, middle - half, middle + half));
      for (const std::string name : {"factor", "iterations"})
      {
         if (options.method != name && options.method != "both") { continue; }
         CondenseSettings settings = miniapp::condensation();
         settings.direct_dofs = name == "factor" ? std::numeric_limits<int>::max() : 0;
         forget_peak();
         const auto count = static_cast<double>(2 * line.size());
         miniapp::Stopwatch watch;
         const CondensedBody condensed = condense(body, line, settings);
         const double seconds = body.ranks().max(watch.seconds()),
                      memory = body.ranks().max(peak());
         ordered_json row = {{"ranks", ranks},     {"dofs", body.dofs()},
                             {"method", name},     {"contact_dofs", count},
                             {"seconds", seconds}, {"seconds_per_column", seconds / count},
                             {"megabytes", memory}};
         std::printf("%5d %9d  %-10s %8.2f %10.3f", ranks, body.dofs(), name.c_str(), seconds,
                     seconds / count);
         if (name == "iterations")
         {
            row["iterations_per_column"] =
               static_cast<double>(condensed.counters.krylov_iterations) / count;
            std::printf(" %9.1f", row["iterations_per_column"].get<double>());
         }
         else { std::printf(" %9s", "-"); }
         std::printf(" %8.0f\n", memory);
         std::cout << std::flush;
         std::fflush(stdout);
         list.push_back(row);
      }
   }
   return list;
}

} // namespace

#endif

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         std::string method = "both", json;
         std::vector<double> sizes = {112, 224};
         bool weak = false;
         int nodes = 5;
         miniapp::Options args("benchmarks/benchmark_ranks.cpp", argc, argv);
         args.add(&sizes, "elements", "Elements a side: a list.");
         args.add(&nodes, "nodes", "Contact nodes.");
         args.add(&method, "method", "factor, iterations or both.",
                  {"factor", "iterations", "both"});
         args.add(&weak, {"weak", "strong"}, "Dofs in proportion to the ranks.");
         args.add(&json, "json", "File for the results.", miniapp::Text::output);
         args.parse();
         ordered_json results;
#ifdef MFEM_USE_MPI
         results["condensation"] = condensation({sizes, method, weak, nodes});
#else
         std::printf("This MFEM has no MPI: ./run --mpi benchmark_ranks -np 2\n");
#endif
         miniapp::write_json(results, json);
         return 0;
      });
}
