#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/** The place (x, y) at an arc length of a chain: on the straight way between the two nodes
   around it. Of a closed chain, arc lengths beyond its ends are on the way from its last node
   to its first one. NaN where the problem has no places. */
Eigen::Vector2d place_along(const ReducedProblem &problem, const ContactChain &chain,
                            double at);

} // namespace cattaneo
