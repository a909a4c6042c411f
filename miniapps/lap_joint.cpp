//  lap_joint: two laps pinched by bolts and pulled, in cycles; slip, dissipation, rows of bolts
//
//  Thesis chapter 6 and 8.2 (3). Two equal laps of half the thickness t overlap by the
//  protrusion on both sides of the bolt, a pressure p0 over the width w on both outer faces (P0
//  = p0 w); then the remote load T cycles 0 → Tmax → 0. The contact recedes to |x| < a, stick
//  is |x| < c. Forward slip is +x of the upper lap, whose loaded end is at -x. Units t = p0 =
//  E' = 1, E' = E/(1-ν²); dissipation D E'/P0² a cycle.
//
//  Sample runs:  lap_joint
//                lap_joint -friction 0.5 -load -0.04 -touch
//                lap_joint -march exact
//                lap_joint -sweep-load "-0.03 0.04" -sweep-friction "0.2 0.8"
//                lap_joint -sweep-load 0.04 -sweep-width "0.5 1 2" -spacing 0.01
//                lap_joint -bolts "-1.5 0 1.5" -friction 0.4 -load 0.2 -spacing 0.025
//                lap_joint -bolts "-1.2 0 1.2" -lower-thickness 2 -load 0.1 -spacing 0.025

#include "common/contact_edges.hpp"
#include "common/fields.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/study_output.hpp"

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

double half_width(const Zone &zone)
{
   return zone.last < zone.first ? 0.0 : 0.5 * (zone.to.position - zone.from.position);
}

double read_out_error(const Zone &zone)
{
   return std::max(zone.from.error, zone.to.error);
}

/// Largest deviation from mirror symmetry, over the largest value.
double asymmetry(const VectorXd &forces)
{
   const double largest = forces.cwiseAbs().maxCoeff();
   return largest > 0 ? (forces - forces.reverse()).cwiseAbs().maxCoeff() / largest : 0.0;
}

/// What a history of tightening and cycles gave.
struct Outcome
{
   MarchReport report;
   int code = 0;
   ContactState tightened, first_peak, first_end, last_peak;
   std::vector<Zone> cycle_zones; ///< of the last whole cycle
   double a0 = 0, a = 0, c_first = 0, c_steady = 0, peak_pressure = 0;
   double a0_error = 0, a_error = 0, c_first_error = 0, c_steady_error = 0;

   double first() const
   {
      return report.cycles.empty() ? none : report.cycles.front().dissipation;
   }
   double steady() const
   {
      return report.cycles.empty() ? none : report.cycles.back().dissipation;
   }
   /// External work against dissipation over the last cycle, relative.
   double work_error() const
   {
      if (report.cycles.empty() || steady() == 0) { return 0.0; }
      return std::abs(report.cycles.back().external_work - steady()) / steady();
   }
};

using Observer = std::function<void(const ContactState &)>;

