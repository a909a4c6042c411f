#pragma once

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/contact/boundary_surface.hpp>

namespace cattaneo
{

/// How a body is condensed.
struct CondenseSettings
{
   /// A body on an mfem::ParMesh with more dofs than this is condensed by conjugate gradients
   /// on all ranks. A smaller one is gathered and factored by the first rank. At the default a
   /// factor takes some 1.4 GB (docs/ranks.md).
   int direct_dofs = 500000;
   /// Most iterations of conjugate gradients for each right-hand side. InputError if more are
   /// needed.
   int max_iterations = 2000;

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/** condense() of an MFEM body. A distributed body is gathered on the first rank, or (see the
    settings) condensed by one iterative solve for each contact dof and load pattern; the
    counters tell which. Either way S and the loads have the same bits on all ranks, and so have
    errors. */
CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings = {},
                       const CondensedBody *alike = nullptr);
/// The same of a body in space, to the nodes of a surface.
CondensedBody condense(const ElasticBody &body, const ContactSurface &surface,
                       const CondensedBody *alike = nullptr);

} // namespace cattaneo
