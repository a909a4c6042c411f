#include "contact/contact_in_space.hpp"

#include "common/own_history.hpp"
#include "contact/bolts_report.hpp"
#include "contact/load_sizes.hpp"
#include "contact/named_points.hpp"
#include "contact/own_bolts.hpp"
#include "contact/own_part.hpp"
#include "contact/own_warnings.hpp"
#include "contact/report_in_space.hpp"
#include "contact/rims.hpp"
#include "contact/sketch.hpp"

#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector3d;

namespace
{

/// Where the cells of a brick end along an axis.
std::vector<double> cell_ends(const JointCase::Body::Brick::Axis &axis)
{
   std::vector<double> ends{axis.points[0]};
   for (std::size_t k = 0; k < axis.cells.size(); ++k)
   {
      const int n = axis.cells[k];
      double sum = 0, step = 1;
      std::vector<double> shares;
      for (int i = 0; i < n; ++i, step *= axis.growth[k]) { shares.push_back(sum += step); }
      for (int i = 0; i < n; ++i)
      {
         const double share = shares[i] / sum;
         // The last one is the point itself.
         ends.push_back(i + 1 == n
                           ? axis.points[k + 1]
                           : axis.points[k] + share * (axis.points[k + 1] - axis.points[k]));
      }
   }
   return ends;
}

mfem::Mesh mesh_of_brick(const JointCase::Body::Brick &brick)
{
   std::array<std::vector<double>, 3> ends;
   std::array<int, 3> cells{};
   for (int c = 0; c < 3; ++c)
   {
      ends[c] = cell_ends(brick.axes[c]);
      cells[c] = static_cast<int>(ends[c].size()) - 1;
   }
   const mfem::Element::Type type = brick.elements == "tetrahedra" ? mfem::Element::TETRAHEDRON
                                    : brick.elements == "wedges"   ? mfem::Element::WEDGE
                                                                   : mfem::Element::HEXAHEDRON;
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian3D(cells[0], cells[1], cells[2], type, cells[0],
                                                 cells[1], cells[2]);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *at = mesh.GetVertex(v);
      for (int c = 0; c < 3; ++c) { at[c] = ends[c][std::lround(at[c])]; }
   }
   return mesh;
}

/// Sides of a brick by their names, with the attributes that MFEM gives them.
const std::map<std::string, std::vector<int>> brick_sides = {
   {"bottom", {1}}, {"front", {2}}, {"right", {3}}, {"back", {4}}, {"left", {5}}, {"top", {6}}};

/// A body of the case, before it is condensed.
struct PartInSpace
{
   const JointCase::Body *said = nullptr;
   ElasticBody *body = nullptr;
   BodyTerms terms;
   std::vector<Holding> holdings;

   std::string called() const
   {
      return "body " + said->name + (said->mesh.empty() ? "" : " ('" + said->mesh + "')");
   }
   template <class Action>
   auto named(Action action) const
   {
      try
      {
         return action();
      }
      catch (const InputError &error)
      {
         throw InputError(called() + ": " + error.what());
      }
   }
   /// Calls a function that holds dofs, and notes those that were free before.
   template <class Hold>
   void hold(const std::string &kind, const std::string &name, Hold hold)
   {
      const mfem::Array<int> before = body->essential_dofs();
      hold();
      const mfem::Array<int> after = body->essential_dofs();
      Holding made{kind, name, {}};
      std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                          std::back_inserter(made.dofs));
      if (!made.dofs.empty()) { holdings.push_back(std::move(made)); }
   }
   ContactSurface surface(const JointCase::Side &side) const
   {
      require(!side.part.empty(), side.called, " is empty, must name a part of the boundary");
      return contact_surface(*body, boundary_part(side.called, side.part, terms));
   }
};

/// InputError if displacements contradict each other, or supports.
void check_displacements(const PartInSpace &part)
{
   const ElasticBody &body = *part.body;
   std::vector<Prescribed> all;
   for (const BodyLoad &load : body.patterns())
   {
      if (load.control != Control::displacement) { continue; }
      const std::vector<int> dofs = body.prescribed_dofs(load.name);
      all.push_back({load.name, {dofs.begin(), dofs.end()}, &load.values});
   }
   if (all.empty()) { return; }
   std::vector<std::pair<Vector3d, int>> dofs(body.dofs());
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      for (int c = 0; c < 3; ++c) { dofs[body.true_dof(node, c)] = {body.place(node), c}; }
   }
   require_one_displacement(
      all, part.holdings, [&](int dof) { return dofs[dof].second; },
      [&](int dof)
      {
         const auto &[at, component] = dofs[dof];
         return told("the node at (", at[0], ", ", at[1], ", ", at[2], ") along ",
                     "xyz"[component]);
      });
}

