#pragma once

#include <vector>

namespace miniapp
{

/// Growth of the elements away from a contact: the chosen value, or for 0 the largest one
/// without loss of accuracy (docs/benchmarks.md): 1.5, and 1.25 for bilinear elements.
double element_growth(double chosen, int order);
/// InputError unless it is 0 or above 1 and at most 2.
void check_growth(double chosen);

double smallest_step(const std::vector<double> &grid);
double largest_step(const std::vector<double> &grid);

} // namespace miniapp
