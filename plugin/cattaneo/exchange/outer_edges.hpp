#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <functional>

namespace cattaneo
{

/** Edges that belong to one element only, each in the direction with the body on the left,
    whatever the sense of its element. NodalStiffness::edges needs these. An element is given by
    its corners, three or four, in their order around it; of order 2 the middles of its sides
    follow, first that between the first two corners (6 or 8 nodes), and then a node inside that
    it may have (7 or 9), as ABAQUS, Gmsh and VTK number them.

    InputError, with the number of the element in the list or of `numbers`, for another number
    of nodes, a node without a place, one that is not between the corners it should be between,
    or two elements on the same side of an edge. */
std::vector<NodalStiffness::Nodes>
outer_edges(const std::vector<NodalStiffness::Nodes> &elements,
            const NodalStiffness::Places &places, const std::vector<int> &numbers = {});

/** Faces that belong to one element only, with their nodes in order around each.
    NodalStiffness::faces needs these. Elements begin with their corners: 4 of a tetrahedron, 5
   of a pyramid (the apex last), 6 of a wedge (one triangle, then the other), 8 of a hexahedron
   (one side, then the other), as ABAQUS, CalculiX, Gmsh and VTK number them. Of order 2 the
   middles of edges follow, and then those of faces and of the element that it may have (10, 13
   or 14, 15 or 18, 20 or 27 nodes). Programs number these differently: each is the one that
   lies nearest to its place between the corners.

    @param place  of a node; needed only for elements of order 2
    InputError, with the number of the element in the list or of `numbers`, for another number
    of nodes, or a middle that is nearer to the place of another one. */
std::vector<NodalStiffness::Nodes>
outer_faces(const std::vector<NodalStiffness::Nodes> &elements,
            const std::function<Eigen::Vector3d(int)> &place = {},
            const std::vector<int> &numbers = {});

/// The corners of the faces of an element of outer_faces(), in the order in which ABAQUS and
/// CalculiX number faces; none for another number of nodes.
std::vector<NodalStiffness::Nodes> faces_of(const NodalStiffness::Nodes &element);

} // namespace cattaneo
