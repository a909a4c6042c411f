#pragma once

#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/** Condenses a body to the nodes of a contact line: one factorisation, contact dofs last, one
    solve a load pattern. If `alike` was condensed from an equal operator (entries equal to
    1e-12 of the largest, same supports, same contact dofs in the same order, as for the second
    of two equal bodies turned by 180° or shifted) its factor is used and nothing is factored.

    InputError, before factoring, if the body is not sound (AssembledBody::validate), if a
    dof of the line is not of its component or not at its node's place, if the supports and the
    contact nodes together leave a rigid motion of the body (or of a part that is connected to
    nothing) free, or if a contact dof is displaced by a load; afterwards if the stiffness is
    not positive definite. Contact dofs that are fixed, on a plane of symmetry for instance, are
    no part of the trace (CondensedBody::held). */
CondensedBody condense(const AssembledBody &body, const ContactLine &line,
                       const CondensedBody *alike = nullptr);

} // namespace cattaneo
