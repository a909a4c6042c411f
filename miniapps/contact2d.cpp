//  contact2d: frictional contact of your own meshes: any number of bodies and interfaces
//
//  Reads meshes (MFEM, Gmsh, ABAQUS or CalculiX), condenses each to the nodes of its interfaces
//  and marches a load history with Coulomb friction. A JSON case file names bodies, interfaces,
//  bolts and loads; two bodies, or one on a line or half-plane, can be said by options as well:
//  docs/contact2d.md describes both. Units are the user's: forces are per unit thickness.
//
//  Sample runs:  contact2d -case meshes/bolted_joint.json
//                contact2d -case meshes/pin.json
//                contact2d -case meshes/dovetail.json
//                contact2d -case meshes/rounded_punch.json --cycles 2 -edges "1 2 3"
//                contact2d -case meshes/rounded_punch.json --check --plot check.png
//                contact2d -case meshes/punch_on_half_plane.json
//                contact2d -case meshes/calculix/laps.json
//                contact2d -mesh1 meshes/rounded_punch.msh -contact1 3 -load1 "P pressure 2 .1"

#include "common/contact_edges.hpp"
#include "common/own_history.hpp"
#include "contact2d/joint_report.hpp"
#include "contact2d/own_bodies.hpp"
#include "contact2d/own_options.hpp"
#include "contact2d/own_warnings.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
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
   std::vector<BodyOptions> bodies{2};
   HalfPlaneOptions half_plane;
   int order = 2;
   bool plane_stress = false;
   double friction = 0, pairing = 1e-6;
   std::string matrix, gap = "geometry", paraview, convert;
   std::vector<double> edges;
   std::string analysis, joined, interfaces, bolts; ///< the keys of a case file 2

   explicit CaseOptions(Study &study)
   {
      Options &all = study.options();
      all.of_version(1);
      add_options(study, bodies[0], "1", "Mesh of body 1 (MFEM, Gmsh, or .inp).");
      add_options(study, bodies[1], "2",
                  "Mesh of body 2; without it body 1 is on a rigid line or a half-plane.");
      add_options(study, half_plane);
      study.option(&matrix, "matrix",
                   "Stiffness of both bodies, or of one, as another program wrote it, in place "
                   "of the meshes; contact, supports and loads are on its sets of nodes.",
                   Text::input);
      all.of_version(0);
      study.option(&order, "order", "Order of the elements.", within(1, 8));
      all.of_version(1);
      study.option(&plane_stress, "plane-stress", "Plane stress instead of plane strain.");
      study.option(&friction, "friction", "Coefficient of friction.", not_negative);
      study.option(&gap, "gap", "Initial gap: geometry (from the meshes) or closed (none).",
                   {"geometry", "closed"});
      study.option(&pairing, "pairing",
                   "Largest offset of paired nodes along the contact, in distances of nodes.",
                   between(0, 0.5));
      all.of_version(0);
      study.option(&edges, "edges",
                   "Times of two states: pressed, and at the peak of the cyclic loads. Reports "
                   "K_N, K_T and slip at the contact edges; a third time is the other end of "
                   "the cycle, for the energy.");
      study.option(&paraview, "paraview", "Folder for ParaView files.", Text::folder);
      all.of_version(2);
      study.option(&analysis, "analysis", "plane strain, plane stress or axisymmetric.");
      study.option(&joined, "bodies", "Bodies by their names (case file 2).", Text::structure);
      study.option(&interfaces, "interfaces", "Where they touch, by names (case file 2).",
                   Text::structure);
      study.option(&bolts, "bolts", "Shanks that pull two parts together (case file 2).",
                   Text::structure);
      all.of_version(0);
      study.option(&convert, "convert", "File for the same as a case file 2, and stop there.",
                   Text::output);
   }

   /// Of file 1, or of no file.
   void check_bodies(const Options &said) const
   {
      const BodyOptions &second = bodies[1];
      said.only_if(
         matrix.empty(),
         {"mesh1", "mesh2", "young1", "young2", "poisson1", "poisson2", "plane-stress"},
         "is what a matrix has in itself, which goes without meshes");
      said.only_if(matrix.empty(), {"edges"},
                   "needs materials, which are not known of a matrix");
      require(!bodies[0].mesh.empty() || !matrix.empty(),
              "option mesh1 is empty, must name a mesh file (or matrix a stiffness)");
      require(!alone() || (second.contact + second.support + second.load).empty(),
              "options contact2, support2 or load2 are given without a mesh2");
      require(alone() || !half_plane.given(),
              "options mesh2 (or contact2) and half-plane-young are "
              "both given: body 1 stands on body 2 or on "
              "the half-plane");
      require(std::isnan(half_plane.poisson) != half_plane.given() &&
                 (half_plane.given() || std::isnan(half_plane.depth)),
              "options half-plane-young and half-plane-poisson must be given together, "
              "half-plane-depth with them only");
      require(paraview.empty() || !half_plane.given() || !std::isnan(half_plane.depth),
              "option paraview writes displacements, which on a half-plane are relative to a "
              "depth: option half-plane-depth must state it");
      require(edges.empty() || friction > 0,
              "option edges needs friction: without it nothing is stuck");
   }
   bool alone() const
   {
      return bodies[1].mesh.empty() && (matrix.empty() || bodies[1].contact.empty());
   }

   void check_edges() const
   {
      require(edges.empty() || edges.size() == 2 || edges.size() == 3, "option edges has ",
              edges.size(),
              " times, must have two (pressed, peak) or three (the other end of the cycle)");
      for (std::size_t k = 1; k < edges.size(); ++k)
      {
         require(edges[k] > edges[0], "option edges: time ", edges[k],
                 " must be after the pressed state's, ", edges[0]);
      }
   }

   bool of_file_2() const { return !(analysis + joined + interfaces + bolts).empty(); }

   /// The keys of a case file 2 that say it. A matrix may know the order of its elements, if
   /// none is said.
   JointKeys keys(const Options &said) const
   {
      if (of_file_2())
      {
         return {analysis.empty() ? "plane strain" : analysis, structure("bodies", joined),
                 structure("interfaces", interfaces), structure("bolts", bolts)};
      }
      check_bodies(said);
      using Json = nlohmann::ordered_json;
      const auto one_or_all = [](const std::vector<double> &values)
      { return values.size() == 1 ? Json(values[0]) : Json(values); };
      Json all, face;
      for (int k = 0; k < (alone() ? 1 : 2); ++k)
      {
         const BodyOptions &body = bodies[k];
         const std::string number = std::to_string(k + 1);
         Json &made = all[number];
         if (!matrix.empty()) { made["matrix"] = matrix; }
         else
         {
            made = {{"mesh", body.mesh},
                    {"young", one_or_all(body.young)},
                    {"poisson", one_or_all(body.poisson)}};
         }
         if (!matrix.empty() && said.says("order")) { made["order"] = order; }
         if (!body.support.empty()) { made["support"] = body.support; }
         if (!body.load.empty()) { made["load"] = split(body.load, ";"); }
         require(!body.young.empty() && !body.poisson.empty(), "options young", number,
                 " and poisson", number, " must not be empty");
         require(!body.contact.empty(), "option contact", number,
                 " is empty, must name boundary attributes");
         face["between"].push_back(number + ":" + body.contact);
      }
      if (half_plane.given())
      {
         Json &made = all["half-plane"]["half-plane"];
         made = {{"young", half_plane.young}, {"poisson", half_plane.poisson}};
         if (!std::isnan(half_plane.depth)) { made["depth"] = half_plane.depth; }
         face["between"].push_back("half-plane");
      }
      face["friction"] = friction;
      if (gap == "closed") { face["gap"] = gap; }
      if (!alone()) { face["pairing"] = pairing; }
      return {plane_stress ? "plane stress" : "plane strain", all, {{"contact", face}}, {}};
   }

   /// What the keys come to; of file 1 errors name options.
   JointCase all(const JointKeys &keys) const
   {
      JointCase made = joint_case(keys, order);
      if (of_file_2()) { return made; }
      made.numbered = true;
      for (JointCase::Body &body : made.bodies)
      {
         body.source = {"option ", body.name};
         if (body.half_plane) { body.source = {"option half-plane-", ""}; }
      }
      made.faces[0].source = {"option ", ""};
      for (int k : {0, 1})
      {
         made.faces[0].sides[k].called = "option contact" + std::to_string(k + 1);
      }
      return made;
   }
};

