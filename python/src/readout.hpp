#pragma once

#include "arguments.hpp"
#include <cattaneo/readout/contact_edges.hpp>

// What functions share that read out edges of contact.

namespace cattaneo::python
{

CATTANEO_ARGUMENT(Window, "None | tuple[float, float]");

CrackedBody cracked_body(nb::handle word);
/// window: None or two distances from the edge.
FitSettings fit_settings(nb::handle window, nb::handle skip);

} // namespace cattaneo::python
