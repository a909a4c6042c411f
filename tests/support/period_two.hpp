#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo_test
{

/** Two nodes of unit stiffness, f = ½, each of which slips in its own direction only and
    presses the other: f p0 = 1 + v1, f p1 = 1 - v0 under "P". Sheared to and fro one after the
    other, first by -1.5 and then by 1, node 0 comes to v0 = v1, and after it node 1 to v1 =
    -v0: each cycle turns the sign of v1, whatever its size up to a quarter. Of period two.

    A third node, soft, is pressed and sheared by "P" and sticks: it stores the energy
    `stored`. */
cattaneo::ReducedProblem period_two(double stored = 0);

/// The loads of a cycle, one column each.
Eigen::MatrixXd loads_of_period_two();

/// Loss of a cycle that begins with v1 = x: |x - (½ - x)| f p0 of node 0 and so on, each node
/// against the pressure that it has while it slips.
double loss_of_period_two(double x);

} // namespace cattaneo_test