PartInSpace made_part(BodiesInSpace &own, const JointCase &joint, const JointCase::Body &said)
{
   PartInSpace part;
   part.said = &said;
   part.named(
      [&]
      {
         MeshPart of_solids{said.part, said.name};
         of_solids.dimension = 3;
         mfem::Mesh mesh =
            said.brick ? mesh_of_brick(*said.brick) : read_mesh(said.mesh, nullptr, of_solids);
         MeshNames names;
         if (said.brick) { names.boundary = brick_sides; }
         else { names = mesh_names(said.mesh, of_solids); }
         if (!names.passed_over.empty())
         {
            warn("mesh '" + said.mesh + "': its " + names.passed_over +
                 " are ignored: contacts, supports and loads are those of the case");
         }
         part.terms = {names.boundary, !said.brick, said.expansion};
         own.materials.push_back(materials_of(said, mesh, names, false));
         own.densities.push_back(densities_of(said, mesh, names));
         const int order = said.order > 0 ? said.order : joint.order;
         // Sides of this body that touch each other may have nodes at the same places.
         std::vector<int> meeting;
         for (const JointCase::Face &face : joint.faces)
         {
            const bool itself = face.sides[0].body >= 0 &&
                                face.sides[0].body == face.sides[1].body &&
                                &joint.bodies[face.sides[0].body] == &said;
            for (std::size_t k = 0; itself && k < 2; ++k)
            {
               const JointCase::Side &side = face.sides[k];
               const BoundaryPart its = boundary_part(side.called, side.part, part.terms);
               meeting.insert(meeting.end(), its.attributes.begin(), its.attributes.end());
            }
         }
         for (const std::string &warning :
              {said.brick ? std::string() : unjoined_vertices(mesh, said.mesh, meeting),
               missed_curves(mesh, order, said.mesh)})
         {
            if (!warning.empty()) { warn(warning); }
         }
         require(ranks() == 1, "bodies in space are computed on one rank, there are ", ranks(),
                 ": start the program without mpirun");
         part.body =
            &own.scene.add(std::move(mesh), order, own.materials.back(), Formulation::space);
         const std::string support = said.source.called("support"),
                           load = said.source.called("load");
         for (const std::string &one : split(said.support, " ;\t\n"))
         {
            part.hold("support", one,
                      [&] { add_supports(*part.body, support, one, part.terms); });
         }
         for (const JointCase::Body::Guided &each : said.guides)
         {
            part.hold("guide", each.on,
                      [&]
                      {
                         const std::string on = each.source.called("on");
                         const BoundaryPart where = boundary_part(on, each.on, part.terms);
                         try
                         {
                            part.body->guide(where, each.guide);
                         }
                         catch (const InputError &error)
                         {
                            throw InputError(on + " '" + each.on + "': " + error.what());
                         }
                      });
         }
         for (const std::string &one : split(said.load, ";\n"))
         {
            part.hold("displacement", split(one, " \t")[0],
                      [&] { add_loads(*part.body, load, one, part.terms); });
         }
         check_displacements(part);
      });
   return part;
}

