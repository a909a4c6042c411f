#include "common/case_file.hpp"

#include <cattaneo/input_error.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;
using json = nlohmann::ordered_json;

CaseFile read_case(const std::string &file, int newest)
{
   const std::string where = "case file '" + file + "'";
   std::ifstream in(file);
   require(in.good() && !std::filesystem::is_directory(file), where, " cannot be read");
   json keys;
   std::map<int, std::set<std::string>> names; ///< so far, of the object at a depth
   // Of a key that is there twice the parser itself keeps the last without a word.
   const auto once = [&](int depth, json::parse_event_t event, const json &name)
   {
      if (event == json::parse_event_t::object_start) { names[depth + 1].clear(); }
      if (event == json::parse_event_t::key)
      {
         const auto key = name.get<std::string>();
         require(names[depth].insert(key).second, where, ": key '", key,
                 "' is there twice, must be there once");
      }
      return true;
   };
   try
   {
      keys = json::parse(in, once);
   }
   catch (const json::exception &error)
   {
      throw InputError(where + " is not JSON: " + error.what());
   }
   require(keys.is_object(), where, " holds a JSON ", keys.type_name(), ", must be an object");
   const json version = keys.value("version", json(1));
   const std::string shown = version.is_structured() ? version.type_name() : version.dump();
   require(version == 1 || (newest > 1 && version == newest), where, ": key 'version' is ",
           shown, ", must be 1",
           newest > 1 ? " or " + std::to_string(newest)
                      : ", the only version that this program knows");
   for (const char *key : {"version", "$schema"}) { keys.erase(key); }
   return {keys, version.get<int>()};
}

} // namespace miniapp
