#include "common/own_bodies.hpp"

#include "common/own_half_plane.hpp"

#include <algorithm>
#include <cattaneo/elastic/rotation.hpp>
#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/filled_corner.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <map>
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

std::vector<Material> materials(const JointCase::Body &body, int attributes, bool plane_stress)
{
   std::vector<double> young = body.young, poisson = body.poisson;
   const std::string both =
      body.source.called("young") + " and " + body.source.called("poisson");
   require(!young.empty() && !poisson.empty(), both, " must not be empty");
   const std::size_t count = std::max(young.size(), poisson.size());
   if (young.size() == 1) { young.resize(count, young[0]); }
   if (poisson.size() == 1) { poisson.resize(count, poisson[0]); }
   require(young.size() == poisson.size(), both, " have ", young.size(), " and ",
           poisson.size(), " values, must have as many (or one)");
   require(count == 1 || count <= static_cast<std::size_t>(attributes), both, " have ", count,
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

/// The rigid obstacle is the straight line that touches the contact nodes, across their mean
/// normal.
ScalarField distance_to_rigid_line(const ContactLine &line)
{
   const Eigen::Vector2d normal = mean_normal(line);
   const double level = (line.each(&LineNode::position) * normal).minCoeff();
   return [=](double x, double y) { return normal.dot(Eigen::Vector2d(x, y)) - level; };
}

bool similar(const Material &a, const Material &b)
{
   return a.young == b.young && a.poisson == b.poisson;
}

/// A body of a case before it is condensed: elements, or nodes of a matrix.
class Part
{
public:
   Part(OwnBodies &own, const JointCase &joint, int b) : joint_(joint), body_(joint.bodies[b])
   {
      if (!body_.mesh.empty()) { make_of_mesh(own); }
   }
   /// The body of a matrix that has the sets of its contacts.
   void make_of_matrix(NodalStiffness matrix)
   {
      require(matrix.formulation == joint_.formulation, "its elements are ",
              name(matrix.formulation), ", must be ", name(joint_.formulation));
      nodal_ = std::move(matrix);
      add_supports(*nodal_, body_.source.called("support"), body_.support);
      add_loads(*nodal_, body_.source.called("load"), body_.load);
   }
   ContactLine line(const JointCase::Side &side) const
   {
      require(!side.part.empty(), side.called, " is empty, must name boundary attributes");
      return nodal_ ? nodal_->contact_line(nodal_->nodes_of(side.part))
                    : contact_line(*elastic_, boundary_part(side.called, side.part, terms_));
   }
   bool has_load(const std::string &load) const
   {
      const auto named = [&](const BodyLoad &one) { return one.name == load; };
      const auto has = [&](const std::vector<BodyLoad> &loads)
      { return std::any_of(loads.begin(), loads.end(), named); };
      return (nodal_ && has(nodal_->loads)) || (elastic_ && has(elastic_->patterns()));
   }
   /// An end of a shank: forces that add up to F, spread evenly.
   void pull(const std::string &load, const JointCase::Side &end, const Eigen::Vector2d &F)
   {
      const Eigen::Vector2d t = F / line(end).each(&LineNode::weight).sum();
      if (nodal_) { nodal_->add_traction(load, nodal_->nodes_of(end.part), t); }
      else
      {
         elastic_->add_traction(load, boundary_part(end.called, end.part, terms_), t[0], t[1]);
      }
   }
   CondensedBody condensed(const ContactLine &line, const CondensedBody *alike) const
   {
      CondensedBody made = nodal_ ? condense(nodal_->body(), line)
                                  : condense(*elastic_, line, condensation(), alike);
      if (!joint_.numbered) { made.name = body_.name; }
      return made;
   }
   /// Is something said of what happens around the axis?
   bool twists() const { return cattaneo::twists(body_.support, body_.load); }
   /// To the nodes of its sides of interfaces, in their order.
   CondensedBody condensed_twisting(const std::vector<JointCase::Side> &sides) const
   {
      std::vector<ContactLine> lines;
      for (const JointCase::Side &side : sides)
      {
         lines.push_back(
            contact_line(*twisting_, boundary_part(side.called, side.part, terms_)));
      }
      CondensedBody made =
         condense(*twisting_, lines.size() == 1 ? lines[0] : joined(lines), condensation());
      made.name = body_.name;
      return made;
   }
   /// In a sentence.
   std::string called() const
   {
      const std::string file =
         body_.mesh.empty() ? nodal_ ? nodal_->name : body_.matrix : body_.mesh;
      return "body " + body_.name + " ('" + file + "')";
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
   /// The torsion of the body, on its mesh.
   void add_twisting(OwnBodies &own, std::size_t b)
   {
      const std::vector<Material> &its = own.materials[b];
      mfem::Mesh &mesh = *own.scene.meshes[b];
      own.scene.torsion.push_back(
         its.size() == 1
            ? std::make_unique<ElasticBody>(mesh, joint_.order, its[0], Formulation::torsion)
            : std::make_unique<ElasticBody>(mesh, joint_.order, its, Formulation::torsion));
      twisting_ = own.scene.torsion.back().get();
      own.scene.dofs += twisting_->dofs();
      named(
         [&]
         {
            add_supports(*twisting_, body_.source.called("support"), body_.support, terms_);
            add_loads(*twisting_, body_.source.called("load"), body_.load, terms_);
         });
   }

private:
   void make_of_mesh(OwnBodies &own)
   {
      named(
         [&]
         {
            mfem::Mesh mesh = read_mesh(body_.mesh);
            for (const std::string &warning : {unjoined_vertices(mesh, body_.mesh),
                                               missed_curves(mesh, joint_.order, body_.mesh)})
            {
               if (!warning.empty()) { warn(warning); }
            }
            const MeshNames names = mesh_names(body_.mesh);
            require(!names.axisymmetric || joint_.formulation == Formulation::axisymmetric,
                    "its elements are axisymmetric (CAX), key 'analysis' must be axisymmetric");
            if (!names.passed_over.empty())
            {
               warn("mesh '" + body_.mesh + "': its " + names.passed_over +
                    " are passed over, supports and loads are those of the case");
            }
            terms_ = {names.boundary, names.numbered, body_.expansion};
            const int attributes = mesh.attributes.Size() ? mesh.attributes.Max() : 1;
            own.materials.push_back(materials(body_, attributes, joint_.plane_stress));
            elastic_ = &own.scene.add(std::move(mesh), joint_.order, own.materials.back(),
                                      joint_.formulation);
            add_supports(*elastic_, body_.source.called("support"), body_.support, terms_);
            for (const JointCase::Body::Guided &each : body_.guides)
            {
               elastic_->guide(boundary_part(each.source.called("on"), each.on, terms_),
                               each.guide);
            }
            add_loads(*elastic_, body_.source.called("load"), body_.load, terms_);
         });
   }

   const JointCase &joint_;
   const JointCase::Body &body_;
   ElasticBody *elastic_ = nullptr, *twisting_ = nullptr;
   std::optional<NodalStiffness> nodal_;
   BodyTerms terms_;
};

/// Adds the torsion of all bodies if a support or a load of one asks for it.
bool twist(OwnBodies &own, const JointCase &joint, std::vector<Part> &parts)
{
   const auto asks =
      std::find_if(parts.begin(), parts.end(), [](const Part &part) { return part.twists(); });
   if (joint.formulation == Formulation::plane || asks == parts.end()) { return false; }
   for (const JointCase::Body &body : joint.bodies)
   {
      require(!body.mesh.empty(), asks->called(), " is turned about the axis, and body ",
              body.name, body.half_plane ? " is a half-plane" : " is a matrix",
              ": bodies that twist must have meshes");
   }
   require(joint.bolts.empty(), asks->called(),
           " is turned about the axis: beside bolts it cannot be, their shanks would twist");
   for (std::size_t b = 0; b < parts.size(); ++b) { parts[b].add_twisting(own, b); }
   return true;
}

std::vector<CondensedBody> condensed_twisting(const JointCase &joint,
                                              const std::vector<Part> &parts)
{
   std::vector<std::vector<JointCase::Side>> sides(parts.size());
   for (const JointCase::Face &face : joint.faces)
   {
      for (const JointCase::Side &side : face.sides)
      {
         if (side.body >= 0) { sides[side.body].push_back(side); }
      }
   }
   std::vector<CondensedBody> made;
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      made.push_back(parts[b].named([&] { return parts[b].condensed_twisting(sides[b]); }));
   }
   return made;
}

/// Of bodies that are matrices each takes the part of its file that has the sets which its
/// contacts name.
void find_matrices(OwnBodies &own, const JointCase &joint, std::vector<Part> &parts)
{
   std::map<std::string, std::vector<NodalStiffness>> files;
   std::map<std::string, int> asked;
   for (const JointCase::Body &body : joint.bodies)
   {
      if (body.matrix.empty()) { continue; }
      ++asked[body.matrix];
      if (files.count(body.matrix) == 0)
      {
         files[body.matrix] = read_stiffness(body.matrix).parts();
      }
   }
   for (const auto &[file, bodies] : files)
   {
      std::vector<std::string> names;
      for (const NodalStiffness &part : bodies) { names.push_back(part.name); }
      require(static_cast<int>(bodies.size()) == asked[file], "matrix '", file, "' has ",
              bodies.size(), " bodies (", listed(names),
              joint.numbered ? "), options contact1 and contact2 name the contact of "
                             : "), the case has ",
              asked[file]);
   }
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      const std::string &file = joint.bodies[b].matrix;
      if (file.empty()) { continue; }
      std::vector<NodalStiffness> &left = files[file];
      auto found = left.end();
      for (const JointCase::Face &face : joint.faces)
      {
         for (const JointCase::Side &side : face.sides)
         {
            if (side.body != static_cast<int>(b) || found != left.end()) { continue; }
            found = std::find_if(left.begin(), left.end(),
                                 [&](const NodalStiffness &part)
                                 { return part.has_set(side.part); });
            require(found != left.end(), "matrix '", file, "': ", side.called,
                    " names the set '", side.part, "', there is no other body that has it");
         }
      }
      require(found != left.end(), "matrix '", file, "': body ", joint.bodies[b].name,
              " is at no interface, must be at one");
      own.known_elements = false;
      own.scene.dofs += static_cast<int>(found->dofs.size());
      own.materials.emplace_back(); // not known
      Part &part = parts[b];
      part.named([&] { part.make_of_matrix(std::move(*found)); });
      left.erase(found);
   }
}

/// The only interface of two bodies, whose nodes are paired one to one.
Reduction paired(std::vector<CondensedBody> bodies, const JointCase::Face &face, bool numbered)
{
   try
   {
      const Pairing pairs = pair_lines(bodies[0].line, bodies[1].line, face.pairing);
      return reduce(std::move(bodies[0]), std::move(bodies[1]), pairs);
   }
   catch (const InputError &error)
   {
      throw InputError((numbered ? "option " : "interface '" + face.name + "': ") +
                       std::string(error.what()));
   }
}

bool has_shape(const JointCase::Face &face)
{
   return !face.obstacle.empty() || !std::isnan(face.radius) || face.curve;
}

/// Loads that move rigid obstacles, of several interfaces if they have one name.
void move_obstacles(Reduction &reduction, const JointCase &joint)
{
   std::map<std::string, std::vector<ObstacleMotion>> loads;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      for (const JointCase::Motion &one : joint.faces[k].motions)
      {
         require(joint.formulation == Formulation::plane ||
                    (one.along[0] == 0 && one.angle == 0),
                 joint.faces[k].source.called("motion"),
                 ": about an axis an obstacle moves along y alone");
         loads[one.load].push_back(
            {k,
             [one](double, double y) { return one.along[0] - one.angle * (y - one.centre[1]); },
             [one](double x, double)
             { return one.along[1] + one.angle * (x - one.centre[0]); }});
      }
   }
   for (const auto &[load, motions] : loads) { reduction.add_obstacle_motion(load, motions); }
}