/// Marches through the tightening points, then cycles the remote load between 0 and `load`.
Outcome run(FrictionSolver &solver, std::vector<NamedLoads> points, double load, int cycles,
            const MarchSettings &settings, const Observer &observe = {})
{
   Outcome outcome;
   const ReducedProblem &problem = solver.problem();
   const int tightened = static_cast<int>(points.size()) - 1;
   NamedLoads loaded = points.back();
   loaded["T"] = load;
   points.insert(points.end(), {loaded, points.back()});
   LoadHistory history = LoadHistory::through(problem, points);
   history.cycle_start = tightened;
   history.cycles = cycles;
   ContactState state = ContactState::virgin(problem);
   SlipRange cycle(problem);
   auto note = [&](const ContactState &now, const IncrementRecord &)
   {
      if (observe) { observe(now); }
      cycle.note(now);
      const double pieces = now.time - tightened; // of the cycles; whole at their ends
      if (pieces >= 0 && std::abs(pieces - std::round(pieces)) < 1e-12)
      {
         const int piece = static_cast<int>(std::round(pieces));
         if (piece == 0) { outcome.tightened = now; }
         else if (piece % 2 == 1)
         {
            outcome.last_peak = now;
            if (piece == 1) { outcome.first_peak = now; }
         }
         else
         {
            if (piece == 2) { outcome.first_end = now; }
            outcome.cycle_zones = zones(problem, outcome.last_peak, cycle);
         }
         if (piece % 2 == 0) { cycle.start(now); }
      }
   };
   outcome.report = march(solver, history, state, settings, note);
   outcome.code = miniapp::exit_code(problem, outcome.report);
   if (outcome.code != 0) { return outcome; }
   Zone zone = contact_zone(problem, outcome.tightened);
   outcome.a0 = half_width(zone);
   outcome.a0_error = read_out_error(zone);
   outcome.peak_pressure = tractions(problem, outcome.tightened.p).maxCoeff();
   zone = contact_zone(problem, outcome.first_peak);
   outcome.a = half_width(zone);
   outcome.a_error = read_out_error(zone);
   zone = stick_zone(problem, outcome.first_peak);
   outcome.c_first = half_width(zone);
   outcome.c_first_error = read_out_error(zone);
   // At a reload peak the nodes between the first and the steady border lie on the friction
   // limit and do not slip: the steady border is that of the nodes which slip in the cycle.
   zone = stick_zone(problem, outcome.cycle_zones);
   outcome.c_steady = half_width(zone);
   outcome.c_steady_error = read_out_error(zone);
   return outcome;
}

/// Remote compression at which a free end touches the other lap; NaN if none does before
/// `limit`.
double touch_load(FrictionSolver &solver, NamedLoads loads, double limit)
{
   const ReducedProblem &problem = solver.problem();
   ContactState state = ContactState::virgin(problem);
   const auto solves = [&](ContactState &from) {
      return solver.solve(from, problem.multipliers(loads)).status == FrictionStatus::converged;
   };
   if (!solves(state)) { return none; }
   auto touches = [&](const ContactState &s)
   {
      const std::vector<NodeState> settled = settled_states(problem, s);
      return closed(settled.front()) || closed(settled.back());
   };
   if (touches(state)) { return 0; }
   double step = limit / 50, remote = 0;
   while (std::abs(step) > 1e-7 * std::abs(limit))
   {
      loads["T"] = remote + step;
      ContactState next = state;
      if (solves(next) && !touches(next) && std::abs(loads["T"]) <= std::abs(limit))
      {
         state = next;
         remote = loads["T"];
      }
      else { step *= 0.5; }
   }
   const double load = remote + 2 * step;
   return std::abs(load) < 0.999 * std::abs(limit) ? load : none;
}

/// The order of tightening: numbers of bolts from 1, orders separated by a slash.
std::vector<std::vector<int>> orders(const std::string &text, const std::vector<double> &bolts)
{
   const int count = static_cast<int>(bolts.size());
   std::vector<std::vector<int>> result;
   if (text.empty())
   {
      std::vector<int> order(count);
      std::iota(order.begin(), order.end(), 0);
      auto nearer = [&](int i, int k) { return std::abs(bolts[i]) < std::abs(bolts[k]); };
      std::stable_sort(order.begin(), order.end(), nearer);
      result.push_back(order);
      std::stable_sort(order.begin(), order.end(), [&](int i, int k) { return nearer(k, i); });
      if (order != result[0]) { result.push_back(order); }
      return result;
   }
   std::istringstream words(text);
   for (std::string part; std::getline(words, part, '/');)
   {
      std::vector<int> order;
      std::vector<bool> used(count, false);
      for (double number : miniapp::numbers("--tightening", part))
      {
         const int bolt = static_cast<int>(number) - 1;
         require(bolt >= 0 && bolt < count && number == bolt + 1 && !used[bolt],
                 "option --tightening: ", number, " in '", part,
                 "' must be the number of a bolt (1 to ", count, "), once");
         used[bolt] = true;
         order.push_back(bolt);
      }
      require(static_cast<int>(order.size()) == count, "option --tightening: '", part, "' has ",
              order.size(), " bolts, there are ", count);
      result.push_back(order);
   }
   return result;
}

