//  contact: frictional contact of your own meshes: any number of bodies and interfaces
//
//  Reads meshes (MFEM, Gmsh, ABAQUS or CalculiX), condenses each to the nodes of its interfaces
//  and marches a load history with Coulomb friction. A JSON case file names bodies, interfaces,
//  bolts and loads: docs/contact.md describes it. Any consistent units will do. Forces of plane
//  cases are per unit thickness, unless --thickness is given.
//
//  Sample runs:
//    contact --case meshes/bolted_joint.json
//    contact --case meshes/pin.json
//    contact --case meshes/dovetail.json
//    contact --case meshes/rounded_punch.json --cycles 2 --edges "1 2 3"
//    contact --case meshes/rounded_punch.json --check --plot check.png
//    contact --case meshes/punch_on_half_plane.json
//    contact --case meshes/calculix/laps.json
//    contact --case meshes/dovetail.json --set interfaces.flank.friction=0

#include "common/contact_edges.hpp"
#include "common/own_history.hpp"
#include "contact/bolts_report.hpp"
#include "contact/contact_in_space.hpp"
#include "contact/example_case.hpp"
#include "contact/joint_report.hpp"
#include "contact/load_sizes.hpp"
#include "contact/named_points.hpp"
#include "contact/own_bodies.hpp"
#include "contact/own_warnings.hpp"
#include "contact/reactions.hpp"
#include "contact/sketch.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cmath>
#include <deque>
#include <optional>

using namespace cattaneo;
using namespace miniapp;

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

struct CaseOptions
{
   int order = 2;
   double thickness = none;
   std::string example, paraview, analysis = "plane strain", geometry = "smooth", bodies,
                                  interfaces, bolts, points, units;
   std::vector<double> edges;

   explicit CaseOptions(Study &study)
   {
      study.options().require_version(2);
      study.options().group("The case");
      study.option(&example, "example",
                   ("Prints a case to start from, as in --example joint > my.json, and does "
                    "nothing else. Names: " +
                    example_names() + ".")
                      .c_str());
      study.options().leave_out_of_cases("example");
      study.option(&analysis, "analysis", "plane strain, plane stress, axisymmetric or space.");
      study.option(
         &thickness, "thickness",
         "Thickness of plane bodies: forces, moments and energies are those of the whole "
         "thickness (default: unit thickness).",
         positive);
      study.option(&geometry, "geometry",
                   "Sides meshed with straight edges: smooth (the curve through their "
                   "vertices, if they lie on one) or as meshed (polygons).",
                   {"smooth", "as meshed"});
      study.option(&bodies, "bodies", "Bodies by their names, as JSON.", Text::structure);
      study.option(&interfaces, "interfaces",
                   "Interfaces, where bodies touch, by their names, as JSON.", Text::structure);
      study.option(&bolts, "bolts",
                   "Bolts, which pull two parts together, by their names, as JSON.",
                   Text::structure);
      study.option(
         &points, "points",
         "Points at which displacements and stresses are printed, by their names, as JSON.",
         Text::structure);
      study.option(&units, "units",
                   "Names of the units of length and force, as JSON; they are printed, and "
                   "nothing is converted.",
                   Text::structure);
      study.options().add_set();
      study.option(&order, "order", "Order of the elements.", within(1, 8));
      study.option(&edges, "edges",
                   "Times of two states, after pressing and at the peak of the cyclic loads: "
                   "prints the intensities of pressure and shear (K_N, K_T) and the slip at "
                   "the edges of contact. With a third time, the other end of the cycle, the "
                   "energy loss at the edges is printed too.");
      study.option(&paraview, "paraview", "Folder for ParaView files.", Text::folder);
   }

   void check_edges(const std::string &called) const
   {
      require(edges.empty() || edges.size() == 2 || edges.size() == 3, called, " has ",
              edges.size(),
              " times, must have two (pressed, peak) or three (the other end of the cycle)");
      for (std::size_t k = 1; k < edges.size(); ++k)
      {
         require(edges[k] > edges[0], called, ": time ", edges[k],
                 " must be after the pressed state's, ", edges[0]);
      }
   }

   JointCase joint() const
   {
      return joint_case({analysis, structure("bodies", bodies),
                         structure("interfaces", interfaces), structure("bolts", bolts),
                         structure("points", points), structure("units", units), geometry,
                         thickness},
                        order);
   }
};

