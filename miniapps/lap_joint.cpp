//  lap_joint: two laps pinched by bolts and pulled, in cycles; slip, dissipation, rows of bolts
//
//  Thesis, chapter 6, and item 3 of section 8.2. Two equal laps, each t/2 thick, overlap by the
//  protrusion on both sides of the bolt. The bolt is a pressure p0 over the width w on both
//  outer faces, P0 = p0 w. Then a remote load T cycles 0 → Tmax → 0. The contact recedes to
//  |x| < a, and stick is |x| < c. Forward slip is +x of the upper lap, whose loaded end is at
//  -x. Units: t = p0 = E' = 1, with E' = E/(1-ν²). The dissipation D of a cycle is printed as
//  D E'/P0².
//
//  Sample runs:
//    lap_joint
//    lap_joint --friction 0.5 --load -0.04 --touch
//    lap_joint --stepping fixed
//    lap_joint --map-load "-0.03 0.04" --map-friction "0.2 0.8"
//    lap_joint --map-load 0.04 --map-width "0.5 1 2" --spacing 0.01
//    lap_joint --bolt-positions "-1.5 0 1.5" --friction 0.4 --load 0.2 --spacing 0.025
//    lap_joint --bolt-positions "-1.2 0 1.2" --lower-thickness 2 --load 0.1 --spacing 0.025
//    lap_joint --friction 0.8 --load 0.01
//    lap_joint --friction 0.8 --load 0.03
//    lap_joint --modes 2 --amplitudes "1e-7 3e-6" --spacing 0.025

#include "common/contact_edges.hpp"
#include "common/modal_curves.hpp"
#include "lap_joint/bolted_loop.hpp"

#include <algorithm>
#include <cattaneo/contact/vibrating_body.hpp>
#include <cattaneo/input_error.hpp>

using namespace cattaneo;
using namespace miniapp;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

void draw(Study &study, Joint &joint, const BoltedLoop &loop,
          const std::vector<ContactState> &stations, Panel &diagram)
{
   const ReducedProblem &problem = joint.problem();
   const VectorXd x = problem.position.col(0);
   double edge = 0;
   const auto tightened = settled_states(problem, loop.tightened),
              pulled = settled_states(problem, loop.first_peak);
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      if (!closed(tightened[i]) && !closed(pulled[i])) { continue; }
      edge = std::max(edge, std::abs(x[i]));
   }
   edge *= 1.15;
   Panel &profiles =
            study.lines("tractions", "Pressure p and shear q over f", "x/t", "p/p0, q/(f p0)"),
         &density = study.lines("dissipation", "Dissipation a cycle along the contact", "x/t",
                                "D' E' t/P0² × 10³");
   for (std::size_t k = 0; k < stations.size(); ++k)
   {
      const double T = named(problem, stations[k].multipliers).at("T") / joint.P0();
      profiles.add_tractions(text("%zu: T/P0 = %.3g", k + 1, T), x, problem, stations[k]);
   }
   const VectorXd weight = problem.weights * (joint.unit() / 1e3);
   density.add("first cycle", x,
               loop.report.cycles.front().node_dissipation.cwiseQuotient(weight));
   density.add("steady cycle", x,
               loop.report.cycles.back().node_dissipation.cwiseQuotient(weight));
   profiles.limit("x", -edge, edge);
   density.limit("x", -edge, edge);
   diagram.limit("y", -edge, edge);
}

/// Some states of the first cycle, evenly spaced, the first and the last among them.
void write_frames(Study &study, Joint &joint, const std::vector<ContactState> &states)
{
   std::vector<ContactState> shown;
   const std::size_t last = states.size() - 1;
   const auto count = std::min(static_cast<std::size_t>(joint.frames), last);
   for (std::size_t k = 0; k <= count; ++k) { shown.push_back(states[k * last / count]); }
   study.write_frames(joint.paraview, joint.scene, shown);
}

