#include "contact/own_part.hpp"

#include "contact/own_warnings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/words.hpp>
#include <map>
#include <set>

namespace miniapp
{

using namespace cattaneo;

namespace
{

std::vector<Material> materials(const JointCase::Body &body, int attributes, bool plane_stress)
{
   std::vector<double> young = body.young.values, poisson = body.poisson.values;
   const std::string both =
      body.source.called("young") + " and " + body.source.called("poisson");
   for (const auto &[key, values] :
        {std::pair("young", &young), std::pair("poisson", &poisson)})
   {
      require(values->size() <= 1 || values->size() <= static_cast<std::size_t>(attributes),
              body.source.called(key), " has ", values->size(), " values, must have one",
              attributes > 1 ? ", or one for each element attribute of the mesh, 1 to " +
                                  std::to_string(attributes)
                             : ": the elements of the mesh have one attribute, 1");
   }
   const std::size_t count = std::max(young.size(), poisson.size());
   if (young.size() == 1) { young.resize(count, young[0]); }
   if (poisson.size() == 1) { poisson.resize(count, poisson[0]); }
   require(young.size() == poisson.size(), both, " have ", young.size(), " and ",
           poisson.size(), " values, must have as many (or one)");
   std::vector<Material> list;
   for (std::size_t a = 0; a < count; ++a)
   {
      list.push_back(
         {young[a], poisson[a], plane_stress ? PlaneState::stress : PlaneState::strain});
   }
   return list;
}

/// The materials of the sections of a deck, if the case names none.
JointCase::Body with_materials(JointCase::Body body, const MeshNames &names)
{
   if (!body.young.empty()) { return body; }
   require(
      !names.materials.empty(),
      "it has no *SOLID SECTION with a material: the keys young and poisson must be there");
   for (std::size_t k = 0; k < names.materials.size(); ++k)
   {
      const MeshNames::DeckMaterial &material = names.materials[k];
      require(material.young > 0, "the material '", material.name, "' of its section ", k + 1,
              " has no *ELASTIC that is isotropic and the same at all temperatures: the keys "
              "young and poisson must be there");
      body.young.values.push_back(material.young);
      body.poisson.values.push_back(material.poisson);
   }
   return body;
}

/// A constant for each attribute of the elements, given by number or by the name of the group.
void by_attribute(JointCase::Body::Constants &constants, const std::string &key,
                  const mfem::Mesh &mesh, const MeshNames &names)
{
   if (constants.named.empty()) { return; }
   constants.values.assign(mesh.attributes.Max(), constants.named.begin()->second);
   std::set<int> known;
   std::vector<std::string> groups;
   for (const auto &[group, attribute] : names.elements) { groups.push_back(group); }
   for (const auto &[group, value] : constants.named)
   {
      const auto found = names.elements.find(group);
      require(found != names.elements.end(), key, " names '", group,
              "', which is no group of elements of the mesh, must be one of ",
              groups.empty() ? "none: the mesh has no names" : listed(groups));
      known.insert(found->second);
      // A group without elements needs no value.
      if (found->second <= mesh.attributes.Max())
      {
         constants.values[found->second - 1] = value;
      }
   }
   for (int attribute : mesh.attributes)
   {
      const auto its =
         std::find_if(names.elements.begin(), names.elements.end(),
                      [&](const auto &group) { return group.second == attribute; });
      require(known.count(attribute) == 1, key, " has nothing for ",
              its == names.elements.end() ? "attribute " + std::to_string(attribute)
                                          : "the group '" + its->first + "'",
              " of the elements, must have a number for each group");
   }
}

/// Forces and moments on a rigid block, per thickness as in the body.
Guide per_thickness(Guide guide, double thickness)
{
   for (Guide::Along *along : {&guide.x, &guide.y, &guide.rotation})
   {
      if (along->motion == Guide::Motion::force) { along->value /= thickness; }
   }
   return guide;
}

/// The plane state of a deck, in words, if the case has the other one; else empty.
std::string other_plane_state(const MeshNames &names, bool plane_stress, bool about_axis)
{
   if (about_axis && !names.axisymmetric && !names.plane_elements.empty())
   {
      return "its elements are plane (" + *names.plane_elements.begin() +
             "), the case computes bodies of revolution (key 'analysis')";
   }
   const std::string other = plane_stress ? "CPE" : "CPS";
   if (names.axisymmetric || names.plane_elements.count(other) == 0) { return ""; }
   return "its elements are of plane " +
          std::string(plane_stress ? "strain (CPE), the case computes plane stress"
                                   : "stress (CPS), the case computes plane strain") +
          " (key 'analysis')";
}

} // namespace

std::vector<Material> materials_of(JointCase::Body body, const mfem::Mesh &mesh,
                                   const MeshNames &names, bool plane_stress)
{
   body = with_materials(std::move(body), names);
   by_attribute(body.young, body.source.called("young"), mesh, names);
   by_attribute(body.poisson, body.source.called("poisson"), mesh, names);
   return materials(body, mesh.attributes.Size() ? mesh.attributes.Max() : 1, plane_stress);
}

std::vector<double> densities_of(JointCase::Body body, const mfem::Mesh &mesh,
                                 const MeshNames &names)
{
   const std::string key = body.source.called("density");
   by_attribute(body.density, key, mesh, names);
   const std::size_t attributes = mesh.attributes.Size() ? mesh.attributes.Max() : 1;
   require(body.density.values.size() < 2 || body.density.values.size() == attributes, key,
           " has ", body.density.values.size(),
           " values, must have one, or one for each element attribute of the mesh, 1 to ",
           attributes);
   return body.density.values;
}

OwnPart::OwnPart(OwnBodies &own, const JointCase &joint, int b)
   : joint_(joint), body_(joint.bodies[b])
{
   if (!body_.mesh.empty()) { make_of_mesh(own, b); }
}

std::vector<int> OwnPart::of_sides(int b, bool slits) const
{
   std::vector<int> attributes;
   for (const JointCase::Face &face : joint_.faces)
   {
      if (slits && (face.sides[0].body != b || face.sides[1].body != b)) { continue; }
      for (const JointCase::Side &side : face.sides)
      {
         if (side.body != b || side.part.empty()) { continue; }
         const BoundaryPart part = boundary_part(side.called, side.part, terms_);
         attributes.insert(attributes.end(), part.attributes.begin(), part.attributes.end());
      }
   }
   return attributes;
}

void OwnPart::make_of_mesh(OwnBodies &own, int b)
{
   named(
      [&]
      {
         std::vector<int> curves;
         const MeshPart part{body_.part, body_.name, body_.split};
         mfem::Mesh mesh = read_mesh(body_.mesh, &curves, part);
         const MeshNames names = mesh_names(body_.mesh, part);
         require(!names.axisymmetric || joint_.formulation == Formulation::axisymmetric,
                 "its elements are axisymmetric (CAX), key 'analysis' must be axisymmetric");
         if (!names.passed_over.empty())
         {
            warn("mesh '" + body_.mesh + "': its " + names.passed_over +
                 " are ignored: contacts, supports and loads are those of the case");
         }
         if (const std::string other = other_plane_state(
                names, joint_.plane_stress, joint_.formulation != Formulation::plane);
             !other.empty())
         {
            warn(called() + ": " + other);
         }
         for (int vertex = 0; vertex < mesh.GetNV(); ++vertex)
         {
            const double *at = mesh.GetVertex(vertex);
            vertices_.insert(vertices_.end(), {at[0], at[1]});
         }
         terms_ = {names.boundary, names.numbered, body_.expansion};
         for (const std::string &warning :
              {unjoined_vertices(mesh, body_.mesh, of_sides(b, true)),
               missed_curves(mesh, order(), body_.mesh)})
         {
            if (!warning.empty()) { warn(warning); }
         }
         // With `as meshed` no node moves. The curves of the file are then used only for
         // estimates.
         const std::string support = body_.source.called("support");
         sides_ = curve_sides(mesh, body_.as_meshed ? 1 : order(), of_sides(b), curves,
                              supported_attributes(support, body_.support, terms_));
         if (!body_.as_meshed) { warn_of_thin_wall(sides_, body_.name, order()); }
         own.materials.push_back(materials_of(body_, mesh, names, joint_.plane_stress));
         own.densities.push_back(densities_of(body_, mesh, names));
         elastic_ =
            &own.scene.add(std::move(mesh), order(), own.materials.back(), joint_.formulation);
         for (const std::string &one : split(body_.support, " ;\t\n"))
         {
            hold("support", one, [&] { add_supports(*elastic_, support, one, terms_); });
         }
         for (const JointCase::Body::Guided &each : body_.guides)
         {
            hold("guide", each.on,
                 [&]
                 {
                    const std::string on = each.source.called("on");
                    try
                    {
                       elastic_->guide(boundary_part(on, each.on, terms_),
                                       per_thickness(each.guide, joint_.thickness_of(b)));
                    }
                    catch (const InputError &error)
                    {
                       const std::string said = error.what();
                       throw InputError(
                          said.rfind(on, 0) == 0 ? said : on + " '" + each.on + "': " + said);
                    }
                 });
         }
         for (const std::string &one : split(body_.load, ";\n"))
         {
            hold("displacement", split(one, " \t")[0],
                 [&] { add_loads(*elastic_, body_.source.called("load"), one, terms_); });
         }
         require_one_displacement();
      });
}

std::vector<OwnPart::Dof> OwnPart::dofs_of(const ElasticBody &body) const
{
   std::vector<Dof> all(body.space().GetTrueVSize());
   const mfem::DenseMatrix &places = body.node_coordinates();
   for (int node = 0; node < places.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof < 0) { continue; }
         all[dof] = {{places(0, node), places(1, node)}, body.components() == 1 ? 2 : c};
      }
   }
   return all;
}

