#pragma once

#include <map>
#include <mfem.hpp>
#include <set>
#include <string>
#include <vector>

namespace cattaneo
{

/// The part of a mesh file that is read.
struct MeshPart
{
   /// A part of a deck: an instance, or a set of elements. Empty: the deck has one body, or
   /// `usual` names it.
   std::string name;
   /// The name of the instance that is used if `name` is empty and there are several.
   std::string usual = {};
   /// The name of a line within the body (a physical curve of Gmsh) along which the mesh is
   /// cut: elements on its two sides get separate nodes there, except at ends within the body,
   /// which are tips of the crack. The two lips are boundaries "NAME+", on the left of the line
   /// as it runs, and "NAME-". Empty: none.
   std::string split = {};
   /// 2: a plane mesh, 3: one of solids.
   int dimension = 2;
};

/** The mesh in a user's file, of triangles and quadrilaterals in the plane: MFEM's format
   ("MFEM mesh v1.…", conforming), Gmsh's 4.1 or 2.2, ASCII or binary, or an .inp of CalculiX or
   ABAQUS. In space (MeshPart::dimension) of hexahedra, tetrahedra and wedges, from Gmsh and
   decks of orders 1 and 2.

    MFEM's reader trusts its file: a node number that is out of range reads foreign memory. The
    file is therefore checked first, section by section. InputError names the fault.

    @param curves if not null, gets the curve of the file (Gmsh's entity) of each boundary
    element, -1 if it is not known; for curve_sides()
    @param part InputError if it names a body and the file is no deck, or a line to split and
   the file is not Gmsh's */
mfem::Mesh read_mesh(const std::string &file, std::vector<int> *curves = nullptr,
                     const MeshPart &part = {});

/// Data of a mesh file besides the mesh.
struct MeshNames
{
   /// Boundary attributes by the names of groups ($PhysicalNames of Gmsh; spaces as
   /// underscores), surfaces and sets of a deck (in capitals; several if they overlap, none if
   /// a set is no part of the boundary).
   std::map<std::string, std::vector<int>> boundary;
   std::map<std::string, int> elements; ///< attributes by the names of groups
   bool numbered = true;                ///< false: boundary attributes are this program's own
   bool axisymmetric = false;           ///< elements of a deck
   /// Cards of a deck that are not read: "*BOUNDARY, *CLOAD, *STEP".
   std::string passed_over;
   /// Elastic constants of a material of a deck, both 0 if it is not isotropic, or changes with
   /// temperature.
   struct DeckMaterial
   {
      std::string name;   ///< in capitals
      double young = 0;   ///< Young's modulus, in the deck's units
      double poisson = 0; ///< Poisson's ratio
   };
   std::vector<DeckMaterial> materials;  ///< of a deck's sections: attributes 1, 2, …
   std::set<std::string> plane_elements; ///< CPS, CPE: of a deck's sections
};
/// Names and other data of a mesh file that read_mesh() takes, for the same part of it.
MeshNames mesh_names(const std::string &file, const MeshPart &part = {});

/// A sentence if vertices coincide, within a thousandth of their shortest edge: the body is cut
/// there, and its faces may pass through each other. Otherwise empty. `name` is the name of the
/// mesh in the sentence. Boundary attributes `meeting` are left out, because contact keeps
/// their faces apart.
std::string unjoined_vertices(const mfem::Mesh &mesh, const std::string &name,
                              const std::vector<int> &meeting = {});

/// A sentence if the mesh is more curved than elements of this order can be: such a body
/// falsely resists rotation. The false forces, over those of a shear as large as the turn, were
/// measured on a ring: with edges of 10 degrees 1e-2 (order 1) and 2e-4 (order 2), with edges
/// of 20 degrees 2e-2 and 1e-3.
std::string missed_curves(mfem::Mesh &mesh, int order, const std::string &name);

} // namespace cattaneo