/// One bolt: the thesis' study.
void single(Study &study, Joint &joint)
{
   const ReducedProblem &problem = joint.problem();
   Run run(study, problem, joint.settings);
   run.unit = joint.unit();
   const double shift = problem.position(0, 0);
   const auto x = [=](double arc_length) { return arc_length + shift; };
   Panel &diagram =
      study.panel(Panel::Kind::zones, "zones",
                  "Zones in time (1: pinched, then T: 0 → Tmax → 0)", "time", "x/t");
   nlohmann::ordered_json evolution = nlohmann::ordered_json::array();
   std::vector<ContactState> states, stations; // for the frames, and for draw()
   const auto observe = [&](const ContactState &state)
   {
      if (state.time < 1) { return; }
      if (!joint.paraview.empty() && state.time <= 3) { states.push_back(state); }
      const double off = std::abs(2 * state.time - std::round(2 * state.time));
      if (off < 1e-9 && state.time < 4.25) { stations.push_back(state); }
      const std::vector<Zone> all = zones(problem, state);
      diagram.add(state.time, all, x);
      evolution.push_back({{"time", state.time},
                           {"load", named(problem, state.multipliers).at("T")},
                           {"zones", to_json(all, shift)}});
   };
   const BoltedLoop o = pull(run, joint.tightening({0}, joint.P0()), joint.load * joint.P0(),
                             joint.cycles, observe);
   report_exact_path(study, run);
   report_cycles(study, problem, o.report, joint.unit());
   study.title(exact_text("P only, then T/P0 = ", joint.load));
   const double a = half_width(o.pulled), a_error = read_out_error(o.pulled),
                c = half_width(o.stick_first), c_error = read_out_error(o.stick_first);
   study.value("a0", half_width(o.contact), "contact under P only a0/t",
               read_out_error(o.contact));
   study.value("peak_pressure", tractions(problem, o.tightened.p).maxCoeff(),
               "and its peak pressure", none, "p0");
   study.value("a", a, "contact a/t", a_error);
   study.value("c_first", c, "stick in the first loading c/t", c_error);
   study.value("c_over_a", c / a, "over the contact c/a", (c_error + c / a * a_error) / a);
   // A result that is not steady gets another name, so that programs that read it notice.
   const bool steady = o.report.steady_cycle > 0;
   study.value(steady ? "c_steady" : "c_last", half_width(o.stick_steady),
               steady ? "stick in the steady cycle c/t"
                      : "stick in the last cycle (not steady yet) c/t",
               read_out_error(o.stick_steady));
   study.value("dissipation_first", o.first() / joint.unit(),
               "loss in the first cycle D E'/P0²");
   study.value(steady ? "dissipation_steady" : "dissipation_last", o.steady() / joint.unit(),
               steady ? "and in the steady one" : "and in the last one (not steady yet)");
   study.value("work_error", o.work_error(), "work of the last cycle over it, less 1");
   const double most_p = o.tightened.p.maxCoeff(), most_q = joint.friction * most_p;
   study.value("asymmetry",
               std::max({asymmetry(o.tightened.p, most_p), asymmetry(o.first_peak.p, most_p),
                         asymmetry(o.first_peak.q, most_q), asymmetry(o.first_end.q, most_q)}),
               "asymmetry of p and q");
   study.value("pressure_memory",
               (o.first_end.p - o.tightened.p).cwiseAbs().maxCoeff() / o.tightened.p.maxCoeff(),
               "memory of p");
   const double sheared =
      tractions(problem, o.tightened.q).cwiseAbs().maxCoeff() / joint.friction;
   study.value("residual_shear", sheared > round_off ? sheared : 0, "shear after P", none,
               "f p0");
   study.results["zones"] = evolution;
   // The remote load goes from none to its peak: the pressed state is the cycle's other end.
   fretting::MarchedStates edges{problem, o.tightened, o.first_peak};
   edges.opposite = &edges.pressed;
   edges.cycle = &o.report.cycles.back();
   edges.modulus = 0.5; // E*, with E' = 1 of both laps
   report_edges(study, fretting::read_edges(edges), shift);
   draw(study, joint, o, stations, diagram);
   if (!joint.paraview.empty()) { write_frames(study, joint, states); }
}

