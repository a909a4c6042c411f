//  contact2d: frictional contact of your own meshes: two bodies, or one on a line or half-plane
//
//  Reads one or two meshes (MFEM, or Gmsh in format 2.2), condenses them to the nodes of their
//  contact attributes and marches a load history with Coulomb friction. Materials, supports,
//  loads and history come from options, from a JSON case file, or from both: docs/contact2d.md
//  describes them. Units are the user's: forces are per unit thickness.
//
//  Sample runs:  contact2d -case meshes/dovetail.json
//                contact2d -case meshes/rounded_punch.json --cycles 2 -edges "1 2 3"
//                contact2d -case meshes/rounded_punch.json --check --plot check.png
//                contact2d -case meshes/punch_on_half_plane.json
//                contact2d -case meshes/calculix/laps.json
//                contact2d -mesh1 meshes/rounded_punch.msh -contact1 3 -load1 "P pressure 2 .1"

#include "common/contact_edges.hpp"
#include "common/own_bodies.hpp"
#include "common/own_history.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <optional>

using namespace cattaneo;
using miniapp::text;

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

struct Options
{
   std::vector<miniapp::BodyOptions> bodies{2};
   miniapp::HalfPlaneOptions half_plane;
   int order = 2;
   bool plane_stress = false;
   double friction = 0, pairing = 1e-6;
   std::string matrix, gap = "geometry", paraview;
   std::vector<double> edges;

   explicit Options(miniapp::Study &study)
   {
      add_options(study, bodies[0], "1", "Mesh of body 1 (MFEM, or Gmsh 2.2).");
      add_options(study, bodies[1], "2",
                  "Mesh of body 2; without it body 1 is on a rigid line or a half-plane.");
      add_options(study, half_plane);
      study.option(&matrix, "matrix",
                   "Stiffness of both bodies, or of one, as another program wrote it, in place "
                   "of the meshes; contact, supports and loads are on its sets of nodes.",
                   miniapp::Text::input);
      study.option(&order, "order", "Order of the elements.", miniapp::within(1, 8));
      study.option(&plane_stress, "plane-stress", "Plane stress instead of plane strain.");
      study.option(&friction, "friction", "Coefficient of friction.", miniapp::not_negative);
      study.option(&gap, "gap", "Initial gap: geometry (from the meshes) or closed (none).",
                   {"geometry", "closed"});
      study.option(&pairing, "pairing",
                   "Largest offset of paired nodes along the contact, in distances of nodes.",
                   miniapp::between(0, 0.5));
      study.option(&edges, "edges",
                   "Times of two states: pressed, and at the peak of the cyclic loads. Reports "
                   "K_N, K_T and slip at the contact edges; a third time is the other end of "
                   "the cycle, for the energy.");
      study.option(&paraview, "paraview", "Folder for ParaView files.", miniapp::Text::folder);
   }

   /// What a matrix has in itself, and what is not known of it.
   void check_matrix() const
   {
      for (const miniapp::BodyOptions &body : bodies)
      {
         require(body.mesh.empty() && body.young == std::vector<double>{1} &&
                    body.poisson == std::vector<double>{0.3},
                 "option matrix goes without meshes and without the options young and poisson, "
                 "which the matrix has in itself");
      }
      require(order == 2 && !plane_stress, "option matrix goes without the options order and "
                                           "plane-stress, which the matrix has in itself");
      require(edges.empty(), "option matrix goes without the option edges: materials are not "
                             "known");
   }

   void check()
   {
      const miniapp::BodyOptions &second = bodies[1];
      if (!matrix.empty()) { check_matrix(); }
      require(!bodies[0].mesh.empty() || !matrix.empty(),
              "option mesh1 is empty, must name a mesh file (or matrix a stiffness)");
      const bool alone = second.mesh.empty() && (matrix.empty() || second.contact.empty());
      require(!alone || (second.contact + second.support + second.load).empty(),
              "options contact2, support2 or load2 are given without a mesh2");
      require(alone || !half_plane.given(),
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
      if (alone) { bodies.pop_back(); }
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
   }
};

/// The contact pushes body 1 by q along the tangents and p along the normals.
Eigen::Vector2d contact_force(const ContactLine &line, const ContactState &state)
{
   return line.each(&LineNode::tangent).transpose() * state.q +
          line.each(&LineNode::normal).transpose() * state.p;
}

void contact2d(miniapp::Study &study)
{
   Options options(study);
   miniapp::OwnHistory history(study);
   study.parse();
   options.check();
   history.check_options();
   Snapshots snapshots{options.edges, {}};
   snapshots.states.resize(snapshots.times.size());

   miniapp::OwnBodies own =
      options.matrix.empty()
         ? make_own_bodies(options.bodies, options.half_plane, options.order,
                           options.plane_stress, options.pairing)
         : own_bodies_of_matrix(options.matrix, options.bodies, options.half_plane,
                                options.pairing);
   require(options.paraview.empty() || !own.scene.bodies.empty(),
           "option matrix goes without the option paraview: elements are not known");
   const ContactLine &line = own.line();
   ReducedProblem &problem = own.scene.problem();
   set_friction(problem, options.friction);
   if (options.gap == "closed") { problem.gap.setZero(); }
   require(!problem.patterns.empty(), "there is no load: option load1 or load2 must name one");
   history.begin(problem);
   history.check_times("edges", options.edges);
   study.condensed(own.scene);
   study.value("condensation_error", own.accuracy);
   study.say(text("   gap %g to %g; stiffness right to %.2g of itself", problem.gap.minCoeff(),
                  problem.gap.maxCoeff(), own.accuracy));
   miniapp::warn_of_accuracy(own.accuracy);
   miniapp::warn_of_overlap(problem, line);

   std::optional<miniapp::SidesThatBear> beyond_corners;
   if (own.materials.size() == 1) { beyond_corners.emplace(line); }
   std::optional<ReductionFields> fields;
   if (!options.paraview.empty())
   {
      for (const char *part : {"", "/contact", "/body1", "/body2"})
      {
         study.begins(options.paraview + part, true);
      }
      fields.emplace(
         own.scene.fields(options.paraview, own.half_plane ? &*own.half_plane : nullptr));
   }
   const Counters &spent = own.scene.reduction.counters;
   int frames = 0;
   history.march(problem,
                 [&](const ContactState &reached, bool frame)
                 {
                    snapshots.note(reached);
                    if (beyond_corners) { beyond_corners->note(reached); }
                    if (!fields || !frame) { return; }
                    study.counters -= spent; // what the frame costs is added
                    fields->write(reached);
                    study.counters += spent;
                    ++frames;
                 });
   study.save(problem);
   if (fields) { study.say(text("%d frames in %s", frames, options.paraview.c_str())); }
   if (beyond_corners) { beyond_corners->warn(); }

   const Eigen::Vector2d force = contact_force(line, history.state);
   study.results["contact_force"] = {force[0], force[1]};
   history.report_state(problem, text("contact force on body 1 (%g, %g)", force[0], force[1]));
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
      miniapp::report_edges(study, fretting::read_edges(edges));
   }
   miniapp::report_critical_friction(study, problem);
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::Study::run("contact2d", argc, argv, contact2d);
}
