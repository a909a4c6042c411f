#pragma once

#include <cattaneo/halfplane/half_plane.hpp>
#include <vector>

/// Half-planes and lines on them.
namespace cattaneo_test
{

/// Of all half-planes here.
const double depth = 20;

cattaneo::HalfPlane half_plane(double young, double poisson,
                               cattaneo::PlaneState state = cattaneo::PlaneState::strain);

/// Equal elements.
std::vector<double> even(double from, double to, int elements);

/// Elements of unequal lengths, and of a line of which the first node is on the axis.
inline const std::vector<double> uneven{0, 0.3, 0.35, 1.1, 2};

/// E'/4G of plane strain: what a force moves the surface less than the logarithm says, against
/// what is below it.
double below(double poisson);

} // namespace cattaneo_test
