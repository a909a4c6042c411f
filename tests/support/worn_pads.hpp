#pragma once

#include "worn_problems.hpp"

#include <cattaneo/wear/wear_march.hpp>
#include <string>
#include <vector>

/// Pads that wear, and marches with jumps beside all cycles marched.
namespace cattaneo_test
{

struct Pad
{
   cattaneo::ReducedProblem problem;
   cattaneo::LoadHistory history;
};

/// Grid of |x| < span, finer toward ±c.
std::vector<double> grid_about(double c, double span, int inner, int outer);

/// A parabola on a half-plane, a = P = R = 1, f = 1/2, Q between ±shear f P. `unit` of length.
Pad hertz_pad(const std::vector<double> &grid, double shear, double unit = 1);

Pad small_pad(double unit = 1);

cattaneo::MarchSettings one_increment();

cattaneo::WearSettings settings_with(double tolerance);

/** n nodes on springs of their own, kt along and kn across, beneath a rigid block that moves up
    and down, held by P = n, and is moved by d along: gaps decide who carries how much. */
Pad springs(const Eigen::VectorXd &gap, double kt, double kn, double friction,
            double amplitude);

/// What jumps come to beside all cycles marched with the same increments.
struct Jumped
{
   int jumped = 0, all = 0, not_reached = 0;
   long rows = 0, rows_missed = 0;
};

/// Depths on a way with jumps, and at its end, beside those of all cycles marched with the same
/// increments: within what records and the report say, and at the end within the tolerance.
void compare(const WornProblem &of, const std::string &named, Jumped &count);

/// Number of random cases: `many` in `./test --all`, else `few`.
int rounds(int few, int many);

} // namespace cattaneo_test
