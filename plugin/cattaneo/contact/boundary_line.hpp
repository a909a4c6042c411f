#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// Contact nodes of the boundary elements of a boundary part (an interval keeps the elements
/// that lie wholly inside it). InputError if there are none, or if a basis with weights of both
/// signs was used.
ContactLine contact_line(const ElasticBody &body, const BoundaryPart &part);

} // namespace cattaneo
