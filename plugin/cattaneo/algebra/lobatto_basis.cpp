#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <vector>

namespace cattaneo
{

using Eigen::Index;

LobattoBasis::LobattoBasis(int order)
   : nodes(lobatto_points(order)), scale(order + 1), slopes(order + 1, order + 1)
{
   for (Index i = 0; i <= order; ++i)
   {
      double product = 1;
      for (Index j = 0; j <= order; ++j)
      {
         if (j != i) { product *= nodes[i] - nodes[j]; }
      }
      scale[i] = 1 / product;
   }
   for (Index i = 0; i <= order; ++i)
   {
      slopes(i, i) = 0;
      for (Index j = 0; j <= order; ++j)
      {
         if (j == i) { continue; }
         slopes(i, j) = scale[j] / (scale[i] * (nodes[i] - nodes[j]));
         slopes(i, i) += 1 / (nodes[i] - nodes[j]);
      }
   }
}

Eigen::MatrixXd LobattoBasis::values(const Eigen::VectorXd &t) const
{
   Eigen::MatrixXd all = scale.transpose().replicate(t.size(), 1);
   for (Index i = 0; i < nodes.size(); ++i)
   {
      for (Index j = 0; j < nodes.size(); ++j)
      {
         if (j != i) { all.col(i).array() *= t.array() - nodes[j]; }
      }
   }
   return all;
}

void LobattoBasis::evaluate(double t, Eigen::Ref<Eigen::VectorXd> values) const
{
   values = this->values(Eigen::VectorXd::Constant(1, t)).transpose();
}

const LobattoBasis &lobatto_basis(Index order)
{
   static const std::vector<LobattoBasis> all = []
   {
      std::vector<LobattoBasis> made;
      for (int k = 1; k <= LobattoBasis::highest_order; ++k) { made.emplace_back(k); }
      return made;
   }();
   return all[order - 1];
}

} // namespace cattaneo
