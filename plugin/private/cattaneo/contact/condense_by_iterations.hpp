#pragma once

#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

#ifdef MFEM_USE_MPI

/// The result of condense_by_factor() for a body on several ranks, by conjugate gradients.
/// `alike` is the solver of an equal body, or null. InputError as there, on all ranks.
Condensation condense_by_iterations(const ElasticBody &body, const ContactLine &line,
                                    const ContactDofs &dofs, int max_iterations,
                                    const BodySolver *alike);

#endif

} // namespace cattaneo
