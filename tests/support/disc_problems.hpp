#pragma once

#include "random_problem.hpp"

namespace cattaneo_test
{

/// A random reduced problem with two tangential components per node and three load patterns:
/// "press" (mostly normal), "shear" (all) and "twist" (second component only).
cattaneo::ReducedProblem random_disc_problem(int n, double friction, double coupling,
                                             std::mt19937 &random);

/// A plane problem with a second tangential component that is coupled to nothing and not
/// loaded.
cattaneo::ReducedProblem as_disc(const cattaneo::ReducedProblem &plane);

} // namespace cattaneo_test
