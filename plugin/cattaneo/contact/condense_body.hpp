#pragma once

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/contact/boundary_line.hpp>

namespace cattaneo
{

struct CondenseSettings
{
   SparseFactor::Backend backend = SparseFactor::Backend::automatic;
   /// Of a body on an mfem::ParMesh: with more dofs than this it is condensed by conjugate
   /// gradients on all of them, below it is gathered and factored by the first. At the default
   /// a factor takes some 1.4 GB (docs/ranks.md).
   int direct_dofs = 500000;
   /// apply_reduction() forms S nevertheless for up to this many contact nodes: it costs the
   /// time of a few increments without it, but 40 × (2n)² bytes a rank (docs/ranks.md).
   int formed_nodes = 5000;
   /// Of conjugate gradients, for each right-hand side; an InputError beyond.
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

/// contact_dofs() of an MFEM body, global numbers, and which are held. InputError, on all
/// ranks, if one is displaced by a load pattern.
ContactDofs contact_dofs(const ElasticBody &body, const ContactLine &line);

/// Free motions of a body on several ranks, taken for connected, from what holds it: the places
/// of the supports and of the contact nodes. The errors of find_free_motions().
FreeMotions free_motions_by_places(const ElasticBody &body, const ContactLine &line);

} // namespace cattaneo
