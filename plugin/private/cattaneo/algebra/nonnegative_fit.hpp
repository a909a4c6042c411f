#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

struct NonnegativeFit
{
   Eigen::VectorXd x, residual; ///< g - G x
};

/// min |G x - g| over x >= 0 (Lawson and Hanson's active set; G has few rows).
NonnegativeFit fit_nonnegative(const Eigen::MatrixXd &G, const Eigen::VectorXd &g);

} // namespace cattaneo
