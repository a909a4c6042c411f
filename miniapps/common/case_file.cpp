#include "common/case_file.hpp"

#include "common/table.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;
using json = nlohmann::ordered_json;

CaseFile read_case(const std::string &file, int newest)
{
   const std::string where = "case file '" + file + "'";
   json keys;
   try
   {
      const std::string text = cattaneo::read_whole(file, "case file: ");
      cattaneo::require_single_keys(where, text);
      keys = parsed(text);
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
