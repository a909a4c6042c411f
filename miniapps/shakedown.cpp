//  shakedown: when a cyclically sheared contact stops slipping, with a proof on either side
//
//  Chapter 4 of the thesis: a square block, |x| < a, on an elastically similar half-plane is
//  pressed by P and sheared by a Q that goes to and fro between λmin P and λmax P. Which
//  friction coefficient does it take, or which load can it bear, for the slip to die out? Two
//  estimates, the exact limit by Melan's theorem with bounds on either side that are proven for
//  a contact whose nodes all stay closed, the adhesion of the monolith, marches in time, which
//  say so where nodes open. A limit that is decided where tractions are singular is one of the
//  mesh, not of the bodies, and the result says that. Units a = P = E' = 1, E' = E/(1-ν²).
//
//  Also for any contact saved with --save (or save() of a reduced problem): name the pattern
//  that is held and the one that is cycled; --closed keeps the nodes that stay closed in a
//  march at the limit, and marches the whole contact on both sides of it.
//
//  Sample runs:  shakedown
//                shakedown -nodes 101 -find load -friction 1 -reversal -1 -march -cycles 30
//                shakedown -nodes 65 -map -adhesion-map
//                shakedown -nodes 33 -mesh-study "33 65 101"
//                shakedown -nodes 33 -mismatch "0.1 1 10"
//                shakedown -obstacle rigid -nodes 65 -friction 0.6 -starts 4

#include "common/punch.hpp"
#include "common/study_output.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <cmath>
#include <filesystem>
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

/// What the limits of this program assume.
constexpr const char *assumption = "all nodes of the contact stay closed throughout the cycle";

void print_limit(const char *what, const LimitReport &report)
{
   std::printf("%-28s ", what);
   if (report.status == LimitStatus::certified || report.status == LimitStatus::bracketed)
   {
      std::printf("%.8f   proven between %.8f and %.8f", report.limit, report.lower,
                  report.upper);
   }
   else { std::printf("none: %s", name(report.status)); }
   std::printf("\n%-28s %s; violation %.1e, %ld programmes, %d iterations, %.3f s\n", "",
               report.message.empty() ? name(report.status) : report.message.c_str(),
               report.violation, report.counters.limit_solves, report.iterations,
               report.seconds);
}

/// The nodes that are closed throughout @a cycles cycles marched from rest.
std::vector<Eigen::Index> stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                                      double load_factor, int cycles)
{
   std::vector<bool> closed_so_far(problem.nodes(), true);
   const Eigen::MatrixXd vertices = cycle.multipliers(load_factor);
   std::vector<NamedLoads> points = {{}, named(problem, cycle.constant)};
   for (Eigen::Index j = 0; j < vertices.cols(); ++j)
   {
      points.push_back(named(problem, vertices.col(j)));
   }
   points.push_back(points[2]);
   LoadHistory history = LoadHistory::through(problem, points);
   history.cycle_start = 2;
   history.cycles = cycles;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, {},
                                    [&](const ContactState &now, const IncrementRecord &record)
                                    {
                                       if (record.time < 1) { return; }
                                       const auto states = settled_states(problem, now);
                                       for (std::size_t i = 0; i < states.size(); ++i)
                                       {
                                          closed_so_far[i] =
                                             closed_so_far[i] && closed(states[i]);
                                       }
                                    });
   miniapp::warn_of_cut_off(report.cut_off);
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
   if (!miniapp::writes()) { return; }
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

/// What a march came to.
const char *outcome(const TransientReport &run)
{
   return run.verdict == TransientVerdict::no_equilibrium ? name(run.status)
                                                          : name(run.verdict);
}

/// False where the march ended early, for want of an equilibrium.
bool ended(const TransientReport &run)
{
   return run.status == FrictionStatus::converged || run.status == FrictionStatus::not_unique;
}

struct Options
{
   miniapp::PunchOptions punch;
   const char *obstacle = "half-plane";
   double friction = 0.85, lambda_max = 0.8, lambda_min = -0.4, reversal = none;
   const char *find = "both";
   bool map = false, adhesion_map = false, march = false, closed = false;
   int cycles = 200, starts = 0;
   double corner = 0.01;
   const char *mesh_study = "", *mismatch = "", *reduced = "", *save = "", *plot = "",
              *json = "";
   const char *held = "P", *cycled = "Q";

