#pragma once

#include <Eigen/Dense>
#include <string>

namespace cattaneo
{

/// Heights of a surface on a regular grid, as instruments measure them. Linear between the
/// points along x and y; the middle of the grid is x = y = 0.
struct Heights
{
   Eigen::Vector2d step{1, 1}; ///< from one point to the next along x and y, > 0
   /// One column a line along x, the first with the least y. NaN: not measured.
   Eigen::MatrixXd z;

   /// At points (m × 2) within the grid. InputError for another point, or one beside points
   /// that were not measured.
   Eigen::VectorXd at(const Eigen::MatrixX2d &points) const;
};

/// Reads a text file of surface data, SDF of ISO 25178-71 ("aISO-1.0", or the older
/// "aBCR-1.0"). Lengths and heights are stored in metres; `unit` is the unit that they are
/// wanted in, 1e-3 for mm. InputError if the file cannot be read or is none.
Heights read_heights(const std::string &file, double unit = 1);

} // namespace cattaneo
