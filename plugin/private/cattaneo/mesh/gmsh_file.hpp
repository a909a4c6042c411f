#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace cattaneo
{

/// A type of element of Gmsh.
struct GmshType
{
   int nodes;
   std::size_t corners;           ///< the first of its nodes; 0: no element of a plane body
   int order;                     ///< of a solid 0 unless bodies in space may have it
   std::size_t solid_corners = 0; ///< the first nodes of a solid
};
/// Points, lines, triangles, quadrilaterals (some without inner nodes) and solids, by Gmsh's
/// numbers.
const std::map<long, GmshType> &gmsh_types();

/// A mesh in Gmsh's form.
struct GmshMesh
{
   struct Element
   {
      long number, type;
      std::vector<long> tags; ///< the physical group (0: none), then the curve or surface
      std::vector<long> nodes;
   };
   std::map<long, std::array<double, 3>> nodes;
   std::vector<Element> elements;

   /// InputError for a number that exists already, or a place that is not finite.
   void add_node(long number, const std::array<double, 3> &x);
   /// Adds an element of nodes that were added before (InputError). A quadrilateral of 8 nodes
   /// (16) gets a middle node, at the place that its geometry gives. Points are left out.
   void add_element(long number, long type, std::vector<long> tags, std::vector<long> own);
   /// In Gmsh's format 2.2.
   std::string text() const;
};

/** A mesh that Gmsh wrote in format 4.1 or 2.2, ASCII or binary. `size` of the file in bytes is
    an upper limit of the counts in it. InputError, with the section, if the file is cut short,
    is of another version or has numbers of more than 32 bits. */
GmshMesh read_gmsh(const std::string &file, long size);

} // namespace cattaneo