   void parse(int argc, char *argv[])
   {
      miniapp::Options args(argc, argv);
      args.AddOption(&friction, "-friction", "--friction",
                     "Coefficient of friction of the largest load and of the marches.");
      args.AddOption(&lambda_max, "-lambda-max", "--lambda-max",
                     "Largest cycled load, of the smallest friction and of the marches.");
      args.AddOption(&lambda_min, "-lambda-min", "--lambda-min", "Smallest cycled load.");
      args.AddOption(&reversal, "-reversal", "--reversal",
                     "R = λmin/λmax, instead of --lambda-min: -1 to and fro, 0 pulsating.");
      args.AddOption(&find, "-find", "--find",
                     "The smallest friction for the loads, the largest load for the friction, "
                     "or both: friction, load or both.");
      args.AddOption(&map, "-map", "--map", "-no-map", "--no-map",
                     "Largest load against friction for several R (figure 4.18).");
      args.AddOption(&adhesion_map, "-adhesion-map", "--adhesion-map", "-no-adhesion-map",
                     "--no-adhesion-map",
                     "Friction that prevents all slip under a monotonic load (figure 4.3).");
      args.AddOption(&march, "-march", "--march", "-no-march", "--no-march",
                     "March in time from zero, optimal and negative optimal slip.");
      args.AddOption(&cycles, "-cycles", "--cycles", "Cycles of a march, at most.");
      args.AddOption(&starts, "-starts", "--starts",
                     "Random starts of the search for one that slips for ever (0: none).");
      args.AddOption(
         &corner, "-corner", "--corner",
         "Share of the contact length that pointwise figures leave out at each end, "
         "where nodal ratios do not converge.");
      args.AddOption(&mesh_study, "-mesh-study", "--mesh-study",
                     "Numbers of contact nodes to repeat the limits with.");
      args.AddOption(
         &mismatch, "-mismatch", "--mismatch",
         "Stiffnesses of the half-plane over the block's to repeat the limits with.");
      args.AddOption(&obstacle, "-obstacle", "--obstacle",
                     "What the block stands on: rigid or half-plane.");
      // A block: on coarse meshes the corner's nodal forces are nearer to their limit with it.
      punch.domain = 1e4;
      add_options(args, punch);
      args.add(miniapp::Options::Names::input, &reduced, "-reduced", "--reduced",
               "A saved reduced problem instead of the punch.");
      args.AddOption(&held, "-held", "--held", "Load pattern that is held at 1.");
      args.AddOption(&cycled, "-cycled", "--cycled", "Load pattern that is cycled.");
      args.AddOption(&closed, "-closed", "--closed", "-no-closed", "--no-closed",
                     "Keep only the nodes that stay closed in three cycles at the largest load "
                     "(--lambda-max, or with --find load the limit).");
      miniapp::add_save_option(args, &save);
      args.add(miniapp::Options::Names::folder, &plot, "-plot", "--plot",
               "Directory for tables and figures 4.3, 4.9 and 4.15 to 4.19; makes the maps "
               "and the marches.");
      args.add(miniapp::Options::Names::output, &json, "-json", "--json",
               "File for the results.");
      args.parse();

      miniapp::check_choice("--obstacle", obstacle, {"rigid", "half-plane"});
      miniapp::check_choice("--find", find, {"friction", "load", "both"});
      require(lambda_max > 0, "option --lambda-max is ", lambda_max, ", must be positive");
      require(friction > 0, "option --friction is ", friction, ", must be positive");
      require(corner >= 0 && corner < 0.5, "option --corner is ", corner,
              ", must be at least 0 and below 0.5");
      require(cycles >= 1, "option --cycles is ", cycles, ", must be at least 1");
      require(starts >= 0, "option --starts is ", starts, ", must not be negative");
      punch.half_plane = std::string(obstacle) == "half-plane";
      if (std::isnan(reversal))
      {
         require(std::abs(lambda_min) <= lambda_max, "option --lambda-min is ", lambda_min,
                 ", must be between the negative and the positive value of --lambda-max, ",
                 lambda_max, " (call the larger load the largest)");
         reversal = lambda_min / lambda_max;
      }
      require(reversal >= -1 && reversal <= 1, "option --reversal is ", reversal,
              ", must be between -1 and 1");
      require(std::string(held) != cycled, "options --held and --cycled are both '", held,
              "', must be two load patterns");
      if (*plot) { map = adhesion_map = march = true; }
   }

   bool finds_friction() const { return std::string(find) != "load"; }
   bool finds_load() const { return std::string(find) != "friction"; }
};

class Study
{
public:
   explicit Study(const Options &options) : options(options) {}

