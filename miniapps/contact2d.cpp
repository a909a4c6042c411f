//  contact2d: frictional contact of your own meshes: two bodies, or one on a rigid line
//
//  Reads one or two meshes (MFEM, or Gmsh in format 2.2), condenses them to the nodes of their
//  contact attributes and marches a load history with Coulomb friction. Materials, supports,
//  loads and history come from options, from a JSON case file, or from both: docs/contact2d.md
//  describes them. Units are the user's: forces are per unit thickness.
//
//  Sample runs:  contact2d -case meshes/dovetail.json
//                contact2d -case meshes/rounded_punch.json --cycles 2 -edges "1 2 3"
//                contact2d -mesh1 meshes/rounded_punch.msh -contact1 3 -load1 "P pressure 2 .1"

#include "common/contact_edges.hpp"
#include "common/own_bodies.hpp"
#include "common/run.hpp"
#include "common/statements.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <optional>

using namespace cattaneo;
using Eigen::VectorXd;
using miniapp::none;
using miniapp::Panel;
using miniapp::text;
using nlohmann::ordered_json;

namespace
{

/// States of a march at given times, each the first one that reaches its time.
struct Snapshots
{
   std::vector<double> times;
   std::vector<ContactState> states;

   void note(const ContactState &reached)
   {
      for (std::size_t k = 0; k < times.size(); ++k)
      {
         if (states[k].status.empty() && reached.time >= times[k]) { states[k] = reached; }
      }
   }
   bool complete() const
   {
      return std::none_of(states.begin(), states.end(),
                          [](const ContactState &s) { return s.status.empty(); });
   }
};

/// A saved state must stand where the history stands at its time.
void check_start(const ContactState &state, const LoadHistory &history)
{
   for (int k = 0; k < history.pieces(); ++k)
   {
      const LoadPiece piece = history.piece(k);
      if (state.time < piece.start || state.time > piece.end) { continue; }
      const VectorXd loads = piece.at((state.time - piece.start) / piece.duration());
      const double scale = history.multipliers.cwiseAbs().maxCoeff();
      require((loads - state.multipliers).cwiseAbs().maxCoeff() <= 1e-9 * scale,
              "option load-state: the saved state has the load multipliers (",
              state.multipliers.transpose(), "), the history has (", loads.transpose(),
              ") at its time ", state.time);
      return;
   }
   require(false, "option load-state: the saved state's time ", state.time,
           " is outside of the history, which ends at ",
           history.piece(history.pieces() - 1).end);
}

struct Options
{
   std::vector<miniapp::BodyOptions> bodies{2};
   int order = 2, cycle_start = -1, cycles = 1;
   bool plane_stress = false;
   double friction = 0, pairing = 1e-6;
   std::string gap = "geometry", history, stepping = "advancing", paraview, frames, save_state,
               load_state;
   std::vector<double> edges;
   MarchSettings settings;