/// Where a place is along a line, at the nearest point; beyond its ends as the line goes on.
double arc_length_on(const ContactLine &line, const Eigen::Vector2d &place)
{
   double nearest = std::numeric_limits<double>::infinity(), found = 0;
   for (const LineChain &chain : line.chains)
   {
      const Eigen::Index last = chain.first + chain.nodes - 1;
      if (chain.nodes == 1) { found = line.nodes[last].arc_length; }
      for (Eigen::Index i = chain.first; i < last + (chain.loop ? 1 : 0); ++i)
      {
         const LineNode &a = line.nodes[i], &b = line.nodes[i < last ? i + 1 : chain.first];
         const Eigen::Vector2d along = b.position - a.position;
         const double share = along.dot(place - a.position) / along.squaredNorm();
         const double within = std::clamp(share, 0.0, 1.0);
         const double away = (a.position + within * along - place).norm();
         const bool end = !chain.loop && (share < 0 ? i == chain.first : i == last - 1);
         if (away >= nearest) { continue; }
         nearest = away;
         found = a.arc_length + (end ? share : within) * along.norm();
      }
   }
   return found;
}

/// What the case says of the interfaces' friction and gaps, and of shanks.
void complete(Reduction &reduction, const JointCase &joint,
              const std::vector<std::array<ContactLine, 2>> &lines)
{
   ReducedProblem &problem = reduction.problem;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      InterfaceReport &report = reduction.interfaces[k];
      report.name = face.name;
      for (Eigen::Index i = report.first; i < report.first + report.nodes && !face.tied; ++i)
      {
         const Eigen::Vector2d place = problem.position.row(i);
         const double arc = arc_length_on(lines[k][0], place);
         const auto check = [&](const char *key, double value, bool right, const char *must)
         {
            require(right, face.source.called(key), " is ", value, " at arc length ", arc,
                    ", the place ", place, ", ", must);
         };
         const double f = problem.friction[i] = face.friction.at(arc, place);
         check("friction", f, std::isfinite(f) && f >= 0, "must be finite and not negative");
         if (!face.gap) { continue; }
         const double g = problem.gap[i] = face.gap->at(arc, place);
         check("gap", g, std::isfinite(g), "must be finite");
      }
      if (has_shape(face))
      {
         try
         {
            problem.gap.segment(report.first, report.nodes) =
               face.curve ? gaps_to_curve(report, [&](double x) { return (*face.curve)({x}); })
               : face.obstacle.empty() ? gaps_to_circle(report, face.centre, face.radius)
                                       : gaps_to_polyline(report, face.obstacle);
         }
         catch (const InputError &error)
         {
            throw InputError(face.source.called("obstacle") + ": " + error.what());
         }
      }
   }
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      reduction.add_shank(bolt.name, bolt.stiffness / (bolt.pretension * bolt.pretension));
   }
   move_obstacles(reduction, joint);
}

