#include "common/focused_grid.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

std::vector<double> focused_grid(double from, double to, int order, double growth,
                                 const std::vector<Focus> &foci)
{
   cattaneo::require(to > from && growth > 1 && !foci.empty(), "focused grid: from ", from,
                     " to ", to, " with growth ", growth, " and ", foci.size(),
                     " foci, must run upward, grow and have a focus");
   const auto size = [&](double x)
   {
      double least = std::numeric_limits<double>::infinity();
      for (const Focus &focus : foci)
      {
         const double away = std::max({focus.lo - x, x - focus.hi, 0.0});
         least = std::min(least, focus.spacing + (growth - 1) * away);
      }
      return order * least;
   };
   // Elements from the start up to a point, as if there were parts of elements.
   std::vector<double> x{from}, count{0.0};
   while (x.back() < to)
   {
      const double step = std::min(0.02 * size(x.back()), to - x.back());
      count.push_back(count.back() + step / size(x.back() + 0.5 * step));
      x.push_back(to - x.back() <= step ? to : x.back() + step);
   }
   const int elements = std::max(1, static_cast<int>(std::ceil(count.back() - 0.01)));
   std::vector<double> grid{from};
   std::size_t k = 1;
   for (int e = 1; e < elements; ++e)
   {
      const double wanted = count.back() * e / elements;
      while (count[k] < wanted) { ++k; }
      const double part = (wanted - count[k - 1]) / (count[k] - count[k - 1]);
      grid.push_back(x[k - 1] + part * (x[k] - x[k - 1]));
   }
   grid.push_back(to);
   return grid;
}

std::vector<double> mirrored(const std::vector<double> &grid)
{
   std::vector<double> both;
   for (auto x = grid.rbegin(); x != grid.rend(); ++x) { both.push_back(-*x); }
   both.back() = 0;
   both.insert(both.end(), grid.begin() + 1, grid.end());
   return both;
}
