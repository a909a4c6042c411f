#pragma once

#include "words.hpp"
#include <cattaneo/readout/contact_edges.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

// Code shared by all functions that read out zones and edges of contact.

namespace cattaneo::python
{

/// The body that a word names.
inline CrackedBody cracked_body(const std::string &cracked)
{
   return chosen<CrackedBody>(cracked, "cracked");
}

/// A zone with its interface and places.
struct NamedZone
{
   Zone zone;
   std::optional<NodeState> state; ///< none: in contact, sticking or slipping
   std::string interface;
   /// Places of its ends; NaN if they are not known.
   Eigen::Vector2d from = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()),
                   to = from;

   bool none() const { return zone.last < zone.first; }
   /// ", (x, y) to (x, y)", or nothing.
   std::string places() const;
};

/// Zones with their interfaces and places. `contact`: they are zones of nodes in contact,
/// sticking and slipping alike.
std::vector<NamedZone> named_zones(const ReducedProblem &problem,
                                   const std::vector<Zone> &zones, bool contact);

} // namespace cattaneo::python
