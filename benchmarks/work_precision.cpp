//  work_precision: error against whole run time and dofs, orders 1 to 4, uniform and graded
//
//  Problems with known answers: Hertz and Cattaneo-Mindlin, Lubkin's twisted spheres, the
//  square punch, the receding strip and disc, the lap joint, the shakedown limit of a punch.
//  Every run is a process of its own, from mesh to answer, on the exact path (no error of
//  increments).
//
//  Meshes: uniform - nodes of equal distance where contact can be; graded - toward corners and
//  toward the edges of contact and stick that a coarse run finds (its time is counted); nested
//  - the same by splitting elements in four (nonconforming); block - graded, of order 2, with a
//  meshed block in place of a half-plane, which has no mesh otherwise; default - the miniapp's
//  own. Away from the contact elements grow, and all are about halved from one level to the
//  next.
//
//  References are closed forms where there are any; else two runs of this library on another
//  discretisation (orders 5 and 6 on finer graded meshes), whose difference is the uncertainty.
//  Independent reference values are printed beside them. An error within the uncertainty is
//  printed as "<" and left out of rates and pictures.

#include "common/figure.hpp"
#include "common/known_problems.hpp"
#include "common/measure.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"
#include "common/text.hpp"

#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

using namespace cattaneo;
using namespace known;

