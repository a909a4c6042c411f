#include "contact/own_bolts.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Vector3d;

namespace
{

/// "1, 2", in space "1, 2, 3".
std::string components(const JointCase &joint, const Vector3d &all)
{
   const std::string two = message_text(all[0]) + ", " + message_text(all[1]);
   return joint.in_space() ? two + ", " + message_text(all[2]) : two;
}

void warn_of_push(const JointCase &joint, const JointCase::Bolt &bolt, const Vector3d &along,
                  const std::array<Vector3d, 2> &ends)
{
   const Vector3d apart = ends[0] - ends[1];
   if (along.dot(apart) < -1e-6 * apart.norm())
   {
      const std::string &from = joint.bodies[bolt.ends[0].body].name,
                        &to = joint.bodies[bolt.ends[1].body].name;
      warn(bolt.source.called("direction") + " points from " + from + " to " + to +
           ", must point from " + to + " to " + from + ": the shank would push them apart");
   }
   const double off = along.cross(apart).norm();
   if (off > 0.05 * apart.norm())
   {
      warn(bolt.source.called("direction") + " is (" + components(joint, along) +
           "), and the middles of its ends lie at (" + components(joint, ends[0]) + ") and (" +
           components(joint, ends[1]) + "): its two forces pass each other at a distance of " +
           message_text(off) +
           " and turn the bodies. A shank must lie along its direction, from one middle to the "
           "other");
   }
}

} // namespace

Vector3d bolt_direction(const JointCase &joint, const JointCase::Bolt &bolt,
                        const std::array<Vector3d, 2> &ends)
{
   if (bolt.direction)
   {
      if (bolt.ends[1].body >= 0) { warn_of_push(joint, bolt, *bolt.direction, ends); }
      return *bolt.direction;
   }
   Vector3d apart = ends[0] - ends[1];
   const double size = std::max(ends[0].norm(), ends[1].norm());
   if (joint.formulation == Formulation::axisymmetric) { apart[0] = 0; }
   require(apart.norm() > 1e-9 * size, bolt.source.called("between"),
           ": the middles of both ends are at (", components(joint, ends[0]), ") and (",
           components(joint, ends[1]),
           "), so that no direction follows from them: the bolt must have the key 'direction', "
           "which points from the second end to the first");
   // Removes the round-off of the middles.
   for (double &x : apart) { x = settled(x, 1e4 * apart.norm()); }
   const Vector3d along = apart.normalized();
   const double leans =
      std::acos(std::min(1.0, along.cwiseAbs().maxCoeff())) * 180 / std::acos(-1.0);
   if (leans > 5)
   {
      warn("bolt '" + bolt.name + "' leans by " + text("%.3g", leans) +
           " degrees, because it lies along the line between the middles of its ends, at " +
           components(joint, ends[0]) + " and at " + components(joint, ends[1]) +
           ": if it should not, the parts must end elsewhere, or the key 'direction' must be "
           "there");
   }
   if (bolt.ends[1].body >= 0) { warn_of_push(joint, bolt, along, ends); }
   return along;
}

void add_bolts(Reduction &reduction, std::optional<BoltedJoint> &bolted, const JointCase &joint,
               const std::function<void(Reduction &)> &move_obstacles)
{
   std::vector<Bolt> tightened;
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      const Bolt one{bolt.name, bolt.stiffness / (bolt.force * bolt.force)};
      if (bolt.tightened) { tightened.push_back(one); }
      else { reduction.add_shank(one.load, one.stiffness); }
   }
   if (tightened.empty()) { move_obstacles(reduction); }
   else
   {
      bolted.emplace(reduction, std::move(tightened), move_obstacles);
      reduction = bolted->tightened();
   }
}

void warn_of_bolt_on_supports(const JointCase::Bolt &bolt)
{
   warn(bolt.source.called("between") + ": all nodes that bolt '" + bolt.name +
        "' pulls are held along it by supports, guides or prescribed displacements, so it does "
        "nothing");
}

} // namespace miniapp