struct Study
{
   miniapp::LapJointOptions options;
   miniapp::LapJoint joint;
   double friction = 0.2, load = 0.04, snug = 0.05;
   int cycles = 3;
   MarchSettings settings;
   Counters counters;
   miniapp::ReferenceTable table;
   nlohmann::ordered_json results;
   std::vector<miniapp::Panel> panels;

   ReducedProblem &problem() { return joint.reduction.problem; }
   double P0() const { return options.widths[0]; }
   double x(double arc_length) { return arc_length + problem().position(0, 0); }
   /// Multipliers of the pinch pressures: several bolts are first drawn together to the snug
   /// pressure, then tightened one after another.
   std::vector<NamedLoads> tightening(const std::vector<int> &order, double width,
                                      double pressure = 1);

   std::string paraview; ///< folder for the frames of the first cycle; none if empty
   int frames = 8;

   int single();
   void write_frames(const std::vector<ContactState> &states);
   int sweep(const std::vector<double> &loads, const std::vector<double> &frictions,
             const std::vector<double> &widths);
   int row(const std::vector<std::vector<int>> &all);
   void compare(const Outcome &outcome);
   void draw(const Outcome &outcome, const miniapp::Panel &diagram);
};

std::vector<NamedLoads> Study::tightening(const std::vector<int> &order, double width,
                                          double pressure)
{
   std::vector<NamedLoads> points(1);
   if (order.size() > 1 && snug > 0)
   {
      points.push_back(points.back());
      for (int bolt : order)
      {
         points.back()[miniapp::pinch_load(bolt, width)] = snug * pressure;
      }
   }
   for (int bolt : order)
   {
      points.push_back(points.back());
      points.back()[miniapp::pinch_load(bolt, width)] = pressure;
   }
   return points;
}

/// Rows of the table, where the studies' notes have the case: their ± (where they say none,
/// half of the last digit), and what the mesh and the increments may add: the errors printed
/// with the edges, and 0.2 % of a loss in 20 increments or more.
void Study::compare(const Outcome &o)
{
   const bool standard = options.widths[0] == 1 && options.protrusion == 1.95 &&
                         options.bolts == std::vector<double>{0.0} && options.remote == 16 &&
                         options.lower_thickness == 1 && options.order >= 2;
   if (!standard) { return; }
   table.add("a0/t", 0.7011, {0.0005, o.a0_error}, 0.71, o.a0);
   table.add("peak pressure / p0", 1.0468, 2e-4, 1.05, o.peak_pressure);
   const miniapp::Allowed a_allowed{load > 0 ? 0.0005 : 0.001, o.a_error};
   if (load == 0.04) { table.add("a/t, T = 0.04 P0", 0.6596, a_allowed, 0.67, o.a); }
   if (load == -0.04) { table.add("a/t, T = -0.04 P0", 0.763, a_allowed, none, o.a); }
   if (load == 0.04 && friction == 0.2)
   {
      table.add("c/a, first loading, T = 0.04, f = 0.2", 0.760,
                {0.0005, (o.c_first_error + o.c_first / o.a * o.a_error) / o.a}, 0.78,
                o.c_first / o.a);
   }
   struct
   {
      double load, friction, c;
   } const borders[] = {
      {0.04, 0.2, 0.5809}, {-0.04, 0.5, 0.6685}, {0.01, 0.8, 0.685}, {0.03, 0.8, 0.6605}};
   for (const auto &row : borders)
   {
      if (load != row.load || friction != row.friction || o.report.steady_cycle == 0)
      {
         continue;
      }
      table.add(miniapp::exact_text("c/t, steady, T = ", load) +
                   miniapp::exact_text(", f = ", friction),
                row.c, {row.c == 0.685 ? 0.0005 : 5e-5, o.c_steady_error}, none, o.c_steady);
   }
   const bool fine = options.spacing <= 0.00625 && settings.increments >= 20 && cycles >= 2;
   struct
   {
      double load, friction, first, steady, spread;
   } const losses[] = {{0.04, 0.2, 4.898e-4, 1.938e-4, 0.003},
                       {-0.04, 0.5, 1.718e-4, 1.029e-4, 0.006}};
   for (const auto &row : losses)
   {
      if (load != row.load || friction != row.friction) { continue; }
      const std::string where =
         miniapp::exact_text(", T = ", load) + miniapp::exact_text(", f = ", friction);
      const auto add = [&](const std::string &name, double loss, double computed) {
         table.add(name + where, loss, {row.spread * loss, 0.002 * loss}, none, computed);
      };
      add("D first", row.first, o.first());
      if (fine) { add("D steady", row.steady, o.steady()); }
   }
   table.note(
      "Thesis: a uniform bilinear mesh, 0.005 of its own t, and values read off figures; "
      "its a and c are each about 0.01 t larger.");
   table.note(
      "Cattaneo's c/a for the same T/fP0 would be 0.894: the pressure is not Hertz's and "
      "the laps stretch.");
   table.note("Its 'tension dissipates more' holds for the first cycle only.");
}

