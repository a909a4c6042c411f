#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/// The functions of a face at 0 <= s, t <= 1 (of a triangle s + t <= 1), and in columns 1 and 2
/// their derivatives.
using FaceFunctions = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 16, 3>;

/// Those of a face with so many nodes, in the order of ContactSurface::faces.
FaceFunctions face_functions(std::size_t nodes, double s, double t);

/// How many of its nodes are corners.
std::size_t corners_of(std::size_t nodes);

} // namespace cattaneo
