#pragma once

#include <vector>

/// A part of a contact line, or a point of it (lo = hi), that needs nodes at a distance
/// `spacing`.
struct Focus
{
   double lo, hi, spacing;
};

/** Grid lines from `from` to `to` for elements of the given order. The distance of the nodes is
    the least that any focus asks for: its own spacing in it, and away from it `growth` (above
    1) as much from one node to the next. */
std::vector<double> focused_grid(double from, double to, int order, double growth,
                                 const std::vector<Focus> &foci);

/// Grid lines on both sides of 0, from the given ones on one side, which begin at 0. Symmetric
/// to the last bit.
std::vector<double> mirrored(const std::vector<double> &grid);
