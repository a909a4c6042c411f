#pragma once

#include <cattaneo/condense/contact_surface.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/// Contact nodes of the boundary elements of a boundary part of a body in space, and the faces
/// between them. InputError if there are none, if the body is in a plane, if an interval cuts a
/// face, or for faces that surface_of() does not take.
ContactSurface contact_surface(const ElasticBody &body, const BoundaryPart &part);

} // namespace cattaneo
