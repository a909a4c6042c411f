#pragma once

#include <Eigen/Dense>
#include <optional>

namespace cattaneo
{

struct NonnegativeFit
{
   Eigen::VectorXd x, residual; ///< g - G x
};

/// min |G x - g| over x >= 0 (Lawson and Hanson's active set; G has few rows).
NonnegativeFit fit_nonnegative(const Eigen::MatrixXd &G, const Eigen::VectorXd &g);

/// The x of least |x| with G x >= h (G has few columns), by Lawson and Hanson's least distance
/// programming. Empty if no x is found.
std::optional<Eigen::VectorXd> least_distance(const Eigen::MatrixXd &G,
                                              const Eigen::VectorXd &h);

} // namespace cattaneo
