#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// x with the least |A x - b|, of several such the shortest one; one problem a column of b.
/// Compiled once, where Eigen's templates take long in every file.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd &A, const Eigen::MatrixXd &b);

} // namespace cattaneo