void Study::draw(const Outcome &o, const miniapp::Panel &diagram)
{
   const ReducedProblem &problem = this->problem();
   const VectorXd position = problem.position.col(0);
   double edge = 0;
   const auto tightened = settled_states(problem, o.tightened),
              pulled = settled_states(problem, o.first_peak);
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      const bool in = closed(tightened[i]) || closed(pulled[i]);
      if (in) { edge = std::max(edge, std::abs(position[i])); }
   }
   miniapp::Panel profiles = miniapp::Panel::lines("tractions", "Pressure p and shear q over f",
                                                   "x/t", "p/p0, q/(f p0)");
   auto add = [&](const char *label, const ContactState &state)
   {
      profiles.add(label, position, tractions(problem, state.p));
      profiles.add(std::string("q/f: ") + label, position,
                   tractions(problem, state.q) / friction, "dashed");
   };
   add("P only", o.tightened);
   add("first Tmax", o.first_peak);
   add("back to T = 0", o.first_end);
   profiles.limit_x(-1.15 * edge, 1.15 * edge);
   miniapp::Panel density = miniapp::Panel::lines(
      "dissipation", "Dissipation a cycle along the contact", "x/t", "D' E' t/P0² × 10³");
   const VectorXd weight = problem.weights * (P0() * P0() / 1e3);
   density.add("first cycle", position,
               o.report.cycles.front().node_dissipation.cwiseQuotient(weight));
   density.add("steady cycle", position,
               o.report.cycles.back().node_dissipation.cwiseQuotient(weight));
   density.limit_x(-1.15 * edge, 1.15 * edge);
   miniapp::Panel zones = diagram;
   zones.limit_y(-1.15 * edge, 1.15 * edge);
   panels.insert(panels.end(), {profiles, zones, density});
}

/// Some states of the first cycle, evenly spaced, the first and the last among them.
void Study::write_frames(const std::vector<ContactState> &states)
{
   std::vector<ContactState> shown;
   const std::size_t last = states.size() - 1;
   const auto count = std::min(static_cast<std::size_t>(frames), last);
   for (std::size_t k = 0; k <= count; ++k) { shown.push_back(states[k * last / count]); }
   counters -= joint.reduction.counters; // what the frames cost is added
   miniapp::write_paraview(paraview, joint.reduction,
                           {joint.bodies[0].get(), joint.bodies[1].get()}, shown);
   counters += joint.reduction.counters;
   std::cout << shown.size() << " frames of the first cycle in " << paraview << "\n";
}

