#pragma once

#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/** Two bodies in space whose contact nodes match, condensed together in relative coordinates.
    Displacements of the first body's contact nodes are those of the second body's nodes plus
    the relative displacements, u₁ = u₂ + r. All but r is eliminated by one factor. Only 3n rows
    are kept, and no second dense matrix.

    The result represents the joint as one body on a rigid obstacle: reduce(joint, gap), with
    the gap of the pairing, is the problem that reduce(body1, body2, pairing) has. Its surface
    is that of the first body, with frames between those of both and mean weights. Forces are on
    the first body. Loads are joined by name. recover() gives the rows of the first body, then
    those of the second.

    @param partner  of each node of `surface1`: the node of `surface2` that faces it
                    (Pairing::partner)
    InputError as of condense(); if supports do not hold the second body, or hold a contact node
    of the first one where they do not hold its partner; if a load moves a contact node of the
    first body; if a load has forces on one body and displacements on the other; for surfaces
    whose nodes or edges of order 2 do not match, and for bodies with blocks. */
CondensedBody condense_joint(const AssembledBody &body1, const ContactSurface &surface1,
                             const AssembledBody &body2, const ContactSurface &surface2,
                             const std::vector<int> &partner);

} // namespace cattaneo
