//  axisymmetric_receding: an elastic disc pressed onto a half-space, unloaded, or twisted
//
//  Thesis chapter 7. The disc, of thickness t and radius b, is pressed by p0 on its top for
//  r < a; beyond r = d it lifts off, and slip spreads between d and a stick zone r < c. Loading
//  is self-similar: one increment is exact. In torsion the pressure is constant, and the
//  program prescribes the rotation of the top, of its loaded part or of the rim (the torque
//  may then pass a maximum), or the torque itself, as a shear on the loaded part. The torque
//  of steady spinning is T_s = f Σ r p, with the pressure of the contact without friction.
//  Units: t = p0 = E = 1. Rotations are in p0/E. Torques are in p0 t³ and are those of the
//  whole circumference.
//
//  Sample runs:
//    axisymmetric_receding
//    axisymmetric_receding --unload "0.9 0.5 0.3 0.1" --spacing 0.04
//    axisymmetric_receding --torque "0.3 0.5 0.7" --spacing 0.04
//    axisymmetric_receding --torque "0.5 0.9" --twist traction --spacing 0.05
//    axisymmetric_receding --twist-cycles 3 --amplitude 0.6 --spacing 0.05 --increments 40
//    axisymmetric_receding --bonded "2.1 3.75 4.25 4.7" --map-load-radius "0.5 1 2 3 4"
//    axisymmetric_receding --critical "1 3 5"
//    axisymmetric_receding --map-load-radius "0.5 2.5" --map-friction "0.8 0.9" --spacing 0.05
//    axisymmetric_receding --critical 8
//    axisymmetric_receding --cycle-to 0.5 --cycles 6 --increments 20 --spacing 0.05
//    axisymmetric_receding --domain 100 --spacing 0.04

#include "axisymmetric_receding/disc_torsion.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <map>

using namespace cattaneo;
using namespace miniapp;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// The bonded disc (thesis 7.3), pressed at several radii.
void bonded(Study &study, Disc &disc, const std::vector<double> &wanted)
{
   const ReducedProblem &problem = disc.problem();
   // The node next to the axis sees little area; the last three, at the 270° corner, never
   // converge.
   const Index first = 1, count = problem.nodes() - 4;
   const VectorXd r = disc.radii().segment(first, count);
   study.title("Bonded disc (adhesion '-': it pulls, no friction keeps it together)");
   ResultTable &table = study.table("bonded", {{"load_radius", "a/t", "%.3g"},
                                               {"lowest_pressure", "lowest p/p0", "%.3e"},
                                               {"lowest_at", "at r/t", "%.3f"},
                                               {"adhesion_friction", "f for full adhesion"},
                                               {"p_05"},
                                               {"p_1"},
                                               {"p_2"},
                                               {"p_3"},
                                               {"p_4"}});
   Panel &panel = study.lines("bonded_pressure", "Bonded disc: pressure, shear (dashed)", "r/t",
                              "p/p0, q/p0");
   for (double a : wanted)
   {
      const LoadPattern &pattern = problem.patterns[problem.pattern(radius_load(a))];
      const VectorXd p = tractions(problem, pattern.p).segment(first, count),
                     q = tractions(problem, pattern.q.head(problem.nodes()))
                            .segment(first, count);
      Index low = 0;
      const double lowest = p.minCoeff(&low);
      std::vector<ordered_json> row = {
         a, lowest, r[low], lowest > 0 ? q.cwiseAbs().cwiseQuotient(p).maxCoeff() : none};
      for (double radius : {0.5, 1.0, 2.0, 3.0, 4.0})
      {
         Index i = 0;
         (r.array() - radius).abs().minCoeff(&i);
         row.push_back(radius < disc.options.disc_radius ? p[i] : none);
      }
      study.row(table, row);
      panel.add(exact_text("a = ", a), r, p);
      panel.add(exact_text("q: a = ", a), r, q, "dashed");
   }
}

