#include "contact/own_half_plane.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;

Eigen::Vector2d mean_normal(const ContactLine &line)
{
   return (line.each(&LineNode::normal).transpose() * line.each(&LineNode::weight))
      .normalized();
}

namespace
{

/// Share of the nodes' common displacement along an axis that the body resists, from 0 to 1.
double held_share(const CondensedBody &body, const Eigen::Vector2d &axis)
{
   const Eigen::VectorXd motion = (body.rigid_motions().leftCols(2) * axis).normalized();
   const Eigen::MatrixXd &free = body.free_motions;
   return (motion - free * (free.transpose() * motion)).norm();
}

/// The same node in the line of the condensed body, if that line ends there at a plane of
/// symmetry; else none. The tangent of the returned node is that of the surface.
const LineNode *symmetric_end(const LineNode &node, const ContactLine &all)
{
   for (const LineChain &chain : all.chains)
   {
      for (const std::size_t end : {0, 1})
      {
         const LineNode &last = all.nodes[chain.first + (end ? chain.nodes - 1 : 0)];
         if (last.dofs == node.dofs && chain.ends[end] == LineEnd::symmetry) { return &last; }
      }
   }
   return nullptr;
}

} // namespace

void stand_on_half_plane(OwnBodies &own, std::vector<CondensedBody> bodies,
                         std::vector<Interface> interfaces, const JointCase &joint)
{
   const JointCase::Body &plane = joint.bodies.back();
   const auto number = static_cast<int>(bodies.size());
   const bool about_axis = joint.formulation != Formulation::plane;
   HalfPlane below;
   below.material = {plane.young.values[0], plane.poisson.values[0],
                     joint.plane_stress ? PlaneState::stress : PlaneState::strain};
   Eigen::Vector2d normal(0, 0);
   const LineNode *held = nullptr, *any = nullptr;
   Eigen::AlignedBox2d box;
   for (const Interface &one : interfaces)
   {
      if (one.second.body != number) { continue; }
      const ContactLine &line = one.first.line;
      normal += line.each(&LineNode::normal).transpose() * line.each(&LineNode::weight);
      const CondensedBody &body = bodies[one.first.body];
      for (const LineNode &node : line.nodes)
      {
         if (!held) { held = symmetric_end(node, body.line); }
         any = any ? any : &node;
         box.extend(node.position);
      }
   }
   require(
      any, "body ", plane.name,
      " is in no interface, so nothing touches it: name an interface for it, or leave it out");
   normal.normalize();
   if (about_axis) { normal = Eigen::Vector2d(0, normal[1] > 0 ? 1 : -1); }
   Eigen::Vector2d at = any->position;
   Eigen::Index axis = 0;
   if (held && !about_axis)
   {
      below.symmetric = true;
      // The normal is the axis nearest to the node's normal: the line may miss 90 degrees to
      // the support by LineChain::symmetry_turn.
      const Eigen::Vector2d leaning = held->normal();
      leaning.cwiseAbs().maxCoeff(&axis);
      normal.setZero();
      normal[axis] = std::copysign(1.0, leaning[axis]);
      at = held->position;
   }
   double level = normal.dot(at);
   for (const Interface &one : interfaces)
   {
      if (one.second.body != number) { continue; }
      level = std::min(level, (one.first.line.each(&LineNode::position) * normal).minCoeff());
   }
   below.normal = -normal;
   // A bulk stress does not move the middle of the contact.
   below.bulk = plane.bulk;
   if (!below.bulk.empty() && !held && !about_axis) { at = box.center(); }
   below.point = at + (level - normal.dot(at)) * normal;
   if (about_axis) { below.point[0] = 0; }
   const bool relative =
      !about_axis && std::isnan(plane.depth); // no depth: only forces are possible
   for (const CondensedBody &body : bodies)
   {
      if (!relative) { break; }
      const double most = below.is_symmetric()
                             ? held_share(body, normal)
                             : std::max(held_share(body, Eigen::Vector2d(1, 0)),
                                        held_share(body, Eigen::Vector2d(0, 1)));
      require(most < 1e-7, "half-plane: supports or prescribed displacements hold body ",
              body.name, " against it. Displacements of a half-plane are relative to a depth: ",
              plane.source.called("half-plane.depth"),
              " must give it, unless the body has no such supports and only forces act on it");
   }
   require(!relative || joint.bolts.empty(), plane.source.called("half-plane.depth"),
           " must be given if there are bolts, because their forces depend on displacements");
   below.thickness = joint.thickness_of(number);
   below.depth = relative ? 1e4 * box.diagonal().norm() : about_axis ? 0 : plane.depth;
   own.scene.reduction = reduce(std::move(bodies), std::move(interfaces), below);
   if (relative) { own.scene.problem().H.resize(0, 0); }
   CondensedBody &made = own.scene.reduction.bodies.back();
   made.name = plane.name;
   own.accuracy = std::max(own.accuracy, made.error_estimate());
   own.materials.push_back({below.material});
   own.half_plane = below;
}

} // namespace miniapp