std::vector<OwnPart::Dof> OwnPart::dofs() const
{
   if (elastic_) { return dofs_of(*elastic_); }
   const AssembledBody body = nodal_->body();
   std::vector<Dof> all(body.places.component.size());
   for (std::size_t dof = 0; dof < all.size(); ++dof)
   {
      all[dof] = {{body.places.x[dof], body.places.y[dof]}, body.places.component[dof]};
   }
   return all;
}

void require_one_displacement(const std::vector<Prescribed> &all,
                              const std::vector<Holding> &holdings,
                              const std::function<int(int dof)> &component,
                              const std::function<std::string(int dof)> &where)
{
   const auto by = [](const Prescribed &one, int dof)
   { return as_text((*one.values)[dof]) + " per unit of load '" + one.load + "'"; };
   // A support whose dofs a load moves.
   for (const Holding &held : holdings)
   {
      for (const int dof : held.dofs)
      {
         for (const Prescribed &one : all)
         {
            const bool moved = one.dofs.count(dof) > 0 && (*one.values)[dof] != 0;
            require(held.kind != "support" || !moved, "support '", held.name, "' holds ",
                    moved ? where(dof) : "", ", and it is moved by ", moved ? by(one, dof) : "",
                    ": the part of the load must end before it, by an interval such as "
                    "3[-1<x<1], or the support must");
         }
      }
   }
   // Two loads that move the same nodes add up. If they share only some nodes, such as a
   // corner, the shared nodes would follow the sum and all others only one of the loads.
   for (std::size_t a = 0; a < all.size(); ++a)
   {
      for (std::size_t b = a + 1; b < all.size(); ++b)
      {
         for (const int way : {0, 1, 2})
         {
            const auto of = [&](const std::set<int> &dofs)
            {
               std::set<int> own;
               for (const int dof : dofs)
               {
                  if (component(dof) == way) { own.insert(dof); }
               }
               return own;
            };
            const std::set<int> first = of(all[a].dofs), second = of(all[b].dofs);
            if (first == second) { continue; }
            for (const int dof : first)
            {
               const bool moved = second.count(dof) > 0 &&
                                  ((*all[a].values)[dof] != 0 || (*all[b].values)[dof] != 0);
               require(!moved, "two loads share ", moved ? where(dof) : "", ", which is to be ",
                       moved ? by(all[a], dof) : "", " and ", moved ? by(all[b], dof) : "",
                       ": the part of one must end before it, by an interval such as "
                       "3[-1<x<1], or both must be one load");
            }
         }
      }
   }
}

