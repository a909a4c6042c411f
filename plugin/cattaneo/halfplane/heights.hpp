#pragma once

#include <Eigen/Dense>
#include <string>

namespace cattaneo
{

/// Heights of a surface on a regular grid, as instruments measure them. Between the points they
/// are linear along x and y. The middle of the grid is x = y = 0.
struct Heights
{
   Eigen::Vector2d step{1, 1}; ///< from one point to the next along x and y, > 0
   /// Each column is a line along x, the first one with the least y. NaN: not measured.
   Eigen::MatrixXd z;

   /// Heights at points (m × 2) within the grid. InputError for a point outside, or one beside
   /// points that were not measured.
   Eigen::VectorXd at(const Eigen::MatrixX2d &points) const;
};

/// Reads a text file of surface data, SDF of ISO 25178-71 ("aISO-1.0", or the older
/// "aBCR-1.0"). The file has lengths and heights in metres. `unit` is the unit of the result in
/// metres, 1e-3 for mm. InputError if the file cannot be read or is no such file.
Heights read_heights(const std::string &file, double unit = 1);

} // namespace cattaneo