void contact2d(Study &study)
{
   CaseOptions options(study);
   OwnHistory history(study);
   study.parse();
   options.check_edges();
   const JointKeys keys = options.keys(study.options());
   const JointCase joint = options.all(keys);
   history.check_options();
   study.only_if(options.convert.empty(), {"csv", "plot", "html"},
                 "is of a run, --convert writes the case alone");
   if (!options.convert.empty()) { convert(study, keys, options.order, options.convert); }
   Snapshots snapshots{options.edges, {}};
   snapshots.states.resize(snapshots.times.size());

   OwnBodies own = make_own_bodies(joint);
   require(options.paraview.empty() || own.known_elements,
           "option matrix goes without the option paraview: elements are not known");
   if (!own.known_elements) { own.scene.bodies.clear(); } // of the others nothing is shown
   ReducedProblem &problem = own.scene.problem();
   require(!problem.patterns.empty(),
           joint.numbered ? "there is no load: option load1 or load2 must name one"
                          : "there is no load: key 'load' of a body must name one");
   require(options.edges.empty() || (joint.faces.size() == 1 && own.known_elements),
           "option edges is for one interface of bodies with elements, the case has ",
           joint.faces.size());
   history.begin(problem);
   history.check_times("edges", options.edges);
   study.condensed(own.scene);
   study.value("condensation_error", own.accuracy);
   study.say(text("   gap %g to %g; stiffness right to %.2g of itself", problem.gap.minCoeff(),
                  problem.gap.maxCoeff(), own.accuracy));
   warn_of_accuracy(own.accuracy);
   std::deque<SidesThatBear> beyond_corners;
   const std::vector<bool> even = even_sides(joint);
   for (std::size_t k = 0; k < own.scene.reduction.interfaces.size(); ++k)
   {
      const InterfaceReport &face = own.scene.reduction.interfaces[k];
      warn_of_overlap(problem, face);
      warn_of_left_out(face);
      if (face.tied) { continue; }
      if (face.bodies[1] < 0 && even[k]) { beyond_corners.emplace_back(face); }
      else { beyond_corners.emplace_back(face, own.scene.reduction.bodies); }
   }
   JointReport joint_report(study, joint, own.scene.reduction);
   if (history.state.time > 0) { joint_report.note(history.state, 0); }
   SmallDisplacements small(own.scene.reduction, even);
   std::optional<ReductionFields> fields;
   if (!options.paraview.empty())
   {
      study.begins(options.paraview, true);
      study.begins(options.paraview + "/contact", true);
      for (std::size_t b = 0; b < own.scene.reduction.bodies.size(); ++b)
      {
         study.begins(options.paraview + "/" + body_name(own.scene.reduction, b), true);
      }
      fields.emplace(
         own.scene.fields(options.paraview, own.half_plane ? &*own.half_plane : nullptr));
   }
   Eigen::VectorXd pressed = Eigen::VectorXd::Zero(problem.nodes()), // at the largest of all
      most = pressed;                                                // of each node
   const Counters &spent = own.scene.reduction.counters;
   int frames = 0;
   history.march(problem,
                 [&](const ContactState &reached, bool frame)
                 {
                    snapshots.note(reached);
                    for (auto &side : beyond_corners) { side.note(reached); }
                    joint_report.note(reached, history.cycle);
                    small.note(reached);
                    if (reached.p.maxCoeff() > pressed.maxCoeff()) { pressed = reached.p; }
                    most = most.cwiseMax(reached.p);
                    if (!fields || !frame) { return; }
                    study.counters -= spent; // what the frame costs is added
                    fields->write(reached);
                    study.counters += spent;
                    ++frames;
                 });
   study.save(problem);
   if (fields) { study.say(text("%d frames in %s", frames, options.paraview.c_str())); }
   for (const auto &side : beyond_corners) { side.warn(); }
   for (const std::string &said : geometry_warnings(own.scene.reduction, most)) { warn(said); }
   warn_of_chords(own.scene.reduction, pressed);
   warn_of_linear_axis(own.scene.reduction, pressed);
   warn_of_large_displacements(own, small, history.state);
   if (history.report.status != FrictionStatus::converged) { warn_of_loose_bodies(own); }

   history.report_state(problem, joint_report.of_state(history.state));
   joint_report.report(history.state, history.report);
   history.report_march(problem);
   if (!snapshots.times.empty() && snapshots.complete())
   {
      fretting::MarchedStates edges{problem, snapshots.states[0], snapshots.states[1]};
      if (snapshots.times.size() == 3 && !history.report.cycles.empty() &&
          history.report.cycles.back().whole)
      {
         edges.opposite = &snapshots.states[2];
         edges.cycle = &history.report.cycles.back();
      }
      if (own.materials.size() == 1) { edges.cracked = CrackedBody::first; }
      edges.modulus = own.modulus();
      edges.corner = [&](int end) { return own.corner(end); };
      report_edges(study, fretting::read_edges(edges));
   }
   report_critical_friction(study, problem);
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("contact2d", argc, argv, contact2d);
}
