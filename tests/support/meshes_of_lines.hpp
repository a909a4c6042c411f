#pragma once

#include <mfem.hpp>

/// Meshes whose boundary is numbered or bent in unusual ways.
namespace cattaneo_test
{

/// Vertices, elements and boundary elements in random order, boundary elements oriented at
/// random.
mfem::Mesh scrambled(const mfem::Mesh &plain, int seed);

/// Part of a ring between radii 1 and 2, `from` one angle `to` a smaller one; attributes 1
/// inner arc, 2 its end, 3 outer arc, 4 its beginning.
mfem::Mesh ring_sector(int order, int elements, double from, double to);

} // namespace cattaneo_test
