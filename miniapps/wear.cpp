//  wear: fretting wear of a contact in partial slip, cycle by cycle and at its end
//
//  A parabola 1/R on a half-plane of the same material is pressed by P, and Q goes to and fro
//  between ±f P times --amplitude. The surfaces wear by Archard's law, depth = k p |slip|,
//  with one k for both together. Units: a (half-width of the unworn contact) = P = R = 1. Wear
//  ends when slipping nodes carry no force. This state is also computed directly, and compared
//  with Ciavarella and Hills (1999). With --reduced the program takes any saved reduced
//  problem, in its own units, through a history of your own. There is no debris, and the depth
//  must be small compared with the contact: docs/wear.md.
//
//  Sample runs:
//    wear
//    wear --amplitude 0.2 --friction 0.3 --cycles 0
//    wear --profile flat --cycles 2000
//    wear --case problems/hertz_wear.case.json

#include "common/run.hpp"
#include "common/watch.hpp"
#include "wear/wear_read_outs.hpp"

#include <algorithm>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <cmath>

using namespace cattaneo;
using namespace miniapp;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Is one increment between two points of the cycle exact? It is if slip keeps its direction,
/// does not affect the normal problem, and no load changes the pressure.
bool path_is_straight(const ReducedProblem &problem, const LoadHistory &history)
{
   if (problem.coupled || problem.components() > 1) { return false; }
   const Index n = problem.nodes(), start = history.cycle_start;
   const auto pressing = [&](Index k) -> VectorXd
   { return problem.clamped_forces(history.multipliers.col(k)).tail(n); };
   const VectorXd first = pressing(start);
   for (Index k = start + 1; k < history.times.size(); ++k)
   {
      const double change = (pressing(k) - first).cwiseAbs().maxCoeff();
      if (change > 1e-8 * first.cwiseAbs().maxCoeff()) { return false; } // round-off of shear
   }
   return true;
}