/// @param levels P/P0 at which to draw: the zones are the same at each
void load(Study &study, Disc &disc, Run &run, const std::vector<double> &levels)
{
   if (!levels.empty())
   {
      Panel &profiles =
         study.lines("loading_tractions", "Pressure p and shear q over f, loading", "r/t",
                     "p/p0, q/(f p0)");
      for (double level : levels)
      {
         run.to(disc.pressed(level));
         profiles.add_tractions(exact_text("P/P0 = ", level), disc.radii(), disc.problem(),
                                run.state);
      }
   }
   run.leaves = false;
   run.to(disc.pressed());
   run.leaves = true;
   // If the state is one of several, it is shown before the study says so and ends.
   if (!has_state(run.report)) { run.leave(); }
   const Extent found = disc.extent(run.state);
   study.title(
      text("Loading, b = %g, a = %g, f = %g", disc.options.disc_radius, disc.a, disc.f));
   study.value("separation", found.separation, "separation d/t", found.separation_error);
   study.value("stick", found.stick, "border of stick c/t", found.stick_error);
   study.results.update(found.json());
   study.lines("tractions", "Pressure p and shear q over f", "r/t", "p/p0, q/(f p0)")
      .add_tractions("loaded", disc.radii(), disc.problem(), run.state);
   Panel &zones =
      study.panel(Panel::Kind::zones, "loading_zones", "Zones during loading", "P/P0", "r/t");
   for (double level : {0, 1}) { zones.add(level, found.zones); } // self-similar
   if (run.report.status != FrictionStatus::converged) { run.leave(); }
}

/// c and d over a for several f (thesis figure 7.10): one condensed pair serves all.
void map(Study &study, Disc &disc, const std::vector<double> &wanted,
         const std::vector<double> &frictions)
{
   ResultTable &table = study.table("map", {{"friction", "f", "%.3g"},
                                            {"load_radius", "a/t", "%.4g"},
                                            {"separation", "d/t"},
                                            {"stick", "c/t"},
                                            {"status"}});
   table
      .draw("Separation d (upper) and border of stick c (lower)", "load_radius",
            "radius of the load a/t", {{"separation", "d"}, {"stick", "c"}}, "d/t, c/t",
            {"friction", "f"})
      .mark(2.5, 3.75);
   map_loads(study, table, disc.problem(), wanted, frictions, radius_load,
             [&](double f, double a, const Run &run)
             {
                const Extent found = has_state(run.report)
                                        ? disc.extent(run.solver.problem(), run.state)
                                        : Extent();
                study.row(table, {f, a, found.separation, found.stick, name(run.report.status)},
                          found.errors());
             });
}

/// Load radius above which no point of a disc separates (thesis figure 7.8).
void critical(Study &study, const Disc &disc, const std::vector<double> &discs,
              const std::vector<double> &frictions, bool also_bonded)
{
   const Stopwatch watch;
   ResultTable &table = study.table("critical_load_radius", {{"disc_radius", "b/t", "%.3g"},
                                                             {"friction", "f", "%.3g"},
                                                             {"load_radius", "critical a/t"}});
   table.draw("Radius of the load above which nothing separates", "disc_radius",
              "radius of the disc b/t", {{"load_radius", "a"}}, "radius of the load a/t",
              {"friction", "f"});
   ResultTable &bonded =
      study.table("bonded_critical",
                  {{"disc_radius", "b/t", "%.3g"}, {"load_radius", "bonded: critical a/t"}});
   for (double b : discs)
   {
      DiscOptions own = disc.options;
      own.disc_radius = b;
      own.twist = Twist::none;
      if (also_bonded) { study.row(bonded, {b, bonded_critical_radius(own)}); }
      CriticalLoad critical(own);
      for (double f : frictions) { study.row(table, {b, f, critical.radius(f)}); }
      study.counters += critical.counters();
   }
   study.say(text("%zu critical radii in %.2f s", table.json().size(), watch.seconds()));
}

