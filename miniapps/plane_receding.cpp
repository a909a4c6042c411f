//  plane_receding: an elastic strip pressed onto a similar half-plane, loaded and unloaded
//
//  Thesis chapter 5. The strip, of thickness t, ends at x = 0 and is pressed by p0 on its top
//  for x > n t; its end lifts off, and slip spreads between the separation point and a stick
//  zone. ξ = x - n t is counted from the end of the load, s = -ξ at separation, e = -ξ at the
//  border of stick. Loading is self-similar: one increment is exact. Unloading is marched with
//  steps that shrink with the load. Forward slip is +x of the strip; loading drags it to -x,
//  "backward". Units: t = p0 = E' = 1, with E' = E/(1-ν²).
//
//  Sample runs:
//    plane_receding
//    plane_receding --domain 1e4 --unload "0.9 0.5 0.2 0.1" --increments 50
//    plane_receding --friction 0.7 --unload "0.9 0.5 0.2 0.1"
//    plane_receding --obstacle th0 --friction 0.3 --order 1 --spacing 0.04
//    plane_receding --domain 1e4 --overhang 0.8 --friction 1.4
//    plane_receding --domain 1e4 --overhang 0.8 --bonded "0.1 0.18 0.3 0.5 0.8"
//    plane_receding --obstacle th0 --bonded "1.5 2"
//    plane_receding --spacing 0.05 --corner 0.01 --increments 9 --cycles 4 --cycle-to 0.5
//    plane_receding --map-overhang "0.4 0.8 1.2 1.6 2 3" --spacing 0.05 --corner 0.01
//    plane_receding --domain 1e4 --map-overhang 4 --map-friction "0.3 0.5 1"
//    plane_receding --obstacle th0 --unload 0.5
//    plane_receding --obstacle th0 --overhang 2 --unload 0.5

#include "common/receding_study.hpp"
#include "plane_receding/bonded_strip.hpp"

#include <algorithm>
#include <array>
#include <cattaneo/input_error.hpp>

using namespace cattaneo;
using namespace miniapp;
using Eigen::VectorXd;

