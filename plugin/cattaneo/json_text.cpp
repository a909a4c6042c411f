#include <cattaneo/input_error.hpp>
#include <cattaneo/json_text.hpp>
#include <map>
#include <set>

namespace cattaneo
{

nlohmann::json parsed(const std::string &text, const std::string &what, bool comments)
{
   using nlohmann::json;
   std::map<int, std::set<std::string>> names; // so far, of the object at a depth
   const auto once = [&](int depth, json::parse_event_t event, const json &name)
   {
      if (event == json::parse_event_t::object_start) { names[depth + 1].clear(); }
      if (event == json::parse_event_t::key)
      {
         const auto key = name.get<std::string>();
         require(names[depth].insert(key).second, what, ": key '", key,
                 "' is there twice, must be there once");
      }
      return true;
   };
   return json::parse(text, once, true, comments);
}

} // namespace cattaneo