/// One bolt: the thesis' study.
int Study::single()
{
   set_friction(problem(), friction);
   FrictionSolver solver(problem());
   counters += solver.counters();
   miniapp::Panel diagram = miniapp::Panel::zones(
      "zones", "Zones in time (1: pinched, then T: 0 → Tmax → 0)", "load step", "x/t");
   nlohmann::ordered_json evolution = nlohmann::ordered_json::array();
   std::vector<ContactState> states; // of the first cycle, for the frames
   auto observe = [&](const ContactState &state)
   {
      if (state.time < 1) { return; }
      if (!paraview.empty() && state.time <= 3) { states.push_back(state); }
      const std::vector<Zone> all = zones(problem(), state);
      diagram.add(state.time, all, [&](double s) { return x(s); });
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      for (const Zone &zone : all)
      {
         list.push_back({{"state", name(zone.state)},
                         {"from", x(zone.from.position)},
                         {"to", x(zone.to.position)}});
      }
      evolution.push_back({{"time", state.time},
                           {"load", named(problem(), state.multipliers).at("T")},
                           {"zones", list}});
   };
   const miniapp::Stopwatch watch;
   const Outcome o = run(solver, tightening({0}, P0()), load * P0(), cycles, settings, observe);
   counters += o.report.counters;
   miniapp::add_exact_path(problem(), o.report, settings, results);
   if (o.code != 0)
   {
      miniapp::add_outcome(problem(), o.report, results);
      return o.code;
   }
   const auto pm = [](double error) { return miniapp::error_text(error); };
   std::printf("\nP only:   a0/t = %.4f ± %s, peak pressure %.4f p0\n", o.a0,
               pm(o.a0_error).c_str(), o.peak_pressure);
   std::printf("T/P0 = %g: a/t = %.4f ± %s, c/t = %.4f ± %s first, %.4f ± %s %s\n", load, o.a,
               pm(o.a_error).c_str(), o.c_first, pm(o.c_first_error).c_str(), o.c_steady,
               pm(o.c_steady_error).c_str(),
               o.report.steady_cycle ? "steady" : "in the last cycle, not steady yet");
   std::printf("\n cycle   D E'/P0²    work - D   slip change\n");
   const double unit = P0() * P0();
   for (std::size_t k = 0; k < o.report.cycles.size(); ++k)
   {
      const CycleRecord &cycle = o.report.cycles[k];
      std::printf("%6zu  %10.4e  %10.2e  %12.2e\n", k + 1, cycle.dissipation / unit,
                  (cycle.external_work - cycle.dissipation) / unit, cycle.slip_change);
   }
   if (o.report.steady_cycle)
   {
      std::printf("steady from cycle %d, period %d\n", o.report.steady_cycle,
                  o.report.steady_period);
   }
   const double skew = std::max({asymmetry(o.tightened.p), asymmetry(o.first_peak.p),
                                 asymmetry(o.first_peak.q), asymmetry(o.first_end.q)});
   const double memory =
      (o.first_end.p - o.tightened.p).cwiseAbs().maxCoeff() / o.tightened.p.maxCoeff();
   std::printf("asymmetry of p and q %.1e, memory of p %.1e, shear after P %.1e f p0\n", skew,
               memory, tractions(problem(), o.tightened.q).cwiseAbs().maxCoeff() / friction);
   results["a0"] = o.a0;
   results["peak_pressure"] = o.peak_pressure;
   results["a"] = o.a;
   results["c_first"] = o.c_first;
   results["c_steady"] = o.c_steady;
   results["a0_error"] = o.a0_error;
   results["a_error"] = o.a_error;
   results["c_first_error"] = o.c_first_error;
   results["c_steady_error"] = o.c_steady_error;
   results["dissipation_first"] = o.first() / unit;
   results["dissipation_steady"] = o.steady() / unit;
   results["asymmetry"] = skew;
   results["pressure_memory"] = memory;
   results["work_error"] = o.work_error();
   results["energy_imbalance"] = o.report.energy_imbalance;
   results["steady_cycle"] = o.report.steady_cycle;
   results["steady_period"] = o.report.steady_period;
   results["zones"] = evolution;
   results["seconds_march"] = o.report.seconds;
   // The remote load goes from none to its peak: the pressed state is the cycle's other end.
   miniapp::EdgeStudy edges{problem(), o.tightened, o.first_peak};
   edges.opposite = &edges.pressed;
   edges.cycle = &o.report.cycles.back();
   edges.modulus = 0.5; // E*, with E' = 1 of both laps
   const miniapp::EdgeReport report = miniapp::read_edges(edges);
   miniapp::print(report, [&](double s) { return x(s); });
   results["edges"] = miniapp::to_json(report);
   compare(o);
   draw(o, diagram);
   if (!paraview.empty()) { write_frames(states); }
   return 0;
}

