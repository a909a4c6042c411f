#pragma once

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>

namespace cattaneo_test
{

/// A true square punch, |x| < 1, 0 < y < 2, of quadratic elements graded to its corners, on a
/// rigid plane or on a similar half-plane (cut off at 1000): patterns "P" and "Q" of resultant
/// 1, Q with the pressure that balances its moment. E' = 1.
cattaneo::ReducedProblem punch_problem(int nodes, bool half_plane);

} // namespace cattaneo_test
