#pragma once

#include <Eigen/Dense>

namespace miniapp
{

/// Eigenvalues λ of the Williams corner, a block (90°) stuck on a half-plane (180°) of the same
/// material, and the ratios of shear to normal traction on the interface, modes I and II:
/// tractions are sums of x^(λ-1), x the distance from the corner. The first ratio is the
/// friction below which the corner itself slips.
extern const double williams_eigenvalue[2], williams_ratio[2];

/** Strengths of the two singular terms of tractions (one per column) at distances x from the
    corner, by least squares together with the first bounded term (a pair of complex
    eigenvalues), relative to the first mode. NaN for fewer than eight points. */
Eigen::MatrixXd williams_strengths(const Eigen::VectorXd &x, const Eigen::MatrixXd &tractions);

} // namespace miniapp
