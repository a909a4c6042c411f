//  shakedown: when a cyclically sheared contact stops slipping, with a proof on either side
//
//  Chapter 4 of the thesis: a square block, |x| < a, on an elastically similar half-plane is
//  pressed by P and sheared by a Q that goes to and fro between λmin P and λmax P. Which
//  friction coefficient does it take, or which load can it bear, for the slip to die out? Two
//  estimates, the exact limit by Melan's theorem with proven bounds on either side, the
//  adhesion of the monolith, marches in time. Units a = P = E' = 1, E' = E/(1-ν²).
//
//  Also for any contact saved with --save (or save() of a reduced problem): name the pattern
//  that is held and the one that is cycled; --closed keeps the nodes that stay closed in a
//  march.
//
//  Sample runs:  shakedown
//                shakedown -nodes 101 -find load -friction 1 -reversal -1 -march -cycles 30
//                shakedown -nodes 65 -map -adhesion-map
//                shakedown -nodes 33 -mesh-study "33 65 101"
//                shakedown -obstacle rigid -nodes 65 -friction 0.6 -starts 4

#include "common/miniapp.hpp"
#include "common/punch.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>

using namespace cattaneo;
using nlohmann::ordered_json;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

/// Ratio of shear to normal traction at the corner of a block that is stuck to a half-plane of
/// the same material (mode I of Williams' solution): the friction below which the corner itself
/// slips.
constexpr double corner_friction = 0.543075578837;
/// Williams' exponents λ of that corner, a wedge of 270°: tractions are sums of s^(λ - 1), s
/// the distance. The roots of sin(3πλ/2) = ± λ, the third of which is complex.
constexpr double corner_mode_1 = 0.544483736782, corner_mode_2 = 0.908529189846,
                 corner_mode_3 = 1.629257376760, corner_mode_3_imaginary = 0.231250545117;

/// JSON has no infinity.
ordered_json number(double value)
{
   return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

void print_limit(const char *what, const LimitReport &report)
{
   std::printf(
      "%-28s %.8f   proven between %.8f and %.8f\n%-28s %s; violation %.1e, %ld programmes, "
      "%d iterations, %.3f s\n",
      what, report.limit, report.lower, report.upper, "",
      report.message.empty() ? name(report.status) : report.message.c_str(), report.violation,
      report.counters.limit_solves, report.iterations, report.seconds);
}

void check_status(const LimitReport &report, int &code)
{
   if (report.status != LimitStatus::certified && report.status != LimitStatus::unlimited)
   {
      code = 2;
   }
}

/// The nodes that are closed throughout @a cycles cycles marched from rest.
std::vector<Eigen::Index> stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                                      double load_factor, int cycles)
{
   std::vector<bool> closed_so_far(problem.nodes(), true);
   const Eigen::MatrixXd vertices = cycle.multipliers(load_factor);
   std::vector<Eigen::VectorXd> points = {Eigen::VectorXd::Zero(cycle.constant.size()),
                                          cycle.constant};
   for (Eigen::Index j = 0; j < vertices.cols(); ++j) { points.push_back(vertices.col(j)); }
   points.push_back(points[2]);
   LoadHistory history = LoadHistory::through(points);
   history.cycle_start = 2;
   history.cycles = cycles;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, {},
                                    [&](const ContactState &now, const IncrementRecord &record)
                                    {
                                       if (record.time < 1) { return; }
                                       for (std::size_t i = 0; i < now.status.size(); ++i)
                                       {
                                          closed_so_far[i] =
                                             closed_so_far[i] && closed(now.status[i]);
                                       }
                                    });
   require(report.status == FrictionStatus::converged,
           "option --closed: the march ended with status '", name(report.status),
           "': ", report.message);
   std::vector<Eigen::Index> nodes;
   for (Eigen::Index i = 0; i < problem.nodes(); ++i)
   {
      if (closed_so_far[i]) { nodes.push_back(i); }
   }
   return nodes;
}