/// Sweeps over T, f and w (thesis figures 6.5, 6.10, 6.11). Other widths are shown both with
/// the pressure p0 of the first one and with its clamping force P0; T is the same force in all.
void sweep(Study &study, Joint &joint, const std::vector<double> &loads,
           const std::vector<double> &frictions, const std::vector<double> &widths)
{
   const Stopwatch watch;
   ResultTable &table = study.table("sweep", {{"friction", "f", "%.3g"},
                                              {"width", "w/t", "%.3g"},
                                              {"pressure", "p/p0", "%.3g"},
                                              {"load", "T/P0"},
                                              {"a0", "a0/t"},
                                              {"a", "a/t"},
                                              {"c_first", "c first"},
                                              {"c_steady", "c steady"},
                                              {"dissipation_first", "D first", "%.3e"},
                                              {"dissipation_steady", "D steady", "%.3e"},
                                              {"steady_cycle", "steady from", "%g"},
                                              {"status"}});
   Panel &extents = study.lines("extent", "Steady contact a and stick c", "T/P0",
                                "a/t (upper), c/t (lower)"),
         &losses = study.lines("loss", "Dissipation per steady cycle", "|T|/P0", "D E'/P0²"),
         &by_width =
            study.lines("loss_by_width", "Dissipation per steady cycle", "w/t", "D E'/P0²");
   losses.say("scale", "loglog");
   for (double f : frictions)
   {
      set_friction(joint.problem(), f);
      Run run(study, joint.problem(), joint.settings);
      run.settings.stop_at_steady_state = true;
      run.leaves = false; // gross sliding is a result of a sweep, not its end
      const std::string rubbed = exact_text("f = ", f);
      for (double width : widths)
      {
         std::vector<double> pressures{1.0};
         if (width != joint.P0()) { pressures.push_back(joint.P0() / width); }
         for (double pressure : pressures)
         {
            for (double T : loads)
            {
               const BoltedLoop o = pull(run, joint.tightening({0}, width, pressure),
                                         T * joint.P0(), joint.cycles);
               const bool ends = !o.converged();
               const double loss = ends ? none : o.steady() / joint.unit();
               const auto half = [&](const Zone &zone)
               { return ends ? none : half_width(zone); };
               const double pinched = o.tightened.status.empty() ? none : half_width(o.contact);
               study.row(table,
                         {f, width, pressure, T, pinched, half(o.pulled), half(o.stick_first),
                          half(o.stick_steady), ends ? none : o.first() / joint.unit(), loss,
                          ends ? none : o.report.steady_cycle, name(o.report.status)});
               if (widths.size() > 1)
               {
                  const std::string label = exact_text("T/P0 = ", T) + ", " + rubbed;
                  if (pressure == 1) { by_width.point(label + ", same p0", width, loss); }
                  if (pressure != 1 || width == joint.P0())
                  {
                     by_width.point(label + ", same P0", width, loss);
                  }
               }
               if (loads.size() < 2 || width != joint.P0() || ends) { continue; }
               extents.point("a, " + rubbed, T, half(o.pulled));
               extents.point("c, " + rubbed, T, half(o.stick_steady));
               losses.point((T > 0 ? "tension, " : "compression, ") + rubbed, std::abs(T),
                            loss);
            }
         }
      }
   }
   study.results["seconds_sweep"] = watch.seconds();
}