/// Adds the forces of a bolt to the bodies at its ends, spread evenly over its parts.
void pull_bolt(const JointCase::Bolt &bolt, const JointCase &joint,
               std::vector<PartInSpace> &parts)
{
   for (const PartInSpace &part : parts)
   {
      for (const BodyLoad &load : part.body->patterns())
      {
         require(load.name != bolt.name, part.called(), " has a load '", bolt.name,
                 "', which is the name of a bolt: rename one of the two");
      }
   }
   std::array<Vector3d, 2> ends{Vector3d::Zero(), Vector3d::Zero()};
   std::array<BoundaryPart, 2> on{BoundaryPart(0), BoundaryPart(0)};
   std::array<double, 2> area{};
   for (const int k : {0, 1})
   {
      const JointCase::Side &end = bolt.ends[k];
      if (end.body < 0) { continue; } // the ground
      const PartInSpace &part = parts[end.body];
      part.named(
         [&]
         {
            require(!end.part.empty(), end.called,
                    " is empty, must name a part of the boundary");
            on[k] = boundary_part(end.called, end.part, part.terms);
            const ElasticBody::Extent extent =
               part.body->extent(on[k], end.called + ": '" + end.part + "'");
            require(extent.size > 0, end.called, ": there is nothing on '", end.part,
                    "', must be a part of the boundary");
            ends[k] = extent.middle;
            area[k] = extent.size;
         });
   }
   const Vector3d along = bolt_direction(joint, bolt, ends);
   bool held = true;
   for (const int k : {0, 1})
   {
      if (bolt.ends[k].body < 0) { continue; }
      PartInSpace &part = parts[bolt.ends[k].body];
      // The shank pulls the ends together.
      const Vector3d traction = (k == 0 ? -bolt.force : bolt.force) / area[k] * along;
      part.named(
         [&]
         { part.body->add_traction(bolt.name, on[k], traction[0], traction[1], traction[2]); });
      const mfem::Array<int> fixed = part.body->essential_dofs();
      const Eigen::VectorXd &forces = part.body->patterns().back().values;
      const double small = 1e-12 * forces.cwiseAbs().maxCoeff();
      for (Index dof = 0; dof < forces.size(); ++dof)
      {
         held = held && (std::abs(forces[dof]) <= small ||
                         std::binary_search(fixed.begin(), fixed.end(), static_cast<int>(dof)));
      }
   }
   if (held) { warn_of_bolt_on_supports(bolt); }
}

/// The gaps of the nodes of a side to the obstacle.
Eigen::VectorXd gaps_to(const JointCase::Face &face, const ContactSurface &surface)
{
   const JointCase::Face::Solid &solid = *face.solid;
   try
   {
      using Shape = JointCase::Face::Solid::Shape;
      switch (solid.shape)
      {
      case Shape::sphere:
         return gaps_to_sphere(surface, solid.point, solid.radius);
      case Shape::cylinder:
         return gaps_to_cylinder(surface, solid.point, solid.axis, solid.radius);
      case Shape::height:
         return gaps_to_height(surface,
                               [&](double x, double y) {
                                  return (*solid.height)({x, y});
                               });
      default:
         return gaps_to_plane(surface, solid.point, solid.axis);
      }
   }
   catch (const InputError &error)
   {
      throw InputError(face.source.called("obstacle") + ": " + error.what());
   }
}

/// Geometry in a wrong place, or in other units, is not an interference.
void check_overlaps(const JointCase &joint, const Reduction &reduction)
{
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      const InterfaceReport &report = reduction.interfaces[k];
      for (Index i = 0; i < report.nodes && !face.tied && !face.gap; ++i)
      {
         const double overlap = -reduction.problem.gap[report.first + i],
                      most = face.most_overlap * report.spacing[i];
         const Vector3d at = report.places.row(i);
         require(overlap <= most, face.source.called(face.solid ? "obstacle" : "between"),
                 ": the sides overlap by ", overlap, " at (", at[0], ", ", at[1], ", ", at[2],
                 "), at most ", most, " is allowed (", face.most_overlap,
                 " of the distance of nodes): move one of them, or allow more for an "
                 "interference fit by key 'overlap'");
      }
   }
}

void set_laws(const JointCase &joint, Reduction &reduction)
{
   ReducedProblem &problem = reduction.problem;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      const InterfaceReport &report = reduction.interfaces[k];
      for (Index i = 0; i < report.nodes && !face.tied; ++i)
      {
         const Vector3d at = report.places.row(i);
         const double f = problem.friction[report.first + i] = face.friction.at(at);
         require(std::isfinite(f) && f >= 0, face.source.called("friction"), " is ", f, " at (",
                 at[0], ", ", at[1], ", ", at[2], "), must be finite and not negative");
      }
   }
}

