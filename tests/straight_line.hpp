#pragma once

#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <cmath>
#include <vector>

namespace cattaneo_test
{

/// The trace of a body above y = 0 whose elements of one order end at the given places; from
/// x = 0 on in axisymmetry and torsion, where the node on the axis is left out.
inline cattaneo::ContactLine
straight_line(const std::vector<double> &grid, int order,
              cattaneo::Formulation formulation = cattaneo::Formulation::plane)
{
   using namespace cattaneo;
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
      node.weight = node.spacing = 1; // not asked for
      line.nodes.push_back(node);
      return line.size() - 1;
   };
   for (std::size_t e = 0; e + 1 < grid.size(); ++e)
   {
      LineElement element;
      element.points = Eigen::Matrix2Xd::Zero(2, order + 1);
      for (int a = 0; a <= order; ++a)
      {
         const double t = points[a];
         const double x = a == order ? grid[e + 1] : (1 - t) * grid[e] + t * grid[e + 1];
         element.points(0, a) = x;
         element.nodes.push_back(a == 0 && e > 0 ? chain.elements.back().nodes.back() : add(x));
      }
      chain.elements.push_back(element);
   }
   chain.nodes = line.size();
   line.chains = {chain};
   return line;
}

/// From `from` to `to` in elements that halve towards `to`, the last two of the same size.
inline std::vector<double> halving(double from, double to, int elements)
{
   std::vector<double> grid{from};
   for (int e = 1; e < elements; ++e) { grid.push_back(0.5 * (grid.back() + to)); }
   grid.push_back(to);
   return grid;
}

/// Halving towards both ends of -a < x < a.
inline std::vector<double> halving_both_ways(double a, int elements)
{
   std::vector<double> grid;
   for (double x : halving(0, a, elements)) { grid.insert(grid.begin(), -x); }
   for (double x : halving(0, a, elements))
   {
      if (x > 0) { grid.push_back(x); }
   }
   return grid;
}

} // namespace cattaneo_test