void OwnPart::require_one_displacement() const
{
   const ElasticBody *body = twisting_ ? twisting_ : elastic_;
   std::vector<Prescribed> all;
   for (const BodyLoad &load : body ? body->patterns() : nodal_->loads)
   {
      if (load.control != Control::displacement) { continue; }
      Prescribed &made = all.emplace_back(Prescribed{load.name, {}, &load.values});
      if (!body)
      {
         const auto its = prescribed_.find(load.name);
         if (its != prescribed_.end()) { made.dofs = its->second; }
         continue;
      }
      const std::vector<int> its = body->prescribed_dofs(load.name);
      made.dofs.insert(its.begin(), its.end());
   }
   if (all.empty()) { return; }
   const std::vector<Dof> places = body ? dofs_of(*body) : dofs();
   const bool plane = joint_.formulation == Formulation::plane;
   const auto where = [&](int dof)
   {
      static const char *const ways[2][3] = {{"along r", "along z", "around the axis"},
                                             {"along x", "along y", ""}};
      return told("the node at ", as_text(places[dof].place), " ",
                  ways[plane][places[dof].component]);
   };
   miniapp::require_one_displacement(
      all, twisting_ ? around_ : holdings_, [&](int dof) { return places[dof].component; },
      where);
}

double OwnPart::size() const
{
   Eigen::AlignedBox2d box;
   if (nodal_)
   {
      for (const auto &node : nodal_->places) { box.extend(node.second); }
   }
   if (elastic_ && !elastic_->ranks().distributed())
   {
      const mfem::DenseMatrix &places = elastic_->node_coordinates();
      for (int node = 0; node < places.Width(); ++node)
      {
         box.extend(Eigen::Vector2d(places(0, node), places(1, node)));
      }
   }
   return box.isEmpty() ? 0 : box.diagonal().norm();
}

