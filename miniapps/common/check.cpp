#include "common/check.hpp"

#include "common/study.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// Largest number of marks that are drawn for a contact line or a load.
constexpr Index most_arrows = 60;

/// A rectangle that holds points.
struct Frame
{
   Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;

   void hold(const Vector2d &point)
   {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
   }
   double size() const { return (high - low).maxCoeff(); }
   /// Widened so that the shorter side is at least half as long as the longer one.
   void round()
   {
      const Vector2d middle = 0.5 * (low + high),
                     half = (0.5 * (high - low)).cwiseMax(0.25 * size());
      low = middle - half;
      high = middle + half;
   }
};

/// Values of a load or marks of the supports at a node.
struct AtNode
{
   Vector2d position;
   std::array<double, 2> value{0, 0};
};

/// Values by nodes, from values by true dofs (torsion: one component).
std::vector<AtNode> at_nodes(const ElasticBody &body, const VectorXd &values)
{
   std::vector<AtNode> all;
   const mfem::DenseMatrix &place = body.node_coordinates();
   for (int node = 0; node < place.Width(); ++node)
   {
      AtNode at{{place(0, node), place(1, node)}};
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0) { at.value[c] = values[dof]; }
      }
      if (at.value[0] != 0 || at.value[1] != 0) { all.push_back(at); }
   }
   return all;
}

std::vector<const GuidedPart *> guides_of(const Scene &scene, std::size_t k)
{
   std::vector<const GuidedPart *> guides;
   for (const GuidedPart &guide : scene.guides)
   {
      if (guide.body == static_cast<int>(k)) { guides.push_back(&guide); }
   }
   return guides;
}

/// The nodes that a guide moves.
std::vector<AtNode> nodes_of(const ElasticBody &body, const GuidedPart &guide)
{
   VectorXd moved = VectorXd::Zero(body.space().GetTrueVSize());
   for (int dof : guide.dofs) { moved[dof] = 1; }
   return at_nodes(body, moved);
}

/// The components that are held, not those that a load or a guide moves.
std::vector<AtNode> supports(const Scene &scene, std::size_t k)
{
   const ElasticBody &body = *scene.bodies[k];
   VectorXd held = VectorXd::Zero(body.space().GetTrueVSize());
   for (int dof : body.essential_dofs()) { held[dof] = 1; }
   for (const GuidedPart *guide : guides_of(scene, k))
   {
      for (int dof : guide->dofs) { held[dof] = 0; }
   }
   for (const BodyLoad &load : body.patterns())
   {
      if (load.control == Control::force) { continue; }
      for (Index dof = 0; dof < held.size(); ++dof)
      {
         if (load.values[dof] != 0) { held[dof] = 0; }
      }
   }
   return at_nodes(body, held);
}

/// What a load does to a guide, per thickness.
struct OnGuide
{
   Vector2d force{0, 0};
   double moment = 0;
   std::size_t nodes = 0;
};

std::vector<OnGuide> on_guides(const ElasticBody &body, const std::string &load)
{
   std::vector<OnGuide> all;
   for (const BlockMotion &block : body.blocks())
   {
      if (block.load != load) { continue; }
      const std::vector<AtNode> nodes = at_nodes(body, block.motion);
      const auto same = [&](const AtNode &at) { return at.value == nodes[0].value; };
      OnGuide made;
      made.nodes = nodes.size();
      // All nodes move alike, or about a centre.
      if (!nodes.empty() && std::all_of(nodes.begin(), nodes.end(), same))
      {
         made.force = block.force * Vector2d(nodes[0].value[0], nodes[0].value[1]);
      }
      else { made.moment = block.force; }
      all.push_back(made);
   }
   return all;
}

std::string heading(const Reduction &reduction, std::size_t k)
{
   const std::string &name = reduction.bodies[k].name;
   return name.empty() ? "body " + std::to_string(k + 1) : name;
}

