#include "common/contact_grid.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>

namespace miniapp
{

double element_growth(double chosen, int order)
{
   return chosen > 0 ? chosen : order == 1 ? 1.25 : 1.5;
}

void check_growth(double chosen)
{
   cattaneo::require(chosen == 0 || (chosen > 1 && chosen <= 2), "growth is ", chosen,
                     ", must be above 1 and at most 2, or 0 for the default");
}

double smallest_step(const std::vector<double> &grid)
{
   double smallest = grid[1] - grid[0];
   for (std::size_t k = 2; k < grid.size(); ++k)
   {
      smallest = std::min(smallest, grid[k] - grid[k - 1]);
   }
   return smallest;
}

double largest_step(const std::vector<double> &grid)
{
   double largest = grid[1] - grid[0];
   for (std::size_t k = 2; k < grid.size(); ++k)
   {
      largest = std::max(largest, grid[k] - grid[k - 1]);
   }
   return largest;
}

} // namespace miniapp
