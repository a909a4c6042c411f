#pragma once

#include <string>

namespace cattaneo
{

/** A mesh that Gmsh wrote in format 4.1 or 2.2, ASCII or binary, as text of format 2.2, with
    points left out and quadrilaterals of 8 nodes (serendipity) given their middle node, which
   is where their own geometry has it. `size` of the file bounds what can be in it. InputError,
    with the section, if the file is cut short or is of another version. */
std::string as_gmsh_22(const std::string &file, long size);

/// True if read as it stands such a file would be refused: format 4.1, binary, or
/// quadrilaterals of 8 nodes.
bool needs_gmsh_22(const std::string &file);

} // namespace cattaneo