/// Adds loads that move rigid obstacles, and obstacles that are free to move along axes.
void move_obstacles_in_space(Reduction &reduction, const JointCase &joint)
{
   const auto motion = [](std::size_t face, const Vector3d &along)
   {
      ObstacleMotion made;
      made.interface = face;
      made.ux = along[0];
      made.uy = along[1];
      made.uz = along[2];
      return made;
   };
   std::map<std::string, std::vector<ObstacleMotion>> loads;
   std::vector<Reduction::FreeMotion> free;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      for (const JointCase::Motion &one : face.motions)
      {
         loads[one.load].push_back(motion(k, one.along));
      }
      for (int c = 0; face.moves && c < 3; ++c)
      {
         const Guide::Along &along = (*face.moves)[c];
         const Vector3d way = Vector3d::Unit(c);
         if (along.motion == Guide::Motion::held) { continue; }
         if (along.motion == Guide::Motion::displacement)
         {
            loads[along.load].push_back(motion(k, along.value * way));
         }
         else { free.push_back({along.load, along.value, {motion(k, way)}}); }
      }
   }
   if (!free.empty()) { reduction.free_obstacles(free); }
   for (const auto &[load, motions] : loads) { reduction.add_obstacle_motion(load, motions); }
}

} // namespace

BodiesInSpace make_bodies_in_space(const JointCase &joint)
{
   BodiesInSpace own;
   std::vector<PartInSpace> parts;
   for (const JointCase::Body &said : joint.bodies)
   {
      parts.push_back(made_part(own, joint, said));
   }
   for (const JointCase::Bolt &bolt : joint.bolts) { pull_bolt(bolt, joint, parts); }
   std::vector<std::vector<ContactSurface>> of_body(parts.size());
   std::vector<Interface> interfaces;
   for (const JointCase::Face &face : joint.faces)
   {
      Interface made;
      made.name = face.name;
      made.slave = face.slave;
      made.tied = face.tied;
      // Overlaps of nodes are checked by check_overlaps().
      made.most_overlap = face.most_overlap;
      for (const int s : {0, 1})
      {
         const JointCase::Side &side = face.sides[s];
         if (side.body < 0) { continue; }
         InterfaceSide &own_side = s == 0 ? made.first : made.second;
         own_side.body = side.body;
         own_side.surface =
            parts[side.body].named([&] { return parts[side.body].surface(side); });
         of_body[side.body].push_back(own_side.surface);
      }
      if (face.solid) { made.node_gaps = gaps_to(face, made.first.surface); }
      if (face.gap)
      {
         made.gap = [gap = *face.gap](double x, double y, double z)
         { return gap.at(Vector3d(x, y, z)); };
      }
      interfaces.push_back(std::move(made));
   }
   std::vector<CondensedBody> condensed;
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      require(!of_body[b].empty(), "body ", joint.bodies[b].name,
              " is in no interface, so nothing touches it: name an interface for it, or leave "
              "it out");
      const ContactSurface surface =
         of_body[b].size() == 1 ? of_body[b][0] : joined(of_body[b]);
      // The last body with a factor that this body could use.
      const CondensedBody *alike = nullptr;
      for (const CondensedBody &before : condensed)
      {
         if (before.surface.size() == surface.size()) { alike = &before; }
      }
      condensed.push_back(
         parts[b].named([&] { return condense(*parts[b].body, surface, alike); }));
      condensed.back().name = joint.bodies[b].name;
      own.accuracy = std::max(own.accuracy, condensed.back().error_estimate());
      own.holdings.push_back(parts[b].holdings);
   }
   own.scene.reduction = reduce(std::move(condensed), interfaces);
   check_overlaps(joint, own.scene.reduction);
   warn_of_seams(own.scene, interfaces);
   warn_of_faces_covered_twice(own.scene, interfaces);
   mark_rims(own.scene, interfaces);
   std::vector<std::optional<Vector3d>> planes;
   for (const JointCase::Face &face : joint.faces)
   {
      planes.emplace_back();
      if (face.solid && face.solid->shape == JointCase::Face::Solid::Shape::plane)
      {
         planes.back() = face.solid->axis;
      }
   }
   own.corners = nodes_at_corners(own.scene, interfaces, planes);
   for (const InterfaceReport &face : own.scene.reduction.interfaces)
   {
      warn_of_left_out(face);
   }
   set_laws(joint, own.scene.reduction);
   add_bolts(own.scene.reduction, own.bolted, joint,
             [&joint](Reduction &made) { move_obstacles_in_space(made, joint); });
   set_load_sizes(own, joint);
   return own;
}

