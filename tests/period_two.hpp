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
inline cattaneo::ReducedProblem period_two(double stored = 0)
{
   using namespace cattaneo;
   const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
   const double soft = std::ldexp(1.0, -30);
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Vector3d(1, 1, soft).asDiagonal(),
                         Eigen::Matrix3d{{0, 2, 0}, {-2, 0, 0}, {0, 0, 0}},
                         8 * Eigen::Matrix3d::Identity());
   problem.patterns = {{"P", Control::force, std::sqrt(2 * soft * stored) * zero.Unit(2),
                        Eigen::Vector3d(2, 2, 8)},
                       {"Q0", Control::force, zero.Unit(0), zero},
                       {"Q1", Control::force, zero.Unit(1), zero}};
   problem.H = Eigen::Matrix3d::Zero();
   problem.chains = one_chain(3);
   problem.gap = zero;
   set_friction(problem, 0.5);
   return problem;
}

/// The loads of a cycle, one column each.
inline Eigen::MatrixXd loads_of_period_two()
{
   Eigen::MatrixXd loads(3, 4);
   loads << 1, 1, 1, 1, -1.5, 1, 0, 0, 0, 0, -1.5, 1;
   return loads;
}

/// Loss of a cycle that begins with v1 = x: |x - (½ - x)| f p0 of node 0 and so on, each node
/// against the pressure that it has while it slips.
inline double loss_of_period_two(double x)
{
   return 2 - x - 4 * x * x;
}

} // namespace cattaneo_test
