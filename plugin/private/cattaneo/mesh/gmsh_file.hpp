#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace cattaneo
{

/// A mesh as text of Gmsh's format 2.2.
class GmshText
{
public:
   /// InputError for a number that is there already.
   void add_node(long number, const std::array<double, 3> &x);
   /// Of the nodes before, by Gmsh's number of its type; one of 8 nodes (16) is given its
   /// middle one, which is where its own geometry has it. Points are left out.
   void add_element(long number, long type, const std::vector<long> &tags,
                    std::vector<long> nodes);
   std::string text() const;

private:
   std::map<long, std::array<double, 3>> nodes_;
   std::string elements_;
   long count_ = 0;
};

/** A mesh that Gmsh wrote in format 4.1 or 2.2, ASCII or binary, as text of format 2.2, with
    points left out and quadrilaterals of 8 nodes (serendipity) given their middle node, which
    is where their own geometry has it. `size` of the file bounds what can be in it. InputError,
    with the section, if the file is cut short or is of another version. */
std::string as_gmsh_22(const std::string &file, long size);

/// True if read as it stands such a file would be refused: format 4.1, binary, or
/// quadrilaterals of 8 nodes.
bool needs_gmsh_22(const std::string &file);

} // namespace cattaneo