bool OwnPart::lies_on(const OwnPart &other) const
{
   return !vertices_.empty() && vertices_ == other.vertices_;
}

std::set<int> OwnPart::supported() const
{
   std::set<int> dofs;
   for (const Holding &each : holdings_)
   {
      if (each.kind == "support") { dofs.insert(each.dofs.begin(), each.dofs.end()); }
   }
   return dofs;
}

std::vector<int> OwnPart::fixed() const
{
   if (nodal_) { return nodal_->fixed; }
   const mfem::Array<int> dofs = elastic_->essential_dofs();
   return {dofs.begin(), dofs.end()};
}

namespace
{

/// Appends the dofs that are held in `after` but not in `before`.
void note_holding(std::vector<Holding> &all, const std::string &kind, const std::string &name,
                  const std::vector<int> &before, const std::vector<int> &after)
{
   Holding made{kind, name, {}};
   std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                       std::back_inserter(made.dofs));
   if (!made.dofs.empty()) { all.push_back(std::move(made)); }
}

} // namespace

template <class Hold>
void OwnPart::hold(const std::string &kind, const std::string &name, Hold hold)
{
   const std::vector<int> before = fixed();
   hold();
   note_holding(holdings_, kind, name, before, fixed());
}

template <class Hold>
void OwnPart::hold_around(const std::string &kind, const std::string &name, Hold hold)
{
   const auto held = [&]
   {
      const mfem::Array<int> dofs = twisting_->essential_dofs();
      return std::vector<int>(dofs.begin(), dofs.end());
   };
   const std::vector<int> before = held();
   hold();
   note_holding(around_, kind, name, before, held());
}

HeldBody OwnPart::held() const
{
   HeldBody made;
   made.holdings = holdings_;
   if (nodal_)
   {
      const AssembledBody body = nodal_->body();
      made.K = body.K;
      made.component = body.places.component;
      for (std::size_t dof = 0; dof < made.component.size(); ++dof)
      {
         made.place.emplace_back(body.places.x[dof], body.places.y[dof]);
      }
      made.loads = body.loads;
      made.supports_left_out = nodal_->supports_left_out || !body.eliminated().empty();
   }
   if (!elastic_ || elastic_->ranks().distributed()) { return made; }
   made.K = elastic_->shared_stiffness();
   for (const Dof &dof : dofs_of(*elastic_))
   {
      made.component.push_back(dof.component);
      made.place.push_back(dof.place);
   }
   made.loads = elastic_->patterns();
   if (twisting_)
   {
      made.around = {twisting_->shared_stiffness(), {}, twisting_->patterns(), around_};
      for (const Dof &dof : dofs_of(*twisting_)) { made.around.place.push_back(dof.place); }
   }
   return made;
}

std::optional<VibratingBody> OwnPart::vibrating() const
{
   if (!nodal_ || nodal_->M.rows() == 0) { return {}; }
   return VibratingBody{nodal_->body(), SharedMatrix(nodal_->M)};
}