/// A row of bolts, tightened in several orders (thesis 8.2, item 3).
void row(Study &study, Joint &joint, const std::vector<std::vector<int>> &all)
{
   const ReducedProblem &problem = joint.problem();
   Run run(study, problem, joint.settings);
   run.unit = joint.unit();
   const VectorXd x = problem.position.col(0);
   ResultTable &table = study.table("tightening", {{"label", "order of tightening"},
                                                   {"residual_shear", "largest q/fp0", "%.3e"},
                                                   {"dissipation_first", "D first", "%.3e"},
                                                   {"dissipation_steady", "D steady", "%.3e"},
                                                   {"steady_cycle", "steady from"},
                                                   {"work_error"}});
   Panel &residual = study.lines("residual", "Shear left by tightening", "x/t", "q/(f p0)"),
         &density = study.lines("dissipation", "Dissipation per steady cycle along the contact",
                                "x/t", "D' E' t/P0² × 10³");
   for (const std::vector<int> &order : all)
   {
      const BoltedLoop o =
         pull(run, joint.tightening(order, joint.P0()), joint.load * joint.P0(), joint.cycles);
      std::string label;
      nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
      for (int bolt : order)
      {
         label += (label.empty() ? "" : " ") + std::to_string(bolt + 1);
         numbers.push_back(bolt + 1);
      }
      const VectorXd q = tractions(problem, o.tightened.q);
      study.row(table,
                {label, q.cwiseAbs().maxCoeff() / joint.friction, o.first() / joint.unit(),
                 o.steady() / joint.unit(), o.report.steady_cycle, o.work_error()},
                {}, {{"order", numbers}});
      residual.add("order " + label, x, q / joint.friction);
      density.add("order " + label, x,
                  o.report.cycles.back().node_dissipation.cwiseQuotient(problem.weights) *
                     (1e3 / joint.unit()));
   }
}

/// The density of steel over its E', in s²/mm².
constexpr double steel = 7.85e-9 * (1 - 0.3 * 0.3) / 210e3;

/// Modes of the pinched joint without remote load, and their loops.
void vibrate(Study &study, Joint &joint, ModalCurves &curves, double density,
             const std::vector<int> &order)
{
   ReducedProblem &problem = joint.problem();
   study.title("Vibration about the pinched state");
   study.value("density", density, "density over E'", none,
               density == steel ? "s²/mm² (steel)" : "");
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.keep_increments = false;
   const LoadHistory history =
      LoadHistory::through(problem, joint.tightening(order, joint.P0()));
   const MarchReport report = march(problem, history, state, settings);
   study.counters += report.counters;
   if (const int code = exit_code(problem, report); code != 0)
   {
      study.code = code;
      return;
   }
   std::vector<VibratingBody> laps;
   for (const auto &lap : joint.scene.bodies)
   {
      laps.push_back(vibrating_body(*lap, {density}));
   }
   const VibratingStructure structure(joint.scene.reduction, std::move(laps));
   const JointCase plane; // without bolts that are springs
   const Modes modes = curves.report_modes(structure, problem, state, plane);
   curves.report_loops(structure, modes, joint.scene, plane, state);
}

