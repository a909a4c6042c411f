#pragma once

#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// Places of the true dofs of this rank.
DofPlaces places_of(const ElasticBody &body);

/// The whole MFEM body on the first of its ranks, in the order of its global dofs. The result
/// on other ranks has no meaning.
AssembledBody assembled(const ElasticBody &body);

} // namespace cattaneo
