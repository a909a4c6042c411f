#include <algorithm>
#include <cattaneo/exchange/off_plane.hpp>
#include <cmath>

namespace cattaneo
{

std::optional<std::size_t> first_off_plane(const std::vector<Eigen::Vector3d> &places)
{
   if (places.empty()) { return std::nullopt; }
   Eigen::Vector3d low = places[0], high = places[0];
   for (const Eigen::Vector3d &place : places)
   {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
   }
   const double level = places[0][2],
                allowed = 1e-9 * std::max(high[0] - low[0], high[1] - low[1]) +
                          1e-12 * std::abs(level);
   for (std::size_t k = 0; k < places.size(); ++k)
   {
      if (std::abs(places[k][2] - level) > allowed) { return k; }
   }
   return std::nullopt;
}

} // namespace cattaneo
