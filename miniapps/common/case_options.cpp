#include "common/case_options.hpp"
#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;

CaseOptions::CaseOptions(int argc, char *argv[]) : args_(argc, argv)
{
   args_.add(Options::Names::input, &case_file_, "-case", "--case",
             "JSON file with options; those of the command line override it.");
}

const char *CaseOptions::keep(const std::string &text)
{
   texts_.push_back(text);
   return texts_.back().c_str();
}

void CaseOptions::add(int *value, const std::string &name, const char *help)
{
   args_.AddOption(value, keep("-" + name), keep("--" + name), help);
   keys_.push_back({name, value, Text::word});
}

void CaseOptions::add(double *value, const std::string &name, const char *help)
{
   args_.AddOption(value, keep("-" + name), keep("--" + name), help);
   keys_.push_back({name, value, Text::word});
}

void CaseOptions::add(bool *value, const std::string &name, const char *help)
{
   args_.AddOption(value, keep("-" + name), keep("--" + name), keep("-no-" + name),
                   keep("--no-" + name), help);
   keys_.push_back({name, value, Text::word});
}

void CaseOptions::add(const char **value, const std::string &name, Text text, const char *help)
{
   args_.AddOption(value, keep("-" + name), keep("--" + name), help);
   if (text == Text::file) { args_.note(Options::Names::input, value, keep("--" + name)); }
   keys_.push_back({name, value, text});
}

void CaseOptions::parse()
{
   args_.check_words();
   // First for the name of the case file only; a bad command line is reported below.
   args_.Parse();
   if (args_.Good() && case_file_[0]) { read(case_file_); }
   args_.parse();
}

void CaseOptions::read(const std::string &file)
{
   const std::string where = "case file '" + file + "'";
   std::ifstream in(file);
   require(in.good() && !std::filesystem::is_directory(file), where, " cannot be read");
   nlohmann::json j;
   std::set<std::string> names;
   // Of a key that is there twice the parser itself keeps the last without a word.
   const auto once =
      [&](int depth, nlohmann::json::parse_event_t event, const nlohmann::json &name)
   {
      if (event == nlohmann::json::parse_event_t::key && depth == 1)
      {
         const auto key = name.get<std::string>();
         require(names.insert(key).second, where, ": key '", key,
                 "' is there twice, must be there once");
      }
      return true;
   };
   try
   {
      j = nlohmann::json::parse(in, once);
   }
   catch (const nlohmann::json::exception &error)
   {
      throw InputError(where + " is not JSON: " + error.what());
   }
   require(j.is_object(), where, " holds a JSON ", j.type_name(), ", must be an object");
   for (const auto &[name, value] : j.items())
   {
      const auto key = std::find_if(keys_.begin(), keys_.end(),
                                    [&name = name](const Key &k) { return k.name == name; });
      if (key == keys_.end())
      {
         std::string known;
         for (const Key &k : keys_) { known += (known.empty() ? "" : ", ") + k.name; }
         throw InputError(where + ": unknown key '" + name + "', must be one of " + known);
      }
      set(*key, value, where + ": key '" + name + "'", file);
   }
}

void CaseOptions::set(const Key &key, const nlohmann::json &value, const std::string &where,
                      const std::string &file)
{
   const auto expect = [&](bool condition, const char *allowed)
   {
      // Nothing nested is shown: it may be too deep to be written.
      require(condition, where, " is ",
              value.is_structured() ? value.type_name() : value.dump(), ", must be ", allowed);
   };
   const auto all = [&value](auto is)
   { return value.is_array() && std::all_of(value.begin(), value.end(), is); };
   const auto is_number = [](const nlohmann::json &v) { return v.is_number(); };
   const auto is_attribute = [](const nlohmann::json &v)
   { return v.is_number_integer() && v.get<double>() > 0; };
   const auto is_string = [](const nlohmann::json &v) { return v.is_string(); };
   const auto joined = [&value](const char *between)
   {
      std::string list;
      for (const auto &v : value)
      {
         list +=
            (list.empty() ? "" : between) + (v.is_string() ? v.get<std::string>() : v.dump());
      }
      return list;
   };
   if (auto integer = std::get_if<int *>(&key.value))
   {
      expect(value.is_number_integer() &&
                std::abs(value.get<double>()) <= std::numeric_limits<int>::max(),
             "an integer");
      **integer = value.get<int>();
   }
   else if (auto number = std::get_if<double *>(&key.value))
   {
      expect(value.is_number(), "a number");
      **number = value.get<double>();
   }
   else if (auto flag = std::get_if<bool *>(&key.value))
   {
      expect(value.is_boolean(), "true or false");
      **flag = value.get<bool>();
   }
   else
   {
      std::string text;
      switch (key.text)
      {
      case Text::word:
         expect(value.is_string(), "a string");
         text = value.get<std::string>();
         break;
      case Text::attributes:
         expect(value.is_string() || is_attribute(value) || all(is_attribute),
                "boundary attributes: a string such as \"3,4\" or \"3[-1<x<1]\", a positive "
                "integer, or an array of positive integers");
         text = value.is_string()  ? value.get<std::string>()
                : value.is_array() ? joined(",")
                                   : value.dump();
         break;
      case Text::file:
         expect(value.is_string(), "a string (the path of a file)");
         text = (std::filesystem::path(file).parent_path() / value.get<std::string>()).string();
         break;
      case Text::numbers:
         expect(value.is_number() || all(is_number), "a number or an array of numbers");
         text = value.is_number() ? value.dump() : joined(" ");
         break;
      case Text::statements:
         expect(value.is_string() || all(is_string), "a string or an array of strings");
         text = value.is_string() ? value.get<std::string>() : joined("; ");
         break;
      }
      *std::get<const char **>(key.value) = keep(text);
   }
}

} // namespace miniapp
