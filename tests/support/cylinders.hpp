#pragma once

#include <mfem.hpp>
#include <string>

namespace cattaneo_test
{

/// The kinds of its elements.
constexpr const char *kinds[] = {"quads", "triangles", "curved"};

/// [0, 2] × [0, 1] with its left side on the axis (attribute 4), distorted inside.
mfem::Mesh cylinder(const std::string &kind, double inner = 0.0, int nr = 4, int nz = 3);

} // namespace cattaneo_test
