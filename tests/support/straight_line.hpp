#pragma once

#include <vector>

namespace cattaneo_test
{

/// From `from` to `to` in elements that halve towards `to`, the last two of the same size.
std::vector<double> halving(double from, double to, int elements);

/// Halving towards both ends of -a < x < a.
std::vector<double> halving_both_ways(double a, int elements);

} // namespace cattaneo_test