   /// The exit code: 0, or 2 if a limit does not exist or was not certified, or a march ended
   /// early.
   int run()
   {
      prepare();
      monolith();
      if (options.finds_friction()) { smallest_friction(); }
      if (options.finds_load() || options.march || options.starts > 0) { largest_of_closed(); }
      if (options.finds_load()) { largest_load(); }
      if (*options.plot) { write_optimal(); }
      if (options.march) { marches(); }
      if (options.map) { limit_map(); }
      if (*options.mesh_study) { mesh_study(); }
      if (*options.mismatch) { mismatch(); }
      table.print();
      if (thesis_loads && options.finds_friction())
      {
         std::printf(
            "\nThe thesis' (3.25) and (4.10) disagree about B and Bᵀ: with the coupling "
            "transposed the exact limit is\nits 0.85. Where its values of the two "
            "estimates come from is not known.\n");
      }
      results["dofs"] = punch.dofs;
      results["seconds"] = watch.seconds();
      results["counters"] = miniapp::to_json(counters);
      results["references"] = table.json();
      miniapp::write_json(results, options.json);
      if (*options.plot)
      {
         miniapp::write_json(results, std::string(options.plot) + "/results.json");
         require(miniapp::run_plot_script("shakedown.py", {options.plot}),
                 "the tables are in '", options.plot,
                 "', but the figures could not be drawn: it needs python3 with matplotlib");
      }
      return code;
   }

private:
   void prepare()
   {
      saved = *options.reduced != 0;
      if (saved) { problem = load_reduced_problem(options.reduced); }
      else
      {
         punch = miniapp::make_punch(options.punch);
         problem = punch.reduction.problem;
         counters += punch.reduction.counters;
      }
      set_friction(problem, options.friction);
      gapped = problem;
      if (!problem.gap.isZero(0)) { problem = absorb_gap(problem); }
      whole = problem;
      if (options.closed) { keep_closed(options.lambda_max); }
      set_up();
      if (*options.save && miniapp::writes()) { save(gapped, options.save); }
      if (*options.plot && miniapp::writes())
      {
         std::filesystem::create_directories(options.plot);
      }
      std::printf(
         "%ld contact nodes, condensed in %.2f s; degree of coupling %.4f (0: none, 1: "
         "most)\n",
         static_cast<long>(problem.nodes()), watch.seconds(), limit.coupling);
      std::printf("The limits are those of a contact without separation: %s.\n", assumption);
      results["limit_assumption"] = assumption;
      results["coupling"] = limit.coupling;
      results["contact_nodes"] = problem.nodes();
      standard = !saved && options.punch.half_plane && options.punch.order > 1 &&
                 options.punch.unbounded();
      thesis_loads =
         standard && options.lambda_max == 0.8 && std::abs(options.reversal + 0.5) < 1e-12;
      // What the mesh adds: the extremes lie between nodes, at second order in their spacing.
      mesh_error = 30.0 / std::pow(static_cast<double>(problem.nodes() - 1), 2);
   }

   /// Leaves in the problem the nodes that stay closed in marches at this load.
   void keep_closed(double load_factor)
   {
      const NodeList always_closed =
         stay_closed(gapped, cycle_of(gapped, options.reversal), load_factor, 3);
      part = closed_contact(whole, always_closed);
      problem = part.reduced;
      std::printf("%zu of %ld nodes stay closed at λ = %g; the limits assume that they do and "
                  "that the others stay open\n",
                  part.closed.size(), static_cast<long>(whole.nodes()), load_factor);
      results["closed_nodes"] = part.closed.size();
   }

   /// What follows from the problem.
   void set_up()
   {
      cycle = cycle_of(problem, options.reversal);
      const Eigen::VectorXd &arc = problem.arc_length;
      const Eigen::Index n = problem.nodes();
      require(arc.size() == n && problem.weights.size() == n,
              "the reduced problem has no arc length or no weights");
      const double length = arc[n - 1] - arc[0];
      // In the tables x runs from -a to a.
      x = arc.array() - (saved ? 0.0 : arc[0] + 0.5 * length);
      inner = nodes_away_from_ends(problem, options.corner);
      limit = limit_problem(problem, cycle);
   }

   /// The limit; if it alone is asked for, on the nodes that stay closed at the limit itself.
   void largest_of_closed()
   {
      most = load_limit(limit);
      const int repetitions = options.closed && !options.finds_friction() ? 10 : 0;
      for (int k = 0; k < repetitions && most.status == LimitStatus::certified; ++k)
      {
         const NodeList before = part.closed;
         keep_closed(most.limit);
         if (part.closed == before) { break; }
         set_up();
         most = load_limit(limit);
      }
      note(most);
   }

   LoadCycle cycle_of(const ReducedProblem &of, double reversal) const
   {
      NamedLoads constant = {{options.held, 1}};
      // The forces that close an initial gap are always there.
      for (const LoadPattern &pattern : of.patterns)
      {
         if (pattern.name == "gap") { constant["gap"] = 1; }
      }
      return LoadCycle::through(of, constant,
                                {{{options.cycled, 1}}, {{options.cycled, reversal}}});
   }

   void note(const LimitReport &report)
   {
      counters += report.counters;
      if (report.status != LimitStatus::certified && report.status != LimitStatus::unlimited)
      {
         code = 2;
      }
   }

   void record_bounds(const LimitReport &report)
   {
      results["bound_lower"] = miniapp::json_number(report.lower);
      results["bound_upper"] = miniapp::json_number(report.upper);
      results["violation"] = miniapp::json_number(report.violation);
      results["status"] = name(report.status);
   }