void OwnPart::make_of_matrix(NodalStiffness matrix)
{
   require(matrix.formulation == joint_.formulation, "its elements are ",
           name(matrix.formulation), ", must be ", name(joint_.formulation),
           ", as key 'analysis' says");
   nodal_ = std::move(matrix);
   const std::string key = body_.source.called("order");
   require(nodal_->edges.empty() || body_.order == 0, key,
           ": the orders of its elements are known from the deck: leave this key out");
   require(!nodal_->edges.empty() || body_.order > 0, "its elements are not known, so ", key,
           " must give the order of the elements along the sets; list the nodes of a set in "
           "sequence, with the body on the left");
   if (!nodal_->fixed.empty())
   {
      holdings_.push_back({"support", "of the deck", nodal_->fixed});
   }
   for (const std::string &one : split(body_.support, " ;\t\n"))
   {
      hold("support", one, [&] { add_supports(*nodal_, body_.source.called("support"), one); });
   }
   for (const std::string &one : split(body_.load, ";\n"))
   {
      const std::string load = split(one, " \t")[0];
      hold("displacement", load,
           [&]
           {
              // A load prescribes the rows that it would hold if it were the only one.
              std::vector<int> before;
              std::swap(before, nodal_->fixed);
              add_loads(*nodal_, body_.source.called("load"), one, body_.order);
              prescribed_[load].insert(nodal_->fixed.begin(), nodal_->fixed.end());
              std::set<int> all(before.begin(), before.end());
              all.insert(nodal_->fixed.begin(), nodal_->fixed.end());
              nodal_->fixed.assign(all.begin(), all.end());
           });
   }
   require_one_displacement();
}

void OwnPart::add_twisting(OwnBodies &own, std::size_t b)
{
   const std::vector<Material> &its = own.materials[b];
   mfem::Mesh &mesh = *own.scene.meshes[b];
   own.scene.torsion.push_back(
      its.size() == 1
         ? std::make_unique<ElasticBody>(mesh, order(), its[0], Formulation::torsion)
         : std::make_unique<ElasticBody>(mesh, order(), its, Formulation::torsion));
   twisting_ = own.scene.torsion.back().get();
   own.scene.dofs += twisting_->dofs();
   named(
      [&]
      {
         const std::string support = body_.source.called("support");
         for (const std::string &one : split(body_.support, " ;\t\n"))
         {
            hold_around("support", one,
                        [&] { add_supports(*twisting_, support, one, terms_); });
         }
         for (const std::string &one : split(body_.load, ";\n"))
         {
            hold_around("displacement", split(one, " \t")[0],
                        [&]
                        { add_loads(*twisting_, body_.source.called("load"), one, terms_); });
         }
         require_one_displacement();
      });
}

namespace
{

ContactLine of_set(const JointCase::Side &side, const NodalStiffness &nodal, int order)
{
   try
   {
      return nodal.contact_line(nodal.nodes_of(side.part), order);
   }
   catch (const InputError &error)
   {
      throw InputError(side.called + " '" + side.part + "': " + error.what());
   }
}

} // namespace

ContactLine OwnPart::line(const JointCase::Side &side) const
{
   require(!side.part.empty(), side.called, " is empty, must name boundary attributes");
   if (elastic_)
   {
      const BoundaryPart part = boundary_part(side.called, side.part, terms_);
      warn_of_cut_elements(*elastic_->space().GetMesh(), part, side.called, side.part);
   }
   ContactLine made =
      nodal_ ? of_set(side, *nodal_, body_.order)
             : contact_line(*elastic_, boundary_part(side.called, side.part, terms_));
   made.as_meshed = body_.as_meshed;
   // The file has more information than the line alone.
   bend_elements(made, sides_.chords);
   bend_elements(made, sides_.folding);
   return made;
}

bool OwnPart::has_load(const std::string &load) const
{
   const auto named = [&](const BodyLoad &one) { return one.name == load; };
   const auto has = [&](const std::vector<BodyLoad> &loads)
   { return std::any_of(loads.begin(), loads.end(), named); };
   return (nodal_ && has(nodal_->loads)) || (elastic_ && has(elastic_->patterns())) ||
          std::any_of(body_.bulk.begin(), body_.bulk.end(),
                      [&](const BulkStress &one) { return one.pattern == load; });
}

