#pragma once

#include <cattaneo/mesh/gmsh_file.hpp>

namespace cattaneo
{

/** Cuts the mesh along the lines of a physical group: elements on both sides of it then have
    different nodes there, except at an end of the line inside the body (a crack tip). Lines of
    the group keep the nodes of the side on their left. New lines, of group `right`, have the
    nodes of the side on their right.

    InputError if the group has no lines, one of them is on the outer boundary, or a part of it
    runs against the next one, so that left and right are not defined. */
void split_line(GmshMesh &mesh, long group, long right, const std::string &name);

} // namespace cattaneo
