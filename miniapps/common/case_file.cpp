#include "common/case_file.hpp"

#include "common/table.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;
using json = nlohmann::ordered_json;

namespace
{

/// The library's sentence as "line 3, column 12: unexpected '}', must be …".
std::string where_broken(std::string said)
{
   for (const char *begin : {"] ", "parse error at "})
   {
      const std::size_t at = said.find(begin);
      if (at != std::string::npos) { said.erase(0, at + std::string(begin).size()); }
   }
   const std::size_t inner = said.find(": syntax error while parsing "),
                     dash = said.find(" - ", std::min(inner, said.size()));
   if (dash == std::string::npos) { return said; }
   said.replace(inner, dash + 3 - inner, ": ");
   const std::size_t expected = said.find("; expected ");
   if (expected == std::string::npos)
   {
      return said + (said.rfind("line 1, column 1: invalid", 0) == 0
                        ? ", a case must begin with { (// and /* */ begin comments)"
                        : "");
   }
   std::string must = said.substr(expected + std::string("; expected ").size());
   said.erase(expected);
   // The last line of the text before it is enough.
   const std::size_t read = said.find("; last read: '");
   if (read != std::string::npos)
   {
      const std::size_t from = read + std::string("; last read: '").size(),
                        line = said.rfind("<U+000A>"),
                        text = said.find_first_not_of(' ', line + 8);
      if (line != std::string::npos && line > from && text != std::string::npos)
      {
         said.erase(from, text - from);
      }
   }
   const std::size_t comma = said.find("unexpected '}'");
   if (must == "string literal")
   {
      must = "a name in double quotes";
      if (comma != std::string::npos) { must += ", or no comma before it"; }
   }
   return said + ", must be " + must;
}

} // namespace

json read_case(const std::string &file, int version)
{
   const std::string where = "case file '" + file + "'";
   json keys;
   try
   {
      const std::string text = cattaneo::read_whole(file, "case file: ");
      require(text.find_first_not_of(" \t\r\n") != std::string::npos, where, " is empty");
      cattaneo::require_single_keys(where, text);
      keys = parsed(text, true);
   }
   catch (const json::exception &error)
   {
      throw InputError(where + " is not JSON: " + where_broken(error.what()));
   }
   require(keys.is_object(), where, " holds a JSON ", keys.type_name(), ", must be an object");
   const json said = keys.value("version", json());
   const std::string shown = said.is_structured() ? said.type_name() : said.dump();
   const int must = std::max(version, 1);
   // A file without bodies counts as version 1, which did not have to name its version.
   require(version < 2 || (said != 1 && (!said.is_null() || keys.contains("bodies"))), where,
           " is of version 1, which is no longer read, key 'version' must be ", must,
           ": docs/contact.md says under 'Case files of version 1' how to write it anew");
   require(version < 2 || !said.is_null(), where, ": key 'version' is missing, must be ", must);
   require(said.is_null() || said == must, where, ": key 'version' is ", shown, ", must be ",
           must);
   for (const char *key : {"version", "$schema"}) { keys.erase(key); }
   return keys;
}

} // namespace miniapp