Eigen::Vector2d OwnPart::middle(const JointCase::Side &end) const
{
   require(!end.part.empty(), end.called, " is empty, must name a part of the boundary");
   if (nodal_)
   {
      const ContactLine its = line(end);
      const Eigen::VectorXd weights = its.each(&LineNode::weight);
      return its.each(&LineNode::position).transpose() * weights / weights.sum();
   }
   // The middle of the length on which the traction acts. An interval may end within an
   // element, but a contact line has only whole elements.
   const ElasticBody::Extent extent = elastic_->extent(
      boundary_part(end.called, end.part, terms_), end.called + ": '" + end.part + "'");
   require(extent.size > 0, end.called, ": there is nothing on '", end.part,
           "', must be a part of the boundary");
   return extent.middle.head<2>();
}

void OwnPart::pull(const std::string &load, const JointCase::Side &end,
                   const Eigen::Vector2d &F)
{
   if (nodal_)
   {
      const double size = line(end).each(&LineNode::weight).sum();
      nodal_->add_traction(load, nodal_->nodes_of(end.part), F / size, body_.order);
      return;
   }
   const BoundaryPart part = boundary_part(end.called, end.part, terms_);
   const double size = elastic_->extent(part).size;
   elastic_->add_traction(load, part, F[0] / size, F[1] / size);
}

bool OwnPart::holds_all_of(const std::string &load) const
{
   if (elastic_ && elastic_->ranks().distributed()) { return false; } // others may not
   const std::vector<int> all = fixed();
   std::set<int> held(all.begin(), all.end());
   if (elastic_)
   {
      // Dofs of a guide move with it if it is free or under a force.
      for (const BlockMotion &block : elastic_->blocks())
      {
         for (const int dof : all)
         {
            if (block.motion[dof] != 0) { held.erase(dof); }
         }
      }
   }
   for (const BodyLoad &one : elastic_ ? elastic_->patterns() : nodal_->loads)
   {
      if (one.name != load) { continue; }
      const double size = one.values.cwiseAbs().maxCoeff();
      for (Eigen::Index dof = 0; dof < one.values.size(); ++dof)
      {
         const bool pushed = std::abs(one.values[dof]) > 1e-12 * size;
         if (pushed && held.count(static_cast<int>(dof)) == 0) { return false; }
      }
   }
   return true;
}

CondensedBody OwnPart::condensed(const ContactLine &line, const CondensedBody *alike) const
{
   if (nodal_)
   {
      const AssembledBody body = nodal_->body();
      const std::string gone = body.grounded ? body.eliminated_warning() : std::string();
      if (!gone.empty()) { warn(called() + ": " + gone); }
   }
   CondensedBody made = nodal_ ? condense(nodal_->body(), line)
                               : condense(*elastic_, line, condensation(), alike);
   made.name = body_.name;
   return made;
}

CondensedBody OwnPart::condensed_twisting(const std::vector<JointCase::Side> &sides) const
{
   std::vector<ContactLine> lines;
   for (const JointCase::Side &side : sides)
   {
      lines.push_back(contact_line(*twisting_, boundary_part(side.called, side.part, terms_)));
   }
   CondensedBody made =
      condense(*twisting_, lines.size() == 1 ? lines[0] : joined(lines), condensation());
   made.name = body_.name;
   return made;
}

std::string OwnPart::called() const
{
   const std::string file =
      body_.mesh.empty() ? nodal_ ? nodal_->name : body_.matrix : body_.mesh;
   return "body " + body_.name + " ('" + file + "')";
}

bool twist(OwnBodies &own, const JointCase &joint, std::vector<OwnPart> &parts)
{
   const auto asks = std::find_if(parts.begin(), parts.end(),
                                  [](const OwnPart &part) { return part.twists(); });
   if (joint.formulation == Formulation::plane || asks == parts.end()) { return false; }
   for (const JointCase::Body &body : joint.bodies)
   {
      require(!body.mesh.empty(), asks->called(), " is turned about the axis, and body ",
              body.name, body.half_plane ? " is a half-plane" : " is a matrix",
              ": bodies that twist must have meshes");
   }
   require(joint.bolts.empty(), asks->called(),
           " twists a body about the axis, which a case with bolts does not allow, because "
           "their shanks would twist");
   for (std::size_t b = 0; b < parts.size(); ++b) { parts[b].add_twisting(own, b); }
   return true;
}

std::vector<CondensedBody> condensed_twisting(const JointCase &joint,
                                              const std::vector<OwnPart> &parts)
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