void list_bodies(Study &study, const Scene &scene)
{
   const std::string length = study.units.of(0, 1);
   ResultTable &bodies = study.table("bodies", {{"body", "body"},
                                                {"elements", "elements"},
                                                {"dofs", "dofs"},
                                                {"x_from", "x from" + length, "%.5g"},
                                                {"x_to", "to" + length, "%.5g"},
                                                {"y_from", "y from" + length, "%.5g"},
                                                {"y_to", "to" + length, "%.5g"},
                                                {"held_x", "held in x"},
                                                {"held_y", "in y (nodes)"}});
   const Reduction &reduction = scene.reduction;
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const ElasticBody &body = *scene.bodies[k];
      const mfem::DenseMatrix &place = body.node_coordinates();
      Frame frame;
      for (int i = 0; i < place.Width(); ++i) { frame.hold({place(0, i), place(1, i)}); }
      int held[2] = {0, 0};
      for (const AtNode &support : supports(scene, k))
      {
         for (int c : {0, 1}) { held[c] += support.value[c] != 0; }
      }
      study.row(bodies,
                {heading(reduction, k), scene.meshes[k]->GetNE(), body.dofs(),
                 settled(frame.low[0], frame.size()), settled(frame.high[0], frame.size()),
                 settled(frame.low[1], frame.size()), settled(frame.high[1], frame.size()),
                 held[0], held[1]});
   }
}

void list_lines(Study &study, const Reduction &reduction)
{
   ResultTable &lines = study.table("lines", {{"line", "contact of"},
                                              {"nodes", "nodes"},
                                              {"pieces", "pieces"},
                                              {"length", "length", "%.5g"},
                                              {"least_spacing", "spacing", "%.3g"},
                                              {"most_spacing", "to", "%.3g"}});
   for (std::size_t k = 0; k < reduction.bodies.size(); ++k)
   {
      const ContactLine &line = reduction.bodies[k].line;
      const VectorXd spacing = line.each(&LineNode::spacing);
      double length = line.nodes.back().arc_length;
      study.row(lines, {heading(reduction, k), line.size(), line.chains.size(), length,
                        spacing.minCoeff(), spacing.maxCoeff()});
   }
   const VectorXd &gap = reduction.problem.gap;
   study.value("least_gap", gap.minCoeff(), "least gap (negative: overlap)");
   study.value("most_gap", gap.maxCoeff(), "largest gap");
}

void list_loads(Study &study, const Scene &scene)
{
   ResultTable &loads =
      study.table("loads", {{"load", "load"},
                            {"body", "body"},
                            {"kind", "kind"},
                            {"nodes", "nodes"},
                            {"x", "sum x" + study.units.total(0), "%.6g"},
                            {"y", "sum y" + study.units.total(0), "%.6g"},
                            {"moment", "moment" + study.units.total(1), "%.6g"}});
   const Reduction &reduction = scene.reduction;
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const double thickness = scene.thickness.empty() ? 1 : scene.thickness[k];
      for (const BodyLoad &load : scene.bodies[k]->patterns())
      {
         const std::vector<AtNode> nodes = at_nodes(*scene.bodies[k], load.values);
         const bool force = load.control == Control::force;
         bool moment_known = force && scene.bodies[k]->formulation() == Formulation::plane;
         double x = 0, y = 0, moment = 0, all = 0, lever = 0, far = 0;
         for (const AtNode &at : nodes)
         {
            x += at.value[0];
            y += at.value[1];
            moment += at.position[0] * at.value[1] - at.position[1] * at.value[0];
            all += std::hypot(at.value[0], at.value[1]);
            far = std::max(far, at.position.norm());
         }
         lever = all * far;
         std::size_t count = nodes.size();
         for (const OnGuide &guide : on_guides(*scene.bodies[k], load.name))
         {
            x += guide.force[0];
            y += guide.force[1];
            moment += guide.moment;
            all += guide.force.norm();
            count += guide.nodes;
            // The place of the force on a guide is that of its bearing, which is not known.
            moment_known = moment_known && guide.force.norm() == 0;
            lever += std::abs(guide.moment);
         }
         study.row(loads, {load.name, heading(reduction, k), force ? "forces" : "displacement",
                           count, force ? thickness * settled(x, all) : none,
                           force ? thickness * settled(y, all) : none,
                           moment_known ? thickness * settled(moment, lever) : none});
      }
   }
   // Loads of a half-plane are far forces and bulk stresses. They act on no nodes.
   for (std::size_t k = scene.bodies.size(); k < reduction.bodies.size(); ++k)
   {
      if (scene.bodies.empty()) { break; } // their elements are not known
      for (const LoadPattern &load : reduction.bodies[k].patterns)
      {
         study.row(loads, {load.name, heading(reduction, k), "far away", 0, none, none, none});
      }
   }
   for (std::size_t k = 0; k < scene.torsion.size(); ++k)
   {
      for (const BodyLoad &load : scene.torsion[k]->patterns())
      {
         const bool force = load.control == Control::force;
         study.row(loads, {load.name, heading(reduction, k), force ? "torque" : "twist",
                           at_nodes(*scene.torsion[k], load.values).size(), none, none,
                           force ? load.values.sum() : none});
      }
   }
}