std::vector<Interface> interfaces_of(const JointCase &joint,
                                     const std::vector<std::array<ContactLine, 2>> &lines)
{
   std::vector<Interface> interfaces;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      Interface made{face.name, {face.sides[0].body, lines[k][0]}, {}, face.slave};
      made.most_overlap = face.most_overlap;
      made.tied = face.tied;
      if (face.sides[1].body >= 0) { made.second = {face.sides[1].body, lines[k][1]}; }
      else { made.gap = distance_to_rigid_line(lines[k][0]); }
      // By the arc length or the normals, which are not known yet.
      if (face.gap || has_shape(face)) { made.gap = 0.0; }
      interfaces.push_back(std::move(made));
   }
   return interfaces;
}

Reduction united(const JointCase &joint, std::vector<CondensedBody> condensed,
                 const std::vector<std::array<ContactLine, 2>> &lines)
{
   const JointCase::Face &one = joint.faces[0];
   if (!std::isnan(one.pairing))
   {
      require(joint.faces.size() == 1 && condensed.size() == 2 && one.sides[1].body >= 0,
              one.source.called("pairing"),
              " is for two bodies at one interface: others need none, their nodes need not "
              "match");
      return paired(std::move(condensed), one, joint.numbered);
   }
   return reduce(std::move(condensed), interfaces_of(joint, lines));
}

