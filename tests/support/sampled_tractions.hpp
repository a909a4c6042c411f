#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo_test
{

/// Tractions at nodes.
struct Sampled
{
   cattaneo::ReducedProblem problem;
   cattaneo::ContactState state;
};

/// Tractions of Hertz and Cattaneo–Mindlin on n nodes of [-1.5, 1.5]: a = 1, stick in |x| < c.
Sampled cattaneo_mindlin(int n, double c, double shift);

} // namespace cattaneo_test