/// Edges of the boundary as straight lines; curved ones in four pieces.
void draw_boundary(Panel &panel, const std::string &item, mfem::Mesh &mesh)
{
   for (int e = 0; e < mesh.GetNBE(); ++e)
   {
      mfem::ElementTransformation &edge = *mesh.GetBdrElementTransformation(e);
      const int pieces = edge.Order() > 1 ? 4 : 1;
      double ends[2][2];
      for (int k = 0; k <= pieces; ++k)
      {
         mfem::IntegrationPoint at;
         at.Set1w(static_cast<double>(k) / pieces, 1);
         mfem::Vector point(ends[k % 2], 2);
         edge.Transform(at, point);
         if (k == 0) { continue; }
         const double *a = ends[(k + 1) % 2], *b = ends[k % 2];
         panel.item(item, {a[0], a[1]}, {b[0] - a[0], b[1] - a[1]});
      }
   }
}

/// All edges of the elements, straight between their vertices.
void draw_mesh(Study &study, const Scene &scene, Frame frame)
{
   constexpr int most_edges = 20000;
   int edges = 0;
   for (const auto &mesh : scene.meshes) { edges += mesh->GetNEdges(); }
   if (edges > most_edges)
   {
      study.say(
         text("   the mesh has %d edges: more than %d are not drawn", edges, most_edges));
      return;
   }
   frame.round();
   const bool about_axis = scene.bodies[0]->formulation() != Formulation::plane;
   const std::string unit = study.units.of(0, 1);
   Panel &panel = study.panel(Panel::Kind::scene, "mesh", "Meshes",
                              (about_axis ? "r" : "x") + unit, (about_axis ? "z" : "y") + unit);
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const mfem::Mesh &mesh = *scene.meshes[k];
      const std::string &name = scene.reduction.bodies[k].name;
      const std::string item = name.empty() ? heading(scene.reduction, k) : "body " + name;
      mfem::Array<int> ends;
      for (int e = 0; e < mesh.GetNEdges(); ++e)
      {
         mesh.GetEdgeVertices(e, ends);
         const double *a = mesh.GetVertex(ends[0]), *b = mesh.GetVertex(ends[1]);
         panel.item(item, {a[0], a[1]}, {b[0] - a[0], b[1] - a[1]});
      }
   }
   const double margin = 0.05 * frame.size();
   panel.limit("x", frame.low[0] - margin, frame.high[0] + margin);
   panel.limit("y", frame.low[1] - margin, frame.high[1] + margin);
}

void draw_nodes(Panel &panel, const Reduction &reduction)
{
   for (std::size_t k = 0; k < reduction.bodies.size(); ++k)
   {
      for (const LineNode &node : reduction.bodies[k].line.nodes)
      {
         panel.item("contact of " + heading(reduction, k), node.position, {0, 0});
      }
   }
   for (const InterfaceReport &face : reduction.interfaces)
   {
      for (const Vector2d &at : face.free_surface)
      {
         panel.item("contact facing nothing", at, {0, 0});
      }
   }
}

