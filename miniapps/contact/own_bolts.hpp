#pragma once

#include "contact/joint_case.hpp"

#include <array>
#include <cattaneo/joints/bolts.hpp>
#include <functional>
#include <optional>

namespace miniapp
{

/** The direction in which a bolt pulls its first end away from its second one, a unit vector:
    that of the case, or the line between the middles of both ends. About an axis it is along
    the axis, because the ends are rings. Middles in the plane have no third component.

    Warns if the line between the middles leans, if the bolt would push its ends apart, or if
   its two forces would turn the bodies. InputError if no direction follows. */
Eigen::Vector3d bolt_direction(const JointCase &joint, const JointCase::Bolt &bolt,
                               const std::array<Eigen::Vector3d, 2> &ends);

/** Adds the shanks of the bolts to a reduction, then the motions of its obstacles. Bolts that
   are tightened to a force become springs only after that: `bolted` is then set, and the
   reduction is that of the tightened joint. */
void add_bolts(cattaneo::Reduction &reduction, std::optional<cattaneo::BoltedJoint> &bolted,
               const JointCase &joint,
               const std::function<void(cattaneo::Reduction &)> &move_obstacles);

/// Warns of a bolt that pulls only nodes that are held along it.
void warn_of_bolt_on_supports(const JointCase::Bolt &bolt);

} // namespace miniapp
