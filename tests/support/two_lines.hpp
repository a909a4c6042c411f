#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <vector>

namespace cattaneo_test
{

/// A problem twice, side by side: both are loaded alike and know nothing of each other. Where
/// the arc length of the second begins is arbitrary.
cattaneo::ReducedProblem twice(const cattaneo::ReducedProblem &one);

} // namespace cattaneo_test