/// Sweeps over T, f and w (thesis figures 6.5, 6.10, 6.11). Other widths are shown both with
/// the pressure p0 of the first one and with its clamping force P0; T is the same force in all.
int Study::sweep(const std::vector<double> &loads, const std::vector<double> &frictions,
                 const std::vector<double> &widths)
{
   const miniapp::Stopwatch watch;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   const double unit = P0() * P0();
   miniapp::Panel extents = miniapp::Panel::lines("extent", "Steady contact a and stick c",
                                                  "T/P0", "a/t (upper), c/t (lower)");
   miniapp::Panel losses =
      miniapp::Panel::lines("loss", "Dissipation a steady cycle", "|T|/P0", "D E'/P0²");
   miniapp::Panel by_width =
      miniapp::Panel::lines("loss_by_width", "Dissipation a steady cycle", "w/t", "D E'/P0²");
   losses.logarithmic();
   std::printf(
      "\n      f    w/t   p/p0     T/P0     a0/t      a/t  c first c steady    D first   "
      "D steady\n");
   for (double f : frictions)
   {
      set_friction(problem(), f);
      FrictionSolver solver(problem());
      counters += solver.counters();
      // Of the first width: a and c over T, and D over T of either sign.
      MarchSettings to_steady = settings;
      to_steady.stop_at_steady_state = true;
      std::vector<double> T, a, c, tension, compression, D_tension, D_compression;
      std::vector<std::vector<double>> by_p0(loads.size()), by_P0(loads.size());
      for (double width : widths)
      {
         std::vector<double> pressures{1.0};
         if (width != P0()) { pressures.push_back(P0() / width); }
         for (double pressure : pressures)
         {
            for (std::size_t k = 0; k < loads.size(); ++k)
            {
               const Outcome o = run(solver, tightening({0}, width, pressure), loads[k] * P0(),
                                     cycles, to_steady);
               counters += o.report.counters;
               // Gross sliding is a result of a sweep, not its end.
               const double first = o.code ? none : o.first() / unit;
               const double steady = o.code ? none : o.steady() / unit;
               std::printf("%7.3g %6.3g %6.3g %8.4f %8.4f %8.4f %8.4f %8.4f %10.3e %10.3e\n", f,
                           width, pressure, loads[k], o.a0, o.a, o.c_first, o.c_steady, first,
                           steady);
               list.push_back({{"friction", f},
                               {"width", width},
                               {"pressure", pressure},
                               {"load", loads[k]},
                               {"a0", o.a0},
                               {"a", o.a},
                               {"c_first", o.c_first},
                               {"c_steady", o.c_steady},
                               {"dissipation_first", miniapp::json_number(first)},
                               {"dissipation_steady", miniapp::json_number(steady)},
                               {"status", name(o.report.status)}});
               if (pressure == 1) { by_p0[k].push_back(steady); }
               if (pressure != 1 || width == P0()) { by_P0[k].push_back(steady); }
               if (width != P0() || o.code) { continue; }
               T.push_back(loads[k]);
               a.push_back(o.a);
               c.push_back(o.c_steady);
               (loads[k] > 0 ? tension : compression).push_back(std::abs(loads[k]));
               (loads[k] > 0 ? D_tension : D_compression).push_back(steady);
            }
         }
      }
      const std::string rubbed = miniapp::exact_text("f = ", f);
      extents.add("a, " + rubbed, T, a);
      extents.add("c, " + rubbed, T, c);
      if (!tension.empty()) { losses.add("tension, " + rubbed, tension, D_tension); }
      if (!compression.empty())
      {
         losses.add("compression, " + rubbed, compression, D_compression);
      }
      for (std::size_t k = 0; k < loads.size(); ++k)
      {
         const std::string label = miniapp::exact_text("T/P0 = ", loads[k]) + ", " + rubbed;
         by_width.add(label + ", same p0", widths, by_p0[k]);
         by_width.add(label + ", same P0", widths, by_P0[k]);
      }
   }
   if (loads.size() > 1) { panels.insert(panels.end(), {extents, losses}); }
   if (widths.size() > 1) { panels.push_back(by_width); }
   results["sweep"] = list;
   results["seconds_sweep"] = watch.seconds();
   return 0;
}

