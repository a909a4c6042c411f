#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/** The place (x, y) at an arc length of a chain: on the straight line between the two nodes
    around it. On a closed chain, arc lengths beyond the ends lie between its last node and its
    first one. NaN where the problem has no places. */
Eigen::Vector2d place_along(const ReducedProblem &problem, const ContactChain &chain,
                            double at);

} // namespace cattaneo
