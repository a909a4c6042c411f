#pragma once

#include "common/units.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <functional>
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
   /// The fields of a state on all nodes, as JSON.
   using Fields = std::function<nlohmann::ordered_json(const cattaneo::ContactState &)>;
   /// For contact on surfaces, which have no zones: the interfaces as maps, and the fields of
   /// their nodes in place of the tractions along lines.
   void show_maps(const nlohmann::ordered_json &interfaces, Fields fields);
   /// To be called with every accepted increment of that problem.
   void add(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state,
            const cattaneo::IncrementRecord &record);
   bool empty() const { return frames_.empty(); }
   nlohmann::ordered_json json() const;

private:
   struct Frame
   {
      std::size_t row;               ///< of the history
      Eigen::VectorXd p, q;          ///< tractions along lines
      nlohmann::ordered_json others; ///< zones of lines, or the fields of maps
      nlohmann::ordered_json json() const;
   };
   nlohmann::ordered_json head_;
   std::vector<nlohmann::ordered_json> history_;
   std::vector<Frame> frames_;
   Frame last_; ///< even if it is not among the kept ones
   std::size_t most_, stride_ = 1;
   Fields fields_; ///< of maps
};

/// Zones as they are drawn. A zone of a single node has no length, and gets one to be visible.
std::vector<cattaneo::Zone> drawn_zones(const cattaneo::ReducedProblem &problem,
                                        const cattaneo::ContactState &state);

} // namespace miniapp
