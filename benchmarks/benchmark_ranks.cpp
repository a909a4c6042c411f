//  benchmark_ranks: condensation on several ranks, time, iterations and memory against dofs
//
//  A square block, quadratic elements, fixed at the top, with the contact nodes on a sixteenth
//  of its lower side. Run it under --mpi with -np 1 and 2: on one rank the direct factor
//  condenses, on several conjugate gradients with BoomerAMG, one solve a contact dof. -weak
//  multiplies the dofs by the number of ranks.
//
//     ./run --mpi benchmark_ranks -np 1
//     ./run --mpi benchmark_ranks -np 2

#include <cattaneo/condense/condensed_body.hpp>
#include <common/miniapp.hpp>
#include <cstdio>
#include <iostream>
#include <sys/resource.h>

using namespace cattaneo;

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const char *sizes = "150 300 500", *json = "";
         bool weak = false;
         mfem::OptionsParser args(argc, argv);
         args.AddOption(&sizes, "-elements", "--elements", "Elements a side: a list.");
         args.AddOption(&weak, "-weak", "--weak", "-strong", "--strong",
                        "Dofs in proportion to the ranks.");
         args.AddOption(&json, "-json", "--json", "File for the results.");
         miniapp::parse(args);
         nlohmann::ordered_json list = nlohmann::ordered_json::array();
         std::printf("\n ranks      dofs  contact  seconds  seconds/column  iterations/column  "
                     "MB of the largest rank\n");
         for (double side : miniapp::numbers("--elements", sizes))
         {
            const int ranks = Ranks(*miniapp::distribute(mfem::Mesh::MakeCartesian2D(
                                       16, 16, mfem::Element::QUADRILATERAL)))
                                 .size();
            const int rows = static_cast<int>(side) * (weak ? ranks : 1),
                      columns = static_cast<int>(side);
            const auto mesh = miniapp::distribute(mfem::Mesh::MakeCartesian2D(
               columns, rows, mfem::Element::QUADRILATERAL, true, 1.0, double(rows) / columns));
            const miniapp::Stopwatch watch;
            ElasticBody body(*mesh, 2, Material{1.0, 0.3});
            for (int component : {0, 1}) { body.fix(3, component); }
            const double half = 1.0 / 32;
            const ContactLine line =
               contact_line(body, BoundaryPart({1}, 0, 0.5 - half, 0.5 + half));
            const CondensedBody condensed = condense(body, line);
            const double seconds = watch.seconds();
            rusage usage{};
            getrusage(RUSAGE_SELF, &usage);
            const double memory = body.ranks().max(static_cast<double>(usage.ru_maxrss) / 1024);
            const long columns_solved = 2 * line.size();
            const double iterations =
               static_cast<double>(condensed.counters.krylov_iterations) / columns_solved;
            const int dofs = body.dofs();
            std::printf("%6d %9d %8ld %8.2f %15.4f %18.1f %10.0f\n", ranks, dofs,
                        columns_solved, seconds, seconds / columns_solved, iterations, memory);
            std::cout << std::flush;
            list.push_back({{"ranks", ranks},
                            {"dofs", dofs},
                            {"columns", columns_solved},
                            {"seconds", seconds},
                            {"iterations_per_column", iterations},
                            {"megabytes", memory}});
         }
         miniapp::write_json({{"condensation", list}}, json);
         return 0;
      });
}
