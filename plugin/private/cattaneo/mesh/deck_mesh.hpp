#pragma once

#include <cattaneo/mesh/gmsh_file.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <string>

namespace cattaneo
{

/// A mesh of a deck, and the names in it.
struct DeckMesh
{
   GmshMesh mesh;
   MeshNames names;
};

/// True for files that end with .inp.
bool is_deck(const std::string &file);

/** The plane mesh in an .inp of CalculiX or ABAQUS, of CPS, CPE or CAX elements of 3, 4, 6 or 8
    nodes. Parts of the boundary are its surfaces, sets of nodes that are whole edges, and sets
    of trusses along the boundary, as programs write named lines. Attribute k is the k-th *SOLID
    SECTION of the body; all are 1 if there is none. In space (MeshPart::dimension) it has C3D
    elements of 4, 6, 8, 10, 15 and 20 nodes, and parts of the boundary are faces. InputError,
   with file and line, for other elements, and as read_input_deck(). */
DeckMesh deck_mesh(const std::string &file, const MeshPart &part = {});

} // namespace cattaneo
