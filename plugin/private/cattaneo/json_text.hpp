#pragma once

#include <cattaneo/input_error.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace cattaneo
{

/// JSON of a text, in which each object has each of its keys once: of two the library would
/// keep the last without a word. Json is a type of that library. InputError, which begins with
/// `what`, for a key that is there twice; the library's own error for what is not JSON.
template <typename Json>
Json parsed(const std::string &text, const std::string &what)
{
   std::map<int, std::set<std::string>> names; // so far, of the object at a depth
   const auto once = [&](int depth, typename Json::parse_event_t event, const Json &name)
   {
      using Event = typename Json::parse_event_t;
      if (event == Event::object_start) { names[depth + 1].clear(); }
      if (event == Event::key)
      {
         const auto key = name.template get<std::string>();
         require(names[depth].insert(key).second, what, ": key '", key,
                 "' is there twice, must be there once");
      }
      return true;
   };
   return Json::parse(text, once);
}

} // namespace cattaneo