/// A row of bolts, tightened in several orders (thesis 8.2, item 3).
int Study::row(const std::vector<std::vector<int>> &all)
{
   set_friction(problem(), friction);
   FrictionSolver solver(problem());
   counters += solver.counters();
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   const double unit = P0() * P0();
   miniapp::Panel residual =
      miniapp::Panel::lines("residual", "Shear left by tightening", "x/t", "q/(f p0)");
   miniapp::Panel density =
      miniapp::Panel::lines("dissipation", "Dissipation a steady cycle along the contact",
                            "x/t", "D' E' t/P0² × 10³");
   const VectorXd position = problem().position.col(0);
   std::printf("\n order of tightening   largest q/fp0   D first   D steady   steady from\n");
   for (const std::vector<int> &order : all)
   {
      const Outcome o = run(solver, tightening(order, P0()), load * P0(), cycles, settings);
      counters += o.report.counters;
      if (o.code != 0) { return o.code; }
      std::string label;
      nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
      for (int bolt : order)
      {
         label += (label.empty() ? "" : " ") + std::to_string(bolt + 1);
         numbers.push_back(bolt + 1);
      }
      const VectorXd q = tractions(problem(), o.tightened.q);
      const double largest = q.cwiseAbs().maxCoeff() / friction;
      std::printf(" %-20s %14.3e %10.3e %10.3e %8d\n", label.c_str(), largest, o.first() / unit,
                  o.steady() / unit, o.report.steady_cycle);
      list.push_back({{"order", numbers},
                      {"residual_shear", largest},
                      {"dissipation_first", o.first() / unit},
                      {"dissipation_steady", o.steady() / unit},
                      {"steady_cycle", o.report.steady_cycle},
                      {"work_error", o.work_error()}});
      residual.add("order " + label, position, q / friction);
      density.add("order " + label, position,
                  o.report.cycles.back().node_dissipation.cwiseQuotient(problem().weights) *
                     (1e3 / unit));
   }
   panels.insert(panels.end(), {residual, density});
   results["tightening"] = list;
   return 0;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         miniapp::StudyOutput output;
         Study study;
         miniapp::LapJointOptions &options = study.options;
         options.spacing = 0.005;
         const char *bolts = "0", *tightening = "", *sweep_load = "", *sweep_friction = "",
                    *sweep_width = "", *march_by = "advancing", *paraview = "";
         bool touch = false, all_cycles = false;
         miniapp::Options args(argc, argv);
         args.AddOption(&options.widths[0], "-width", "--width",
                        "Width w of the pinch pressure, in t.");
         args.AddOption(&options.protrusion, "-protrusion", "--protrusion",
                        "Free end beyond the (outermost) bolt, in t.");
         args.AddOption(&options.remote, "-remote", "--remote",
                        "Loaded end beyond the (outermost) bolt, in t.");
         args.AddOption(&options.lower_thickness, "-lower-thickness", "--lower-thickness",
                        "Thickness of the lower lap over the upper's (1: equal laps).");
         args.AddOption(&study.friction, "-friction", "--friction", "Coefficient of friction.");
         args.AddOption(&study.load, "-load", "--load", "Tmax/P0, tension positive.");
         args.AddOption(&study.cycles, "-cycles", "--cycles",
                        "Cycles at most; the march stops when steady.");
         args.AddOption(&all_cycles, "-all-cycles", "--all-cycles", "-stop-when-steady",
                        "--stop-when-steady", "March all cycles.");
         args.AddOption(&study.settings.increments, "-increments", "--increments",
                        "Load increments from 0 to Tmax, and as many back.");
         args.AddOption(&march_by, "-march", "--march", miniapp::stepping_help);
         args.AddOption(&touch, "-touch", "--touch", "-no-touch", "--no-touch",
                        "Find the compression at which the free ends touch.");
         args.AddOption(&bolts, "-bolts", "--bolts", "Positions of the bolts, in t.");
         args.AddOption(&tightening, "-tightening", "--tightening",
                        "Orders of tightening, bolts from 1: \"2 1 3 / 1 3 2\" (empty: inner "
                        "first, outer first).");
         args.AddOption(&study.snug, "-snug", "--snug",
                        "Pressure over p0 to which several bolts are drawn together first.");
         args.AddOption(&sweep_load, "-sweep-load", "--sweep-load",
                        "Sweep: list of T/P0 (empty: none).");
         args.AddOption(&sweep_friction, "-sweep-friction", "--sweep-friction",
                        "Sweep: list of f (empty: --friction).");
         args.AddOption(&sweep_width, "-sweep-width", "--sweep-width",
                        "Sweep: list of w/t (empty: --width).");
         args.AddOption(&options.order, "-order", "--order", "Order of the elements.");
         args.AddOption(&options.spacing, "-spacing", "--spacing",
                        "Distance of the contact nodes, in t.");
         args.AddOption(&options.poisson, "-poisson", "--poisson",
                        "Poisson's ratio of both laps.");
         args.add(miniapp::Options::Names::folder, &paraview, "-paraview", "--paraview",
                  "Folder for ParaView files of the first cycle (one bolt).");
         args.AddOption(&study.frames, "-frames", "--frames",
                        "Intervals between the frames of --paraview.");
         output.add_options(args);
         args.parse();

         require(study.frames >= 1, "option --frames is ", study.frames,
                 ", must be at least 1");
         study.paraview = paraview;
         require(study.friction > 0, "option --friction is ", study.friction,
                 ", must be positive");
         require(study.cycles >= 1, "option --cycles is ", study.cycles,
                 ", must be at least 1");
         require(study.settings.increments >= 1, "option --increments is ",
                 study.settings.increments, ", must be at least 1");
         require(study.snug >= 0 && study.snug < 1, "option --snug is ", study.snug,
                 ", must be 0 or more and below 1");
         study.settings.stepping = miniapp::stepping("--march", march_by);
         study.settings.stop_at_steady_state = !all_cycles;
         options.bolts = miniapp::numbers("--bolts", bolts);
         const std::vector<double> loads = miniapp::numbers("--sweep-load", sweep_load);
         std::vector<double> frictions = miniapp::numbers("--sweep-friction", sweep_friction);
         std::vector<double> widths = miniapp::numbers("--sweep-width", sweep_width);
         for (double f : frictions)
         {
            require(f > 0, "option --sweep-friction: ", f, " must be positive");
         }
         if (frictions.empty()) { frictions = {study.friction}; }
         if (widths.empty()) { widths = {options.widths[0]}; }
         for (double w : widths)
         {
            auto &all = options.widths;
            if (std::find(all.begin(), all.end(), w) == all.end()) { all.push_back(w); }
         }
         const bool single = options.bolts.size() == 1;
         require(single || !paraview[0],
                 "option --paraview: frames are of one bolt, there are ", options.bolts.size());
         require(single || loads.empty(),
                 "option --sweep-load: sweeps are of one bolt, there are ",
                 options.bolts.size());
         const std::vector<std::vector<int>> all = orders(tightening, options.bolts);

         study.joint = miniapp::make_lap_joint(options);
         study.counters = study.joint.reduction.counters;
         set_friction(study.problem(), study.friction);
         output.reduced(study.problem(), study.joint.dofs);
         int code = single ? study.single() : study.row(all);
         nlohmann::ordered_json &results = study.results;
         if (code == 0 && touch)
         {
            set_friction(study.problem(), study.friction);
            FrictionSolver solver(study.problem());
            const double limit = -study.friction * study.P0() * options.bolts.size();
            const double load =
               touch_load(solver, study.tightening(all[0], study.P0()).back(), limit);
            study.counters += solver.counters();
            const double ratio = load / study.P0();
            std::printf("\nThe free ends touch at T/P0 = %.5f\n", ratio);
            results["touch_load"] = miniapp::json_number(ratio);
            if (!study.table.empty())
            {
               study.table.add("T/P0 at which the free ends touch", -0.0407, 1e-4, -0.04,
                               ratio);
            }
         }
         if (code == 0 && !loads.empty()) { code = study.sweep(loads, frictions, widths); }
         results["code"] = code;
         output.write(results, study.counters, study.table, study.panels);
         return code;
      });
}
