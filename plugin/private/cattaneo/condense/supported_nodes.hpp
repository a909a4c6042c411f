#pragma once

#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/// The components of each node of a line that supports hold; 0: x or r, 1: y or z.
using HeldComponents = Eigen::Array<bool, Eigen::Dynamic, 2>;

/** Frames and ends of a line by what supports hold of its nodes.

    A node keeps the line's own tangent, unless that lies along the axes to round-off (1e-9): it
    is turned onto them then.

    An open chain that ends at a node which one support holds along it ends at a plane of
    symmetry if it meets that plane at 90 degrees to LineChain::symmetry_turn. So it does if it
    is a curve there that meets its mirror image without a corner: the smooth curve that its
    last element is a chord of (LineElement::bend), the circle through the last three nodes, or
    that through the ends of the last two elements (chords of a curve) meets the plane at 90
    degrees, to a quarter of what that curve turns between the end and the middle of the first
    chord. There the frame is turned onto the axes, as the mean with that of the mirror image
    is. LineChain::off_symmetry says by how much that curve, or a line that is straight, is off.
    About an axis a node that is held in r is on no plane of symmetry, and nowhere is a node
   in whose plane a load moves anything (`moved`, of what is held).

    InputError if one component of a node is held and the line meets it at neither 0 nor 90
    degrees, to LineChain::smooth_turn, unless it curves into a plane of symmetry there (the
    first chord of a circle of 8 edges leans by 22.5 degrees). */
void meet_supports(ContactLine &line, const HeldComponents &held, const HeldComponents &moved);

/// The same of a line whose nodes are some of those that the body was condensed to.
void meet_supports(ContactLine &line, const CondensedBody &body);

} // namespace cattaneo
