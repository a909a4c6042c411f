#pragma once

#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// Places of the true dofs of this rank.
DofPlaces places_of(const ElasticBody &body);

/// All of an MFEM body on the first of its ranks, in the order of its global dofs; nothing of
/// use on the others.
AssembledBody assembled(const ElasticBody &body);

} // namespace cattaneo
