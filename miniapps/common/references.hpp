#pragma once

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
   double spread, mesh;
};

/// The table at the end of a study: reference | its ± | mesh ± | thesis | computed |
/// difference.
class ReferenceTable
{
public:
   void add(const std::string &name, double reference, Allowed allowed, double computed,
            double thesis = std::numeric_limits<double>::quiet_NaN());
   /// A line below the table: why the thesis differs, for instance.
   void note(const std::string &text) { notes_.push_back(text); }
   bool has(const std::string &name) const;
   void print() const;
   nlohmann::ordered_json json() const;

private:
   struct Row
   {
      std::string name;
      double reference;
      Allowed allowed;
      double computed, thesis;
   };
   std::vector<Row> rows_;
   std::vector<std::string> notes_;
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
   /// Adds to the table the entries of a key whose conditions hold, with the error of the
   /// computed value's own read-out. What is found twice is compared once.
   void compare(const std::string &key, double computed, double error, const Meaning &meaning,
                ReferenceTable &table) const;
   /// Adds the notes whose conditions hold.
   void add_notes(const Meaning &meaning, ReferenceTable &table) const;

private:
   nlohmann::ordered_json entries_;
};

} // namespace miniapp