void lap_joint(Study &study)
{
   Joint joint;
   LapJointOptions &options = joint.options;
   options.spacing = 0.005;
   std::string tightening;
   SteppingOptions stepping;
   std::vector<double> loads, frictions, widths;
   bool touch = false, all_cycles = false;
   study.options().group("The joint");
   study.option(&options.widths[0], "width", "Width w of the pinch pressure, in t.");
   study.option(&options.protrusion, "protrusion",
                "Length of the free end beyond the (outermost) bolt, in t (twice the thickness "
                "of the upper lap).",
                positive);
   study.option(&options.remote, "remote",
                "Length of the loaded end beyond the (outermost) bolt, in t.", above(2));
   study.option(&options.lower_thickness, "lower-thickness",
                "Thickness of the lower lap over the upper's (1: equal laps).",
                between(0.1, 100));
   study.option(&joint.friction, "friction", "Coefficient of friction.", positive);
   study.options().group("The loads");
   study.option(
      &joint.load, "load",
      "Largest remote load Tmax/P0, tension positive, with P0 = p0 w and the w of --width.");
   study.option(&joint.cycles, "cycles",
                "Largest number of cycles. The march ends earlier when they are steady.",
                at_least(1));
   study.option(&all_cycles, {"all-cycles", "stop-when-steady"}, "March all cycles.");
   study.option(&joint.settings.increments, "increments",
                "Load increments from 0 to Tmax, and as many back.", at_least(1));
   stepping.declare_with_events(study);
   study.options().group("More results");
   study.option(&touch, "touch", "Also finds the compression at which the free ends touch.");
   study.options().group("Several bolts");
   study.option(&options.bolts, "bolt-positions", "Positions of the bolts, in t.");
   study.option(&tightening, "tightening",
                "Orders of tightening, bolts from 1: \"2 1 3 / 1 3 2\" (empty: two orders, "
                "from the inside out and from the outside in).");
   study.option(
      &joint.snug, "snug",
      "With several bolts: pressure, over p0, to which all are tightened together first.",
      at_least_below(0, 1));
   study.options().group("More results");
   study.option(&loads, "map-load",
                "Loads T/P0 of a map over load, friction and width (empty: no map). P0 is that "
                "of --width for all widths.");
   study.option(&frictions, "map-friction", "Values of f of the map (empty: --friction).",
                positive);
   study.option(&widths, "map-width", "Values of w/t of the map (empty: --width).");
   study.options().group("The mesh");
   study.option(&options.order, "order", "Order of the elements.", within(1, 8));
   study.option(&options.spacing, "spacing", "Distance of the contact nodes, in t.",
                above_up_to(0, 0.1));
   study.options().group("The joint");
   study.option(&options.poisson, "poisson", "Poisson's ratio of both laps.");
   ModalCurves curves(study, 0, false);
   double density = steel;
   study.option(&density, "density",
                "Mass per volume over E', in s²/t². The default is steel, if t is in mm: for "
                "t = 1 mm frequencies are in Hz, and they fall as 1/t.",
                positive);
   study.options().group("More results");
   study.option(&joint.paraview, "paraview",
                "Folder for ParaView files of the first cycle (one bolt).", Text::folder);
   study.option(&joint.frames, "frame-intervals",
                "Number of intervals between the frames of --paraview.", at_least(1));
   study.options().renamed({{"march", "stepping"},
                            {"bolts", "bolt-positions"},
                            {"frames", "frame-intervals"},
                            {"sweep-load", "map-load"},
                            {"sweep-friction", "map-friction"},
                            {"sweep-width", "map-width"}});
   study.parse();
   const std::size_t bolts = options.bolts.size();
   study.only_if(!loads.empty(), {"map-friction", "map-width"}, "goes with --map-load");
   study.only_if(!joint.paraview.empty(), {"frame-intervals"}, "goes with --paraview");
   study.only_if(bolts > 1, {"tightening", "snug"}, "needs several --bolt-positions");
   study.only_if(
      curves.modes() > 0,
      {"amplitudes", "points-of-curve", "amplitude-of", "shown-amplitude", "density"},
      "goes with --modes");
   curves.check_options();
   stepping.set(joint.settings);
   joint.settings.stop_at_steady_state = !all_cycles;
   if (frictions.empty()) { frictions = {joint.friction}; }
   if (widths.empty()) { widths = {options.widths[0]}; }
   options.widths = joined_once(options.widths, widths);
   require(bolts == 1 || joint.paraview.empty(),
           "option --paraview writes frames for one bolt only, there are ", bolts);
   require(bolts == 1 || loads.empty(), "option --map-load needs a single bolt, there are ",
           bolts);
   const std::vector<std::vector<int>> all = orders(tightening, options.bolts);

   joint.scene = make_lap_joint(options);
   set_friction(joint.problem(), joint.friction);
   study.reduced(joint.scene);
   if (touch)
   {
      FrictionSolver solver(joint.problem());
      const double found = touch_load(solver, joint.tightening(all[0], joint.P0()).back(),
                                      -joint.friction * joint.P0() * bolts);
      study.counters += solver.counters();
      study.title("Compression at which the free ends touch");
      study.value("touch_load", found / joint.P0(), "T/P0");
   }
   if (bolts == 1) { single(study, joint); }
   else { row(study, joint, all); }
   if (!loads.empty())
   {
      sweep(study, joint, loads, frictions, widths);
      set_friction(joint.problem(), joint.friction);
   }
   if (curves.modes() > 0) { vibrate(study, joint, curves, density, all[0]); }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("lap_joint", argc, argv, lap_joint);
}
