#pragma once

#include <cattaneo/mesh/gmsh_file.hpp>

namespace cattaneo
{

/** Cuts the mesh along the lines of a physical group: elements on both sides of it have nodes
   of their own there, but for an end of the line that is inside of the body (a crack tip).
   Lines of the group remain those of the side on their left, as they run; on their right new
   lines, of group `right`, lie on the nodes of their own.

    InputError if the group has no lines, one of them is on the outer boundary, or a part of it
    runs against the next one, so that left and right are not told apart. */
void split_line(GmshMesh &mesh, long group, long right, const std::string &name);

} // namespace cattaneo
