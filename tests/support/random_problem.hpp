#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <random>

namespace cattaneo_test
{

/// A random reduced problem with a positive definite stiffness of moderate coupling and two
/// load patterns: "press" (mostly normal) and "shear" (both). Dense, without any geometry
/// behind it.
cattaneo::ReducedProblem random_problem(int n, double friction, double coupling,
                                        std::mt19937 &random);

} // namespace cattaneo_test
