#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

namespace cattaneo
{

/** Edges that belong to one element only, each in the direction with the body on the left,
    whatever the sense of its element. NodalStiffness::edges needs these. An element is its
    corners, three or four, in their order around it; of order 2 the middles of its sides
    follow, first that between the first two corners (6 or 8 nodes), and then a node inside that
    it may have (7 or 9), as ABAQUS, Gmsh and VTK number them.

    InputError, with the number of the element in the list or of `numbers`, for another number
    of nodes, a node without a place, one that is not between the corners it should be between,
    or two elements on the same side of an edge. */
std::vector<NodalStiffness::Nodes>
outer_edges(const std::vector<NodalStiffness::Nodes> &elements,
            const NodalStiffness::Places &places, const std::vector<int> &numbers = {});

/** Faces that belong to one element only, with their nodes in order around each.
    NodalStiffness::faces needs these. Elements by their corners: 4 nodes a tetrahedron, 5 a
    pyramid (the apex last), 6 a wedge (one triangle, then the other), 8 a hexahedron (one side,
    then the other), as ABAQUS, Gmsh and VTK number them.

    InputError, with the number of the element in the list, for another number of nodes. */
std::vector<NodalStiffness::Nodes>
outer_faces(const std::vector<NodalStiffness::Nodes> &elements);

} // namespace cattaneo