   void monolith()
   {
      const Incipience opening = incipient_separation(problem, cycle, 0, inner);
      const Incipience slip = incipient_slip(problem, cycle, 0, inner);
      std::printf("\nMonolith, away from the ends: first slip at λ = %.4f", slip.load_factor);
      if (slip.node >= 0) { std::printf(", x = %.3f", x[slip.node]); }
      std::printf("; first opening at λ = %.4f", opening.load_factor);
      if (opening.node >= 0) { std::printf(", x = %.3f", x[opening.node]); }
      std::printf("\n");
      results["first_slip"] = miniapp::json_number(slip.load_factor);
      results["first_opening"] = miniapp::json_number(opening.load_factor);
      // Beyond this load a node has opened: nothing adheres there, whatever the friction.
      double opens = incipient_separation(problem, cycle, 0).load_factor;
      bool by_fit = false;
      if (standard)
      {
         const double corner_opens = corner_opening(
            problem, problem.patterns[problem.pattern(options.held)].p,
            problem.patterns[problem.pattern(options.cycled)].p, options.punch.order);
         if (std::isfinite(corner_opens))
         {
            std::printf("the trailing corner opens at λ = %.4f (fit of Williams' modes)\n",
                        corner_opens);
            table.add("corner opens at λ", 0.865, {0.002, mesh_error}, none, corner_opens);
            opens = std::min(opening.load_factor, corner_opens);
            by_fit = true;
         }
         results["corner_opening"] = miniapp::json_number(corner_opens);
         const double expected[] = {0.7256, 1.1045, 1.5752};
         const auto points = adhesion_map(problem, cycle, 0, {0.4, 0.6, 0.8}, inner);
         for (int k = 0; k < 3; ++k)
         {
            char label[64];
            std::snprintf(label, sizeof label, "full adhesion, f at λ = %g",
                          points[k].load_factor);
            table.add(label, expected[k], {3e-4, mesh_error}, none, points[k].friction);
         }
      }
      if (!options.adhesion_map) { return; }
      std::vector<double> factors;
      for (int k = 0; k <= 40; ++k) { factors.push_back(0.025 * k); }
      ordered_json list = ordered_json::array();
      std::printf("\n    λ     f, full adhesion   at x\n");
      for (Adhesion point : adhesion_map(problem, cycle, 0, factors, inner))
      {
         const bool open = point.load_factor > opens;
         const bool at_corner = standard && point.friction < corner_friction;
         if (at_corner) { point.friction = corner_friction; }
         const double place = at_corner ? 1.0 : x[point.node];
         if (open) { std::printf("%6.3f   %12s\n", point.load_factor, "open"); }
         else
         {
            std::printf("%6.3f   %12.4f   %12.3f\n", point.load_factor, point.friction, place);
         }
         list.push_back({{"load_factor", point.load_factor},
                         {"open", open},
                         {"friction", open ? nullptr : miniapp::json_number(point.friction)},
                         {"x", open ? nullptr : miniapp::json_number(place)}});
      }
      results["adhesion_map"] = list;
      results["adhesion_opens"] = miniapp::json_number(opens);
      std::printf("open: beyond λ = %.4f an end of the contact has opened, and no friction "
                  "adheres there (by %s)\n",
                  opens, by_fit ? "the fit" : "the nodal forces of this mesh");
      if (!standard) { return; }
      const Eigen::VectorXd ratios = traction_ratio(problem, cycle.constant);
      const double at_node =
         std::max(std::abs(ratios[0]), std::abs(ratios[problem.nodes() - 1]));
      results["corner_node_ratio"] = miniapp::json_number(at_node);
      std::printf("f = %.4f at x = 1 is the ratio of the singular tractions. The forces of the "
                  "corner's own node have the\nratio %.4f under P alone, which no mesh brings "
                  "to the tractions': with friction between the two a march\nslips at that "
                  "node and its next, by less the finer the mesh. That is an artefact.\n",
                  corner_friction, at_node);
   }

   void smallest_friction()
   {
      std::printf("\nSmallest friction for λ = %g … %g\n", options.lambda_max,
                  options.lambda_max * options.reversal);
      const PointwiseEstimate first =
         method1_friction(problem, cycle, options.lambda_max, inner);
      std::printf("%-28s %.5f at x = %.3f\n", "method 1 (4.9)", first.value, x[first.node]);
      results["method1"] = miniapp::json_number(first.value);
      if (problem.components() == 1) { method2(); }
      least = friction_limit(limit, options.lambda_max);
      note(least);
      print_limit("exact, f", least);
      say_if_of_the_mesh("friction", least, options.lambda_max, least.limit);
      results["friction_limit"] = miniapp::json_number(least.limit);
      record_bounds(least);
      if (!thesis_loads) { return; }
      table.add("method 1, f", 0.8385, {1e-4, mesh_error}, 0.83, first.value);
      table.add("exact, f", 0.805, 1e-3, 0.85, least.limit);
      // With (4.10) as printed, whose coupling block is the transpose of (3.25)'s.
      ReducedProblem transposed = problem;
      transposed.B() = problem.B().transpose().eval();
      complete(transposed); // rigid motions of the bodies do not belong to this matrix
      const LimitReport other =
         friction_limit(limit_problem(transposed, cycle), options.lambda_max);
      note(other);
      results["friction_limit_transposed"] = miniapp::json_number(other.limit);
      table.add("exact with B transposed, f", 0.848, {1e-3, mesh_error}, 0.85, other.limit);
   }