/// Pulled apart by a shank that is to pull together: most likely a direction the wrong way.
void warn_of_push(const JointCase &joint, const JointCase::Bolt &bolt,
                  const std::array<ContactLine, 2> &ends)
{
   const auto middle = [](const ContactLine &line) -> Eigen::Vector2d
   {
      return line.each(&LineNode::position).transpose() * line.each(&LineNode::weight) /
             line.each(&LineNode::weight).sum();
   };
   const Eigen::Vector2d apart = middle(ends[0]) - middle(ends[1]),
                         along(bolt.direction[0], bolt.direction[1]);
   if (along.dot(apart) < -1e-6 * apart.norm())
   {
      warn(bolt.source.called("direction") + " points from " +
           joint.bodies[bolt.ends[0].body].name + " to " +
           joint.bodies[bolt.ends[1].body].name +
           ": the shank pushes them apart, to pull them together it must point the other way");
   }
}

} // namespace

OwnBodies make_own_bodies(const JointCase &joint)
{
   OwnBodies own;
   std::vector<Part> parts;
   int half_planes = 0;
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      parts.emplace_back(own, joint, static_cast<int>(b));
      half_planes += joint.bodies[b].half_plane;
   }
   require(half_planes < 2, "there are ", half_planes,
           " half-planes, must be one at most: two would have no body between them");
   const bool twists = twist(own, joint, parts);
   find_matrices(own, joint, parts);
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      for (const Part &part : parts)
      {
         require(!part.has_load(bolt.name), part.called(), " has a load '", bolt.name,
                 "', which is the name of a bolt: one of them must have another");
      }
   }
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      for (int k : {0, 1})
      {
         const Eigen::Vector2d along(bolt.direction[0], bolt.direction[1]);
         Part &part = parts[bolt.ends[k].body];
         // The shank pulls the ends together.
         const double pull = k == 0 ? -bolt.pretension : bolt.pretension;
         part.named([&] { part.pull(bolt.name, bolt.ends[k], pull * along); });
      }
      warn_of_push(joint, bolt,
                   {parts[bolt.ends[0].body].line(bolt.ends[0]),
                    parts[bolt.ends[1].body].line(bolt.ends[1])});
   }
   std::vector<std::array<ContactLine, 2>> lines(joint.faces.size());
   std::vector<std::vector<ContactLine>> of_body(parts.size());
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      for (int s : {0, 1})
      {
         const JointCase::Side &side = joint.faces[k].sides[s];
         if (side.body < 0 || joint.bodies[side.body].half_plane) { continue; }
         const Part &part = parts[side.body];
         lines[k][s] = part.named([&] { return part.line(side); });
         of_body[side.body].push_back(lines[k][s]);
      }
   }
   std::vector<CondensedBody> condensed;
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      if (joint.bodies[b].half_plane) { continue; }
      require(!of_body[b].empty(), "body ", joint.bodies[b].name,
              " is at no interface, nothing touches it: it must be at one, or be left out");
      const ContactLine line = of_body[b].size() == 1 ? of_body[b][0] : joined(of_body[b]);
      // The last with a factor that this one's could be.
      const CondensedBody *alike = nullptr;
      for (const CondensedBody &before : condensed)
      {
         if (before.line.size() == line.size()) { alike = &before; }
      }
      condensed.push_back(parts[b].named([&] { return parts[b].condensed(line, alike); }));
      own.accuracy = std::max(own.accuracy, condensed.back().error_estimate());
   }
   if (half_planes > 0)
   {
      stand_on_half_plane(own, std::move(condensed), interfaces_of(joint, lines), joint);
   }
   else { own.scene.reduction = united(joint, std::move(condensed), lines); }
   if (twists) { own.scene.reduction.add_torsion(condensed_twisting(joint, parts)); }
   complete(own.scene.reduction, joint, lines);
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
void warn_of_overlap(const ReducedProblem &problem, const InterfaceReport &interface)
{
   if (interface.tied) { return; }
   Eigen::Index deepest = 0;
   const auto gap = problem.gap.segment(interface.first, interface.nodes);
   const double overlap = -gap.cwiseQuotient(interface.spacing).minCoeff(&deepest);
   if (overlap <= 1) { return; }
   std::ostringstream text;
   text << "the bodies overlap by " << -gap[deepest] << " at ("
        << interface.position(deepest, 0) << ", " << interface.position(deepest, 1)
        << "), which is " << overlap
        << " distances of nodes: small displacements do not open that, see that both meshes "
           "are in "
           "their places and in one unit";
   warn(text.str());
}