void wear_contact(Study &study)
{
   WearingPad pad;
   SteppingOptions stepping;
   std::string file, history_text, update = "cycle", save_state, load_state;
   double shear = none, friction = none, coefficient = 1e-2, threshold = 0;
   bool of_energy = false;
   double cycles = 1000;
   int cycle_start = -1;
   WearSettings settings;
   settings.tolerance = 1e-3;
   settings.march.increments = 0;
   study.options().group("The pad");
   study.option(&pad.profile, "profile",
                "Pad: parabola, or flat with rounded edges. Units: P = 1, R = 1, and the "
                "parabola's half-width of contact under P is 1, which fixes the modulus.",
                {"parabola", "flat"});
   study.option(
      &pad.flat, "flat",
      "Pad: half-width of the flat part (with 0.5 the half-width of contact is 1.36 under P).",
      between(0, 1));
   study.option(&shear, "amplitude", "Pad: amplitude of Q over fP; default: 0.5.",
                between(0, 1));
   study.option(&friction, "friction",
                "Coefficient of friction; default: 0.5, with --reduced that of the file.",
                positive);
   study.option(&pad.poisson, "poisson", "Pad: Poisson's ratio.");
   study.option(&pad.nodes, "nodes",
                "Pad: number of contact nodes, one more than a multiple of twice the order.",
                at_least(25));
   study.option(&pad.order, "order", "Pad: order of the elements.", within(1, 8));
   study.options().group("The wear");
   study.option(&cycles, "cycles", "Number of cycles in all, those of --load-state included.",
                within(0, 1e15));
   study.option(&coefficient, "wear", "Archard's k of both bodies together, in 1/pressure.",
                not_negative);
   study.option(&threshold, "least-pressure", "Pressure below which nothing wears.",
                not_negative);
   study.option(&of_energy, "energy",
                "k is the wear per energy lost by friction: f k takes the place of k.");
   study.option(&settings.tolerance, "depth-error",
                "Largest error of worn depths that skipping cycles may cause, as a share of "
                "the largest depth. 0: no cycle is skipped.",
                within(0, 0.1));
   study.option(&update, "update",
                "When wear is added to the gap: after each cycle, or after each piece of the "
                "cycle (from one point of the history to the next).",
                {"cycle", "piece"});
   study.options().group("The march");
   study.option(
      &settings.march.increments, "increments",
      "Load increments between two points of the history. 0: one increment where slip is in "
      "proportion to the load in each part of the cycle (the pads, or an uncoupled "
      "problem with constant normal loads in the cycle), else 20.",
      at_least(0));
   stepping.declare(study);
   study.options().group("A saved problem in place of the pad");
   study.option(&file, "reduced", "Reduced problem, in place of the pad.", Text::input);
   study.option(&history_text, "history",
                "With --reduced: load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'.",
                Text::statements);
   study.option(&cycle_start, "cycle-start",
                "With --reduced: point of the history (from 0) where its cycle starts.",
                at_least(-1));
   study.options().group("The march");
   study.option(&save_state, "save-state", "File for the last state.", Text::output);
   study.option(&load_state, "load-state", "State from which the march continues.",
                Text::input);
   study.options().leave_out_of_cases("load-state");
   study.options().renamed(
      {{"shear", "amplitude"}, {"tolerance", "depth-error"}, {"threshold", "least-pressure"}});
   study.parse();
   stepping.set(settings.march);
   settings.update = update == "piece" ? GapUpdate::piece : GapUpdate::cycle;

   study.only_if(!file.empty(), {"history", "cycle-start"},
                 "goes with --reduced, the pad has its own");
   study.only_if(file.empty(), {"amplitude", "profile", "flat", "poisson", "nodes", "order"},
                 "belongs to the pad, --reduced has its own contact and --history");
   WearCase scene;
   if (file.empty())
   {
      shear = std::isnan(shear) ? 0.5 : shear;
      study.results["shear"] = shear;
      friction = std::isnan(friction) ? 0.5 : friction;
      scene = pad_on_half_plane(study, pad, shear, friction);
   }
   else
   {
      scene.problem = load_reduced_problem(file);
      if (!std::isnan(friction)) { set_friction(scene.problem, friction); }
      require(cycle_start >= 0, "option --cycle-start is ", cycle_start,
              ", must be the point of --history where its cycle starts");
      require(scene.problem.arc_length.size() > 0 && scene.problem.weights.size() > 0, "'",
              file, "' has no arc_length or no weights, which wear needs");
      scene.history = load_history("history", history_text, scene.problem);
      scene.history.cycle_start = cycle_start;
      scene.history.cycles = 1;
      scene.history.validate(scene.problem);
      study.condensed(scene.problem, 0);
   }
   study.results["scene"] = file.empty() ? pad.profile : "reduced";
   if (settings.march.increments == 0)
   {
      // On a straight path one increment between two points is exact, without events.
      const bool straight = path_is_straight(scene.problem, scene.history);
      settings.march.increments = straight ? 1 : 20;
      if (straight && !study.options().says("stepping"))
      {
         settings.march.stepping = Stepping::fixed;
      }
   }
   const ReducedProblem &problem = scene.problem;
   study.save(problem);
   WearLaw law = WearLaw::uniform(problem, coefficient);
   law.threshold = VectorXd::Constant(problem.nodes(), threshold);
   law.of_energy = of_energy;

   WearState state = WearState::virgin(problem);
   if (!load_state.empty()) { state = load_wear_state(load_state); }
   const VectorXd x = problem.arc_length.array() - scene.middle;
   // The pad's units. A saved problem has its own.
   const auto in = [&](const char *unit)
   { return file.empty() ? std::string(" [") + unit + "]" : ""; };
   const std::string place = (file.empty() ? "x" : "arc length") + in("a");
   Panel &profiles = study.lines("profile", "Worn depth", place, "depth" + in("a²/R"));
   Panel &pressures = study.lines("pressure", "Pressure", place, "p" + in("P/a"));
   Panel &borders = study.lines("stick", "Ends of the stick zone", "cycles", place);
   Panel &loops = study.lines("loops", "Force over displacement", "displacement" + in("a²/R"),
                              "force" + in("P"));
   ResultTable &table =
      study.table("cycles", {{"cycle", "cycle", "%.0f"},
                             {"volume", "worn volume" + in("a³/R"), "%.6g"},
                             {"depth", "depth" + in("a²/R"), "%.6g"},
                             {"dissipation", "energy lost so far" + in("P a²/R"), "%.6g"},
                             {"loss", "in the cycle" + in("P a²/R"), "%.4g"},
                             {"stick", "stick half-width" + in("a"), "%.5g"}});
   table.draw("Worn volume", "cycle", "cycles", {{"volume", "volume"}},
              "worn volume" + in("a³/R"));
   study.lead = {
      {"sentence",
       told(
          file.empty()
             ? "Units: a is the half-width of contact of a parabola 1/R under P, forces are "
               "per thickness. "
             : "",
          "Cycle 0 is the loading before the first cycle. All cycles are marched, unless "
          "jumps over cycles are reported. The table has the first cycles, and a row whenever "
          "their number has grown by a quarter.")},
      {"rows", nlohmann::ordered_json::array()}};
   std::vector<double> times, from, to;
   double drawn_at = 0, last_row = none;
   const auto add_row = [&](const WearState &now, const WearRecord &record)
   {
      last_row = record.cycles;
      const Zone stick = stick_zone(with_gap(problem, now.depth), now.contact);
      study.row(table, {record.cycles, record.volume, record.depth, record.dissipation,
                        record.loss, half_width(stick)});
      if (stick.last >= stick.first)
      {
         times.push_back(record.cycles);
         from.push_back(stick.from.position - scene.middle);
         to.push_back(stick.to.position - scene.middle);
      }
   };
   // A row for each of the first cycles, and then whenever their number has grown by a quarter.
   settings.observed = [&](double before, double now)
   {
      const auto rows = [](double at) { return std::floor(std::log(at) / std::log(1.25)); };
      return now <= 5 || now >= cycles || rows(now) > rows(before);
   };
   const auto observe = [&](const WearState &now, const WearRecord &record)
   {
      add_row(now, record);
      if (record.cycles < drawn_at && record.cycles < cycles) { return; }
      drawn_at = std::max(0.01 * cycles, 4 * record.cycles);
      const std::string label = exact_text("cycle ", record.cycles);
      const ReducedProblem worn = with_gap(problem, now.depth);
      profiles.add(label, x, now.depth);
      pressures.add(label, x, tractions(worn, now.contact.p));
      if (record.cycles == 0) { draw_loop(loops, "first cycle", scene, now, settings.march); }
   };
   WearReport report;
   {
      Watch watch("wear");
      settings.march.monitor = watch.monitor();
      report = wear(problem, law, scene.history, cycles, state, settings, observe);
      settings.march.monitor = {};
   }
   // A computation that ends early ends between the rows.
   if (!report.records.empty() && last_row < report.records.back().cycles)
   {
      add_row(state, report.records.back());
   }
   study.counters += report.counters;
   warn_of_cut_off(report.cut_off);
   study.results["cycles_worn"] = state.cycles;
   study.results["cycles_marched"] = report.marched;
   study.results["jumps"] = report.jumps;
   study.results["steady_cycle"] = report.steady_cycle;
   study.results["implicit_cycles"] = report.implicit_cycles;
   const auto unit = [&](const char *name) { return file.empty() ? name : ""; };
   study.value("volume", worn_volume(problem, state.depth), "worn volume at the last cycle",
               none, unit("a³/R"));
   // Without an estimate no ± is printed.
   study.value("depth", state.depth.maxCoeff(), "largest depth at the last cycle",
               std::isfinite(report.error) ? report.error : none, unit("a²/R"));
   study.results["tolerance_reached"] = report.reached;
   study.value("energy", state.dissipation.sum(), "energy that friction took, all cycles", none,
               unit("P a²/R"));
   study.value("explicit_limit", report.explicit_limit,
               "largest stable explicit step, in cycles");
   study.say(text("   %ld cycles marched, %ld jumps, %.2g s", report.marched, report.jumps,
                  report.seconds));
   if (report.error > 0 && std::isfinite(report.error))
   {
      study.say("   the ± is an estimate of the largest error, at any node, that jumps over "
                "cycles cause");
   }
   if (!report.remark.empty()) { warn(report.remark); }
   if (report.implicit_cycles > 0)
   {
      warn(
         text("%ld cycles wore so much that pressures changed within them: k or the amplitude "
              "is large, and the depths before the end have an error of first order in the "
              "wear of a cycle",
              report.implicit_cycles));
   }
   if (!save_state.empty() && writes()) { save(state, save_state); }
   if (report.status != FrictionStatus::converged)
   {
      study.code = 2;
      MarchReport last = report.last;
      last.status = report.status;
      last.message = report.message;
      if (report.last.status == FrictionStatus::converged) // it ended between two cycles
      {
         last.event_time = state.contact.time;
         last.event_multipliers = state.contact.multipliers;
      }
      add_outcome(problem, last, study.results);
      const std::string where =
         event_text(last.event_time, named(problem, last.event_multipliers));
      study.say(told("Ended after ", state.cycles, " cycles with status '", name(report.status),
                     "' at ", where, ": ", report.message));
      if (report.status != FrictionStatus::not_unique) { throw Outcome(); }
   }
   draw_loop(loops, exact_text("after cycle ", state.cycles), scene, state, settings.march);
   borders.add("left end", times, from);
   borders.add("right end", times, to);
   // Lengths across the pad have another unit than lengths along it: a²/R.
   if (!file.empty()) { warn_of_depth(problem, state.depth, state.contact); }
   if (coefficient == 0 || threshold > 0)
   {
      study.title("Worn out");
      return study.say(coefficient == 0
                          ? "   none: with k = 0 nothing wears"
                          : "   not computed with a threshold: nodes with less pressure do not "
                            "wear, so that wear ends before slipping nodes are free of load");
   }
   Watch watch("worn out");
   settings.march.monitor = watch.monitor();
   const WornOut end =
      worn_out(problem, scene.history, ContactState::virgin(problem), settings.march);
   warn_of_cut_off(end.cut_off);
   report_end(study, scene, end, file.empty(), profiles, pressures);
   if (end.status == FrictionStatus::stopped)
   {
      study.code = 2;
      study.results["status"] = name(end.status);
   }
   if (!file.empty() && end.status == FrictionStatus::converged)
   {
      warn_of_depth(problem, end.depth, end.contact);
   }
   if (end.status == FrictionStatus::converged && end.depth.maxCoeff() > 0 && state.cycles > 0)
   {
      study.value("distance_to_end",
                  (state.depth - end.depth).cwiseAbs().maxCoeff() / end.depth.maxCoeff(),
                  "largest distance to the worn-out depth, over its largest depth");
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("wear", argc, argv, wear_contact);
}