/// The load at which the mode I intensity of the pressure vanishes at the left corner, from a
/// fit of Williams' modes to the nodal tractions of both patterns, beyond the third element and
/// up to 5 % of the half-width. NaN on a mesh that is too coarse for it.
double corner_opening(const ReducedProblem &problem, const Eigen::VectorXd &held,
                      const Eigen::VectorXd &cycled, int order)
{
   const Eigen::Index first = 3 * order;
   Eigen::Index rows = 0;
   while (first + rows < problem.nodes() && problem.arc_length[first + rows] < 0.05) { ++rows; }
   constexpr Eigen::Index terms = 4;
   if (rows < 2 * terms) { return none; }
   Eigen::MatrixXd modes(rows, terms), tractions(rows, 2);
   for (Eigen::Index k = 0; k < rows; ++k)
   {
      const Eigen::Index i = first + k;
      const double s = problem.arc_length[i], phase = corner_mode_3_imaginary * std::log(s);
      // Over the leading term: relative misfits.
      const double singular = std::pow(s, corner_mode_1 - 1);
      const double regular = std::pow(s, corner_mode_3 - 1) / singular;
      modes.row(k) << 1, std::pow(s, corner_mode_2 - 1) / singular, regular * std::cos(phase),
         regular * std::sin(phase);
      tractions.row(k) << held[i], cycled[i];
      tractions.row(k) /= problem.weights[i] * singular;
   }
   const Eigen::MatrixXd K = modes.colPivHouseholderQr().solve(tractions);
   return -K(0, 0) / K(0, 1);
}

