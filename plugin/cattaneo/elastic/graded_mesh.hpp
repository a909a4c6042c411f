#pragma once

#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/// Coordinates from `from` to `to` in steps that start at `first` and grow by the factor
/// `growth`
/// (>= 1) until `largest`; the last steps are stretched to end exactly at `to`. `from` > `to`
/// is allowed; the result runs from `from` to `to`.
std::vector<double> graded(double from, double to, double first, double growth,
                           double largest = 1e300);

/// Coordinates of [-half, half] with n intervals, symmetric to the last bit, graded toward both
/// ends so that the end interval is `end_ratio` (0 < end_ratio <= 1) times the middle one.
std::vector<double> graded_to_ends(double half, int intervals, double end_ratio);

/// Joins coordinate lists that share end points.
std::vector<double> joined(const std::vector<std::vector<double>> &pieces);

/// Rectangle of quads with the given (strictly increasing) grid lines. Boundary attributes:
/// 1 bottom, 2 right, 3 top, 4 left.
mfem::Mesh rectangle_mesh(const std::vector<double> &x, const std::vector<double> &y);

} // namespace cattaneo
