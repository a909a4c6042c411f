#include "straight_line.hpp"

namespace cattaneo_test
{

std::vector<double> halving(double from, double to, int elements)
{
   std::vector<double> grid{from};
   for (int e = 1; e < elements; ++e) { grid.push_back(0.5 * (grid.back() + to)); }
   grid.push_back(to);
   return grid;
}

std::vector<double> halving_both_ways(double a, int elements)
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
