#pragma once

#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/elastic/body.hpp>
#include <vector>

namespace cattaneo
{

/** The consistent mass matrix of a body on its true dofs, by mfem::VectorMassIntegrator: in the
    plane per unit of thickness, about an axis of the whole circumference (2πr).
    @param density mass per volume, > 0: one, or one for each element attribute
    InputError for another number of densities, one that is not positive and finite, a body that
    twists, or one on several ranks. */
SharedMatrix mass_matrix(const ElasticBody &body, const std::vector<double> &density);

} // namespace cattaneo