namespace
{

/// Zones of one loaded or partly unloaded state, by ξ. s and e count against ξ, as in the
/// thesis.
Extent extent(const ReducedProblem &problem, const ContactState &state, double overhang)
{
   Extent found = miniapp::extent(problem, state, false, -overhang);
   found.separation *= -1;
   found.stick *= -1;
   return found;
}

/// Length over which the strip lifts off, from its end.
double separated_length(const Extent &found, double overhang)
{
   return std::isfinite(found.separation) ? overhang - found.separation : 0.0;
}

void load(Study &study, Run &run, double overhang)
{
   run.leaves = false;
   run.to({{overhang_load(overhang), 1}});
   run.leaves = true;
   // If the state is one of several, it is shown before the study says so and ends.
   if (!has_state(run.report)) { run.leave(); }
   const Extent found = extent(run.solver.problem(), run.state, overhang);
   study.title(text("Loading, n = %g, f = %g", overhang, run.solver.problem().friction[0]));
   study.value("separation", found.separation, "separation s/t", found.separation_error);
   study.value("stick_slip", found.stick, "border of stick e/t", found.stick_error);
   study.value("separated_length", separated_length(found, overhang));
   study.results["zones"] = to_json(found.zones);
   if (run.report.status != FrictionStatus::converged) { run.leave(); }
}

/// s and e over n for several f (thesis figure 5.3): one condensed pair serves all.
void map(Study &study, const ReducedProblem &problem, const std::vector<double> &overhangs,
         const std::vector<double> &frictions)
{
   ResultTable &table = study.table("map", {{"friction", "f", "%.3g"},
                                            {"overhang", "n", "%.4g"},
                                            {"separation", "s/t"},
                                            {"stick_slip", "e/t"},
                                            {"separated_length"},
                                            {"status"}});
   table.draw("Separation s and border of stick e", "overhang", "overhang n",
              {{"separation", "s"}, {"stick_slip", "e"}}, "s/t (upper), e/t (lower)",
              {"friction", "f"});
   for (const auto &[n, value] : {std::pair{1.6, 1.1}, {1.6, -0.7}, {1.2, 0.9}, {1.2, -1.45}})
   {
      table.mark(n, value);
   }
   map_loads(
      study, table, problem, overhangs, frictions, overhang_load,
      [&](double f, double n, const Run &run)
      {
         const bool has = has_state(run.report);
         const Extent found = has ? extent(run.solver.problem(), run.state, n) : Extent();
         study.row(table,
                   {f, n, found.separation, found.stick,
                    has ? separated_length(found, n) : none, name(run.report.status)},
                   {{"separation", found.separation_error}, {"stick_slip", found.stick_error}});
      });
}

Receding receding(const ReducedProblem &problem, double overhang)
{
   return {overhang_load(overhang),
           {"level", "p/p0", "%.3f"},
           {"separation", "s/t"},
           {"stick_slip", "e/t"},
           "ξ/t",
           -overhang,
           "D E'/(p0 t)²",
           [&problem, overhang](const ContactState &state)
           { return extent(problem, state, overhang); }};
}

/// @param slipping points whose slip is followed, ξ
void unload(Study &study, Run &run, double overhang, const Unloading &unloading,
            const std::vector<double> &slipping)
{
   const ReducedProblem &problem = run.solver.problem();
   const VectorXd xi = problem.arc_length.array() - overhang;
   std::vector<PointHistory> histories;
   for (double point : slipping) { histories.emplace_back(point, xi, run.state.v); }
   const auto note = [&](double level, const ContactState &now)
   {
      const std::vector<NodeState> settled = settled_states(problem, now);
      for (PointHistory &h : histories) { h.note(level, now.v, settled[h.node]); }
   };
   const auto [profiles, diagram] =
      unload(study, run, receding(problem, overhang), unloading, note);
   Panel &slip = study.lines("slip", "Slip of points of the interface", "p/p0", "v E'/(p0 t)");
   report_exact_path(study, run);
   study.results["unloading_increments"] = run.report.increments.size();

   ResultTable &points =
      study.table("slip_histories", {{"xi", "ξ/t", "%.3f"},
                                     {"slip_at_p0", "v at p0"},
                                     {"slips_from", "sticks to", "%.3f"},
                                     {"separates_at", "separates at", "%.3f"},
                                     {"level_error_estimate", "± (estimate)", "%.2g"}});
   for (const PointHistory &h : histories)
   {
      study.row(points, {h.xi, h.slip[1], h.slips_from, h.separates_at, h.step}, {},
                {{"level", h.level}, {"slip", h.slip}});
      slip.add(exact_text("ξ/t = ", h.xi), h.level, h.slip);
   }
   if (problem.friction[0] == 0.7)
   {
      for (double border : {-1.1, -0.7, -0.2, 0.5}) { diagram.mark(0.5, border); }
      diagram.mark(1.0, -1.4);
      diagram.mark(1.0, 0.3);
   }
   diagram.limit("y", -2, 2.2);
   diagram.limit("x", 0, none);
   profiles.limit("x", -2, 2.5);
}

/// s and e as the block grows toward a half-plane.
void domain_study(Study &study, RecedingOptions options, double overhang, double friction)
{
   study.title(text("Domain study, n = %g, f = %g", overhang, friction));
   ResultTable &table = study.table("domain_study", {{"length", "length", "%g"},
                                                     {"domain", "domain", "%g"},
                                                     {"side", "side", "%g"},
                                                     {"separation", "s/t"},
                                                     {"stick_slip", "e/t"}});
   options.overhangs = {overhang};
   for (const auto &[length, domain, side] : {std::array<double, 3>{20, 200, 80},
                                              {20, 1e4, 1e4},
                                              {50, 1e3, 1e3},
                                              {100, 1e4, 1e4},
                                              {400, 1e5, 1e5},
                                              {100, 0, 0}}) // a half-plane without a mesh
   {
      options.length = length;
      options.domain = domain;
      options.side = side;
      Scene scene = make_receding(options);
      set_friction(scene.problem(), friction);
      study.counters += scene.reduction.counters;
      Run run(study, scene.problem());
      run.to({{overhang_load(overhang), 1}});
      const Extent found = extent(scene.problem(), run.state, overhang);
      study.row(table, {length, domain, side, found.separation, found.stick});
   }
}

void plane_receding(Study &study)
{
   RecedingOptions options;
   std::string obstacle = "half-plane";
   SteppingOptions stepping;
   double friction = 0.7;
   double overhang = 4;
   std::vector<double> map_n, map_f = {0.3, 0.5, 0.7, 1}, bonded_n, cycled,
                              slipping = {-0.5, 0, 0.5};
   int cycles = 100;
   Unloading unloading{
      50, 0.05, {}, "levels", "tractions", "Pressure p and shear q over f", "right", 2.5};
   bool study_domain = false;
   study.options().group("The contact");
   study.option(&overhang, "overhang",
                "Distance n from the strip's end to the edge of the load, in t (thickness of "
                "the strip).");
   study.option(&friction, "friction", "Coefficient of friction.", positive);
   study.option(&obstacle, "obstacle",
                "Body below the strip: half-plane, or th0, the block of the thesis (--length "
                "20 --domain 200 --side 80).",
                {"half-plane", "th0"});
   study.options().group("The mesh");
   study.option(&options.domain, "domain", domain_help, none_or_above(1));
   study.option(&options.side, "side",
                "Length of the block beyond the strip's end in t (0: the depth of the block).");
   study.options().group("The contact");
   study.option(&options.length, "length", "Length of the strip in t.", positive);
   study.options().group("The mesh");
   study.option(&options.order, "order", "Order of the elements.", within(1, 8));
   study.option(&options.spacing, "spacing", "Distance of the contact nodes, in t.",
                above_up_to(0, 0.5));
   study.option(&options.corner, "corner",
                "Distance of the contact nodes at the strip's end, in t.");
   study.options().group("The contact");
   study.option(&options.poisson, "poisson", "Poisson's ratio of both bodies.");
   study.options().group("Unloading and cycles");
   study.option(&unloading.wanted, "unload",
                "Unloading: values of p/p0 at which results are printed (empty: none).",
                between(0, 1));
   study.option(&unloading.steps, "increments", "Unloading: number of steps from p0 to zero.",
                at_least(2));
   stepping.declare_with_events(study);
   study.option(&unloading.lowest, "lowest",
                "Unloading: lowest p/p0, towards which the steps shrink.", between(0, 1));
   study.option(&slipping, "slip", "Unloading: places ξ/t whose slip is followed.");
   study.option(
      &cycled, "cycle-to",
      "Cycles of the load between p0 and less: list of the lowest p/p0 (empty: none).",
      between(0, 1));
   study.option(&cycles, "cycles", "Largest number of cycles of the load.", at_least(1));
   study.options().group("More results");
   study.option(&bonded_n, "bonded",
                "Bonded strips: values of n whose tractions are drawn; the n at which their "
                "kind changes is printed too.",
                positive);
   study.option(
      &map_n, "map-overhang",
      "Values of n of a map of the separation s and the border of stick e (empty: no map).");
   study.option(&map_f, "map-friction", "Values of f of the map of s and e.", positive);
   study.option(&study_domain, "domain-study", "Print s and e for growing domains.");
   study.options().renamed(
      {{"march", "stepping"}, {"steps", "increments"}, {"map", "map-overhang"}});
   study.parse();
   study.only_if(!map_n.empty(), {"map-friction"}, "goes with --map-overhang");
   study.only_if(!cycled.empty(), {"cycles"}, "goes with --cycle-to");
   study.only_if(!unloading.wanted.empty(), {"slip"}, "goes with --unload");
   if (obstacle == "th0")
   {
      require(options.domain == 0 && options.side == 0,
              "option --obstacle th0 makes its own block: leave out --domain and --side");
      options.length = 20;
      options.domain = 200;
      options.side = 80;
   }
   require(map_n.empty() || !map_f.empty(),
           "option --map-friction is empty, must list the coefficients of the map");
   for (double point : slipping)
   {
      require(unloading.wanted.empty() ||
                 (point >= -overhang && point <= options.length - overhang),
              "option --slip: ", point, " must be on the strip, from ", -overhang, " to ",
              options.length - overhang, " (in t)");
   }
   options.overhangs = joined_once(joined_once({overhang}, map_n), bonded_n);

   Scene scene = make_receding(options);
   ReducedProblem &problem = scene.problem();
   set_friction(problem, friction);
   study.reduced(scene);
   report_bonded(study, options, problem, overhang, bonded_n);

   Run run(study, problem);
   load(study, run, overhang);
   if (!cycled.empty())
   {
      run.settings.increments = unloading.steps;
      cycle_the_load(study, run, receding(problem, overhang), cycled, cycles);
      run.settings = {};
   }
   if (!unloading.wanted.empty())
   {
      stepping.set(run.settings);
      unload(study, run, overhang, unloading, slipping);
   }
   else
   {
      Panel &profiles =
         study.lines("tractions", "Pressure p and shear q over f", "ξ/t", "p/p0, q/(f p0)");
      const VectorXd xi = problem.arc_length.array() - overhang;
      profiles.add_tractions("p", xi, problem, run.state, 0, nodes_before(xi, 2.5));
      profiles.limit("x", -2, 2.5);
   }
   if (!map_n.empty()) { map(study, problem, map_n, map_f); }
   if (study_domain) { domain_study(study, options, overhang, friction); }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("plane_receding", argc, argv, plane_receding);
}
