#include "common/own_bodies.hpp"

#include <algorithm>
#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/filled_corner.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <sstream>

namespace miniapp
{

using namespace cattaneo;

void add_options(Study &study, BodyOptions &body, const std::string &k, const char *mesh_help)
{
   study.option(&body.mesh, "mesh" + k, mesh_help, Text::input);
   study.option(&body.young, "young" + k,
                "Young's modulus: one, or one for each element attribute.");
   study.option(&body.poisson, "poisson" + k,
                "Poisson's ratio: one, or one for each element attribute.");
   study.option(&body.contact, "contact" + k,
                "Boundary attributes of the contact, as 3 or 3,4 or 3[-1<x<1].",
                Text::attributes);
   study.option(&body.support, "support" + k,
                "Fixed components, as '1:xy 2:x @0,-1:x' (attributes, or the node near a "
                "point).",
                Text::statements);
   study.option(
      &body.load, "load" + k,
      "Loads 'PATTERN KIND WHERE VALUES; …', as 'P pressure 3 100; Q traction 3 1 0'; "
      "kinds: pressure, traction, body-force, displacement-x, displacement-y.",
      Text::statements);
}

void add_options(Study &study, HalfPlaneOptions &half_plane)
{
   study.option(&half_plane.young, "half-plane-young",
                "Young's modulus of a half-plane without a mesh, in place of body 2.",
                positive);
   study.option(&half_plane.poisson, "half-plane-poisson", "Poisson's ratio of the half-plane.",
                between(-1, 0.5));
   study.option(&half_plane.depth, "half-plane-depth",
                "Depth of the half-plane that displacements are relative to; without it none "
                "are given, and none can be prescribed.",
                positive);
   study.options().in_object("half-plane", {"young", "poisson"});
}

namespace
{

std::vector<Material> materials(const BodyOptions &options, const std::string &k,
                                int attributes, bool plane_stress)
{
   std::vector<double> young = options.young, poisson = options.poisson;
   require(!young.empty() && !poisson.empty(), "options young", k, " and poisson", k,
           " must not be empty");
   const std::size_t count = std::max(young.size(), poisson.size());
   if (young.size() == 1) { young.resize(count, young[0]); }
   if (poisson.size() == 1) { poisson.resize(count, poisson[0]); }
   require(young.size() == poisson.size(), "options young", k, " and poisson", k, " have ",
           young.size(), " and ", poisson.size(), " values, must have as many (or one)");
   require(count == 1 || count <= static_cast<std::size_t>(attributes), "options young", k,
           " and poisson", k, " have ", count,
           " values, must have one, or one for each element attribute of the mesh, 1 to ",
           attributes);
   std::vector<Material> list;
   for (std::size_t a = 0; a < count; ++a)
   {
      list.push_back(
         {young[a], poisson[a], plane_stress ? PlaneState::stress : PlaneState::strain});
   }
   return list;
}

CondensedBody make_body(OwnBodies &own, const BodyOptions &options, const std::string &k,
                        int order, bool plane_stress)
{
   try
   {
      require(!options.contact.empty(), "option contact", k,
              " is empty, must name boundary attributes");
      mfem::Mesh mesh = read_mesh(options.mesh);
      for (const std::string &warning :
           {unjoined_vertices(mesh, options.mesh), missed_curves(mesh, order, options.mesh)})
      {
         if (!warning.empty()) { warn(warning); }
      }
      const int attributes = mesh.attributes.Size() ? mesh.attributes.Max() : 1;
      own.materials.push_back(materials(options, k, attributes, plane_stress));
      ElasticBody &body = own.scene.add(std::move(mesh), order, own.materials.back());
      add_supports(body, "support" + k, options.support);
      add_loads(body, "load" + k, options.load);
      const ContactLine line =
         contact_line(body, boundary_part("contact" + k, options.contact));
      return condense(body, line, condensation());
   }
   catch (const InputError &error)
   {
      throw InputError("body " + k + " ('" + options.mesh + "'): " + error.what());
   }
}

Eigen::Vector2d mean_normal(const ContactLine &line)
{
   return (line.each(&LineNode::normal).transpose() * line.each(&LineNode::weight))
      .normalized();
}

/// The rigid obstacle is the straight line that touches the contact nodes, across their mean
/// normal.
Reduction on_rigid_line(const CondensedBody &body)
{
   const ContactLine &line = body.line;
   const Eigen::Vector2d normal = mean_normal(line);
   const double level = (line.each(&LineNode::position) * normal).minCoeff();
   return reduce(body,
                 [=](double x, double y) { return normal.dot(Eigen::Vector2d(x, y)) - level; });
}

/// How much of the nodes' common displacement along an axis the body resists, of 1.
double held_share(const CondensedBody &body, const Eigen::Vector2d &axis)
{
   const Eigen::VectorXd motion = (body.rigid_motions().leftCols(2) * axis).normalized();
   const Eigen::MatrixXd &free = body.free_motions;
   return (motion - free * (free.transpose() * motion)).norm();
}

/// The half-plane touches the contact nodes as a rigid line does. Contact nodes that are held
/// lie on a plane of symmetry, which it has as well.
void stand_on_half_plane(OwnBodies &own, CondensedBody body, const HalfPlaneOptions &options,
                         bool plane_stress)
{
   const ContactLine &line = body.line;
   HalfPlane below;
   below.material = {options.young, options.poisson,
                     plane_stress ? PlaneState::stress : PlaneState::strain};
   Eigen::Vector2d normal = mean_normal(line), at = line.nodes.front().position;
   if (!body.held.empty())
   {
      const LineNode &node = line.nodes[body.held.front() % line.size()];
      below.symmetric = true;
      normal = node.normal();
      at = node.position;
   }
   const double level = (line.each(&LineNode::position) * normal).minCoeff();
   below.normal = -normal;
   below.point = at + (level - normal.dot(at)) * normal;
   const bool relative = std::isnan(options.depth); // to nothing: forces alone are known
   if (relative)
   {
      const double most = below.symmetric ? held_share(body, normal)
                                          : std::max(held_share(body, Eigen::Vector2d(1, 0)),
                                                     held_share(body, Eigen::Vector2d(0, 1)));
      require(most < 1e-7,
              "half-plane: supports or prescribed displacements hold body 1 against "
              "it, whose displacements are relative to a depth: option "
              "half-plane-depth must state it, or forces alone act on body 1");
   }
   below.depth = relative ? 1e4 * line.nodes.back().arc_length : options.depth;
   own.scene.reduction = reduce(std::move(body), below);
   if (relative) { own.scene.problem().H.resize(0, 0); }
   own.accuracy = std::max(own.accuracy, own.scene.reduction.bodies[1].error_estimate());
   own.materials.push_back({below.material});
   own.half_plane = below;
}

bool similar(const Material &a, const Material &b)
{
   return a.young == b.young && a.poisson == b.poisson;
}

/// On each other, on a half-plane, or on a rigid line.
void put_together(OwnBodies &own, std::vector<CondensedBody> condensed,
                  const HalfPlaneOptions &half_plane, bool plane_stress, double pairing)
{
   for (CondensedBody &body : condensed)
   {
      own.accuracy = std::max(own.accuracy, body.error_estimate());
   }
   if (half_plane.given())
   {
      stand_on_half_plane(own, std::move(condensed[0]), half_plane, plane_stress);
      return;
   }
   if (condensed.size() == 1)
   {
      own.scene.reduction = on_rigid_line(condensed[0]);
      return;
   }
   try
   {
      const Pairing pairs = pair_lines(condensed[0].line, condensed[1].line, pairing);
      own.scene.reduction = reduce(condensed[0], condensed[1], pairs);
   }
   catch (const InputError &error)
   {
      throw InputError(std::string("option ") + error.what());
   }
}

CondensedBody make_body(NodalStiffness body, const BodyOptions &options, const std::string &k)
{
   try
   {
      require(body.formulation == Formulation::plane, "its elements are ",
              name(body.formulation), ", must be plane");
      add_supports(body, "support" + k, options.support);
      add_loads(body, "load" + k, options.load);
      return condense(body.body(), body.contact_line(body.nodes_of(options.contact)));
   }
   catch (const InputError &error)
   {
      throw InputError("body " + k + " ('" + body.name + "'): " + error.what());
   }
}

} // namespace

OwnBodies make_own_bodies(const std::vector<BodyOptions> &options,
                          const HalfPlaneOptions &half_plane, int order, bool plane_stress,
                          double pairing)
{
   OwnBodies own;
   std::vector<CondensedBody> condensed;
   for (const BodyOptions &body : options)
   {
      const std::string k = std::to_string(condensed.size() + 1);
      condensed.push_back(make_body(own, body, k, order, plane_stress));
   }
   put_together(own, std::move(condensed), half_plane, plane_stress, pairing);
   return own;
}

OwnBodies own_bodies_of_matrix(const std::string &matrix,
                               const std::vector<BodyOptions> &options,
                               const HalfPlaneOptions &half_plane, double pairing)
{
   OwnBodies own;
   std::vector<CondensedBody> condensed;
   std::vector<NodalStiffness> parts = read_stiffness(matrix).parts();
   std::vector<std::string> names;
   for (const NodalStiffness &part : parts) { names.push_back(part.name); }
   require(parts.size() == options.size(), "matrix '", matrix, "' has ", parts.size(),
           " bodies (", listed(names), "), options contact1 and contact2 name the contact of ",
           options.size());
   for (const BodyOptions &body : options)
   {
      const std::string k = std::to_string(condensed.size() + 1);
      const auto found =
         std::find_if(parts.begin(), parts.end(),
                      [&](const NodalStiffness &part) { return part.has_set(body.contact); });
      require(found != parts.end(), "matrix '", matrix, "': option contact", k,
              " names the set '", body.contact, "', there is no other body that has it");
      own.scene.dofs += static_cast<int>(found->dofs.size());
      own.materials.emplace_back(); // not known
      condensed.push_back(make_body(std::move(*found), body, k));
      parts.erase(found);
   }
   put_together(own, std::move(condensed), half_plane, false, pairing);
   return own;
}

double OwnBodies::modulus() const
{
   const Material &m = materials[0][0];
   if (materials.size() == 1 || materials[0].size() > 1 || materials[1].size() > 1 ||
       !similar(m, materials[1][0]))
   {
      return 0;
   }
   return fretting::contact_modulus(m.young, m.poisson, m.state == PlaneState::stress);
}

fretting::CornerModes OwnBodies::corner(int end) const
{
   struct Wedge
   {
      double angle; ///< that the body fills
      Material material;
   };
   const auto wedge = [&](int body, bool at_first)
   {
      if (half_plane && body == 1) { return Wedge{std::acos(-1.0), half_plane->material}; }
      const auto &nodes = line(body).nodes;
      const FilledCorner filled =
         filled_corner(*scene.meshes[body], (at_first ? nodes.front() : nodes.back()).position);
      const std::size_t last = materials[body].size() - 1;
      return Wedge{filled.angle,
                   materials[body][std::min<std::size_t>(filled.attribute - 1, last)]};
   };
   const Wedge pad = wedge(0, end > 0);
   if (materials.size() == 1)
   {
      return fretting::corner_modes(fretting::RigidCorner{
         pad.angle, pad.material.poisson, pad.material.state == PlaneState::stress});
   }
   const Wedge body = wedge(1, end < 0);
   require(similar(pad.material, body.material),
           "the bodies differ in material there, whose exponents are not known here");
   const double gap = 2 * std::acos(-1.0) - pad.angle - body.angle;
   require(gap > 1e-6, "the surfaces of both bodies run on smoothly there: the contact line is "
                       "cut off, lengthen it");
   return fretting::corner_modes(fretting::Corner{pad.angle, body.angle});
}

void warn_of_accuracy(double accuracy)
{
   if (accuracy <= 1e-6) { return; }
   std::ostringstream text;
   if (std::isfinite(accuracy))
   {
      text << "the stiffness of the contact may be wrong by " << accuracy
           << " of itself (round-off of the condensation, an estimate from above)";
   }
   else { text << "round-off of the condensation leaves nothing of the contact's stiffness"; }
   text << ": Young's moduli or element sizes within a body are too far apart; take a much "
           "stiffer part for rigid, or less contrast, which changes no result that can be told";
   warn(text.str());
}

/// An interference fit moves nodes by less than their distance; more is a body in a wrong
/// place, or in other units.
void warn_of_overlap(const ReducedProblem &problem, const ContactLine &line)
{
   Eigen::Index deepest = 0;
   const double overlap =
      -problem.gap.cwiseQuotient(line.each(&LineNode::spacing)).minCoeff(&deepest);
   if (overlap <= 1) { return; }
   std::ostringstream text;
   text << "the bodies overlap by " << -problem.gap[deepest] << " at ("
        << line.nodes[deepest].position[0] << ", " << line.nodes[deepest].position[1]
        << "), which is " << overlap
        << " distances of nodes: small displacements do not open that, see that both meshes "
           "are in "
           "their places and in one unit";
   warn(text.str());
}

/// Degrees.
static double angle_of(double cosine)
{
   return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
}

SidesThatBear::SidesThatBear(const ContactLine &line) : line_(line)
{
   const Eigen::VectorXd cosine = line.each(&LineNode::normal) * mean_normal(line);
   for (Eigen::Index i = 0; i < line.size(); ++i)
   {
      if (angle_of(cosine[i]) > 15) { sides_.push_back({i, angle_of(cosine[i])}); }
   }
}

void SidesThatBear::note(const ContactState &state)
{
   for (const Node &side : sides_)
   {
      if (closed(state.status[side.index]) && state.p[side.index] > 1e-9 * state.p.maxCoeff() &&
          side.angle > worst_.angle)
      {
         worst_ = side;
      }
   }
}

void SidesThatBear::warn() const
{
   if (worst_.index < 0) { return; }
   std::ostringstream text;
   text << "node " << worst_.index << " at (" << line_.nodes[worst_.index].position[0] << ", "
        << line_.nodes[worst_.index].position[1] << ") bears although its normal is "
        << std::lround(worst_.angle)
        << " degrees off that of the rigid line: forces and zones are wrong there, name no "
           "boundary around a corner as contact";
   miniapp::warn(text.str());
}

} // namespace miniapp