/// Columns of equal length with a header, for plotting.
void write_csv(const std::string &file, const std::vector<std::string> &header,
               const std::vector<Eigen::VectorXd> &columns)
{
   std::ofstream out(file);
   out.precision(10);
   for (std::size_t k = 0; k < header.size(); ++k) { out << (k ? "," : "") << header[k]; }
   out << '\n';
   for (Eigen::Index i = 0; i < columns[0].size(); ++i)
   {
      for (std::size_t k = 0; k < columns.size(); ++k)
      {
         out << (k ? "," : "") << columns[k][i];
      }
      out << '\n';
   }
   require(out.good(), "cannot write file '", file, "'");
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const miniapp::Stopwatch watch;
         miniapp::PunchOptions options;
         const char *obstacle = "half-plane";
         double friction = 0.85, lambda_max = 0.8, lambda_min = -0.4, reversal = none;
         const char *find = "both";
         bool map = false, adhesion = false, marches = false, closed_nodes = false;
         int cycles = 200, starts = 0;
         double corner = 0.01;
         const char *mesh_study = "", *reduced_file = "", *save_file = "", *csv = "",
                    *json = "";
         const char *held = "P", *cycled = "Q";

         mfem::OptionsParser args(argc, argv);
         args.AddOption(&friction, "-friction", "--friction",
                        "Coefficient of friction of the largest load and of the marches.");
         args.AddOption(&lambda_max, "-lambda-max", "--lambda-max",
                        "Largest cycled load, of the smallest friction and of the marches.");
         args.AddOption(&lambda_min, "-lambda-min", "--lambda-min", "Smallest cycled load.");
         args.AddOption(&reversal, "-reversal", "--reversal",
                        "R = λmin/λmax, instead of --lambda-min.");
         args.AddOption(
            &find, "-find", "--find",
            "The smallest friction for the loads, the largest load for the friction, "
            "or both: friction, load or both.");
         args.AddOption(&map, "-map", "--map", "-no-map", "--no-map",
                        "Largest load against friction for several R (figure 4.18).");
         args.AddOption(&adhesion, "-adhesion-map", "--adhesion-map", "-no-adhesion-map",
                        "--no-adhesion-map",
                        "Friction that prevents all slip under a monotonic load (figure 4.3).");
         args.AddOption(&marches, "-march", "--march", "-no-march", "--no-march",
                        "March in time from zero, optimal and negative optimal slip.");
         args.AddOption(&cycles, "-cycles", "--cycles", "Cycles of a march, at most.");
         args.AddOption(&starts, "-starts", "--starts",
                        "Random starts of the search for one that slips for ever (0: none).");
         args.AddOption(&corner, "-corner", "--corner",
                        "Share of the contact length that pointwise figures leave out at each "
                        "end, where nodal ratios do not converge.");
         args.AddOption(&mesh_study, "-mesh-study", "--mesh-study",
                        "Numbers of contact nodes to repeat the limits with.");
         args.AddOption(&obstacle, "-obstacle", "--obstacle",
                        "What the block stands on: rigid or half-plane.");
         args.AddOption(&options.poisson, "-poisson", "--poisson",
                        "Poisson's ratio of both bodies.");
         args.AddOption(&options.order, "-order", "--order", "Order of the elements.");
         args.AddOption(&options.nodes, "-nodes", "--nodes", "Contact nodes.");
         args.AddOption(
            &options.grading, "-grading", "--grading",
            "Size of the contact elements at the corners over the middle ones (1: uniform).");
         args.AddOption(&options.domain, "-domain", "--domain",
                        "Half-width and depth of the half-plane's block, in a.");
         args.AddOption(&reduced_file, "-reduced", "--reduced",
                        "A saved reduced problem instead of the punch.");
         args.AddOption(&held, "-held", "--held", "Load pattern that is held at 1.");
         args.AddOption(&cycled, "-cycled", "--cycled", "Load pattern that is cycled.");
         args.AddOption(&closed_nodes, "-closed", "--closed", "-no-closed", "--no-closed",
                        "Keep only the nodes that stay closed in a march of three cycles.");
         args.AddOption(&save_file, "-save", "--save", "File for the reduced problem.");
         args.AddOption(&csv, "-csv", "--csv", "Prefix of files with profiles, for plotting.");
         args.AddOption(&json, "-json", "--json", "File for the results.");
         miniapp::parse(args);

         miniapp::check_choice("--obstacle", obstacle, {"rigid", "half-plane"});
         miniapp::check_choice("--find", find, {"friction", "load", "both"});
         const bool find_friction = std::string(find) != "load";
         const bool find_load = std::string(find) != "friction";
         options.half_plane = std::string(obstacle) == "half-plane";
         require(lambda_max > 0, "option --lambda-max is ", lambda_max, ", must be positive");
         if (std::isnan(reversal)) { reversal = lambda_min / lambda_max; }
         require(friction > 0, "option --friction is ", friction, ", must be positive");
         require(corner >= 0 && corner < 0.5, "option --corner is ", corner,
                 ", must be at least 0 and below 0.5");
         require(starts >= 0, "option --starts is ", starts, ", must not be negative");
         const std::vector<double> study = miniapp::numbers("--mesh-study", mesh_study);
         const bool saved = *reduced_file != 0;
         const bool standard =
            !saved && options.half_plane && options.order > 1 && options.domain >= 1e3;

         // --- the contact
         // ---------------------------------------------------------------------
         miniapp::Punch punch;
         ReducedProblem problem;
         Counters counters;
         if (saved) { problem = load_reduced_problem(reduced_file); }
         else
         {
            punch = miniapp::make_punch(options);
            problem = punch.reduction.problem;
            counters += punch.reduction.counters;
         }
         set_friction(problem, friction);
         if (*save_file) { save(problem, save_file); }
         ordered_json results;
         int code = 0;
         ClosedContact part;
         const auto cycle_of = [&](double R)
         {
            LoadCycle cycle = held_and_cycled(problem, held, 1, cycled, R);
            // The forces that close an initial gap are always there.
            for (std::size_t k = 0; k < problem.patterns.size(); ++k)
            {
               if (problem.patterns[k].name == "gap") { cycle.constant[k] = 1; }
            }
            return cycle;
         };
         std::vector<Eigen::Index> always_closed;
         if (closed_nodes)
         {
            always_closed = stay_closed(problem, cycle_of(reversal), lambda_max, 3);
         }
         if (!problem.gap.isZero(0)) { problem = absorb_gap(problem); }
         const LoadCycle cycle = cycle_of(reversal);
         if (closed_nodes)
         {
            part = closed_contact(problem, always_closed);
            std::cout
               << part.closed.size() << " of " << problem.nodes()
               << " nodes stay closed; the limits assume that they do and that the others "
                  "stay open\n";
            results["closed_nodes"] = part.closed.size();
            problem = part.reduced;
         }
         const Eigen::VectorXd &arc = problem.arc_length;
         const double length = arc[arc.size() - 1] - arc[0];
         // In the tables x runs from -a to a.
         const auto x = [&](Eigen::Index i)
         { return saved ? arc[i] : arc[i] - arc[0] - 0.5 * length; };
         NodeList nodes;
         for (Eigen::Index i = 0; i < problem.nodes(); ++i)
         {
            const double end = std::min(arc[i] - arc[0], arc[arc.size() - 1] - arc[i]);
            if (end >= corner * length) { nodes.push_back(i); }
         }
         LimitProblem limit = limit_problem(problem, cycle);
         const double coupling = degree_of_coupling(problem);
         std::printf("%ld contact nodes, condensed in %.2f s; degree of coupling %.4f "
                     "(0: none, 1: most)\n",
                     static_cast<long>(problem.nodes()), watch.seconds(), coupling);
         results["coupling"] = coupling;
         results["contact_nodes"] = problem.nodes();

         miniapp::ReferenceTable table;
         // What the mesh adds: the extremes lie between nodes, at second order in their
         // spacing.
         const double mesh = 30.0 / std::pow(static_cast<double>(problem.nodes() - 1), 2);
         const bool thesis_loads =
            standard && lambda_max == 0.8 && std::abs(reversal + 0.5) < 1e-12;

         // --- the monolith
         // --------------------------------------------------------------------
         const Incipience opening = incipient_separation(problem, cycle, 0, nodes);
         const Incipience slip = incipient_slip(problem, cycle, 0, nodes);
         std::printf("\nMonolith, away from the ends: first slip at λ = %.4f",
                     slip.load_factor);
         if (slip.node >= 0) { std::printf(", x = %.3f", x(slip.node)); }
         std::printf("; first opening at λ = %.4f", opening.load_factor);
         if (opening.node >= 0) { std::printf(", x = %.3f", x(opening.node)); }
         std::printf("\n");
         results["first_slip"] = number(slip.load_factor);
         results["first_opening"] = number(opening.load_factor);
         if (standard)
         {
            const double corner_opens = corner_opening(problem, problem.patterns[0].p,
                                                       problem.patterns[1].p, options.order);
            if (std::isfinite(corner_opens))
            {
               std::printf("the trailing corner opens at λ = %.4f (fit of Williams' modes)\n",
                           corner_opens);
               table.add("corner opens at λ", 0.865, 0.002 + mesh, none, corner_opens);
            }
            results["corner_opening"] = number(corner_opens);
            const auto points = adhesion_map(problem, cycle, 0, {0.4, 0.6, 0.8}, nodes);
            const double expected[] = {0.7256, 1.1045, 1.5752};
            for (int k = 0; k < 3; ++k)
            {
               char label[64];
               std::snprintf(label, sizeof label, "full adhesion, f at λ = %g",
                             points[k].load_factor);
               table.add(label, expected[k], 3e-4 + mesh, none, points[k].friction);
            }
         }
         if (adhesion)
         {
            std::vector<double> factors;
            for (int k = 0; k <= 40; ++k) { factors.push_back(0.025 * k); }
            ordered_json list = ordered_json::array();
            std::printf("\n    λ     f, full adhesion   at x\n");
            for (Adhesion point : adhesion_map(problem, cycle, 0, factors, nodes))
            {
               const bool at_corner = standard && point.friction < corner_friction;
               if (at_corner) { point.friction = corner_friction; }
               const double place = at_corner ? 1.0 : x(point.node);
               std::printf("%6.3f   %12.4f   %12.3f\n", point.load_factor, point.friction,
                           place);
               list.push_back({{"load_factor", point.load_factor},
                               {"friction", number(point.friction)},
                               {"x", place}});
            }
            results["adhesion_map"] = list;
         }

         // --- smallest friction
         // ---------------------------------------------------------------
         LimitReport least;
         if (find_friction)
         {
            std::printf("\nSmallest friction for λ = %g … %g\n", lambda_max,
                        lambda_max * reversal);
            const PointwiseEstimate first = method1_friction(problem, cycle, lambda_max, nodes);
            std::printf("%-28s %.5f at x = %.3f\n", "method 1 (4.9)", first.value,
                        x(first.node));
            results["method1"] = number(first.value);
            if (problem.components() == 1)
            {
               const Method2Estimate second = method2_friction(limit, lambda_max, nodes);
               counters += second.counters;
               if (second.exists)
               {
                  std::printf("%-28s %.5f … %.5f over all residual tractions, %.5f for one\n",
                              "method 2", second.low, second.high, second.natural);
                  results["method2_low"] = number(second.low);
                  results["method2_high"] = number(second.high);
                  results["method2_natural"] = number(second.natural);
                  if (*csv)
                  {
                     Eigen::VectorXd place(problem.nodes());
                     for (Eigen::Index i = 0; i < place.size(); ++i) { place[i] = x(i); }
                     write_csv(std::string(csv) + "_residual.csv",
                               {"x", "lowest", "highest", "chosen"},
                               {place, second.residual_low.cwiseQuotient(problem.weights),
                                second.residual_high.cwiseQuotient(problem.weights),
                                second.natural_residual.cwiseQuotient(problem.weights)});
                  }
               }
               else { std::printf("%-28s none: %s\n", "method 2", second.message.c_str()); }
               if (thesis_loads)
               {
                  table.add("method 1, f", 0.8385, 1e-4 + mesh, 0.83, first.value);
                  table.add("method 2, least f", 0.783, 1e-3 + mesh, 0.87, second.low);
                  table.add("method 2, most f", 0.806, 1e-3 + mesh, 0.87, second.high);
               }
            }
            least = friction_limit(limit, lambda_max);
            counters += least.counters;
            check_status(least, code);
            print_limit("exact, f", least);
            results["friction_limit"] = number(least.limit);
            results["bound_lower"] = number(least.lower);
            results["bound_upper"] = number(least.upper);
            results["violation"] = least.violation;
            results["status"] = name(least.status);
            if (thesis_loads)
            {
               table.add("exact, f", 0.805, 1e-3, 0.85, least.limit);
               // With (4.10) as printed, whose coupling block is the transpose of (3.25)'s.
               ReducedProblem transposed = problem;
               transposed.B = problem.B.transpose().eval();
               const LimitReport other =
                  friction_limit(limit_problem(transposed, cycle), lambda_max);
               counters += other.counters;
               results["friction_limit_transposed"] = number(other.limit);
               table.add("exact with B transposed, f", 0.848, 1e-3, 0.85, other.limit);
            }
         }

         // --- largest load
         // --------------------------------------------------------------------
         LimitReport most;
         if (find_load || marches || starts > 0)
         {
            most = load_limit(limit);
            counters += most.counters;
            check_status(most, code);
         }
         if (find_load)
         {
            std::printf("\nLargest load for f = %g and R = %g\n", friction, reversal);
            const PointwiseEstimate first = method1_load(problem, cycle, nodes);
            std::printf("%-28s %.5f\n", "method 1 (4.9), λmax", first.value);
            print_limit("exact, λmax", most);
            results["method1_load"] = number(first.value);
            results["load_limit"] = number(most.limit);
            results["load_limit_lower"] = number(most.lower);
            results["load_limit_upper"] = number(most.upper);
            if (!find_friction)
            {
               results["bound_lower"] = number(most.lower);
               results["bound_upper"] = number(most.upper);
               results["violation"] = most.violation;
               results["status"] = name(most.status);
            }
            if (most.status == LimitStatus::certified)
            {
               const LowerLimitReport lower = lower_limit(limit, most);
               counters += lower.counters;
               std::printf("%-28s %s\n", "lower limit λ1", lower.message.c_str());
               if (lower.kind != LowerLimitKind::none)
               {
                  std::printf("%-28s %.6f\n", "", lower.value);
                  results["lower_limit"] = lower.value;
               }
               results["lower_limit_statement"] = lower.message;
               if (starts > 0)
               {
                  CounterExampleSettings search;
                  search.starts = starts;
                  search.transient.cycles = cycles;
                  const CounterExample found =
                     find_counter_example(limit, most, lower.value, search);
                  counters += found.counters;
                  std::printf("%-28s %s: %d marches", "", found.message.c_str(), found.marches);
                  if (found.found) { std::printf(", smallest λ %.6f", found.load_factor); }
                  std::printf("\n");
                  results["counter_example"] =
                     found.found ? number(found.load_factor) : nullptr;
                  results["quiet_up_to"] = found.quiet;
               }
            }
            if (closed_nodes && most.slip.size())
            {
               double overlap = std::numeric_limits<double>::infinity();
               const Eigen::MatrixXd vertices = cycle.multipliers(most.limit);
               for (Eigen::Index j = 0; j < vertices.cols() && !part.open.empty(); ++j)
               {
                  overlap =
                     std::min(overlap, part.open_gaps(most.slip, vertices.col(j)).minCoeff());
               }
               std::printf("%-28s %.3e: the assumption %s\n", "smallest gap of open nodes",
                           overlap, overlap >= 0 ? "holds" : "FAILS");
               results["smallest_open_gap"] = number(overlap);
            }
         }
         if (standard && find_load)
         {
            const auto ratio = [&](double R, double f)
            {
               limit.cycle = cycle_of(R);
               set_friction(limit.reduced, f);
               const LimitReport report = load_limit(limit);
               counters += report.counters;
               limit.cycle = cycle;
               set_friction(limit.reduced, friction);
               return report.limit / f;
            };
            table.add("exact, λ/f at R = -1, f = 0.85", 0.8040, 3e-4 + mesh, 0.68,
                      ratio(-1, 0.85));
            table.add("exact, λ/f at R = -1, f = 1", 0.8059, 3e-4 + mesh, none, ratio(-1, 1));
            table.add("exact, λ/f at R = -0.5, f = 0.85", 0.9915, 2e-4 + mesh, none,
                      ratio(-0.5, 0.85));
            limit.cycle = cycle_of(-1);
            table.add("method 1, λ/f at R = -1", 0.7273, 2e-4 + mesh, none,
                      method1_load(limit.reduced, limit.cycle, nodes).value / friction);
            limit.cycle = cycle;
         }

         // --- profiles for plots
         // --------------------------------------------------------------
         const LimitReport &best = find_friction ? least : most;
         const double at = find_friction ? lambda_max : most.limit;
         if (*csv && best.slip.size() && problem.components() == 1)
         {
            const StuckForces stuck = stuck_forces(problem, cycle);
            const Eigen::VectorXd &w = problem.weights;
            Eigen::VectorXd place(problem.nodes());
            for (Eigen::Index i = 0; i < place.size(); ++i) { place[i] = x(i); }
            const Eigen::VectorXd q_residual = problem.A * best.slip;
            const Eigen::VectorXd p_residual = problem.B * best.slip;
            write_csv(
               std::string(csv) + "_profiles.csv",
               {"x", "slip", "q_residual", "p_residual", "q_max", "p_max", "q_min", "p_min"},
               {place, best.slip, q_residual.cwiseQuotient(w), p_residual.cwiseQuotient(w),
                stuck.q(at).col(0).cwiseQuotient(w), stuck.p(at).col(0).cwiseQuotient(w),
                stuck.q(at).col(1).cwiseQuotient(w), stuck.p(at).col(1).cwiseQuotient(w)});
         }

         // --- marches
         // -------------------------------------------------------------------------
         if (marches)
         {
            std::printf("\nMarches at f = %g, λ = %g … %g (shaken down: loss below 1e-6)\n%18s "
                        "%12s %12s %8s %7s  outcome\n",
                        friction, lambda_max, lambda_max * reversal, "start", "first loss",
                        "last loss", "decay", "cycles");
            FrictionSolver solver(limit.reduced);
            TransientSettings settings;
            settings.cycles = cycles;
            const Eigen::VectorXd start = best.slip;
            ordered_json list = ordered_json::array();
            const double expected[] = {0.340, 0, 0.827}, tolerance[] = {1e-3, 1e-15, 0.017};
            const char *names[] = {"zero", "optimal", "negative optimal"};
            for (int k = 0; k < 3; ++k)
            {
               const double sign = k == 0 ? 0 : k == 1 ? 1 : -1;
               const TransientReport run =
                  transient(solver, limit, lambda_max, sign * start, settings);
               counters += run.counters;
               const bool any = !run.dissipation.empty();
               std::printf("%18s %12.4e %12.4e %8.3f %7zu  %s\n", names[k],
                           any ? run.dissipation[0] : none, any ? run.dissipation.back() : none,
                           run.decay, run.dissipation.size(),
                           run.status != FrictionStatus::converged ? name(run.status)
                           : run.shaken_down                       ? "shaken down"
                           : run.steady_cycle                      ? "cyclic slip"
                                                                   : "still slipping");
               list.push_back({{"start", names[k]},
                               {"dissipation", run.dissipation},
                               {"shaken_down", run.shaken_down},
                               {"decay", run.decay},
                               {"status", name(run.status)}});
               if (k == 0 && any) { results["dissipation_first_cycle"] = run.dissipation[0]; }
               if (any && thesis_loads && friction == 0.85 && find_friction)
               {
                  table.add(std::string("first loss from ") + names[k] + " slip", expected[k],
                            tolerance[k] + (k == 1 ? 0 : mesh), none, run.dissipation[0]);
               }
            }
            results["marches"] = list;
            if (most.slip.size() && most.status == LimitStatus::certified)
            {
               const TransientBracket bracket = transient_bracket(limit, most, 0.02, settings);
               for (const auto *side : {&bracket.below, &bracket.above})
               {
                  std::printf("2 %% %s the largest load (λ = %.4f):",
                              side == &bracket.below ? "below" : "above",
                              (*side)[0].load_factor);
                  for (const TransientReport &run : *side)
                  {
                     counters += run.counters;
                     std::printf(" %s,", run.status != FrictionStatus::converged
                                            ? name(run.status)
                                         : run.shaken_down ? "shaken down"
                                                           : "slipping");
                  }
                  std::printf(" from the same starts\n");
               }
            }
         }

         // --- maps and mesh study
         // -------------------------------------------------------------
         if (map)
         {
            const miniapp::Stopwatch map_watch;
            const double reversals[] = {-1, -0.75, -0.5, 0};
            std::printf("\nλmax/f by friction and R\n      f");
            for (const double R : reversals) { std::printf("   R = %5.2f", R); }
            std::printf("\n");
            LimitReport column[4];
            ordered_json list = ordered_json::array();
            for (int k = 0; k < 12; ++k)
            {
               const double f = 0.55 + 0.05 * k;
               std::printf("%7.2f", f);
               for (int r = 0; r < 4; ++r)
               {
                  limit.cycle = cycle_of(reversals[r]);
                  set_friction(limit.reduced, f);
                  LimitSettings settings;
                  if (k > 0) { settings.start = &column[r]; }
                  LimitReport next = load_limit(limit, settings);
                  counters += next.counters;
                  check_status(next, code);
                  column[r] = std::move(next);
                  std::printf("   %9.5f", column[r].limit / f);
                  list.push_back({{"friction", f},
                                  {"reversal", reversals[r]},
                                  {"load_limit", number(column[r].limit)},
                                  {"lower", number(column[r].lower)},
                                  {"upper", number(column[r].upper)}});
               }
               std::printf("\n");
            }
            limit.cycle = cycle;
            set_friction(limit.reduced, friction);
            results["map"] = list;
            results["map_seconds"] = map_watch.seconds();
            std::printf("48 certified limits in %.1f s\n", map_watch.seconds());
         }
         if (!study.empty() && !saved)
         {
            std::printf(
               "\n nodes     dofs   coupling   least f    λ/f at f = %g   R = -1: λ/f   "
               "seconds\n",
               friction);
            ordered_json list = ordered_json::array();
            for (const double n : study)
            {
               const miniapp::Stopwatch mesh_watch;
               miniapp::PunchOptions other = options;
               other.nodes = static_cast<int>(n);
               miniapp::Punch finer = miniapp::make_punch(other);
               LimitProblem on_mesh = limit_problem(
                  finer.reduction.problem,
                  held_and_cycled(finer.reduction.problem, held, 1, cycled, reversal));
               set_friction(on_mesh.reduced, friction);
               const LimitReport f = friction_limit(on_mesh, lambda_max);
               const LimitReport load = load_limit(on_mesh);
               const double beta = degree_of_coupling(on_mesh.reduced);
               on_mesh.cycle = held_and_cycled(finer.reduction.problem, held, 1, cycled, -1);
               const LimitReport reversed = load_limit(on_mesh);
               std::printf("%6d %8d %10.4f %9.6f %18.6f %13.6f %9.2f\n", other.nodes,
                           finer.dofs, beta, f.limit, load.limit / friction,
                           reversed.limit / friction, mesh_watch.seconds());
               list.push_back({{"nodes", other.nodes},
                               {"coupling", beta},
                               {"friction_limit", number(f.limit)},
                               {"load_limit", number(load.limit)},
                               {"load_limit_reversed", number(reversed.limit)}});
            }
            results["mesh_study"] = list;
         }

         table.print();
         if (thesis_loads && find_friction)
         {
            std::printf(
               "\nThe thesis' order, method 1 < exact < method 2, is the mirror of the right "
               "one: its (3.25) and (4.10)\ndisagree about B and Bᵀ, and the transposed "
               "coupling moves the limits to the other side of method 1.\n");
         }
         results["dofs"] = punch.dofs;
         results["seconds"] = watch.seconds();
         results["counters"] = miniapp::to_json(counters);
         results["references"] = table.json();
         miniapp::write_json(results, json);
         return code;
      });
}
