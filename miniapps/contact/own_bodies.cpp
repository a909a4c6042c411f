#include "contact/own_bodies.hpp"

#include "contact/own_bolts.hpp"
#include "contact/own_half_plane.hpp"
#include "contact/own_interfaces.hpp"
#include "contact/own_part.hpp"
#include "contact/own_sides.hpp"
#include "contact/own_warnings.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>

namespace miniapp
{

using namespace cattaneo;

namespace
{

/// Notes the guided parts of bodies, for pictures.
void note_guides(OwnBodies &own, const JointCase &joint)
{
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      const HeldBody &held = own.held[b];
      if (held.place.empty()) { continue; } // on several ranks
      for (const JointCase::Body::Guided &each : joint.bodies[b].guides)
      {
         GuidedPart part{static_cast<int>(b), each.on, {}, {0, 0}, {}};
         for (const Holding &one : held.holdings)
         {
            if (one.kind == "guide" && one.name == each.on) { part.dofs = one.dofs; }
         }
         Eigen::AlignedBox2d box;
         for (int dof : part.dofs) { box.extend(held.place[dof]); }
         if (each.guide.centre)
         {
            part.centre = {(*each.guide.centre)[0], (*each.guide.centre)[1]};
         }
         else if (!box.isEmpty()) { part.centre = box.center(); }
         const Guide::Along *const ways[] = {&each.guide.x, &each.guide.y,
                                             &each.guide.rotation};
         for (int way : {0, 1, 2})
         {
            if (ways[way]->load.empty()) { continue; }
            GuidedPart::Load load{ways[way]->load, ways[way]->motion == Guide::Motion::force};
            (way == 2 ? load.moment : load.along[way]) = ways[way]->value;
            part.loads.push_back(load);
         }
         own.scene.guides.push_back(part);
      }
   }
}

} // namespace

OwnBodies make_own_bodies(const JointCase &joint)
{
   OwnBodies own;
   std::vector<OwnPart> parts;
   int half_planes = 0;
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      parts.emplace_back(own, joint, static_cast<int>(b));
      half_planes += joint.bodies[b].half_plane;
   }
   require(half_planes < 2, "there are ", half_planes, " half-planes, must be at most one");
   const bool twists = twist(own, joint, parts);
   find_matrices(own, joint, parts);
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      for (const OwnPart &part : parts)
      {
         require(!part.has_load(bolt.name), part.called(), " has a load '", bolt.name,
                 "', which is the name of a bolt: rename one of the two");
      }
   }
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      std::array<Eigen::Vector3d, 2> ends{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      for (int k : {0, 1})
      {
         if (bolt.ends[k].body < 0) { continue; } // the ground
         const OwnPart &part = parts[bolt.ends[k].body];
         ends[k] << part.named([&] { return part.middle(bolt.ends[k]); }), 0;
      }
      const Eigen::Vector2d along = bolt_direction(joint, bolt, ends).head<2>();
      bool held = true;
      for (int k : {0, 1})
      {
         if (bolt.ends[k].body < 0) { continue; }
         OwnPart &part = parts[bolt.ends[k].body];
         // The shank pulls the ends together. Forces on each body are those of its own
         // thickness.
         const double pull =
            (k == 0 ? -bolt.force : bolt.force) / joint.thickness_of(bolt.ends[k].body);
         part.named([&] { part.pull(bolt.name, bolt.ends[k], pull * along); });
         held = held && part.holds_all_of(bolt.name);
      }
      if (held) { warn_of_bolt_on_supports(bolt); }
   }
   std::vector<std::array<ContactLine, 2>> lines(joint.faces.size());
   require_own_meshes(joint, parts);
   std::vector<std::vector<ContactLine>> of_body(parts.size());
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      for (int s : {0, 1})
      {
         const JointCase::Side &side = joint.faces[k].sides[s];
         if (side.body < 0 || joint.bodies[side.body].half_plane) { continue; }
         const OwnPart &part = parts[side.body];
         lines[k][s] = part.named([&] { return part.line(side); });
         of_body[side.body].push_back(lines[k][s]);
      }
   }
   require_sides_free(joint, parts, lines);
   const std::string units = other_units(joint, parts);
   std::vector<CondensedBody> condensed;
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      if (joint.bodies[b].half_plane) { continue; }
      require(!of_body[b].empty(), "body ", joint.bodies[b].name,
              " is in no interface, so nothing touches it: name an interface for it, or leave "
              "it out");
      const ContactLine line = of_body[b].size() == 1 ? of_body[b][0] : joined(of_body[b]);
      // The last body whose factor this one may share.
      const CondensedBody *alike = nullptr;
      for (const CondensedBody &before : condensed)
      {
         if (before.line.size() == line.size()) { alike = &before; }
      }
      condensed.push_back(parts[b].named([&] { return parts[b].condensed(line, alike); }));
      own.scene.thickness.push_back(
         joint.formulation == Formulation::plane ? joint.thickness_of(static_cast<int>(b)) : 1);
      own.accuracy = std::max(own.accuracy, condensed.back().error_estimate());
      if (joint.formulation == Formulation::plane)
      {
         condensed.back().thicken(joint.thickness_of(static_cast<int>(b)));
      }
   }
   try
   {
      if (half_planes > 0)
      {
         stand_on_half_plane(own, std::move(condensed), interfaces_of(joint, lines), joint);
      }
      else { own.scene.reduction = united(joint, std::move(condensed), lines); }
   }
   catch (const InputError &error)
   {
      // If sizes suggest mixed units, that sentence comes first, because the error alone does
      // not tell the cause.
      throw InputError(units.empty() ? error.what() : units + " (" + error.what() + ")");
   }
   if (!units.empty()) { warn(units); }
   if (twists) { own.scene.reduction.add_torsion(condensed_twisting(joint, parts)); }
   complete(own, joint, lines);
   for (std::size_t b = 0; b < parts.size(); ++b)
   {
      own.held.push_back(parts[b].held());
      if (auto made = parts[b].vibrating()) { own.vibrating.emplace(b, *std::move(made)); }
   }
   note_guides(own, joint);
   std::vector<SmoothSides> sides;
   for (const OwnPart &part : parts) { sides.push_back(part.sides()); }
   note_smooth_sides(joint, own.scene.reduction, sides);
   return own;
}

} // namespace miniapp
