#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// ∫₀¹ f(t) dt = Σ weights_k f(points_k).
struct QuadratureRule
{
   Eigen::VectorXd points, weights;
};

/// Gauss–Legendre, of 1 to 64 points: exact for polynomials of degree 2 points - 1.
const QuadratureRule &gauss_rule(int points);

/** Rule for f(t) = a(t) + b(t) ln t with a and b analytic around [0, 1], for instance
    polynomials of degree up to 20. Exact to round-off. It is Gauss's rule in the sixth root of
    t. */
const QuadratureRule &logarithmic_rule();

/// The Gauss–Lobatto points of an order on [0, 1]: the ends, and order - 1 between them.
Eigen::VectorXd lobatto_points(int order);

} // namespace cattaneo
