#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>

/// Reduced problems whose answers are known by hand.
namespace cattaneo_test
{

/// One block on a spring: slip and dissipation of a cycle are known in closed form.
cattaneo::ReducedProblem one_block(double f);

/** Four nodes on springs of their own, 2 along and 4 across the contact, f = 1/2. P presses
    three with 1 and lifts the last by 0.4/4; Q shears. Under both, limits being 1/2: the first
    sticks with q = 0.1; -0.5 = 2 v - 0.8 slips forward, 0.5 = 2 v + 0.7 backward; the last
    moves freely, 0 = 2 v + 0.3. */
cattaneo::ReducedProblem four_springs();

/// Pressed by 1, the first load, then sheared to `amplitude` and minus that in each cycle.
cattaneo::LoadHistory press_then_shear(double amplitude, int cycles);

} // namespace cattaneo_test