   void method2()
   {
      const Method2Estimate second = method2_friction(limit, options.lambda_max, inner);
      counters += second.counters;
      if (!second.exists)
      {
         std::printf("%-28s none: %s\n", "method 2", second.message.c_str());
         return;
      }
      std::printf("%-28s %.5f … %.5f over all residual tractions, %.5f for one\n", "method 2",
                  second.low, second.high, second.natural);
      results["method2_low"] = miniapp::json_number(second.low);
      results["method2_high"] = miniapp::json_number(second.high);
      results["method2_natural"] = miniapp::json_number(second.natural);
      if (thesis_loads)
      {
         table.add("method 2, least f", 0.783, {1e-3, mesh_error}, 0.87, second.low);
         table.add("method 2, most f", 0.806, {1e-3, mesh_error}, 0.87, second.high);
      }
      if (*options.plot)
      {
         write_csv(std::string(options.plot) + "/method2.csv",
                   {"x", "lowest", "highest", "chosen"},
                   {x, traction(second.residual_low), traction(second.residual_high),
                    traction(second.natural_residual)});
      }
   }

   void largest_load()
   {
      std::printf("\nLargest load for f = %g and R = %g\n", options.friction, options.reversal);
      const PointwiseEstimate first = method1_load(problem, cycle, inner);
      std::printf("%-28s %.5f\n", "method 1 (4.9), λmax", first.value);
      print_limit("exact, λmax", most);
      say_if_of_the_mesh("load", most, most.limit, options.friction);
      results["method1_load"] = miniapp::json_number(first.value);
      results["load_limit"] = miniapp::json_number(most.limit);
      results["load_limit_lower"] = miniapp::json_number(most.lower);
      results["load_limit_upper"] = miniapp::json_number(most.upper);
      results["load_limit_status"] = name(most.status);
      if (!options.finds_friction()) { record_bounds(most); }
      if (most.status == LimitStatus::certified) { lower(); }
      if (std::isfinite(most.upper) && !part.open.empty()) { check_open_nodes(); }
      if (!standard) { return; }
      const double f = options.friction;
      table.add("exact, λ/f at R = -1, f = 0.85", 0.8040, {3e-4, mesh_error}, 0.68,
                ratio(-1, 0.85));
      table.add("exact, λ/f at R = -1, f = 1", 0.8059, {3e-4, mesh_error}, none, ratio(-1, 1));
      table.add("exact, λ/f at R = -0.5, f = 0.85", 0.9915, {2e-4, mesh_error}, none,
                ratio(-0.5, 0.85));
      table.add("method 1, λ/f at R = -1", 0.7273, {2e-4, mesh_error}, none,
                method1_load(problem, cycle_of(problem, -1), inner).value / f);
   }

   /// Says of a limit that is decided where the stuck tractions are singular that it is one of
   /// the mesh: at an edge within the contact line, where the pressure falls to zero and the
   /// shear does not, and at the ends of the line, if the mechanism does much of its work
   /// there.
   void say_if_of_the_mesh(const std::string &what, const LimitReport &of, double load_factor,
                           double friction)
   {
      if (of.status != LimitStatus::certified && of.status != LimitStatus::bracketed)
      {
         return;
      }
      std::string why;
      const StuckForces stuck = stuck_forces(problem, cycle);
      for (std::size_t i = 0; i < part.closed.size(); ++i)
      {
         const Eigen::Index node = part.closed[i];
         const bool within = opens_next_to(node, node - 1) || opens_next_to(node, node + 1);
         const double shear = stuck.q1.row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff();
         if (within && shear > 1e-6 * stuck.q1.cwiseAbs().maxCoeff())
         {
            char text[200];
            std::snprintf(text, sizeof text,
                          "the contact ends within its line, at x = %.4f: there the pressure "
                          "falls to zero and the stuck shear is singular",
                          x[static_cast<Eigen::Index>(i)]);
            why = text;
         }
      }
      const double share = share_of_ends(of, stuck, load_factor, friction);
      results[what + "_limit_work_at_ends"] = miniapp::json_number(share);
      if (why.empty() && (share > 0.2 || (standard && friction < corner_friction)))
      {
         char text[200];
         std::snprintf(text, sizeof text,
                       "%.0f %% of the mechanism's work is done within 1 %% of the ends of the "
                       "contact line, where tractions are singular",
                       100 * share);
         why = text;
      }
      results[what + "_limit_of_the_mesh"] = !why.empty();
      if (why.empty()) { return; }
      why += what == "load"
                ? "; the figure falls with the spacing of the nodes and is no limit "
                  "of the bodies"
                : "; the figure rises as the spacing of the nodes falls and is no "
                  "limit of the bodies";
      std::printf("%-28s of this mesh only: %s\n", "", why.c_str());
      results[what + "_limit_statement"] = why;
   }

