#pragma once

#include <Eigen/Core>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <optional>

namespace cattaneo
{

/** Where bodies that nothing holds and that touch nothing come to rest as soon as the given
    clamped forces {q; p} begin to push them: the relative displacement {v; w}. As rigid bodies
    and without friction, which there is none of before anything presses, they go on until their
    contacts bear these forces; of several such places to the nearest one,

        min |c - t d|,  W c + g >= 0,

    with d the forces along the free motions c, W the normal rows of these and t large: for all
    t from some one on that is the nearest solution of the linear programme max dᵀc (Mangasarian
    1979). Motions that a touching node would see are left to friction. None if nothing is
    pushed, or if no contact stops it. */
std::optional<Eigen::VectorXd> taken_up_clearance(const ReducedProblem &problem,
                                                  const Eigen::VectorXd &clamped_forces);

} // namespace cattaneo