namespace
{

/// "'LOWER': FACE, BOTTOM; 'UPPER': TOP, …", with some sets of each part.
std::string sets_of(const std::vector<NodalStiffness> &bodies)
{
   constexpr std::size_t most = 12;
   std::vector<std::string> all;
   for (const NodalStiffness &part : bodies)
   {
      std::vector<std::string> names;
      for (const auto &set : part.sets) { names.push_back(set.first); }
      if (names.size() > most)
      {
         names.resize(most);
         names.emplace_back("…");
      }
      const std::string sets = names.empty() ? "no set" : listed(names);
      all.push_back(bodies.size() == 1 ? sets : "'" + part.name + "': " + sets);
   }
   return listed(all, "; ");
}

} // namespace

void find_matrices(OwnBodies &own, const JointCase &joint, std::vector<OwnPart> &parts)
{
   std::map<std::string, std::vector<NodalStiffness>> files;
   std::map<std::string, int> asked;
   std::map<std::string, std::string> decks, masses; // of the files
   for (const JointCase::Body &body : joint.bodies)
   {
      if (body.matrix.empty()) { continue; }
      ++asked[body.matrix];
      const std::string &deck = decks.emplace(body.matrix, body.deck).first->second;
      require(deck == body.deck, body.source.called("deck"), " is '", body.deck,
              "', another body of the matrix '", body.matrix, "' has '", deck,
              "', must be the same");
      const std::string &mass = masses.emplace(body.matrix, body.mass).first->second;
      require(mass == body.mass, body.source.called("mass"), " is '", body.mass,
              "', another body of the matrix '", body.matrix, "' has '", mass,
              "', must be the same");
      if (files.count(body.matrix) == 0)
      {
         try
         {
            NodalStiffness whole = read_stiffness(body.matrix, body.deck);
            if (!body.mass.empty()) { read_mass(whole, body.mass); }
            files[body.matrix] = whole.parts();
         }
         catch (const InputError &error)
         {
            throw InputError("body " + body.name + ": " + error.what());
         }
      }
   }
   // Gives the parts of each file to their bodies, which so far have only their names and sets.
   std::map<std::string, std::vector<NodalStiffness>> shells;
   for (const auto &[file, bodies] : files)
   {
      for (const NodalStiffness &part : bodies)
      {
         shells[file].emplace_back();
         shells[file].back().name = part.name;
         shells[file].back().sets = part.sets;
      }
      const std::size_t own_bodies = asked[file];
      require(bodies.size() == own_bodies, "matrix '", file, "' has ",
              bodies.size() == 1
                 ? "one body"
                 : std::to_string(bodies.size()) + " bodies that nothing connects",
              ", the case has ", own_bodies, " with this matrix, must have ", bodies.size(),
              ": each with a side of an interface that is a set of its own; ",
              bodies.size() == 1 ? "it has " : "they have ", sets_of(shells[file]));
   }
   std::map<std::string, std::string>
      takers; // by file and name of a part: the body that has it
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
            const auto has = [&](const NodalStiffness &part)
            { return part.has_set(side.part); };
            found = std::find_if(left.begin(), left.end(), has);
            if (found != left.end()) { continue; }
            const std::vector<NodalStiffness> &all = shells[file];
            const auto taken = std::find_if(all.begin(), all.end(), has);
            require(side.part.find('[') == std::string::npos, "matrix '", file,
                    "': ", side.called, " is '", side.part,
                    "': intervals are for meshes, a side of a matrix must be a set of nodes");
            require(taken != all.end(), "matrix '", file, "': ", side.called,
                    " names the set '", side.part,
                    "', which the matrix's deck or file does "
                    "not have, must be one of: ",
                    sets_of(all));
            require(false, "matrix '", file, "': ", side.called, " names the set '", side.part,
                    "', which is of the part '", taken->name, "', and that is body ",
                    takers[file + "\n" + taken->name], " already: body ", joint.bodies[b].name,
                    " must be another part, with a set of its own: ", sets_of(all));
         }
      }
      require(found != left.end(), "matrix '", file, "': body ", joint.bodies[b].name,
              " is in no interface, must be in one");
      takers[file + "\n" + found->name] = joint.bodies[b].name;
      own.known_elements = false;
      own.scene.dofs += static_cast<int>(found->dofs.size());
      own.materials.emplace_back(); // not known
      OwnPart &part = parts[b];
      part.named([&] { part.make_of_matrix(std::move(*found)); });
      left.erase(found);
   }
}

} // namespace miniapp