void contact(Study &study)
{
   CaseOptions options(study);
   OwnHistory history(study);
   study.parse();
   require(options.example.empty(), "option --example stands alone: it prints a case and ends");
   const std::string edges = study.options().called("edges");
   options.check_edges(edges);
   const JointCase joint = options.joint();
   history.check_options();
   if (!joint.unit_of_length.empty())
   {
      study.units = {joint.unit_of_length, joint.unit_of_force,
                     joint.formulation == Formulation::plane && std::isnan(options.thickness)};
      study.results["units"] = {{"length", joint.unit_of_length},
                                {"force", joint.unit_of_force}};
      // Each column and each number has its unit.
      if (study.verbose())
      {
         study.say("   units are" + study.units.of(0, 1) + " and" + study.units.of(1, 0) +
                   ", forces in" + study.units.total(0));
      }
   }
   if (joint.in_space())
   {
      require(options.edges.empty(), edges,
              " is for plane and axisymmetric bodies: leave it out of a case in space");
      contact_in_space(study, joint, history, options.paraview);
      return;
   }
   Snapshots snapshots{options.edges, {}};
   snapshots.states.resize(snapshots.times.size());

   OwnBodies own = make_own_bodies(joint);
   require(options.paraview.empty() || own.known_elements,
           "option --paraview needs the elements of all bodies, which a matrix does not have: "
           "leave it out");
   require(options.paraview.empty() || joint.formulation != Formulation::plane ||
              !joint.bodies.back().half_plane || !std::isnan(joint.bodies.back().depth),
           "option --paraview writes displacements, which on a half-plane are relative to a "
           "depth: ",
           joint.bodies.back().source.called("half-plane.depth"), " must give it");
   if (!own.known_elements)
   {
      own.scene.bodies.clear();
   } // bodies without elements are not shown
   ReducedProblem &problem = own.scene.problem();
   require(!problem.patterns.empty(), "there is no load: key 'load' of a body must name one");
   require(options.edges.empty() || (joint.faces.size() == 1 && own.known_elements), edges,
           " is for one interface of bodies with elements, the case has ", joint.faces.size(),
           own.known_elements ? "" : " and a body that is a matrix");
   require(options.edges.empty() || std::isnan(options.thickness), edges,
           " is per thickness, it goes without the key 'thickness'");
   require(options.edges.empty() || (problem.nodes() > 0 && problem.friction.maxCoeff() > 0),
           edges, " needs friction, because without it nothing sticks");
   set_load_sizes(own, joint);
   report_load_sizes(study, problem);
   history.about_axis = joint.formulation != Formulation::plane;
   history.bolts = own.bolted ? &*own.bolted : nullptr;
   history.go_with = joint.go_with;
   history.begin(problem);
   history.check_times("edges", options.edges);
   if (!std::isnan(options.thickness))
   {
      study.results["thickness"] = options.thickness;
      study.say(text("   thickness %g%s: forces, moments and energies are those of the whole "
                     "thickness",
                     options.thickness, study.units.of(0, 1).c_str()));
   }
   study.condensed(own.scene);
   study.value("condensation_error_estimate", own.accuracy);
   // If bodies are only tied, nothing can open or slip: there is no contact node.
   const bool touches = problem.nodes() > 0;
   require(touches || !own.bolted,
           "all interfaces are tied, and bolts have the key 'preload', which is for joints "
           "that may open or slip: use key 'pretension' instead");
   if (!touches || study.verbose())
   {
      study.say(
         (touches ? text("   gap %g to %g; ", problem.gap.minCoeff(), problem.gap.maxCoeff())
                  : std::string("   all interfaces are tied; ")) +
         text("relative error of the condensed stiffness: %.2g (estimate)", own.accuracy));
   }
   warn_of_accuracy(own.accuracy);
   std::deque<SidesThatBear> beyond_corners;
   const std::vector<bool> even = even_sides(joint);
   for (std::size_t k = 0; k < own.scene.reduction.interfaces.size(); ++k)
   {
      const InterfaceReport &face = own.scene.reduction.interfaces[k];
      warn_of_overlap(problem, face);
      warn_of_left_out(face);
      if (face.tied) { continue; }
      if (face.bodies[1] < 0 && even[k])
      {
         beyond_corners.emplace_back(face, joint.faces[k].obstacle);
      }
      else { beyond_corners.emplace_back(face, own.scene.reduction.bodies); }
   }
   NamedPoints points(study, joint, own.scene, own.half_plane ? &*own.half_plane : nullptr);
   points.begin(history.state);
   JointReport joint_report(study, joint, own.scene.reduction);
   BoltsReport bolts(study, joint, own.scene.reduction);
   bolts.begin(history, history.bolts);
   history.keep = [&](ContactState &reached) { bolts.keep(reached); };
   if (history.state.time > 0)
   {
      joint_report.note(history.state, 0);
      bolts.note(history.state);
   }
   SmallDisplacements small(own.scene.reduction, even);
   std::optional<ReductionFields> fields;
   if (!options.paraview.empty())
   {
      study.begins(options.paraview, true);
      study.begins(options.paraview + "/contact", true);
      for (std::size_t b = 0; b < own.scene.reduction.bodies.size(); ++b)
      {
         study.begins(options.paraview + "/" + own.scene.reduction.bodies[b].name, true);
      }
      fields.emplace(
         own.scene.fields(options.paraview, own.half_plane ? &*own.half_plane : nullptr));
   }
   Sketch sketch(study, own.scene);
   // Pressures and openings in the state with the largest pressure, and the largest pressure of
   // each node.
   Eigen::VectorXd pressed = Eigen::VectorXd::Zero(problem.nodes()), away = pressed,
                   most = pressed;
   const Counters &spent = own.scene.reduction.counters;
   int frames = 0;
   history.march(problem,
                 [&](const ContactState &reached, bool frame)
                 {
                    snapshots.note(reached);
                    sketch.note(reached);
                    for (auto &side : beyond_corners) { side.note(reached); }
                    joint_report.note(reached, history.cycle);
                    bolts.note(reached);
                    if (touches) { small.note(reached); }
                    points.note(reached);
                    if (touches && reached.p.maxCoeff() > pressed.maxCoeff())
                    {
                       pressed = reached.p;
                       away = reached.w;
                    }
                    most = most.cwiseMax(reached.p);
                    if (!fields || !frame) { return; }
                    study.counters -= spent; // the cost of the frame is added
                    fields->write(reached);
                    study.counters += spent;
                    ++frames;
                 });
   sketch.report();
   study.save(problem);
   if (fields) { study.say(text("%d frames in %s", frames, options.paraview.c_str())); }
   for (const auto &side : beyond_corners) { side.warn(); }
   if (touches)
   {
      for (const std::string &said : geometry_warnings(own.scene.reduction, most))
      {
         warn(said);
      }
      const ChordalError chords = warn_of_chords(own.scene.reduction, pressed, away);
      // Smaller values are round-off of straight sides.
      if (chords.at_a_node > 1e-6 && std::isfinite(chords.at_a_node))
      {
         study.value("chords_peak_pressure_change_estimate", chords.of_peak);
         study.value("chords_node_pressure_change_estimate", chords.at_a_node);
      }
      warn_of_linear_axis(own.scene.reduction, pressed);
      warn_of_large_displacements(own.scene, small, history.state);
      if (history.report.status != FrictionStatus::converged) { warn_of_loose_bodies(own); }
   }

   history.report_state(problem, joint_report.of_state(history.state));
   joint_report.report(history.state, history.report);
   bolts.report(history.state);
   points.report(history.state);
   report_reactions(study, joint, own, bolts, history.state);
   history.report_march(problem);
   if (!snapshots.times.empty() && snapshots.complete())
   {
      fretting::MarchedStates states{problem, snapshots.states[0], snapshots.states[1]};
      if (snapshots.times.size() == 3 && !history.report.cycles.empty() &&
          history.report.cycles.back().whole)
      {
         states.opposite = &snapshots.states[2];
         states.cycle = &history.report.cycles.back();
      }
      if (own.materials.size() == 1) { states.cracked = CrackedBody::first; }
      states.modulus = own.modulus();
      states.corner = [&](int end) { return own.corner(end); };
      report_edges(study, fretting::read_edges(states));
   }
   if (touches) { report_critical_friction(study, problem); }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("contact", argc, argv,
                     [&](Study &study)
                     {
                        if (prints_example(argc, argv)) { throw Leave(); }
                        contact(study);
                     });
}
