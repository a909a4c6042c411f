//  benchmark_ranks: condensation on several ranks, time, iterations and memory against dofs
//
//  A block of quadratic elements, held at the top, with a few contact nodes in the middle of
//  its lower side, condensed by the factor of one rank and by conjugate gradients with
//  BoomerAMG on all of them: one solve a contact dof, or one for each product with a stiffness
//  that is applied and not formed. -weak multiplies the dofs by the number of ranks.
//  -contact presses a block, its lower side a parabola of as many nodes as are listed, onto a
//  rigid plane and shears it, with the stiffness applied and with it formed by iterations: the
//  increments after which forming it has paid.
//  docs/ranks.md explains what comes out; the largest there is -elements "112 224 354 500".
//
//     ./run --mpi benchmark_ranks -np 1
//     ./run --mpi benchmark_ranks -np 2
//     ./run --mpi benchmark_ranks -np 2 -weak
//     ./run --mpi benchmark_ranks -np 2 -elements "" -contact "65 129 257"

#include <cattaneo/contact/applied_reduction.hpp>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/applied_solver.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <common/miniapp.hpp>
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
   std::vector<double> sizes, contact;
   std::string method;
   bool weak;
   int nodes;
};

/// A column of S, and a product with it, for the listed numbers of elements a side.
ordered_json condensation(const Options &options)
{
   ordered_json list = ordered_json::array();
   std::printf("%5s %9s  %-10s %8s %10s %9s %9s %10s %8s\n", "ranks", "dofs", "method",
               "seconds", "s/column", "its/col", "s/product", "its/prod.", "MB/rank");
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
         settings.formed_nodes = 0;
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
            Counters counters;
            const AppliedProblem applied =
               apply_reduction(body, line, 0.0, settings, &counters);
            counters = {};
            const int products = 2;
            watch = {};
            for (int k = 0; k < products; ++k)
            {
               applied.apply(Eigen::VectorXd::LinSpaced(2 * line.size(), k, 2));
            }
            const double product = body.ranks().max(watch.seconds()) / products;
            row["iterations_per_column"] =
               static_cast<double>(condensed.counters.krylov_iterations) / count;
            row["seconds_per_product"] = product;
            row["iterations_per_product"] =
               static_cast<double>(counters.krylov_iterations) / products;
            std::printf(" %9.1f %9.3f %10.1f", row["iterations_per_column"].get<double>(),
                        product, row["iterations_per_product"].get<double>());
         }
         else { std::printf(" %9s %9s %10s", "-", "-", "-"); }
         std::printf(" %8.0f\n", memory);
         std::cout << std::flush;
         std::fflush(stdout);
         list.push_back(row);
      }
   }
   return list;
}