void draw_normals(Panel &panel, const Reduction &reduction, double arrow)
{
   for (const InterfaceReport &face : reduction.interfaces)
   {
      const Index stride = 1 + face.nodes / most_arrows;
      for (Index i = 0; i < face.nodes; ++i)
      {
         const Vector2d at = face.position.row(i), t = face.tangent.row(i), normal(-t[1], t[0]);
         if (i % stride == 0) { panel.item("normal", at, arrow * normal); }
         if (face.tied) { continue; }
         // The point opposite the node: the matching node of the other body, else the point
         // across the gap.
         Vector2d partner = at - reduction.problem.gap[face.first + i] * normal;
         if (face.matching && reduction.bodies.size() == 2)
         {
            const Eigen::MatrixX2d others = reduction.bodies[1].line.each(&LineNode::position);
            Index nearest = 0;
            (others.rowwise() - partner.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
            partner = others.row(nearest);
         }
         panel.item("gap", at, partner - at);
      }
   }
}

/// Draws the nodes of a guide, its forces at its centre, and a mark at the centre for each load
/// that turns it.
void draw_guide(Panel &panel, const ElasticBody &body, const GuidedPart &guide, double arrow)
{
   for (const AtNode &at : nodes_of(body, guide))
   {
      panel.item("guide " + guide.name, at.position, {0, 0});
   }
   for (const GuidedPart::Load &load : guide.loads)
   {
      const double size = load.along.norm();
      if (size == 0)
      {
         panel.item("turn " + load.name, guide.centre, {0, 0});
         continue;
      }
      const Vector2d shown = load.along / size * arrow;
      panel.item("load " + load.name, guide.centre - shown, shown);
   }
}

void draw_loads(Panel &panel, const Scene &scene, std::size_t k, double arrow)
{
   const ElasticBody &body = *scene.bodies[k];
   for (const GuidedPart *guide : guides_of(scene, k))
   {
      draw_guide(panel, body, *guide, arrow);
   }
   for (const AtNode &support : supports(scene, k))
   {
      if (support.value[0] != 0) { panel.item("held x", support.position, {0, 0}); }
      if (support.value[1] != 0) { panel.item("held y", support.position, {0, 0}); }
   }
   for (const BodyLoad &load : body.patterns())
   {
      const std::vector<AtNode> nodes = at_nodes(body, load.values);
      double largest = 0;
      for (const AtNode &at : nodes)
      {
         largest = std::max(largest, std::hypot(at.value[0], at.value[1]));
      }
      const std::string item = "load " + load.name;
      const std::size_t stride = 1 + nodes.size() / most_arrows;
      for (std::size_t i = 0; i < nodes.size(); i += stride)
      {
         const Vector2d shown =
            Vector2d(nodes[i].value[0], nodes[i].value[1]) / largest * arrow;
         panel.item(item, nodes[i].position - shown, shown); // the tip is where the force acts
      }
   }
}

Panel &draw(Study &study, const Scene &scene, const std::string &name, const std::string &title,
            Frame frame)
{
   frame.round();
   const bool about_axis = scene.bodies[0]->formulation() != Formulation::plane;
   const std::string unit = study.units.of(0, 1);
   Panel &panel = study.panel(Panel::Kind::scene, name, title, (about_axis ? "r" : "x") + unit,
                              (about_axis ? "z" : "y") + unit);
   const double margin = 0.12 * frame.size();
   const Reduction &reduction = scene.reduction;
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const std::string &name = reduction.bodies[k].name;
      draw_boundary(panel, name.empty() ? heading(reduction, k) : "body " + name,
                    *scene.meshes[k]);
   }
   draw_nodes(panel, scene.reduction);
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      draw_loads(panel, scene, k, 0.8 * margin);
   }
   panel.limit("x", frame.low[0] - margin, frame.high[0] + margin);
   panel.limit("y", frame.low[1] - margin, frame.high[1] + margin);
   return panel;
}

} // namespace

void show(Study &study, const Scene &scene)
{
   require(ranks() == 1, "option --check: there are ", ranks(), " ranks, must be one");
   if (scene.bodies[0]->formulation() == Formulation::space)
   {
      show_in_space(study, scene);
      return;
   }
   study.title("Input of the computation");
   list_bodies(study, scene);
   list_lines(study, scene.reduction);
   list_loads(study, scene);
   Frame all, contact;
   for (const auto &body : scene.bodies)
   {
      const mfem::DenseMatrix &place = body->node_coordinates();
      for (int i = 0; i < place.Width(); ++i) { all.hold({place(0, i), place(1, i)}); }
   }
   for (const InterfaceReport &face : scene.reduction.interfaces)
   {
      for (Index i = 0; i < face.nodes; ++i) { contact.hold(face.position.row(i)); }
   }
   draw(study, scene, "scene", "Bodies, supports, loads", all);
   Panel &panel = draw(study, scene, "contact",
                       "Contact, normals into the body with the contact nodes", contact);
   draw_normals(panel, scene.reduction, 0.06 * contact.size());
   draw_mesh(study, scene, all);
   Panel &gaps = study.lines("gap", "Initial gap", "arc length" + study.units.of(0, 1),
                             "gap" + study.units.of(0, 1));
   for (const InterfaceReport &face : scene.reduction.interfaces)
   {
      if (face.tied) { continue; }
      gaps.add(scene.reduction.interfaces.size() == 1 ? "" : face.name,
               VectorXd(scene.problem().arc_length.segment(face.first, face.nodes)),
               VectorXd(scene.problem().gap.segment(face.first, face.nodes)));
   }
}

} // namespace miniapp