   explicit Options(miniapp::Study &study)
   {
      add_options(study, bodies[0], "1", "Mesh of body 1 (MFEM, or Gmsh 2.2).");
      add_options(study, bodies[1], "2",
                  "Mesh of body 2; without it body 1 is on a rigid line.");
      study.option(&order, "order", "Order of the elements.", miniapp::within(1, 8));
      study.option(&plane_stress, "plane-stress", "Plane stress instead of plane strain.");
      study.option(
         &friction, "friction", "Coefficient of friction.",
         miniapp::Check{miniapp::not_negative.holds, "must be a number that is not negative"});
      study.option(&gap, "gap", "Initial gap: geometry (from the meshes) or closed (none).",
                   {"geometry", "closed"});
      study.option(&pairing, "pairing",
                   "Largest offset of paired nodes along the contact, in distances of nodes.",
                   miniapp::between(0, 0.5));
      study.option(&history, "history",
                   "Load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'; default: all from "
                   "0 to 1.",
                   miniapp::Text::statements);
      study.option(&cycle_start, "cycle-start",
                   "Point of the history (from 0) where its cycle starts; -1: there is none.");
      study.option(&cycles, "cycles",
                   "How often the cycle is marched (fewer once it is steady).");
      study.option(&settings.increments, "increments",
                   "Load increments between two points of the history.", miniapp::at_least(1));
      study.option(&stepping, "stepping", miniapp::stepping_help, miniapp::stepping_choices);
      study.option(&edges, "edges",
                   "Times of two states: pressed, and at the peak of the cyclic loads. Reports "
                   "K_N, K_T and slip at the contact edges; a third time is the other end of "
                   "the cycle, for the energy.");
      study.option(&paraview, "paraview", "Folder for ParaView files.", miniapp::Text::folder);
      study.option(&frames, "frames",
                   "Times to be written besides the last one, or all (every increment).");
      study.option(&save_state, "save-state", "File for the last state.",
                   miniapp::Text::output);
      study.option(&load_state, "load-state", "State to go on from.", miniapp::Text::input);
      for (const char *name : {"frames", "load-state"})
      {
         study.options().leave_out_of_cases(name);
      }
      study.parse();
      const miniapp::BodyOptions &second = bodies[1];
      require(!bodies[0].mesh.empty(), "option mesh1 is empty, must name a mesh file");
      require(!second.mesh.empty() || (second.contact + second.support + second.load).empty(),
              "options contact2, support2 or load2 are given without a mesh2");
      if (second.mesh.empty()) { bodies.pop_back(); }
      require(cycle_start >= -1, "option cycle-start is ", cycle_start,
              ", must be a point of the history, from 0, or -1 for no cycle");
      require(cycles >= 1, "option cycles: ", cycles, " cycles, at least 1 is needed");
      if (cycles > 1 && cycle_start < 0)
      {
         miniapp::warn("option cycles is " + std::to_string(cycles) +
                       ", but the history has no cycle: option cycle-start says where it "
                       "starts");
      }
      require(edges.empty() || edges.size() == 2 || edges.size() == 3, "option edges has ",
              edges.size(),
              " times, must have two (pressed, peak) or three (the other end of the cycle)");
      for (std::size_t k = 1; k < edges.size(); ++k)
      {
         require(edges[k] > edges[0], "option edges: time ", edges[k],
                 " must be after the pressed state's, ", edges[0]);
      }
      require(edges.empty() || friction > 0,
              "option edges needs friction: without it nothing is stuck");
      settings.stepping = miniapp::stepping(stepping);
   }
};

/// The last state: forces, zones, tractions.
void report_state(miniapp::Study &study, const ReducedProblem &problem, const ContactLine &line,
                  const ContactState &state, bool unique)
{
   // The contact pushes body 1 by q along the tangents and p along the normals.
   const Eigen::Vector2d force = line.each(&LineNode::tangent).transpose() * state.q +
                                 line.each(&LineNode::normal).transpose() * state.p;
   study.results["time"] = state.time;
   study.results["loads"] = named(problem, state.multipliers);
   study.results["contact_force"] = {force[0], force[1]};
   study.title(text("At time %g%s: contact force on body 1 (%g, %g)", state.time,
                    unique ? "" : ", one of several states", force[0], force[1]));
   study.value("peak_pressure", tractions(problem, state.p).maxCoeff(), "peak pressure");
   const std::vector<Zone> zones = cattaneo::zones(problem, state);
   const bool one_line = zones.back().chain == 0;
   miniapp::Table &table =
      study.table("zones", {{"state", "state"},
                            {"from", "from", "%.5g"},
                            {"to", "to (arc length)", "%.5g"},
                            {"", "±"},
                            {"from_error"},
                            {"to_error"},
                            {"piece", one_line ? "" : "piece of the line"}});
   for (const Zone &zone : zones)
   {
      study.row(table, {name(zone.state), zone.from.position, zone.to.position,
                        miniapp::error_text(std::max(zone.from.error, zone.to.error)),
                        zone.from.error, zone.to.error, zone.chain + 1});
   }
   const Eigen::Index touching = touching_nodes(problem, state);
   study.results["touching_nodes"] = touching;
   if (touching > 0)
   {
      study.say(text("   %ld nodes touch without force; they carry nothing and count as "
                     "separated",
                     static_cast<long>(touching)));
   }
   study
      .panel(Panel::Kind::lines, "tractions", "Pressure, and shear over f (dashed)",
             "arc length", "p, q/f")
      .add_tractions(text("time %g", state.time), problem.arc_length, problem, state);
}

void report_critical_friction(miniapp::Study &study, const ReducedProblem &problem)
{
   const CriticalFriction critical = critical_friction(problem);
   study.results["critical_friction"] = {{"node", critical.node},
                                         {"locking", critical.locking},
                                         {"unique_below", critical.unique_below}};
   const auto words = [](double value, const char *if_infinite)
   { return std::isfinite(value) ? text("%g", value) : if_infinite; };
   const std::string which = std::isfinite(critical.node)
                                ? text(" (node %ld)", static_cast<long>(critical.weakest_node))
                                : "";
   study.say(
      "Critical friction: of a node alone " + words(critical.node, "none") + which +
      ", locks itself above " + words(critical.locking, "none") +
      ", one answer for sure below " +
      (critical.unique_below > 0 ? words(critical.unique_below, "any") : "(nothing proven)"));
}

void contact2d(miniapp::Study &study)
{
   Options options(study);
   const bool all_frames = options.frames == "all";
   std::vector<double> wanted =
      all_frames ? std::vector<double>() : miniapp::numbers("--frames", options.frames);
   std::sort(wanted.begin(), wanted.end());
   Snapshots snapshots{options.edges, {}};
   snapshots.states.resize(snapshots.times.size());

   miniapp::OwnBodies own =
      make_own_bodies(options.bodies, options.order, options.plane_stress, options.pairing);
   const ContactLine &line = own.line();
   ReducedProblem &problem = own.scene.problem();
   set_friction(problem, options.friction);
   if (options.gap == "closed") { problem.gap.setZero(); }
   require(!problem.patterns.empty(), "there is no load: option load1 or load2 must name one");
   LoadHistory history = miniapp::load_history("history", options.history, problem);
   history.cycle_start = options.cycle_start;
   history.cycles = options.cycles;
   history.validate(static_cast<int>(problem.patterns.size()));
   ContactState state = ContactState::virgin(problem);
   if (!options.load_state.empty())
   {
      state = load_contact_state(options.load_state);
      state.validate(problem);
      check_start(state, history);
   }
   for (const auto &[option, times] : {std::pair{"frames", wanted}, {"edges", options.edges}})
   {
      for (double time : times)
      {
         const double end = history.piece(history.pieces() - 1).end;
         require(time > state.time && time <= end, "option ", option, ": time ", time,
                 " is outside of the march from ", state.time, " to ", end);
      }
   }
   study.condensed(own.scene);
   study.value("condensation_error", own.accuracy);
   study.say(text("   gap %g to %g; stiffness right to %.2g of itself", problem.gap.minCoeff(),
                  problem.gap.maxCoeff(), own.accuracy));
   miniapp::warn_of_accuracy(own.accuracy);
   miniapp::warn_of_overlap(problem, line);

   const bool recording = !study.csv().empty() || !options.paraview.empty();
   HistoryTable table;
   std::vector<ContactState> recorded;
   Panel &diagram =
      study.panel(Panel::Kind::zones, "zones_in_time", "Zones in time", "time", "arc length");
   auto next_frame = wanted.begin();
   std::optional<miniapp::SidesThatBear> beyond_corners;
   if (own.materials.size() == 1) { beyond_corners.emplace(line); }
   const auto observe = [&](const ContactState &reached, const IncrementRecord &record)
   {
      snapshots.note(reached);
      if (beyond_corners) { beyond_corners->note(reached); }
      if (study.draws() || recording) { diagram.add(reached.time, zones(problem, reached)); }
      if (!recording) { return; }
      table.add(reached, record);
      bool frame = all_frames;
      for (; next_frame != wanted.end() && reached.time >= *next_frame; ++next_frame)
      {
         frame = true;
      }
      if (frame) { recorded.push_back(reached); }
   };
   miniapp::Watch watch("march");
   options.settings.monitor = watch.monitor();
   const MarchReport report = march(problem, history, state, options.settings, observe);
   require(std::isfinite(report.energy_imbalance) && std::isfinite(state.dissipation),
           "the energies of the march overflow: the loads or the moduli need other units");
   study.save(problem);
   study.counters += report.counters;
   study.code = miniapp::exit_code(problem, report);
   miniapp::add_outcome(problem, report, study.results);
   if (beyond_corners) { beyond_corners->warn(); }
   if (recording && (recorded.empty() || recorded.back().time != state.time))
   {
      recorded.push_back(state);
   }
   if (!options.paraview.empty()) { study.write_frames(options.paraview, own.scene, recorded); }
   if (!study.csv().empty() && miniapp::writes())
   {
      table.write(study.csv() + "_history.csv", problem);
      write_nodes(study.csv() + "_nodes.csv", problem, recorded);
   }
   if (!options.save_state.empty() && miniapp::writes()) { save(state, options.save_state); }

   report_state(study, problem, line, state, !report.not_unique);
   const int last_cycle = report.increments.empty() ? 0 : report.increments.back().cycle;
   // A cycle that was not finished has increments, but no record.
   const bool unfinished = study.code != 0 && last_cycle > 0;
   const int ended = static_cast<int>(report.cycles.size()),
             first_cycle = last_cycle - ended + (unfinished ? 0 : 1);
   report_cycles(study, problem, report, 1, first_cycle);
   study.results["first_cycle"] = ended == 0 ? 0 : first_cycle;
   study.results["total_dissipation"] = state.dissipation;
   study.results["advance_error"] = report.advance_error;
   study.results["largest_residual"] = report.largest_residual;
   if (options.settings.stepping == Stepping::exact)
   {
      report_exact_path(study, problem, report);
   }
   if (!snapshots.times.empty() && snapshots.complete())
   {
      miniapp::EdgeStudy edges{problem, snapshots.states[0], snapshots.states[1]};
      if (snapshots.times.size() == 3 && !report.cycles.empty())
      {
         edges.opposite = &snapshots.states[2];
         edges.cycle = &report.cycles.back();
      }
      if (own.materials.size() == 1) { edges.cracked = CrackedBody::first; }
      edges.modulus = own.modulus();
      edges.corner = [&](int end) { return own.corner(end); };
      const miniapp::EdgeReport found = miniapp::read_edges(edges);
      miniapp::print(found, [](double s) { return s; });
      study.results["edges"] = miniapp::to_json(found);
   }
   report_critical_friction(study, problem);
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::Study::run("contact2d", argc, argv, contact2d);
}
