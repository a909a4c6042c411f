#pragma once

#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

#ifdef MFEM_USE_MPI

/// What condense_by_factor() finds, of a body on several ranks by conjugate gradients; `alike`
/// is what an equal body was condensed by, or null. InputError as there, on all ranks.
Condensation condense_by_iterations(const ElasticBody &body, const ContactLine &line,
                                    const ContactDofs &dofs, int max_iterations,
                                    const BodySolver *alike);

#endif

} // namespace cattaneo
