#pragma once

#include <vector>

namespace miniapp
{

/// A stretch of a contact line, or a point of it (lo = hi), that asks for nodes `spacing`
/// apart.
struct Focus
{
   double lo, hi, spacing;
};

/** Grid lines from `from` to `to` for elements of the given order. The distance of the nodes is
    the least that any focus asks for: its own spacing in it, and away from it `growth` (above
   1) as much from one node to the next. */
std::vector<double> focused_grid(double from, double to, int order, double growth,
                                 const std::vector<Focus> &foci);

/// Of grid lines from 0 on, those of both sides of 0, symmetric to the last bit.
std::vector<double> mirrored(const std::vector<double> &grid);

/// Growth of the elements away from a contact: the one chosen or, if that is 0, the largest
/// that does not cost accuracy (docs/benchmarks.md): 1.5, and 1.25 for bilinear elements.
double element_growth(double chosen, int order);
/// InputError unless it is 0 or above 1 and at most 2.
void check_growth(double chosen);

double smallest_step(const std::vector<double> &grid);
double largest_step(const std::vector<double> &grid);

} // namespace miniapp
