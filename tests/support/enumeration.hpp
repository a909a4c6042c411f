#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <vector>

namespace cattaneo_test
{

/// A solution of an increment: states whose linear equations meet all inequalities.
struct EnumeratedSolution
{
   std::vector<cattaneo::NodeState> states;
   Eigen::VectorXd u; ///< {v; w}
   /// Smallest margin of its inequalities, over the largest force: negative at round-off only.
   double margin = 0;
};

/** All solutions of one increment from slip `v_old`, by trying the 4^n states of n nodes with
    one tangential component. Shares nothing with the library. States whose equations are
    singular (to 1e-9) are passed over: solutions that are not isolated are not found. */
std::vector<EnumeratedSolution> enumerate_solutions(const cattaneo::ReducedProblem &problem,
                                                    const Eigen::VectorXd &v_old,
                                                    const Eigen::VectorXd &multipliers,
                                                    double slack = 1e-10);

} // namespace cattaneo_test
