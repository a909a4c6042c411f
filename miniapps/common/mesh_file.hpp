#pragma once

#include <mfem.hpp>
#include <string>

namespace miniapp
{

/** The plane mesh in a user's file: MFEM's format ("MFEM mesh v1.…", conforming), or Gmsh's 2.2
    in ASCII, of triangles and quadrilaterals.

    MFEM's reader trusts its file: a node number that is out of range reads foreign memory. The
    file is therefore checked first, section by section. InputError saying what is wrong. */
mfem::Mesh read_mesh(const std::string &file);

/// A warning if the mesh is bent more than elements of this order can be: such a body resists
/// turning. Measured on a ring whose edges span 10 degrees each: by 1e-2 of the forces of a
/// shear as large as the turn with order 1, by 2e-4 with order 2; of 20 degrees, 2e-2 and 1e-3.
void warn_of_lower_order(mfem::Mesh &mesh, int order, const std::string &file);

} // namespace miniapp