   /// Is @a other an open node on the contact line of @a node?
   bool opens_next_to(Eigen::Index node, Eigen::Index other) const
   {
      const auto on = [](const ContactChain &chain, Eigen::Index i)
      { return i >= chain.first && i < chain.first + chain.nodes; };
      for (const ContactChain &chain : whole.chains)
      {
         if (on(chain, node) && !on(chain, other)) { return false; }
      }
      return std::binary_search(part.open.begin(), part.open.end(), other);
   }

   /// Of the work that the mechanism of a limit dissipates, f p |slip|: the share within 1 % of
   /// the length from either end.
   double share_of_ends(const LimitReport &of, const StuckForces &stuck, double load_factor,
                        double friction) const
   {
      if (of.mechanism.slip.size() == 0) { return none; }
      const Eigen::Index n = problem.nodes();
      const Eigen::MatrixXd p =
         stuck.p(load_factor).colwise() + Eigen::VectorXd(problem.B() * of.slip);
      const double length = problem.arc_length[n - 1] - problem.arc_length[0];
      double at_ends = 0, all = 0;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double from_end = std::min(problem.arc_length[i] - problem.arc_length[0],
                                          problem.arc_length[n - 1] - problem.arc_length[i]);
         for (Eigen::Index j = 0; j < p.cols(); ++j)
         {
            const double work =
               friction * std::max(p(i, j), 0.0) *
               of.mechanism.slip(Eigen::seqN(i, problem.components(), n), j).norm();
            all += work;
            if (from_end < 0.01 * length) { at_ends += work; }
         }
      }
      return at_ends / all;
   }

   /// Of the nodes taken to stay open: their gaps at the limit, and marches of the whole
   /// contact in which they are free to close.
   void check_open_nodes()
   {
      double smallest = std::numeric_limits<double>::infinity();
      const Eigen::MatrixXd vertices = cycle.multipliers(most.limit);
      for (Eigen::Index j = 0; j < vertices.cols(); ++j)
      {
         smallest = std::min(smallest, part.open_gaps(most.slip, vertices.col(j)).minCoeff());
      }
      std::printf("%-28s %.3e: the assumption %s\n", "smallest gap of open nodes", smallest,
                  smallest >= 0 ? "holds" : "FAILS");
      results["smallest_open_gap"] = smallest;
      const LimitProblem all = limit_problem(whole, cycle_of(whole, options.reversal));
      FrictionSolver solver(whole);
      TransientSettings settings;
      settings.cycles = options.cycles;
      Eigen::VectorXd start = Eigen::VectorXd::Zero(whole.slips());
      for (std::size_t i = 0; i < part.closed.size(); ++i)
      {
         for (Eigen::Index c = 0; c < whole.components(); ++c)
         {
            start[c * whole.nodes() + part.closed[i]] =
               most.slip[c * problem.nodes() + static_cast<Eigen::Index>(i)];
         }
      }
      results["whole_contact"] = ordered_json::array();
      for (const double side : {-0.01, 0.01})
      {
         const TransientReport run =
            transient(solver, all, (1 + side) * most.limit, start, settings);
         miniapp::warn_of_cut_off(run.cut_off);
         counters += run.counters;
         const double loss = run.dissipation.empty() ? none : run.dissipation.back();
         std::printf("%-28s %s (",
                     side < 0 ? "whole contact, 1 % below" : "whole contact, 1 % above",
                     outcome(run));
         if (run.dissipation.empty()) { std::printf("in the first cycle)\n"); }
         else
         {
            std::printf("loss a cycle %.2e of the elastic energy, %zu cycles)\n",
                        loss / run.energy, run.dissipation.size());
         }
         results["whole_contact"].push_back(
            {{"load_factor", run.load_factor},
             {"outcome", outcome(run)},
             {"loss", miniapp::json_number(loss / run.energy)}});
      }
   }

   /// λ/f of the exact limit; leaves cycle and friction as they were.
   double ratio(double reversal, double f)
   {
      limit.cycle = cycle_of(problem, reversal);
      set_friction(limit.reduced, f);
      const LimitReport report = load_limit(limit);
      note(report);
      limit.cycle = cycle;
      set_friction(limit.reduced, options.friction);
      return report.limit / f;
   }

   /// λ1: what is proven, and what marches from many starts show.
   void lower()
   {
      const LowerLimitReport proven = lower_limit(limit, most);
      counters += proven.counters;
      std::printf("%-28s %s\n", "lower limit λ1", proven.message.c_str());
      if (proven.kind != LowerLimitKind::none)
      {
         std::printf("%-28s %.6f\n", "", proven.value);
         results["lower_limit"] = proven.value;
      }
      results["lower_limit_statement"] = proven.message;
      if (options.starts == 0)
      {
         if (proven.kind == LowerLimitKind::bound || proven.kind == LowerLimitKind::none)
         {
            std::printf("%-28s nothing was observed: --starts N marches from N random slips\n",
                        "");
         }
         return;
      }
      CounterExampleSettings search;
      search.starts = options.starts;
      search.transient.cycles = options.cycles;
      const CounterExample found = find_counter_example(limit, most, proven.value, search);
      counters += found.counters;
      std::printf("%-28s %s: %d marches", "", found.message.c_str(), found.marches);
      if (found.found) { std::printf(", smallest λ %.6f", found.load_factor); }
      std::printf("\n");
      results["counter_example"] =
         found.found ? miniapp::json_number(found.load_factor) : nullptr;
      results["quiet_up_to"] = found.quiet;
   }

   Eigen::VectorXd traction(const Eigen::VectorXd &force) const
   {
      return force.cwiseQuotient(problem.weights);
   }

   /// The limit whose optimal slip is drawn and marched from.
   const LimitReport &best() const { return options.finds_friction() ? least : most; }

   void write_optimal() const
   {
      const LimitReport &of = best();
      if (of.slip.size() == 0 || !std::isfinite(of.limit) || problem.components() != 1)
      {
         return;
      }
      // Permissible residual shear with the pressures of the optimal slip (figure 4.17).
      const double at = options.finds_friction() ? options.lambda_max : most.limit;
      const double f = options.finds_friction() ? least.limit : options.friction;
      const StuckForces stuck = stuck_forces(problem, cycle);
      const Eigen::VectorXd q_residual = problem.A() * of.slip,
                            p_residual = problem.B() * of.slip;
      const Eigen::MatrixXd q = stuck.q(at), p = stuck.p(at).colwise() + p_residual;
      write_csv(std::string(options.plot) + "/optimal.csv",
                {"x", "slip", "q_residual", "p_residual", "lowest", "highest"},
                {x, of.slip, traction(q_residual), traction(p_residual),
                 traction((-f * p - q).rowwise().maxCoeff()),
                 traction((f * p - q).rowwise().minCoeff())});
   }

   void marches()
   {
      if (best().slip.size() == 0) { return; }
      std::printf(
         "\nMarches at f = %g, λ = %g … %g (shaken down: the loss decays, and is below "
         "1e-6)\n%18s %12s %12s "
         "%8s %7s  outcome\n",
         options.friction, options.lambda_max, options.lambda_max * options.reversal, "start",
         "first loss", "last loss", "decay", "cycles");
      FrictionSolver solver(limit.reduced);
      Eigen::VectorXd optimal = best().slip;
      if (best().ray.size()) { optimal += options.lambda_max * best().ray; }
      TransientSettings settings;
      settings.cycles = options.cycles;
      ordered_json list = ordered_json::array();
      const char *names[] = {"zero", "optimal", "negative optimal"};
      const double signs[] = {0, 1, -1}, expected[] = {0.340, 0, 0.827};
      const miniapp::Allowed tolerance[] = {{1e-3, mesh_error}, 1e-15, {0.017, mesh_error}};
      bool opened = false;
      for (int k = 0; k < 3; ++k)
      {
         const TransientReport run =
            transient(solver, limit, options.lambda_max, signs[k] * optimal, settings);
         miniapp::warn_of_cut_off(run.cut_off);
         counters += run.counters;
         const bool any = !run.dissipation.empty();
         const double first = any ? run.dissipation.front() : none;
         if (any)
         {
            std::printf("%18s %12.4e %12.4e %8.3f %7zu  %s\n", names[k], first,
                        run.dissipation.back(), run.decay, run.dissipation.size(),
                        outcome(run));
         }
         else
         {
            std::printf("%18s %12s %12s %8s %7d  %s\n", names[k], "-", "-", "-", 0,
                        outcome(run));
         }
         if (!run.opened.empty())
         {
            std::printf("%20s%zu nodes open in the last cycle, x = %.4f … %.4f, and lose %.1e "
                        "in it\n",
                        "", run.opened.size(), x[run.opened.front()], x[run.opened.back()],
                        run.opened_loss);
            opened = true;
         }
         if (!run.message.empty()) { std::printf("%20s%s\n", "", run.message.c_str()); }
         if (!ended(run)) { code = 2; }
         list.push_back({{"start", names[k]},
                         {"dissipation", run.dissipation},
                         {"outcome", outcome(run)},
                         {"opened_nodes", run.opened.size()},
                         {"opened_loss", run.opened_loss},
                         {"decay", run.decay},
                         {"status", name(run.status)}});
         if (k == 0) { results["dissipation_first_cycle"] = miniapp::json_number(first); }
         if (any && thesis_loads && options.friction == 0.85 && options.finds_friction())
         {
            table.add(std::string("first loss from ") + names[k] + " slip", expected[k],
                      tolerance[k], none, first);
         }
      }
      results["marches"] = list;
      if (opened)
      {
         std::printf("Where nodes open the bounds above do not apply: they assume that %s.\n",
                     assumption);
      }
      if (most.status != LimitStatus::certified) { return; }
      const TransientBracket bracket = transient_bracket(limit, most, 0.005, settings);
      for (const auto *side : {&bracket.below, &bracket.above})
      {
         std::printf("0.5 %% %s the largest load (λ = %.4f):",
                     side == &bracket.below ? "below" : "above", side->front().load_factor);
         for (const TransientReport &run : *side)
         {
            counters += run.counters;
            std::printf(" %s,", outcome(run));
         }
         std::printf(" from the same starts\n");
         for (const TransientReport &run : *side) { miniapp::warn_of_cut_off(run.cut_off); }
      }
   }

   void limit_map()
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
         set_friction(limit.reduced, f);
         for (int r = 0; r < 4; ++r)
         {
            limit.cycle = cycle_of(problem, reversals[r]);
            LimitSettings settings;
            if (k > 0) { settings.start = &column[r]; }
            LimitReport next = load_limit(limit, settings);
            note(next);
            column[r] = std::move(next);
            std::printf("   %9.5f", column[r].limit / f);
            list.push_back({{"friction", f},
                            {"reversal", reversals[r]},
                            {"load_limit", miniapp::json_number(column[r].limit)},
                            {"lower", miniapp::json_number(column[r].lower)},
                            {"upper", miniapp::json_number(column[r].upper)}});
         }
         std::printf("\n");
      }
      limit.cycle = cycle;
      set_friction(limit.reduced, options.friction);
      results["map"] = list;
      results["map_seconds"] = map_watch.seconds();
      std::printf("48 limits in %.1f s\n", map_watch.seconds());
   }

   /// The limits of another punch, as a row of a table.
   ordered_json repeat(const miniapp::PunchOptions &other, const std::string &label)
   {
      const miniapp::Stopwatch other_watch;
      miniapp::Punch changed = miniapp::make_punch(other);
      const ReducedProblem &reduced = changed.reduction.problem;
      counters += changed.reduction.counters;
      LimitProblem on = limit_problem(reduced, cycle_of(reduced, options.reversal));
      set_friction(on.reduced, options.friction);
      const LimitReport f = friction_limit(on, options.lambda_max), load = load_limit(on);
      on.cycle = cycle_of(reduced, -1);
      const LimitReport reversed = load_limit(on);
      for (const LimitReport *report : {&f, &load, &reversed}) { note(*report); }
      std::printf("%12s %8d %9.4f %10.6f %10.6f %14.6f %9.2f\n", label.c_str(), changed.dofs,
                  on.coupling, f.limit, load.limit / options.friction,
                  reversed.limit / options.friction, other_watch.seconds());
      return {{"nodes", other.nodes},
              {"plane_stiffness", other.plane_stiffness},
              {"coupling", on.coupling},
              {"friction_limit", miniapp::json_number(f.limit)},
              {"load_limit", miniapp::json_number(load.limit)},
              {"load_limit_reversed", miniapp::json_number(reversed.limit)}};
   }

   void print_repeat_header(const char *what) const
   {
      std::printf("\n%12s     dofs  coupling    least f        λ/f    λ/f, R = -1   seconds   "
                  "(λ/f at f = %g)\n",
                  what, options.friction);
   }

   void mesh_study()
   {
      require(!saved, "option --mesh-study is for the punch, not for a saved problem");
      print_repeat_header("nodes");
      results["mesh_study"] = ordered_json::array();
      for (const double n : miniapp::numbers("--mesh-study", options.mesh_study))
      {
         miniapp::PunchOptions other = options.punch;
         other.nodes = static_cast<int>(n);
         results["mesh_study"].push_back(repeat(other, std::to_string(other.nodes)));
      }
   }

   void mismatch()
   {
      require(!saved, "option --mismatch is for the punch, not for a saved problem");
      print_repeat_header("plane/block");
      results["mismatch"] = ordered_json::array();
      for (const double stiffness : miniapp::numbers("--mismatch", options.mismatch))
      {
         miniapp::PunchOptions other = options.punch;
         other.half_plane = true;
         other.plane_stiffness = stiffness;
         char label[32];
         std::snprintf(label, sizeof label, "%g", stiffness);
         results["mismatch"].push_back(repeat(other, label));
      }
   }

   const Options &options;
   const miniapp::Stopwatch watch;
   bool saved = false;        ///< the contact comes from a file
   bool standard = false;     ///< the punch whose reference values are known, …
   bool thesis_loads = false; ///< … under the loads of chapter 4
   double mesh_error = 0;
   miniapp::Punch punch;
   ReducedProblem problem; ///< of the nodes that stay closed, if asked for
   ReducedProblem whole;   ///< with the others, …
   ReducedProblem gapped;  ///< … and as it was given, with its gap
   ClosedContact part;
   LoadCycle cycle;
   Eigen::VectorXd x;
   NodeList inner; ///< nodes away from the ends
   LimitProblem limit;
   LimitReport least, most;
   miniapp::ReferenceTable table;
   ordered_json results;
   Counters counters;
   int code = 0;
};

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         Options options;
         options.parse(argc, argv);
         return Study(options).run();
      });
}
