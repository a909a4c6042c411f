#pragma once

#include "common/run.hpp"

#include <string>
#include <utility>
#include <vector>

namespace miniapp
{

/// Of a contact that sticks at one end of its line and is open at the other: where it separates
/// and where stick ends, NaN where there is none.
struct Extent
{
   double separation = none, stick = none, separation_error = 0, stick_error = 0;
   std::vector<cattaneo::Zone> zones; ///< shifted as the two are

   /// The errors and the zones.
   nlohmann::ordered_json json() const
   {
      return {{"separation_error", separation_error},
              {"stick_error", stick_error},
              {"zones", to_json(zones)}};
   }
   std::vector<std::pair<std::string, double>> errors() const
   {
      return {{"separation", separation_error}, {"stick", stick_error}};
   }
};

/// @param sticks_first it sticks at the first node, else at the last one
/// @param shift added to arc lengths
Extent extent(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state,
              bool sticks_first, double shift);

/// Columns border_1 … border_4 of a table: where the first zones end, with their errors.
void add_borders(const std::vector<cattaneo::Zone> &zones,
                 std::vector<nlohmann::ordered_json> &row,
                 std::vector<std::pair<std::string, double>> &errors);

} // namespace miniapp