namespace
{

struct Run
{
   Family family;
   int order = 0, level = 0;
   double nodes = 0, dofs = 0, seconds = 0, megabytes = 0;
   std::vector<double> error;
};

Measured measured(const Problem &problem, const Resolution &r)
{
   return in_own_process(
      [&]
      {
         const Answer answer = solve(problem, r);
         std::vector<double> all{answer.nodes, answer.dofs};
         all.insert(all.end(), answer.values.begin(), answer.values.end());
         return all;
      });
}

struct Reference
{
   double value, uncertainty;
};

std::vector<Reference> references(const Problem &problem)
{
   std::vector<Reference> result;
   const bool closed = std::all_of(problem.quantities.begin(), problem.quantities.end(),
                                   [](const Quantity &q) { return std::isfinite(q.exact); });
   Measured runs[2];
   for (int k = 0; k < 2 && !closed; ++k)
   {
      Resolution r = resolution(problem, Family::graded, 5 + k, problem.fine + k);
      r.finest = problem.finest / 4;
      r.corner = problem.corner / 16;
      r.growth = 1.12 - 0.03 * k;
      runs[k] = measured(problem, r);
      require(runs[k].ok, problem.name, ": the reference failed");
      std::printf("reference, order %d: %.0f nodes, %.0f dofs, %.2f s\n", 5 + k,
                  runs[k].values[0], runs[k].values[1], runs[k].cpu);
   }
   std::printf("%-20s %14s %10s   %s\n", "reference", "value", "+-", "independent");
   for (std::size_t q = 0; q < problem.quantities.size(); ++q)
   {
      const Quantity &quantity = problem.quantities[q];
      if (closed)
      {
         result.push_back({quantity.exact, 0});
         std::printf("%-20s %14.8g %10s   closed form\n", quantity.name, quantity.exact, "0");
         continue;
      }
      const double fine = runs[1].values[2 + q], other = runs[0].values[2 + q];
      result.push_back({fine, std::abs(fine - other)});
      std::printf("%-20s %14.8g %10.1e   %g +- %.1e\n", quantity.name, fine,
                  std::abs(fine - other), quantity.known, quantity.known_error);
   }
   return result;
}

/// Errors are over this.
double scale(const Reference &reference, const Quantity &quantity)
{
   return quantity.scale > 0 ? quantity.scale : std::abs(reference.value);
}

/// Error within the uncertainty of the reference?
bool within(const Reference &reference, const Quantity &quantity, double error)
{
   return error <= reference.uncertainty / scale(reference, quantity);
}

void print_rates(const std::vector<Run> &runs, const Problem &problem,
                 const std::vector<Reference> &reference)
{
   std::printf("%-8s %5d  observed rate against dofs:    ", name(runs.back().family),
               runs.back().order);
   for (std::size_t q = 0; q < problem.quantities.size(); ++q)
   {
      std::vector<double> x, y;
      for (const Run &run : runs)
      {
         if (within(reference[q], problem.quantities[q], run.error[q])) { continue; }
         x.push_back(run.dofs);
         y.push_back(run.error[q]);
      }
      std::printf(" %18.2f", log_slope(x, y));
   }
   std::printf("\n");
}

/// One line of the table, in print and in the file.
void write(const Problem &problem, const std::vector<Reference> &reference, const Run &run,
           std::ostream &table)
{
   std::printf("%-8s %5d %6.0f %7.0f %8.3f %6.0f", name(run.family), run.order, run.nodes,
               run.dofs, run.seconds, run.megabytes);
   for (std::size_t q = 0; q < reference.size(); ++q)
   {
      const Quantity &quantity = problem.quantities[q];
      const double uncertainty = reference[q].uncertainty / scale(reference[q], quantity);
      const bool resolved = !within(reference[q], quantity, run.error[q]);
      std::printf(" %10s%8.1e", resolved ? "" : "<", resolved ? run.error[q] : uncertainty);
      table << problem.name << ",\"" << problem.title << "\",\"" << quantity.name << "\","
            << name(run.family) << "," << run.order << "," << run.level << "," << run.nodes
            << "," << run.dofs << "," << run.seconds << "," << run.megabytes << ","
            << run.error[q] << "," << uncertainty << std::endl;
   }
   std::printf("\n");
   std::fflush(stdout);
}

/// A mesh of one kind: edges of contact and stick lie somewhere between the nodes, so that
/// errors of one mesh are luck; of a few of almost the same spacing they are not.
Run run(const Problem &problem, const std::vector<Reference> &reference, Family family,
        int order, int level, int samples, int &failed)
{
   Run result;
   result.family = family;
   result.order = order;
   result.level = level;
   result.error.resize(reference.size());
   int done = 0;
   for (int k = 0; k < samples; ++k)
   {
      Resolution r = resolution(problem, family, order, level);
      r.spacing /= 1 + 0.4 * k / samples;
      const Measured m = measured(problem, r);
      if (!m.ok)
      {
         ++failed;
         std::printf("(a %s mesh of order %d is left out)\n", name(family), order);
         continue;
      }
      ++done;
      result.nodes += m.values[0];
      result.dofs += m.values[1];
      result.seconds += m.cpu;
      result.megabytes = std::max(result.megabytes, m.megabytes);
      for (std::size_t q = 0; q < reference.size(); ++q)
      {
         result.error[q] += std::pow(m.values[2 + q] - reference[q].value, 2);
      }
   }
   for (double *sum : {&result.nodes, &result.dofs, &result.seconds}) { *sum /= done; }
   for (std::size_t q = 0; q < reference.size(); ++q)
   {
      result.error[q] =
         std::sqrt(result.error[q] / done) / scale(reference[q], problem.quantities[q]);
   }
   return result;
}

/// The least time of any mesh and order for errors of the shown quantity, and what the default
/// takes.
void print_buys(const std::vector<Run> &runs, const Problem &problem)
{
   const std::size_t q = 0;
   std::printf("cheapest for %s:", problem.quantities[q].name);
   for (double wanted : {1e-2, 1e-3, 1e-4, 1e-5})
   {
      const Run *best = nullptr;
      for (const Run &run : runs)
      {
         // Every finer run of the same kind must be as good: one lucky zero is no method.
         const bool lasting =
            std::all_of(runs.begin(), runs.end(),
                        [&](const Run &other)
                        {
                           return other.family != run.family || other.order != run.order ||
                                  other.level < run.level || other.error[q] <= wanted;
                        });
         if (lasting && (!best || run.seconds < best->seconds)) { best = &run; }
      }
      if (best)
      {
         std::printf("  %.0e %s p = %d, %.2f s;", wanted, name(best->family), best->order,
                     best->seconds);
      }
   }
   std::printf("\n");
}

/// Error of the first quantity against time and dofs; those within the uncertainty (the grey
/// band) are left out.
void draw(const Problem &problem, const std::vector<Reference> &reference,
          const std::vector<Run> &runs, std::vector<miniapp::Panel> &panels)
{
   const Quantity &quantity = problem.quantities[0];
   const double uncertainty = reference[0].uncertainty / scale(reference[0], quantity);
   for (const bool time : {true, false})
   {
      miniapp::Panel panel(miniapp::Panel::Kind::lines,
                           std::string(problem.name) + (time ? "_seconds" : "_dofs"),
                           std::string(problem.title) + ": " + quantity.name,
                           time ? "seconds (CPU)" : "dofs", "error");
      panel.say("scale", "loglog");
      if (uncertainty > 0) { panel.say("shade y", miniapp::text("1e-16,%g,", uncertainty)); }
      double least = 1;
      for (const Run &run : runs)
      {
         if (within(reference[0], quantity, run.error[0])) { continue; }
         least = std::min(least, run.error[0]);
         const bool standard = run.family == Family::standard;
         panel.add(standard ? "default mesh"
                            : miniapp::text("p = %d, %s", run.order, name(run.family)),
                   std::vector<double>{time ? run.seconds : run.dofs}, {run.error[0]},
                   standard ? "star" : "marked");
      }
      panel.limit("y", 0.5 * std::min(least, uncertainty > 0 ? uncertainty : least),
                  std::numeric_limits<double>::quiet_NaN());
      panels.push_back(panel);
   }
}

/// All meshes of one problem; `orders` of each kind.
void compare(const Problem &problem, const std::vector<double> &orders, int levels, int samples,
             std::ostream &table, std::vector<miniapp::Panel> &panels, int &failed)
{
   std::printf("\n%s\n", problem.title);
   const std::vector<Reference> reference = references(problem);
   std::printf("%-8s %5s %6s %7s %8s %6s", "mesh", "order", "nodes", "dofs", "seconds", "MB");
   for (const Quantity &q : problem.quantities) { std::printf(" %18s", q.name); }
   std::printf("\n");
   std::vector<Run> all;
   const auto add = [&](Family family, int order, int level)
   {
      const int count = family == Family::standard ? 1 : samples;
      all.push_back(run(problem, reference, family, order, level, count, failed));
      write(problem, reference, all.back(), table);
   };
   if (problem.standard) { add(Family::standard, 2, 0); }
   for (Family family : {Family::uniform, Family::graded, Family::nested, Family::block})
   {
      if (family == Family::nested && !problem.nested) { continue; }
      const bool block = family == Family::block;
      if (block && problem.domain == 0) { continue; }
      for (double order : block ? std::vector<double>{2} : orders)
      {
         for (int level = 0; level < levels; ++level)
         {
            add(family, static_cast<int>(order), level);
         }
         print_rates({all.end() - levels, all.end()}, problem, reference);
      }
   }
   print_buys(all, problem);
   draw(problem, reference, all, panels);
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         std::string wanted, csv, picture;
         std::vector<double> orders = {1, 2, 3, 4};
         int levels = 3, samples = 2;
         miniapp::Options args("benchmarks/work_precision.cpp", argc, argv);
         args.add(&wanted, "problems",
                  "Names: hertz lubkin punch strip disc lap_joint shakedown (all).");
         args.add(&orders, "orders", "Orders of the elements.");
         args.add(&levels, "levels", "Meshes of each kind and order.", miniapp::within(1, 8));
         args.add(&samples, "samples", "Meshes of slightly different spacing for each error.");
         args.add(&csv, "csv", "File for the table.", miniapp::Text::output);
         args.add(&picture, "plot", "File for the picture.", miniapp::Text::picture);
         args.parse();
         std::istringstream words(wanted);
         std::vector<std::string> names;
         for (std::string word; words >> word;)
         {
            const std::vector<Problem> all = problems();
            require(std::any_of(all.begin(), all.end(),
                                [&](const Problem &problem) { return word == problem.name; }),
                    "option --problems: there is no problem '", word, "'");
            names.push_back(word);
         }
         std::vector<miniapp::Panel> panels;
         std::ofstream table;
         if (!csv.empty())
         {
            table.open(csv);
            require(table.is_open(), "file '", csv, "' cannot be written");
         }
         table << "problem,title,quantity,mesh,order,level,nodes,dofs,seconds,megabytes,error,"
                  "uncertainty\n";
         const miniapp::Stopwatch watch;
         int failed = 0;
         for (const Problem &problem : problems())
         {
            if (!names.empty() &&
                std::find(names.begin(), names.end(), problem.name) == names.end())
            {
               continue;
            }
            compare(problem, orders, levels, samples, table, panels, failed);
         }
         std::printf("\n%.0f s in all\n", watch.seconds());
         table.close();
         require(csv.empty() || !table.fail(), "file '", csv, "' cannot be written");
         miniapp::draw(panels, "", picture);
         if (failed) { std::printf("%d runs failed\n", failed); }
         return failed ? 2 : 0;
      });
}
