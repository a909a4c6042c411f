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

} // namespace miniapp
