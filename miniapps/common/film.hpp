#pragma once

#include "common/units.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/** The increments of a march, for the slider of the page (--html): all loads with their
    conjugates, and the tractions and zones of as many increments as a page can hold. */
class Film
{
public:
   Film(const std::string &name, const cattaneo::ReducedProblem &problem, const Units &units);
   /// To be called with every accepted increment of that problem.
   void add(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state,
            const cattaneo::IncrementRecord &record);
   bool empty() const { return frames_.empty(); }
   nlohmann::ordered_json json() const;

private:
   nlohmann::ordered_json head_;
   std::vector<nlohmann::ordered_json> history_, frames_;
   nlohmann::ordered_json last_; ///< frame, even if it is not among the kept ones
   std::size_t most_, stride_ = 1;
};

/// Zones as they are drawn. A zone of a single node has no length, and gets one to be visible.
std::vector<cattaneo::Zone> drawn_zones(const cattaneo::ReducedProblem &problem,
                                        const cattaneo::ContactState &state);

} // namespace miniapp
