//  plane_receding: an elastic strip pressed onto a similar half-plane, loaded and unloaded
//
//  Thesis chapter 5. The strip, of thickness t, ends at x = 0 and is pressed by p0 on its top
//  for x > n t; its end lifts off, and slip spreads between the separation point and a stick
//  zone. ξ = x - n t is counted from the end of the load, s = -ξ at separation, e = -ξ at the
//  border of stick. Loading is self-similar: one increment is exact. Unloading is marched with
//  steps that shrink with the load. Forward slip is +x of the strip; loading drags it to -x,
//  "backward". Units t = p0 = E' = 1, E' = E/(1-ν²).
//
//  Sample runs:  plane_receding
//                plane_receding -domain 1e4 -unload "0.9 0.5 0.2 0.1" -steps 50
//                plane_receding -friction 0.7 -unload "0.9 0.5 0.2 0.1" -march exact
//                plane_receding -obstacle th0 -friction 0.3 -order 1 -spacing 0.04
//                plane_receding -domain 1e4 -overhang 0.8 -friction 1.4
//                plane_receding -domain 1e4 -overhang 0.8 -bonded "0.1 0.18 0.3 0.5 0.8"
//                plane_receding -obstacle th0 -bonded "1.5 2"
//                plane_receding -spacing 0.05 -corner 0.01 -steps 9 -cycles 4 -cycle-to 0.5
//                plane_receding -map "0.4 0.8 1.2 1.6 2 3" -spacing 0.05 -corner 0.01
//                plane_receding -domain 1e4 -map 4 -map-friction "0.3 0.5 1"
//                plane_receding -obstacle th0 -unload 0.5
//                plane_receding -obstacle th0 -overhang 2 -unload 0.5

#include "common/bonded_strip.hpp"
#include "common/extent.hpp"
#include "common/receding_cycles.hpp"

#include <algorithm>
#include <array>
#include <cattaneo/input_error.hpp>

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using miniapp::exact_text;
using miniapp::nodes_before;
using miniapp::none;
using miniapp::overhang_load;
using miniapp::Panel;
using miniapp::Table;

