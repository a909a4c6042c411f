#include <algorithm>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/input_error.hpp>
#include <limits>

namespace cattaneo
{

ContactLine straight_line(const std::vector<double> &grid, int order, Formulation formulation)
{
   require(order >= 1, "straight line: its order is ", order, ", must be at least 1");
   require(grid.size() >= 2, "straight line: it has ", grid.size(),
           " places, must have at least two");
   require(formulation != Formulation::space,
           "straight line: it is in space, must be plane, about an axis or of torsion");
   ContactLine line;
   line.formulation = formulation;
   LineChain chain;
   const Eigen::VectorXd points = lobatto_points(order);
   const auto add = [&](double x)
   {
      if (x == 0 && formulation != Formulation::plane) { return Eigen::Index(-1); }
      LineNode node;
      const auto i = static_cast<int>(line.size());
      node.dofs = {2 * i, formulation == Formulation::torsion ? -1 : 2 * i + 1};
      node.position = {x, 0};
      node.arc_length = x - grid.front();
      node.weight = 1; // not known
      node.spacing = std::numeric_limits<double>::infinity();
      line.nodes.push_back(node);
      return line.size() - 1;
   };
   for (std::size_t e = 0; e + 1 < grid.size(); ++e)
   {
      require(grid[e] < grid[e + 1], "straight line: its places ", grid[e], " and ",
              grid[e + 1], " follow each other, must increase");
      LineElement element;
      element.points = Eigen::Matrix2Xd::Zero(2, order + 1);
      for (int a = 0; a <= order; ++a)
      {
         const double t = points[a];
         const double x = a == order ? grid[e + 1] : (1 - t) * grid[e] + t * grid[e + 1];
         element.points(0, a) = x;
         element.nodes.push_back(a == 0 && e > 0 ? chain.elements.back().nodes.back() : add(x));
      }
      for (int a = 1; a <= order; ++a)
      {
         const double step = element.points(0, a) - element.points(0, a - 1);
         for (const Eigen::Index node : {element.nodes[a - 1], element.nodes[a]})
         {
            if (node < 0) { continue; } // on the axis
            line.nodes[node].spacing = std::min(line.nodes[node].spacing, step);
         }
      }
      chain.elements.push_back(element);
   }
   chain.nodes = line.size();
   line.chains = {chain};
   return line;
}

} // namespace cattaneo
