#pragma once

#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/condense/condensed_body.hpp>

namespace cattaneo
{

/** Condenses a body to the nodes of a contact line: one factorisation with the contact dofs
    last, and one solve for each load pattern. If `alike` was condensed from an equal operator
    (entries equal to 1e-12 of the largest, same supports, same contact dofs in the same order,
    as for the second of two equal bodies turned by 180° or shifted) its factor is used and
    nothing is factored.

    InputError before factoring: if the body is not valid (AssembledBody::validate), if a dof of
    the line has another component or another place than its node, or if a load displaces a
    contact dof. Also if supports and contact nodes together leave a rigid motion of the body,
    or of a part of it, free. InputError after factoring if the stiffness is not positive
    definite. Fixed contact dofs, on a plane of symmetry for instance, are not part of the
    condensed stiffness (CondensedBody::held). */
CondensedBody condense(const AssembledBody &body, const ContactLine &line,
                       const CondensedBody *alike = nullptr);
/// The same in space, to the nodes of a surface. InputError also if a support holds one or two
/// components of a node, at an angle to the surface that is more than 10 degrees away from both
/// 0 and 90.
CondensedBody condense(const AssembledBody &body, const ContactSurface &surface,
                       const CondensedBody *alike = nullptr);

} // namespace cattaneo
