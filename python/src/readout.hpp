#pragma once

#include "words.hpp"
#include <cattaneo/readout/contact_edges.hpp>

// What functions share that read out edges of contact.

namespace cattaneo::python
{

/// The body by its word.
inline CrackedBody cracked_body(const std::string &cracked)
{
   return chosen<CrackedBody>(cracked, "cracked");
}

} // namespace cattaneo::python