void contact_in_space(Study &study, const JointCase &joint, OwnHistory &history,
                      const std::string &paraview)
{
   BodiesInSpace own = make_bodies_in_space(joint);
   Reduction &reduction = own.scene.reduction;
   ReducedProblem &problem = reduction.problem;
   require(!problem.patterns.empty(), "there is no load: key 'load' of a body must name one");
   // If bodies are only tied, nothing can open or slip: there is no contact node.
   const bool touches = problem.nodes() > 0;
   require(touches || !own.bolted,
           "all interfaces are tied, and bolts have the key 'preload', which is for joints "
           "that may open or slip: use key 'pretension' instead");
   report_load_sizes(study, problem);
   history.bolts = own.bolted ? &*own.bolted : nullptr;
   history.go_with = joint.go_with;
   history.begin(problem);
   if (reduction.interfaces.size() > 1)
   {
      history.interface_of_node.resize(problem.nodes());
      for (const InterfaceReport &face : reduction.interfaces)
      {
         for (Index i = 0; i < face.nodes && !face.tied; ++i)
         {
            history.interface_of_node[face.first + i] = face.name;
         }
      }
   }
   study.condensed(own.scene);
   study.value("condensation_error_estimate", own.accuracy);
   if (!touches || study.verbose())
   {
      study.say(
         (touches ? text("   gap %g to %g; ", problem.gap.minCoeff(), problem.gap.maxCoeff())
                  : std::string("   all interfaces are tied; ")) +
         text("relative error of the condensed stiffness: %.2g (estimate)", own.accuracy));
   }
   warn_of_accuracy(own.accuracy);
   ReportInSpace report(study, joint, own);
   history.show_maps = [&](Film &film)
   {
      film.show_maps(report.maps(),
                     [&](const ContactState &reached) { return report.fields(reached); });
   };
   BoltsReport bolts(study, joint, reduction);
   bolts.begin(history, history.bolts);
   history.keep = [&](ContactState &reached) { bolts.keep(reached); };
   if (history.state.time > 0)
   {
      report.note(history.state, 0);
      bolts.note(history.state);
   }
   std::optional<ReductionFields> fields;
   if (!paraview.empty())
   {
      study.begins(paraview, true);
      study.begins(paraview + "/contact", true);
      for (const CondensedBody &body : reduction.bodies)
      {
         study.begins(paraview + "/" + body.name, true);
      }
      fields.emplace(own.scene.fields(paraview));
   }
   NamedPoints points(study, joint, own.scene);
   points.begin(history.state);
   // On a plane obstacle a node may slide any way.
   std::vector<bool> even;
   for (const JointCase::Face &face : joint.faces)
   {
      even.push_back(face.solid && face.solid->shape == JointCase::Face::Solid::Shape::plane);
   }
   SmallDisplacements small(reduction, even);
   Sketch sketch(study, own.scene);
   // Pressures and openings in the state with the largest pressure, and the largest pressure of
   // each node.
   Eigen::VectorXd pressed = Eigen::VectorXd::Zero(problem.nodes()), away = pressed,
                   most = pressed;
   const Counters &spent = reduction.counters;
   int frames = 0;
   history.march(problem,
                 [&](const ContactState &reached, bool frame)
                 {
                    report.note(reached, history.cycle);
                    bolts.note(reached);
                    sketch.note(reached);
                    if (touches) { small.note(reached); }
                    if (touches && reached.p.maxCoeff() > pressed.maxCoeff())
                    {
                       pressed = reached.p;
                       away = reached.w;
                    }
                    most = most.cwiseMax(reached.p);
                    points.note(reached);
                    if (!fields || !frame) { return; }
                    study.counters -= spent; // the cost of the frame is added
                    fields->write(reached);
                    study.counters += spent;
                    ++frames;
                 });
   sketch.report();
   study.save(problem);
   if (fields) { study.say(text("%d frames in %s", frames, paraview.c_str())); }
   for (const std::string &said : geometry_warnings(reduction, most)) { warn(said); }
   if (touches) { warn_of_corners(own.corners, most); }
   const ChordalError chords =
      touches ? warn_of_chords(reduction, pressed, away) : ChordalError();
   // Smaller values are round-off of plane sides.
   if (chords.at_a_node > 1e-6 && std::isfinite(chords.at_a_node))
   {
      study.value("chords_peak_pressure_change_estimate", chords.of_peak);
      study.value("chords_node_pressure_change_estimate", chords.at_a_node);
   }
   warn_of_large_displacements(own.scene, small, history.state);
   history.report_state(problem, report.of_state(history.state));
   report.report(history.state, history.report, bolts);
   bolts.report(history.state);
   points.report(history.state);
   history.report_march(problem);
}

} // namespace miniapp