Receding receding(Disc &disc)
{
   return {radius_load(disc.a),
           {"level", "P/P0", "%.3g"},
           {"separation", "d/t"},
           {"stick", "c/t"},
           "r/t",
           disc.radii()[0] - disc.problem().arc_length[0],
           "D E/(p0² t³)",
           [&disc](const ContactState &state) { return disc.extent(state); }};
}

void unload(Study &study, Disc &disc, Run &run, const std::vector<double> &wanted)
{
   const auto [profiles, diagram] =
      unload(study, run, receding(disc),
             {disc.steps, wanted.back(), wanted, "unloading", "unloading_tractions",
              "Pressure p and shear q over f, unloaded", "outer"});
   if (disc.options.disc_radius != 5 || disc.a != 2.5 || disc.f != 0.5) { return; }
   for (double border : {1.6, 2.3, 2.9, 3.4}) { diagram.mark(0.5, border); }
}

void axisymmetric_receding(Study &study)
{
   Disc disc;
   DiscOptions &options = disc.options;
   std::string twisted = "top", obstacle = "half-plane";
   std::vector<double> on_the_way, levels, cycled, torques, rotations, bonded_a, map_a,
      map_f = {0.5, 0.8}, discs, critical_f = {0, 0.5, 0.8};
   double amplitude = 0.5;
   int cycles = 0, load_cycles = 100;
   bool critical_bonded = false;
   study.options().group("The contact");
   study.option(&options.disc_radius, "disc-radius", "b, in t.");
   study.option(&disc.a, "load-radius", "a, in t.");
   study.option(&disc.f, "friction", "Coefficient of friction (0: no tangential unknowns).",
                not_negative);
   study.option(&options.poisson, "poisson", "Poisson's ratio of both bodies.");
   study.option(&obstacle, "obstacle",
                "Body below the disc: half-plane, which is here an axisymmetric half-space.",
                {"half-plane"});
   study.options().group("The mesh");
   study.option(&options.domain, "domain", domain_help);
   study.option(&options.order, "order", "Order of the elements.", within(1, 8));
   study.option(&options.spacing, "spacing",
                "Distance of the contact nodes, in t (thickness of the disc).",
                above_up_to(0, 0.5));
   study.options().group("Pressing");
   study.option(
      &on_the_way, "load-levels",
      "Loading: fractions of the full load P0 at which tractions are drawn (empty: none).",
      above_up_to(0, 1));
   study.option(
      &levels, "unload",
      "Unloading: fractions of the full load P0 at which results are printed (empty: none).",
      between(0, 1));
   study.option(&cycled, "cycle-to",
                "Load cycles between P0 and less: the lowest P/P0 of each (empty: none).",
                between(0, 1));
   study.option(&load_cycles, "cycles", "Largest number of load cycles.", at_least(1));
   study.options().group("Torsion");
   study.option(&torques, "torque",
                "Torsion: torques at which results are printed, over the torque of steady "
                "spinning T_s (empty: none).",
                positive);
   study.option(&rotations, "rotation",
                "Torsion: rotations at which results are printed instead, in p0/E.", positive);
   study.option(
      &twisted, "twist",
      "Control of the twist: rotation of the top, of its loaded part or of the rim, or "
      "traction, a torque, on the loaded part.",
      {"top", "loaded", "rim", "traction"});
   study.option(&cycles, "twist-cycles", "Torsion: cycles to and fro.", not_negative);
   study.option(&amplitude, "amplitude",
                "Torsion: amplitude of the torque of the cycles, in T_s.", above_up_to(0, 1));
   study.options().group("Pressing");
   study.option(&disc.steps, "increments",
                "Number of steps from zero to the full load P0, or to T_s.", at_least(2));
   study.options().group("More results");
   study.option(&bonded_a, "bonded", "Values of a for which the bonded disc is reported.");
   study.option(&map_a, "map-load-radius", "Values of a of a map of c and d (empty: no map).");
   study.option(&map_f, "map-friction", "Values of f of the map of c and d.", positive);
   study.option(&discs, "critical",
                "Values of b for which the critical radius of the load is found (empty: none).",
                at_least(1));
   study.option(&critical_f, "critical-friction",
                "Values of f for which the critical radius of the load is found.",
                not_negative);
   study.option(
      &critical_bonded, "critical-bonded",
      "Finds the critical radius of the load also for the bonded disc (ill-conditioned).");
   study.options().renamed(
      {{"steps", "increments"}, {"load-cycles", "cycles"}, {"map", "map-load-radius"}});
   study.parse();
   const bool twists = !torques.empty() || !rotations.empty() || cycles > 0;
   study.only_if(!map_a.empty(), {"map-friction"}, "goes with --map-load-radius");
   study.only_if(!discs.empty(), {"critical-friction", "critical-bonded"},
                 "goes with --critical");
   study.only_if(!cycled.empty(), {"cycles"},
                 "goes with --cycle-to; cycles of torsion are --twist-cycles");
   study.only_if(cycles > 0, {"amplitude"}, "goes with --twist-cycles");
   study.only_if(twists, {"twist"}, "goes with --torque, --rotation or --twist-cycles");
   study.results["load_radius"] = disc.a;
   require(map_a.empty() || !map_f.empty(),
           "option --map-friction is empty, must list the coefficients of the map");
   require(discs.empty() || !critical_f.empty(),
           "option --critical-friction is empty, must list the coefficients");
   require(torques.empty() || rotations.empty(),
           "options --torque and --rotation exclude each other");
   require(disc.f > 0 || (levels.empty() && cycled.empty() && !twists),
           "option --friction is 0: unloading is loading backwards, and nothing resists a "
           "twist");
   require(rotations.empty() || twisted != "traction",
           "option --rotation does not go with --twist traction, which prescribes torque");
   std::sort(on_the_way.begin(), on_the_way.end());
   std::sort(levels.rbegin(), levels.rend());
   std::sort(torques.begin(), torques.end());
   std::sort(rotations.begin(), rotations.end());
   for (const auto &[option, list] :
        {std::pair{"--bonded", bonded_a}, {"--map-load-radius", map_a}})
   {
      for (double a : list)
      {
         require(a > 0 && a <= options.disc_radius, "option ", option, ": ", a,
                 " must be above 0 and at most the disc's radius ", options.disc_radius);
      }
   }
   options.load_radii = joined_once(joined_once({disc.a}, bonded_a), map_a);
   if (twists)
   {
      options.twist = std::map<std::string, Twist>{{"top", Twist::top},
                                                   {"loaded", Twist::loaded},
                                                   {"rim", Twist::rim},
                                                   {"traction", Twist::traction}}[twisted];
   }

   disc.scene = make_disc(options);
   set_friction(disc.problem(), disc.f);
   study.reduced(disc.scene);
   if (!bonded_a.empty()) { bonded(study, disc, bonded_a); }
   Run run(study, disc.problem());
   load(study, disc, run, on_the_way);
   const ContactState loaded = run.state;
   const auto again = [&]() -> Run &
   {
      run.state = loaded;
      run.settings = {};
      return run;
   };
   if (!levels.empty()) { unload(study, disc, again(), levels); }
   if (!cycled.empty())
   {
      again().settings.increments = disc.steps;
      cycle_the_load(study, run, receding(disc), cycled, load_cycles);
   }
   if (twists) { spinning_limit(study, disc); }
   if (!torques.empty()) { twist(study, disc, again(), Turning::Stop::torque, torques); }
   if (!rotations.empty())
   {
      twist(study, disc, again(), Turning::Stop::multiplier, rotations);
   }
   if (cycles > 0) { cycle(study, disc, again(), amplitude, cycles); }
   if (!map_a.empty()) { map(study, disc, map_a, map_f); }
   if (!discs.empty()) { critical(study, disc, discs, critical_f, critical_bonded); }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("axisymmetric_receding", argc, argv, axisymmetric_receding);
}