namespace
{

/// One loaded or partly unloaded state. Its positions are ξ; the thesis counts s and e the
/// other way.
miniapp::Extent extent(const ReducedProblem &problem, const ContactState &state,
                       double overhang)
{
   return miniapp::extent(problem, state, false, -overhang);
}

void load(miniapp::Study &study, miniapp::Run &run, double overhang)
{
   run.to({{overhang_load(overhang), 1}});
   const miniapp::Extent found = extent(run.solver.problem(), run.state, overhang);
   study.title(
      miniapp::text("Loading, n = %g, f = %g", overhang, run.solver.problem().friction[0]));
   study.value("separation", -found.separation, "separation s/t", found.separation_error);
   study.value("stick_slip", -found.stick, "border of stick e/t", found.stick_error);
   study.value("separated_length",
               std::isfinite(found.separation) ? overhang + found.separation : 0.0);
   study.results["zones"] = miniapp::to_json(found.zones);
}

/// s and e over n for several f (thesis figure 5.3): one condensed pair serves all.
void map(miniapp::Study &study, ReducedProblem &problem, const std::vector<double> &overhangs,
         const std::vector<double> &frictions)
{
   const miniapp::Stopwatch watch;
   Table &table = study.table("map", {{"friction", "f", "%.3g"},
                                      {"overhang", "n", "%.4g"},
                                      {"separation", "s/t"},
                                      {"stick_slip", "e/t"},
                                      {"separated_length"}});
   table.draw("Separation s and border of stick e", "overhang", "overhang n",
              {{"separation", "s"}, {"stick_slip", "e"}}, "s/t (upper), e/t (lower)",
              {"friction", "f"});
   for (const auto &[n, value] : {std::pair{1.6, 1.1}, {1.6, -0.7}, {1.2, 0.9}, {1.2, -1.45}})
   {
      table.mark(n, value);
   }
   std::vector<std::vector<NodeState>> guesses(overhangs.size());
   for (double f : frictions)
   {
      set_friction(problem, f);
      miniapp::Run run(study, problem);
      for (std::size_t k = 0; k < overhangs.size(); ++k)
      {
         const double n = overhangs[k];
         run.state = ContactState::virgin(problem);
         // The states of the nodes at the friction before are where the search starts.
         if (!guesses[k].empty()) { run.state.status = guesses[k]; }
         run.to({{overhang_load(n), 1}});
         guesses[k] = run.state.status;
         const miniapp::Extent found = extent(problem, run.state, n);
         study.row(table,
                   {f, n, -found.separation, -found.stick,
                    std::isfinite(found.separation) ? n + found.separation : 0.0},
                   {{"separation", found.separation_error}, {"stick_slip", found.stick_error}});
      }
   }
   study.results["seconds_map"] = watch.seconds();
   study.say(
      miniapp::text("map of %zu states in %.2f s", table.json().size(), watch.seconds()));
}

/// Unloading from the loaded state (thesis 5.3.2), in steps that shrink with the load; reports
/// the wanted levels, and the slip of some points.
struct Unloading
{
   double overhang;
   int steps;
   double lowest;
   std::vector<double> wanted, points;
};

void unload(miniapp::Study &study, miniapp::Run &run, const Unloading &options)
{
   const ReducedProblem &problem = run.solver.problem();
   const VectorXd xi = problem.arc_length.array() - options.overhang;
   const std::string load = overhang_load(options.overhang);
   std::vector<miniapp::PointHistory> histories;
   for (double point : options.points) { histories.emplace_back(point, xi, run.state.v); }
   Panel &profiles = study.panel(Panel::Kind::lines, "tractions",
                                 "Pressure p and shear q over f", "ξ/t", "p/p0, q/(f p0)"),
         &diagram =
            study.panel(Panel::Kind::zones, "zones", "Zones during unloading", "p/p0", "ξ/t"),
         &slip = study.panel(Panel::Kind::lines, "slip", "Slip of points of the interface",
                             "p/p0", "v E'/(p0 t)");
   const auto add_profile = [&](double level, const ContactState &state)
   {
      profiles.add_tractions(exact_text("p/p0 = ", level), xi, problem, state, 0,
                             nodes_before(xi, 2.5));
   };
   add_profile(1, run.state);
   diagram.add(1.0, extent(problem, run.state, options.overhang).zones);

   Table &levels = study.table("levels", {{"level", "p/p0", "%.3f"},
                                          {"separation", "s/t"},
                                          {"stick_slip", "e/t"},
                                          {"border_1"},
                                          {"border_2"},
                                          {"border_3"},
                                          {"border_4"},
                                          {"zones", "zones and their right ends, ξ/t"}});
   const auto observe = [&](const ContactState &now, const IncrementRecord &)
   {
      const double level = named(problem, now.multipliers).at(load);
      const miniapp::Extent found = extent(problem, now, options.overhang);
      diagram.add(level, found.zones);
      const std::vector<NodeState> settled = settled_states(problem, now);
      for (miniapp::PointHistory &h : histories) { h.note(level, now.v, settled[h.node]); }
      const auto is = [&](double value) { return std::abs(level - value) < 1e-9; };
      if (std::none_of(options.wanted.begin(), options.wanted.end(), is)) { return; }
      std::vector<nlohmann::ordered_json> row = {level, -found.separation, -found.stick};
      std::vector<std::pair<std::string, double>> errors;
      miniapp::add_borders(found.zones, row, errors);
      row.push_back(miniapp::to_json(found.zones));
      study.row(levels, row, errors,
                {{"separation_error", found.separation_error},
                 {"stick_slip_error", found.stick_error}});
      add_profile(level, now);
   };
   std::vector<NamedLoads> loads;
   for (double level : miniapp::unloading_levels(options.steps, options.lowest, options.wanted))
   {
      loads.push_back({{load, level}});
   }
   run.settings.increments = 1;
   run.through(loads, observe);
   report_exact_path(study, run);
   study.results["unloading_increments"] = run.report.increments.size();

   Table &points = study.table("slip_histories", {{"xi", "ξ/t", "%.3f"},
                                                  {"slip_at_p0", "v at p0"},
                                                  {"slips_from", "sticks to", "%.3f"},
                                                  {"separates_at", "separates at", "%.3f"},
                                                  {"level_error", "±", "%.2g"}});
   for (const miniapp::PointHistory &h : histories)
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
   diagram.say("reversed: x");
   profiles.limit("x", -2, 2.5);
}

/// s and e as the block grows toward a half-plane.
void domain_study(miniapp::Study &study, miniapp::RecedingOptions options, double overhang,
                  double friction)
{
   study.title(miniapp::text("Domain study, n = %g, f = %g", overhang, friction));
   Table &table = study.table("domain_study", {{"length", "length", "%g"},
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
      miniapp::Scene scene = miniapp::make_receding(options);
      set_friction(scene.problem(), friction);
      study.counters += scene.reduction.counters;
      miniapp::Run run(study, scene.problem());
      run.to({{overhang_load(overhang), 1}});
      const miniapp::Extent found = extent(scene.problem(), run.state, overhang);
      study.row(table, {length, domain, side, -found.separation, -found.stick});
   }
}

void plane_receding(miniapp::Study &study)
{
   miniapp::RecedingOptions options;
   std::string obstacle = "half-plane", march_by = "advancing";
   double friction = 0.7;
   std::vector<double> map_n, map_f = {0.3, 0.5, 0.7, 1}, bonded_n, cycled;
   int cycles = 100;
   Unloading unloading{4, 50, 0.05, {}, {-0.5, 0, 0.5}};
   bool study_domain = false;
   study.option(&unloading.overhang, "overhang",
                "n: the strip's end to the edge of the load, in t.");
   study.option(&friction, "friction", "Coefficient of friction.", miniapp::positive);
   study.option(&obstacle, "obstacle",
                "What the strip lies on: half-plane, or th0, the thesis' block: --length 20 "
                "--domain 200 --side 80.",
                {"half-plane", "th0"});
   study.option(&options.domain, "domain", miniapp::domain_help, miniapp::none_or_above(1));
   study.option(&options.side, "side",
                "Block beyond the strip's end in t (0: as far as it is deep).");
   study.option(&options.length, "length", "Length of the strip in t.");
   study.option(&options.order, "order", "Order of the elements.");
   study.option(&options.spacing, "spacing", "Distance of the contact nodes, in t.");
   study.option(&options.corner, "corner",
                "Distance of the contact nodes at the strip's end, in t.");
   study.option(&options.poisson, "poisson", "Poisson's ratio of both bodies.");
   study.option(&unloading.wanted, "unload", "Unloading: list of p/p0 to report (empty: none).",
                miniapp::between(0, 1));
   study.option(&unloading.steps, "steps", "Unloading: steps of 1/steps of p0.",
                miniapp::at_least(2));
   study.option(&march_by, "march", miniapp::stepping_help, miniapp::stepping_choices);
   study.option(&unloading.lowest, "lowest",
                "Unloading: p/p0 at which it ends; steps shrink toward it.",
                miniapp::between(0, 1));
   study.option(&unloading.points, "slip", "Unloading: list of ξ/t whose slip is followed.");
   study.option(
      &cycled, "cycle-to",
      "Cycles of the load between p0 and less: list of the lowest p/p0 (empty: none).",
      miniapp::between(0, 1));
   study.option(&cycles, "cycles", "Cycles of the load, at most.", miniapp::at_least(1));
   study.option(&bonded_n, "bonded",
                "Bonded strips: list of n to draw, with the n at which their kind changes.",
                miniapp::positive);
   study.option(&map_n, "map", "Map of s and e: list of n (empty: none).");
   study.option(&map_f, "map-friction", "Map of s and e: list of f.", miniapp::positive);
   study.option(&study_domain, "domain-study", "Print s and e for growing domains.");
   study.parse();
   study.options().only_if(!map_n.empty(), {"map-friction"}, "goes with --map");
   study.options().only_if(!cycled.empty(), {"cycles"}, "goes with --cycle-to");
   study.options().only_if(!unloading.wanted.empty(), {"slip"}, "goes with --unload");
   if (obstacle == "th0")
   {
      require(options.domain == 0 && options.side == 0,
              "option --obstacle th0 is a block of its own, without --domain and --side");
      options.length = 20;
      options.domain = 200;
      options.side = 80;
   }
   const double overhang = unloading.overhang;
   require(map_n.empty() || !map_f.empty(),
           "option --map-friction is empty, must list the coefficients of the map");
   for (double point : unloading.points)
   {
      require(unloading.wanted.empty() ||
                 (point >= -overhang && point <= options.length - overhang),
              "option --slip: ", point, " must be on the strip, from ", -overhang, " to ",
              options.length - overhang, " (in t)");
   }
   options.overhangs = miniapp::joined_once(miniapp::joined_once({overhang}, map_n), bonded_n);

   miniapp::Scene scene = miniapp::make_receding(options);
   ReducedProblem &problem = scene.problem();
   set_friction(problem, friction);
   study.reduced(scene);
   miniapp::report_bonded(study, options, problem, overhang, bonded_n);

   miniapp::Run run(study, problem);
   load(study, run, overhang);
   if (!cycled.empty())
   {
      run.settings.increments = unloading.steps;
      miniapp::cycle_the_load(
         study, run,
         {overhang_load(overhang), cycled, cycles, -overhang, "ξ/t", "D E'/(p0 t)²"});
      run.settings = {};
   }
   if (!unloading.wanted.empty())
   {
      run.settings.stepping = miniapp::stepping(march_by);
      unload(study, run, unloading);
   }
   else
   {
      Panel &profiles = study.panel(Panel::Kind::lines, "tractions",
                                    "Pressure p and shear q over f", "ξ/t", "p/p0, q/(f p0)");
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
   return miniapp::Study::run("plane_receding", argc, argv, plane_receding);
}
