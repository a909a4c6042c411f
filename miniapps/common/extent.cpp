#include "common/extent.hpp"

namespace miniapp
{

using namespace cattaneo;

Extent extent(const ReducedProblem &problem, const ContactState &state, bool sticks_first,
              double shift)
{
   Extent result;
   result.zones = zones(problem, state);
   for (Zone &zone : result.zones)
   {
      zone.from.position += shift;
      zone.to.position += shift;
   }
   const std::size_t count = result.zones.size(), open = sticks_first ? count - 1 : 0,
                     held = count - 1 - open;
   // The border that faces the other end.
   const auto inner = [&](std::size_t k) -> const ZoneBorder &
   { return k == 0 ? result.zones[k].to : result.zones[k].from; };
   if (!closed(result.zones[open].state))
   {
      result.separation = inner(open).position;
      result.separation_error = inner(open).error;
   }
   if (result.zones[held].state == NodeState::stick && count > 1)
   {
      result.stick = inner(held).position;
      result.stick_error = inner(held).error;
      // Slip within the last spacing before the end of contact does not show.
      const Eigen::Index last =
         sticks_first ? result.zones[held].last + 1 : result.zones[held].first;
      if (!slips(result.zones[sticks_first ? 1 : count - 2].state))
      {
         result.stick_error = problem.arc_length[last] - problem.arc_length[last - 1];
      }
   }
   return result;
}

void add_borders(const std::vector<Zone> &zones, std::vector<nlohmann::ordered_json> &row,
                 std::vector<std::pair<std::string, double>> &errors)
{
   for (std::size_t k = 0; k < 4; ++k)
   {
      const bool there = k < zones.size();
      row.push_back(there ? zones[k].to.position : none);
      errors.emplace_back(text("border_%zu", k + 1), there ? zones[k].to.error : none);
   }
}

} // namespace miniapp
