#include "common/references.hpp"

#include "common/miniapp.hpp"
#include "common/shipped.hpp"
#include "common/table.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;
using nlohmann::ordered_json;

std::string Reference::verdict() const
{
   if (!differs_by_more_than(allowed.spread)) { return ""; }
   if (!outside()) { return "within the mesh's ±"; }
   return differs_by_more_than(allowed.all()) ? "outside" : "outside, within the mesh's ±";
}

namespace
{

/// "<= 0.05", "> 1": of a number.
bool compares(const ordered_json &found, const std::string &condition)
{
   std::istringstream words(condition);
   std::string sign;
   double bound = 0;
   if (!(words >> sign >> bound) || !found.is_number()) { return false; }
   const double x = found.get<double>();
   return sign == "<="   ? x <= bound
          : sign == ">=" ? x >= bound
          : sign == "<"  ? x < bound
                         : x > bound;
}

bool holds(const ordered_json &found, const ordered_json &condition)
{
   if (condition.is_array())
   {
      return std::any_of(condition.begin(), condition.end(),
                         [&](const ordered_json &one) { return holds(found, one); });
   }
   if (condition.is_string() && condition.get<std::string>().find_first_of("<>") == 0)
   {
      return compares(found, condition.get<std::string>());
   }
   if (condition == "*") { return !found.empty() && found != ""; }
   // A level that was reached in steps is so but for round-off.
   if (found.is_number() && condition.is_number())
   {
      return std::abs(found.get<double>() - condition.get<double>()) < 1e-9;
   }
   return found == condition;
}

/// An entry has a key, several of them, or none if it is a note.
bool is_of(const ordered_json &entry, const std::string &key)
{
   return entry.contains("key") && holds(key, entry["key"]);
}

bool all_hold(const ordered_json &entry, const Meaning &meaning)
{
   if (!entry.contains("when")) { return true; }
   for (const auto &[name, condition] : entry["when"].items())
   {
      if (!holds(meaning(name), condition)) { return false; }
   }
   return true;
}

/// A number, "name", "number * name" or "number / name", or a sum of such in an array.
double mesh_share(const ordered_json &term, const Meaning &meaning)
{
   if (term.is_number()) { return term.get<double>(); }
   if (term.is_array())
   {
      double sum = 0;
      for (const ordered_json &one : term) { sum += mesh_share(one, meaning); }
      return sum;
   }
   std::istringstream words(term.get<std::string>());
   double factor = 1;
   std::string sign = "*", name;
   if (std::isdigit(words.peek())) { words >> factor >> sign; }
   words >> name;
   const ordered_json found = meaning(name);
   require(found.is_number(), "references.json: the mesh share '", term.get<std::string>(),
           "' is not the name of a number of this run");
   return sign == "*" ? factor * found.get<double>() : factor / found.get<double>();
}

} // namespace

References::References(const std::string &study) : entries_(ordered_json::array())
{
   const std::string file = shipped("miniapps/data/references.json");
   if (!std::ifstream(file).good())
   {
      warn("no result is compared with references, because file '" + file + "' cannot be read");
      return;
   }
   try
   {
      const ordered_json data = parsed(cattaneo::read_whole(file));
      for (const ordered_json &entry : data.at("references"))
      {
         if (entry.at("study") == study) { entries_.push_back(entry); }
      }
   }
   catch (const nlohmann::json::exception &error)
   {
      throw InputError("file '" + file + "': " + error.what());
   }
}

bool References::has(const std::string &key) const
{
   return std::any_of(entries_.begin(), entries_.end(),
                      [&](const ordered_json &entry) { return is_of(entry, key); });
}

void References::compare(const std::string &key, double computed, double error,
                         const Meaning &meaning, std::vector<Reference> &found) const
{
   for (const ordered_json &entry : entries_)
   {
      const auto same = [&](const Reference &one) { return one.name == entry.at("name"); };
      if (!is_of(entry, key) || std::any_of(found.begin(), found.end(), same) ||
          !all_hold(entry, meaning))
      {
         continue;
      }
      const double mesh = mesh_share(entry.value("mesh", ordered_json(0.0)), meaning);
      const double none = std::numeric_limits<double>::quiet_NaN();
      found.push_back({entry.at("name"),
                       entry.value("value", none),
                       {entry.value("spread", none), mesh + (std::isfinite(error) ? error : 0)},
                       computed,
                       entry.value("thesis", none)});
   }
}

std::vector<std::string> References::notes(const Meaning &meaning) const
{
   std::vector<std::string> notes;
   for (const ordered_json &entry : entries_)
   {
      if (entry.contains("note") && all_hold(entry, meaning))
      {
         notes.push_back(entry["note"]);
      }
   }
   return notes;
}

} // namespace miniapp