/// Pressed, then sheared: what an increment takes with the stiffness applied and formed.
ordered_json contact(const Options &options)
{
   ordered_json list = ordered_json::array();
   if (options.contact.empty()) { return list; }
   std::printf("\n%5s %9s %7s | %11s %9s %11s %8s | %8s %9s %11s %8s | %8s %10s\n", "ranks",
               "dofs", "contact", "active sets", "products", "s/increment", "MB/rank",
               "columns", "s to form", "s/increment", "MB/rank", "pays for", "forces");
   std::printf("%5s %9s %7s | %42s | %39s | %8s %10s\n", "", "", "nodes", "applied", "formed",
               "itself", "differ by");
   for (const double nodes : options.contact)
   {
      const int columns = (static_cast<int>(nodes) - 1) / 2, rows = std::max(8, columns / 4);
      mfem::Mesh whole = mfem::Mesh::MakeCartesian2D(
         columns, rows, mfem::Element::QUADRILATERAL, true, 1.0, 0.5);
      mfem::ParMesh mesh(MPI_COMM_WORLD, whole);
      whole.Clear();
      ElasticBody body(mesh, 2, Material{1.0, 0.3});
      body.add_displacement("press", 3, 1, -1.0);
      body.add_displacement("shear", 3, 0, 1.0);
      const ContactLine line = contact_line(body, 1);
      const auto gap = [](double x, double) { return 0.04 * (x - 0.5) * (x - 0.5); };
      const Eigen::Vector2d loads[] = {{4e-3, 0}, {4e-3, 3e-4}, {4e-3, 6e-4}, {4e-3, -3e-4}};
      const double increments = std::size(loads);

      CondenseSettings settings = miniapp::condensation();
      settings.direct_dofs = settings.formed_nodes = 0;
      forget_peak();
      AppliedProblem problem = apply_reduction(body, line, gap, settings);
      problem.friction.setConstant(0.3);
      ContactState state = virgin(problem);
      std::vector<Eigen::VectorXd> forces;
      double sets = 0, products = 0;
      miniapp::Stopwatch watch;
      for (const Eigen::Vector2d &load : loads)
      {
         const AppliedReport report = solve(problem, state, load);
         require(report.status == FrictionStatus::converged, "applied: ", report.message);
         sets += static_cast<double>(report.newton_steps) / increments;
         products += static_cast<double>(report.applications) / increments;
         forces.push_back(state.p);
         forces.push_back(state.q);
      }
      const double applied = body.ranks().max(watch.seconds()) / increments,
                   applied_memory = body.ranks().max(peak());

      forget_peak();
      watch = {};
      ReducedProblem reduced = reduce(condense(body, line, settings), gap).problem;
      const double forming = body.ranks().max(watch.seconds());
      set_friction(reduced, 0.3);
      FrictionSolver solver(reduced);
      ContactState formed = ContactState::virgin(reduced);
      double difference = 0;
      watch = {};
      for (std::size_t k = 0; k < std::size(loads); ++k)
      {
         const IncrementReport report = solver.solve(formed, loads[k]);
         require(report.status == FrictionStatus::converged, "formed: ", report.message);
         difference = std::max({difference, (formed.p - forces[2 * k]).cwiseAbs().maxCoeff(),
                                (formed.q - forces[2 * k + 1]).cwiseAbs().maxCoeff()});
      }
      const double dense = body.ranks().max(watch.seconds()) / increments,
                   formed_memory = body.ranks().max(peak());
      const double pays = forming / (applied - dense);
      difference /= formed.peak_force;
      const long columns_of_S = static_cast<long>(reduced.slips() + reduced.nodes());
      std::printf("%5d %9d %7d | %11.1f %9.0f %11.2f %8.0f | %8ld %9.2f %11.3f %8.0f | %8.1f "
                  "%10.1e\n",
                  body.ranks().size(), static_cast<int>(body.dofs()), static_cast<int>(nodes),
                  sets, products, applied, applied_memory, columns_of_S, forming, dense,
                  formed_memory, pays, difference);
      std::cout << std::flush;
      std::fflush(stdout);
      list.push_back({{"ranks", mfem::Mpi::WorldSize()},
                      {"dofs", body.dofs()},
                      {"nodes", nodes},
                      {"active_sets", sets},
                      {"products", products},
                      {"seconds_applied", applied},
                      {"megabytes_applied", applied_memory},
                      {"columns", columns_of_S},
                      {"seconds_to_form", forming},
                      {"seconds_formed", dense},
                      {"megabytes_formed", formed_memory},
                      {"increments_to_pay", pays},
                      {"force_difference", difference}});
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
         const char *sizes = "112 224", *nodes_of_contact = "", *method = "both", *json = "";
         bool weak = false;
         int nodes = 5;
         miniapp::Options args(argc, argv);
         args.AddOption(&sizes, "-elements", "--elements", "Elements a side: a list.");
         args.AddOption(&nodes, "-nodes", "--nodes", "Contact nodes.");
         args.AddOption(&method, "-method", "--method", "factor, iterations or both.");
         args.AddOption(&weak, "-weak", "--weak", "-strong", "--strong",
                        "Dofs in proportion to the ranks.");
         args.AddOption(&nodes_of_contact, "-contact", "--contact",
                        "Contact nodes (odd) of increments with S applied and formed: a list.");
         args.add(miniapp::Options::Names::output, &json, "-json", "--json",
                  "File for the results.");
         args.parse();
         miniapp::check_choice("--method", method, {"factor", "iterations", "both"});
         ordered_json results;
#ifdef MFEM_USE_MPI
         Options options = {{}, {}, method, weak, nodes};
         if (*sizes) { options.sizes = miniapp::numbers("--elements", sizes); }
         if (*nodes_of_contact)
         {
            options.contact = miniapp::numbers("--contact", nodes_of_contact);
         }
         results["condensation"] = condensation(options);
         results["contact"] = contact(options);
#else
         std::printf("This MFEM has no MPI: ./run --mpi benchmark_ranks -np 2\n");
#endif
         miniapp::write_json(results, json);
         return 0;
      });
}