void warn_of_loose_bodies(const OwnBodies &own)
{
   const Reduction &reduction = own.scene.reduction;
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      double least = std::numeric_limits<double>::infinity();
      for (const InterfaceReport &face : reduction.interfaces)
      {
         const auto number = static_cast<int>(b);
         if (face.bodies[0] != number && face.bodies[1] != number) { continue; }
         least = std::min(
            least,
            face.tied ? 0 : reduction.problem.gap.segment(face.first, face.nodes).minCoeff());
      }
      if (reduction.bodies[b].free_motions.cols() == 0 || least <= 0) { continue; }
      const std::string &name = reduction.bodies[b].name;
      std::ostringstream text;
      text << "body " << (name.empty() ? std::to_string(b + 1) : name)
           << " is free and touches nothing at rest, the least gap is " << least
           << ": the first force moves it until it touches, all at once, which a march may not "
              "follow; place it so that it touches, or move it there by a guide";
      warn(text.str());
   }
}

std::vector<bool> even_sides(const JointCase &joint)
{
   std::vector<bool> even;
   for (const JointCase::Face &face : joint.faces)
   {
      const bool rigid = face.sides[1].body < 0;
      even.push_back(
         (rigid && std::isnan(face.radius) && !face.curve && face.obstacle.size() < 3) ||
         (!rigid && joint.bodies[face.sides[1].body].half_plane));
   }
   return even;
}

