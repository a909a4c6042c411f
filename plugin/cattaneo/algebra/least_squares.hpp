#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// x with the least |A x - b|; if there are several, the shortest one. Each column of b is a
/// problem of its own. Compiled here once, because Eigen's templates take long to compile.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd &A, const Eigen::MatrixXd &b);

} // namespace cattaneo
