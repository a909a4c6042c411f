#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// Lagrange's polynomials through the Gauss–Lobatto points of an order on [0, 1]: the functions
/// of an element of a contact line (LineElement).
struct LobattoBasis
{
   static constexpr Eigen::Index highest_order = 8;
   Eigen::VectorXd nodes;
   Eigen::VectorXd scale;  ///< 1 / Π (node_i - node_j)
   Eigen::MatrixXd slopes; ///< of polynomial j at node i

   explicit LobattoBasis(int order);
   void evaluate(double t, Eigen::Ref<Eigen::VectorXd> values) const;
   /// Values of all polynomials (columns) at each parameter t (rows).
   Eigen::MatrixXd values(const Eigen::VectorXd &t) const;
};

/// The basis of an order from 1 to 8.
const LobattoBasis &lobatto_basis(Eigen::Index order);

} // namespace cattaneo
