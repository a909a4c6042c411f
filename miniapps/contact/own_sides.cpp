#include "contact/own_sides.hpp"

#include "common/text.hpp"
#include <algorithm>
#include <cattaneo/words.hpp>
#include <set>

namespace miniapp
{

using namespace cattaneo;

namespace
{

/// "interface 'face': its side 'bottom' of body pad".
std::string called(const JointCase &joint, const JointCase::Face &face,
                   const JointCase::Side &side)
{
   return "interface '" + face.name + "': its side '" + side.part + "' of body " +
          joint.bodies[side.body].name;
}

void require_side_free(const JointCase &joint, const JointCase::Face &face,
                       const JointCase::Side &side, const OwnPart &part,
                       const ContactLine &line)
{
   for (const JointCase::Body::Guided &guide : joint.bodies[side.body].guides)
   {
      const JointCase::Side on{side.body, guide.on, guide.source.called("on")};
      std::set<int> moved;
      for (const LineNode &node : part.named([&] { return part.line(on); }).nodes)
      {
         moved.insert(node.dofs.begin(), node.dofs.end());
      }
      Eigen::Index inside = 0;
      const LineNode *first = nullptr;
      for (const LineNode &node : line.nodes)
      {
         if (moved.count(node.dofs[0]) + moved.count(node.dofs[1]) == 0) { continue; }
         ++inside;
         first = first ? first : &node;
      }
      require(inside == 0 || inside < line.size(), called(joint, face, side),
              " is all of it in the guide on '", guide.on,
              "', which moves as one block: it must be another part, the one that touches");
      // Nodes of a guide that is held in all motions count as nodes of a support.
      const auto held = [](const Guide::Along &along)
      { return along.motion == Guide::Motion::held; };
      const bool along_axis = joint.formulation != Formulation::plane;
      const Guide &moves = guide.guide;
      require(inside == 0 ||
                 (held(moves.y) && (along_axis || (held(moves.x) && held(moves.rotation)))),
              called(joint, face, side), " reaches into the guide on '", guide.on, "' at ",
              first ? first->position : Eigen::Vector2d(0, 0),
              ", whose nodes move as one block: one of them must end before the other, by an "
              "interval as ",
              side.part, "[0<x<1]");
   }
   const std::set<int> held = part.supported();
   const auto is_held = [&](int dof) { return dof < 0 || held.count(dof) == 1; };
   const bool all_held = std::all_of(
      line.nodes.begin(), line.nodes.end(),
      [&](const LineNode &node) { return is_held(node.dofs[0]) && is_held(node.dofs[1]); });
   require(!all_held || line.size() == 0, called(joint, face, side),
           " is held in all components by supports of the body (",
           joint.bodies[side.body].support,
           "), so that it can neither slip nor open: name the part that touches, or replace "
           "this body by a rigid obstacle");
}

} // namespace

void require_own_meshes(const JointCase &joint, const std::vector<OwnPart> &parts)
{
   for (const JointCase::Face &face : joint.faces)
   {
      if (face.sides[0].body < 0 || face.sides[1].body < 0) { continue; }
      const int one = face.sides[0].body, other = face.sides[1].body;
      if (one == other || !parts[one].lies_on(parts[other])) { continue; }
      const std::string &mesh = joint.bodies[one].mesh, &second = joint.bodies[other].mesh;
      require(false, "interface '", face.name, "': bodies ", joint.bodies[one].name, " and ",
              joint.bodies[other].name,
              mesh == second ? " are the same mesh '" : " have the same nodes, '", mesh,
              mesh == second ? "'" : "' and '" + second + "'",
              " at the same place, so that they overlap wholly: give each a mesh at its own "
              "place (in a deck another 'part')");
   }
}

void require_sides_free(const JointCase &joint, const std::vector<OwnPart> &parts,
                        const std::vector<std::array<ContactLine, 2>> &lines)
{
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      for (int s : {0, 1})
      {
         const JointCase::Side &side = joint.faces[k].sides[s];
         if (side.body < 0 || joint.bodies[side.body].half_plane) { continue; }
         require_side_free(joint, joint.faces[k], side, parts[side.body], lines[k][s]);
      }
   }
}

std::string other_units(const JointCase &joint, const std::vector<OwnPart> &parts)
{
   // Sizes whose ratio is about 1000.
   constexpr double apart = 300;
   for (const JointCase::Face &face : joint.faces)
   {
      if (face.sides[0].body < 0 || face.sides[1].body < 0) { continue; }
      const int one = face.sides[0].body, other = face.sides[1].body;
      if (joint.bodies[one].half_plane || joint.bodies[other].half_plane) { continue; }
      const double size = parts[one].size(), other_size = parts[other].size();
      if (std::min(size, other_size) == 0) { continue; }
      if (std::max(size, other_size) < apart * std::min(size, other_size)) { continue; }
      return told("interface '", face.name, "': body ", joint.bodies[one].name, " is ", size,
                  " across and body ", joint.bodies[other].name, " ", other_size,
                  ": are both meshes in the same unit of length (m and mm are 1000 apart)?");
   }
   return "";
}

} // namespace miniapp