void warn_of_large_displacements(OwnBodies &own, const SmallDisplacements &noted,
                                 const ContactState &last)
{
   for (const std::string &sentence : noted.warnings()) { warn(sentence); }
   Reduction &reduction = own.scene.reduction;
   const Counters before = reduction.counters; // of the study, which asked for no fields
   for (std::size_t b = 0; b < own.scene.bodies.size(); ++b)
   {
      const Eigen::VectorXd field =
         reduction.displacement(static_cast<int>(b), last.v, last.w, last.multipliers);
      const Rotation most = largest_rotation(*own.scene.bodies[b], field);
      const std::string &name = reduction.bodies[b].name,
                        sentence = rotation_warning(name.empty() ? std::to_string(b + 1) : name,
                                                    most.angle, most.place);
      if (!sentence.empty()) { warn(sentence); }
   }
   reduction.counters = before;
}

/// Degrees.
static double angle_of(double cosine)
{
   return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
}

SidesThatBear::SidesThatBear(const InterfaceReport &interface) : face_(interface)
{
   Eigen::MatrixX2d normals(interface.nodes, 2);
   normals << -interface.tangent.col(1), interface.tangent.col(0);
   const Eigen::Vector2d mean = (normals.transpose() * interface.weights).normalized();
   const Eigen::VectorXd cosine = normals * mean;
   for (Eigen::Index i = 0; i < interface.nodes; ++i)
   {
      if (angle_of(cosine[i]) > 15) { sides_.push_back({i, angle_of(cosine[i])}); }
   }
}

void SidesThatBear::note(const ContactState &state)
{
   for (const Node &side : sides_)
   {
      const Eigen::Index i = face_.first + side.index;
      if (closed(state.status[i]) && state.p[i] > 1e-9 * state.p.maxCoeff() &&
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
   text << "node " << worst_.index << " at (" << face_.position(worst_.index, 0) << ", "
        << face_.position(worst_.index, 1) << ") bears although its normal is "
        << std::lround(worst_.angle)
        << " degrees off that of the rigid line: forces and zones are wrong there, name no "
           "boundary around a corner as contact";
   miniapp::warn(text.str());
}

} // namespace miniapp
