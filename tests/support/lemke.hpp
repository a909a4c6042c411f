#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace cattaneo_test
{

struct LemkeReport
{
   bool solved = false; ///< false: ray termination or too many pivots
   long pivots = 0;
   Eigen::VectorXd z;
};

/** Linear complementarity problem  s = M z + b,  s >= 0, z >= 0, sᵀz = 0  by Lemke's method
    with a dense tableau and the lexicographic rule (no cycling). The path starts at z = 0 with
    the right-hand side b + z0·cover, z0 large; for matrices that are not copositive another
    cover (positive entries) may reach a solution where one ends in a ray. */
LemkeReport lemke(const Eigen::MatrixXd &M, const Eigen::VectorXd &b,
                  const Eigen::VectorXd &cover, long max_pivots);

/// The state in which the linear equations of given node states hold, refined once; open nodes
/// bear exactly nothing.
cattaneo::ContactState state_of(const cattaneo::ReducedProblem &problem,
                                const cattaneo::ContactState &before,
                                const Eigen::VectorXd &multipliers,
                                const std::vector<cattaneo::NodeState> &states);

/** An oracle for increments of one tangential component a node with friction: the
    complementarity problem in the gap and the slip forward and backward of every node, by
    Lemke's method. It shares nothing with the library's methods but the laws, and proves
    nothing where it ends in a ray. */
std::optional<cattaneo::ContactState> solve_by_lemke(const cattaneo::ReducedProblem &problem,
                                                     const cattaneo::ContactState &before,
                                                     const Eigen::VectorXd &multipliers);

} // namespace cattaneo_test
