#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/** How far a computed value may be from its reference, in the units of the value: the spread of
    the reference itself, and the share of the mesh and of the increments, where that can be
    said. Whatever is outside of the first is marked, whether or not the second explains it. */
struct Allowed
{
   Allowed(double spread_, double mesh_ = 0) : spread(spread_), mesh(mesh_) {}
   double own() const { return spread == 0 ? mesh : spread; }
   double all() const { return spread + mesh; }
   double spread, mesh;
};

/// One that was found, or a closed form, beside what was computed.
struct Reference
{
   std::string name;
   double value; ///< NaN: only the thesis has one
   Allowed allowed;
   double computed, thesis = std::numeric_limits<double>::quiet_NaN();

   double difference() const { return computed - value; }
   /// Is the computed value outside of the reference's ±? A closed form has none, so its limit
   /// is the ± of the mesh. NaN is outside. A value that only the thesis has never is.
   bool outside() const { return differs_by_more_than(allowed.own()); }
   /// In words, and whether the mesh explains what is outside.
   std::string verdict() const;

private:
   bool differs_by_more_than(double least) const
   {
      return !std::isnan(value) && !(std::abs(difference()) <= least);
   }
};

/// What a name of a condition or of a mesh share stands for in a run; null for nothing.
using Meaning = std::function<nlohmann::ordered_json(const std::string &)>;

/** The reference values of one study, from miniapps/data/references.json, whose head says how
    an entry is written. */
class References
{
public:
   explicit References(const std::string &study);

   bool has(const std::string &key) const;
   /// Adds the entries of a key whose conditions hold, with the error of the computed value's
   /// own read-out. What is found twice is compared once.
   void compare(const std::string &key, double computed, double error, const Meaning &meaning,
                std::vector<Reference> &found) const;
   /// Those whose conditions hold: why the thesis differs, for instance.
   std::vector<std::string> notes(const Meaning &meaning) const;

private:
   nlohmann::ordered_json entries_;
};

} // namespace miniapp
