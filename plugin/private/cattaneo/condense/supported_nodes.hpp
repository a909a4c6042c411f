#pragma once

#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/// The components of each node of a line that supports hold; 0: x or r, 1: y or z.
using HeldComponents = Eigen::Array<bool, Eigen::Dynamic, 2>;

/** Sets frames and ends of a line from the supports of its nodes.

    A node keeps the line's own tangent. A tangent that is along an axis within round-off (1e-9)
    is turned onto the axis.

    An open chain that ends at a node which one support holds along it ends at a plane of
    symmetry if it meets that plane at 90 degrees to LineChain::symmetry_turn. It also does if
    the line is a curve there that meets its mirror image without a corner: the smooth curve
    that its last element is a chord of (LineElement::bend), the circle through the last three
    nodes, or that through the ends of the last two elements (chords of a curve) meets the plane
    at 90 degrees, to a quarter of what that curve turns between the end and the middle of the
    first chord. There the frame is turned onto the axes; it is then the mean of itself and its
    mirror image. LineChain::off_symmetry is the angle by which that curve, or a straight line,
    misses 90 degrees. Two kinds of nodes are on no plane of symmetry: a node that is held in r
    about an axis, and a node in whose plane a load moves a held dof (`moved`).

    InputError if one component of a node is held and the angle of the line to it differs from 0
    and 90 degrees by more than LineChain::smooth_turn, unless the line curves into a plane of
    symmetry there (the first chord of a circle of 8 edges leans by 22.5 degrees). */
void meet_supports(ContactLine &line, const HeldComponents &held, const HeldComponents &moved);

/// The same for a line with some of the nodes to which the body was condensed.
void meet_supports(ContactLine &line, const CondensedBody &body);

/// Turns the frames of a surface whose nodes are some of those that the body was condensed to,
/// so that the held axes are among their axes. InputError as for condense().
void meet_supports(ContactSurface &surface, const CondensedBody &body);

/// The frame of a node in space with the held axes among its axes; `where` names the node in
/// messages.
Eigen::Matrix3d on_supports(const Eigen::Matrix3d &frame, const std::array<bool, 3> &held,
                            const std::string &where);

/// The frame with the mean normal of two nodes that face each other. Its first tangent is that
/// of the first node, or of the second one (`by_other`), turned to be perpendicular to the
/// normal.
Eigen::Matrix3d frame_between(const Eigen::Matrix3d &one, const Eigen::Matrix3d &other,
                              bool by_other);

} // namespace cattaneo
