#include "line_along.hpp"

namespace cattaneo_test
{

cattaneo::ContactLine line_along(const Curve &curve, const std::vector<double> &grid, int order,
                                 cattaneo::Formulation formulation, int first_dof)
{
   using namespace cattaneo;
   using Eigen::Vector2d;
   const LobattoBasis &basis = lobatto_basis(order);
   ContactLine line;
   line.formulation = formulation;
   LineChain chain;
   double length = 0;
   const auto add = [&](const Vector2d &x)
   {
      if (formulation != Formulation::plane && std::abs(x[0]) < 1e-14)
      {
         return Eigen::Index(-1);
      }
      LineNode node;
      const auto i = static_cast<int>(line.size());
      node.dofs = {first_dof + 2 * i, first_dof + 2 * i + 1};
      node.position = x;
      node.tangent.setZero();
      node.spacing = std::numeric_limits<double>::infinity();
      line.nodes.push_back(node);
      return line.size() - 1;
   };
   for (std::size_t e = 0; e + 1 < grid.size(); ++e)
   {
      LineElement element;
      element.points.resize(2, order + 1);
      for (int a = 0; a <= order; ++a)
      {
         const double t = basis.nodes[a];
         element.points.col(a) = curve(a == 0       ? grid[e]
                                       : a == order ? grid[e + 1]
                                                    : (1 - t) * grid[e] + t * grid[e + 1]);
         element.nodes.push_back(a == 0 && e > 0 ? chain.elements.back().nodes.back()
                                                 : add(element.points.col(a)));
      }
      const QuadratureRule &rule = gauss_rule(20);
      for (int k = 0; k < 20; ++k)
      {
         Eigen::VectorXd phi(order + 1);
         basis.evaluate(rule.points[k], phi);
         const Vector2d along = element.points * (basis.slopes.transpose() * phi);
         const double ds = rule.weights[k] * along.norm();
         for (int a = 0; a <= order; ++a)
         {
            if (element.nodes[a] < 0) { continue; }
            LineNode &node = line.nodes[element.nodes[a]];
            node.weight += ds * phi[a] * measure(formulation, (element.points * phi)[0]);
         }
      }
      for (int a = 0; a <= order; ++a)
      {
         const double before =
            a ? (element.points.col(a) - element.points.col(a - 1)).norm() : 0;
         length += before;
         if (element.nodes[a] < 0) { continue; }
         LineNode &node = line.nodes[element.nodes[a]];
         // Weights of both elements are as their lengths.
         const Vector2d slope = element.points * basis.slopes.row(a).transpose();
         node.tangent +=
            (element.points.col(order) - element.points.col(0)).norm() * slope.normalized();
         node.arc_length = length;
         for (double step :
              {before,
               a < order ? (element.points.col(a + 1) - element.points.col(a)).norm() : 0.0})
         {
            if (step > 0) { node.spacing = std::min(node.spacing, step); }
         }
      }
      chain.elements.push_back(element);
   }
   for (LineNode &node : line.nodes) { node.tangent.normalize(); }
   chain.nodes = line.size();
   line.chains = {chain};
   return line;
}

Curve straight(const Eigen::Vector2d &from, const Eigen::Vector2d &to)
{
   return [=](double t) -> Eigen::Vector2d { return (1 - t) * from + t * to; };
}

Curve circle(const Eigen::Vector2d &centre, double radius, bool clockwise)
{
   return [=](double t) -> Eigen::Vector2d
   {
      const double angle = clockwise ? -t : t;
      return centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
   };
}

std::vector<double> uniform_grid(double from, double to, int elements)
{
   std::vector<double> grid;
   for (int e = 0; e <= elements; ++e)
   {
      grid.push_back(e == elements ? to : from + (to - from) * e / elements);
   }
   return grid;
}

} // namespace cattaneo_test
