#include "common/options.hpp"

#include "common/case_file.hpp"
#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

namespace miniapp
{

using cattaneo::exact_text;
using cattaneo::InputError;
using cattaneo::require;
using nlohmann::json;
namespace fs = std::filesystem;

const Check any{[](double) { return true; }, ""};
const Check positive{[](double x) { return x > 0; }, "must be positive"};
const Check not_negative{[](double x) { return x >= 0; }, "must not be negative"};

Check at_least(double least)
{
   return {[=](double x) { return x >= least; }, "must be at least " + exact_text(least)};
}

Check above(double low)
{
   return {[=](double x) { return x > low; }, "must be above " + exact_text(low)};
}

Check between(double low, double high)
{
   return {[=](double x) { return x > low && x < high; },
           "must be between " + exact_text(low) + " and " + exact_text(high)};
}

Check above_up_to(double low, double high)
{
   return {[=](double x) { return x > low && x <= high; },
           "must be above " + exact_text(low) + " and at most " + exact_text(high)};
}

Check at_least_below(double low, double high)
{
   return {[=](double x) { return x >= low && x < high; },
           "must be at least " + exact_text(low) + " and below " + exact_text(high)};
}

Check within(double low, double high)
{
   return {[=](double x) { return x >= low && x <= high; },
           "must be " + exact_text(low) + " to " + exact_text(high)};
}

Check none_or_above(double low)
{
   return {[=](double x) { return x == 0 || x > low; },
           "must be 0, for a half-plane without a mesh, or above " + exact_text(low)};
}

const char *const domain_help =
   "Half-width and depth of a meshed block in place of the half-plane, as a check (0: none, "
   "the half-plane itself, which has no mesh).";

namespace
{

/// Where --sweep is given several times: once, with statements.
std::vector<std::string> with_one_sweep(int argc, char *argv[])
{
   std::vector<std::string> words;
   std::string sweep;
   for (int i = 0; i < argc; ++i)
   {
      const std::string word = argv[i];
      if ((word != "--sweep" && word != "-sweep") || i + 1 == argc)
      {
         words.push_back(word);
         continue;
      }
      sweep += (sweep.empty() ? "" : "; ") + std::string(argv[++i]);
   }
   if (!sweep.empty()) { words.insert(words.end(), {"--sweep", sweep}); }
   return words;
}

std::vector<char *> pointers(const std::vector<std::string> &words)
{
   std::vector<char *> list;
   for (const std::string &word : words) { list.push_back(const_cast<char *>(word.c_str())); }
   return list;
}

/// A number that an option is given as a word.
void check_number(const std::string &option, const std::string &word, bool integer)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   require(!word.empty() && *end == 0 && std::isfinite(value) &&
              (!integer || word.find_first_not_of("+-0123456789") == std::string::npos),
           "option ", option, ": '", word, "' is not ", integer ? "an integer" : "a number");
   constexpr int most = std::numeric_limits<int>::max();
   require(!integer || std::abs(value) <= most, "option ", option, ": ", word,
           " is too large, must be at most ", most);
}

/// Entry k of a text of entries is another value; with a load's name, its part LOAD=value.
std::string replaced(const std::string &text, const std::string &separators,
                     const std::string &key, const std::string &value)
{
   const std::vector<std::string> path = split(key, ".");
   std::vector<std::string> entries = split(text, separators.c_str());
   char *end = nullptr;
   const long k = std::strtol(path[1].c_str(), &end, 10);
   require(*end == 0 && k >= 0 && k < static_cast<long>(entries.size()), "option --sweep: '",
           key, "': option --", path[0], " has ", entries.size(),
           " entries, must name one of them from 0");
   std::string &entry = entries[static_cast<std::size_t>(k)];
   if (path.size() == 2) { entry = value; }
   else
   {
      std::vector<std::string> loads = split(entry, ", ");
      const std::string begin = path[2] + "=";
      const auto same = [&](const std::string &load) { return load.find(begin) == 0; };
      loads.erase(std::remove_if(loads.begin(), loads.end(), same), loads.end());
      entry = begin + value;
      for (const std::string &load : loads) { entry += " " + load; }
   }
   std::string result;
   for (const std::string &one : entries)
   {
      result += (result.empty() ? "" : separators.substr(0, 1)) + one;
   }
   return result;
}

} // namespace

Options::Options(int argc, char *argv[])
   : words_(with_one_sweep(argc, argv)), arguments_(pointers(words_)),
     parser_(static_cast<int>(arguments_.size()), arguments_.data())
{
   add(&case_file_, "case", "JSON file with options; those of the command line override it.",
       Text::input);
   options_.back().in_cases = false;
}

Options::Option &Options::keep(Option option)
{
   options_.push_back(std::move(option));
   return options_.back();
}

void Options::add(int *value, const Names &names, const char *help, const Check &check)
{
   const auto settle = [=]
   { require(check.holds(*value), "option --", names.name, " is ", *value, ", ", check.must); };
   const Option &o = keep({names, Kind::integer, Text::word, value, settle, true});
   parser_.AddOption(value, o.names.on[0].c_str(), o.names.on[1].c_str(), help);
}

void Options::add(double *value, const Names &names, const char *help, const Check &check)
{
   const auto settle = [=]
   {
      require(std::isnan(*value) || check.holds(*value), "option --", names.name, " is ",
              *value, ", ", check.must);
   };
   const Option &o = keep({names, Kind::number, Text::word, value, settle, true});
   parser_.AddOption(value, o.names.on[0].c_str(), o.names.on[1].c_str(), help);
}

void Options::add(bool *value, const Names &names, const char *help)
{
   const Option &o = keep({names, Kind::flag, Text::word, value, {}, true});
   parser_.AddOption(value, o.names.on[0].c_str(), o.names.on[1].c_str(), o.names.on[2].c_str(),
                     o.names.on[3].c_str(), help);
}

void Options::add(std::string *value, const Names &names, const char *help, Text kind)
{
   const bool written = kind > Text::input;
   const Option &o = keep({names, Kind::text, kind, value, {}, !written});
   parser_.AddOption(value, o.names.on[0].c_str(), o.names.on[1].c_str(), help);
}

void Options::add(std::string *value, const Names &names, const char *help,
                  const std::vector<std::string> &choices)
{
   add(value, names, help);
   options_.back().settle = [=]
   {
      std::string list;
      for (const std::string &choice : choices) { list += (list.empty() ? "" : ", ") + choice; }
      require(std::find(choices.begin(), choices.end(), *value) != choices.end(), "option --",
              names.name, ": '", *value, "' is not one of ", list);
   };
}

void Options::add(std::vector<double> *value, const Names &names, const char *help,
                  const Check &check)
{
   std::string &text = lists_.emplace_back();
   for (double x : *value) { text += (text.empty() ? "" : " ") + exact_text(x); }
   add(&text, names, help);
   options_.back().kind = Kind::list;
   options_.back().settle = [value, names, check, &text]
   {
      *value = numbers("--" + names.name, text);
      for (double x : *value)
      {
         require(check.holds(x), "option --", names.name, ": ", x, " ", check.must);
      }
   };
}

void Options::leave_out_of_cases(const std::string &name)
{
   for (Option &option : options_)
   {
      if (option.names.name == name) { option.in_cases = false; }
   }
}

const Options::Option *Options::find(const std::string &word) const
{
   for (const Option &option : options_)
   {
      const std::size_t count = option.kind == Kind::flag ? 4 : 2;
      for (std::size_t k = 0; k < count; ++k)
      {
         if (option.names.on[k] == word) { return &option; }
      }
   }
   return nullptr;
}

void Options::check_words() const
{
   for (std::size_t i = 1; i < words_.size(); ++i)
   {
      const Option *option = find(words_[i]);
      if (!option || option->kind == Kind::flag) { continue; }
      require(i + 1 < words_.size() && !find(words_[i + 1]), "option ", words_[i],
              " has no value");
      const std::string &word = words_[++i];
      if (option->kind == Kind::text || option->kind == Kind::list) { continue; }
      check_number(words_[i - 1], word, option->kind == Kind::integer);
   }
}

void Options::check_files() const
{
   const auto same = [](const std::string &a, const std::string &b)
   {
      std::error_code error;
      return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
   };
   const auto named = [](const Option &option)
   {
      const auto *text = std::get_if<std::string *>(&option.value);
      return text && option.kind == Kind::text && option.text >= Text::input ? **text : "";
   };
   for (const Option &option : options_)
   {
      const std::string file = named(option), what = "option --" + option.names.name;
      if (file.empty() || option.text == Text::input) { continue; }
      try
      {
         const bool folder = option.text == Text::folder;
         require(!folder || !fs::exists(file) || fs::is_directory(file), "'", file,
                 "' is a file, must be a folder");
         if (option.text == Text::prefix) { cattaneo::require_writable(file + "_.csv"); }
         else if (!folder) { cattaneo::require_writable(file); }
         else
         {
            fs::path there = file;
            while (!there.empty() && !fs::exists(there)) { there = there.parent_path(); }
            cattaneo::require_writable(there / "file");
         }
      }
      catch (const InputError &error)
      {
         throw InputError(what + ": " + error.what());
      }
      const std::string type = fs::path(file).extension();
      require(option.text != Text::picture || type == ".png" || type == ".pdf" ||
                 type == ".svg",
              what, ": '", file, "' must end in .png, .pdf or .svg");
      require(option.text != Text::page || type == ".html", what, ": '", file,
              "' must end in .html");
      for (const Option &other : options_)
      {
         if (&other == &option || named(other).empty() || option.text == Text::prefix ||
             other.text == Text::prefix)
         {
            continue;
         }
         require(!same(file, named(other)), what, " would write over '", file,
                 "', the file of option --", other.names.name, ": name another");
      }
   }
}

void Options::parse()
{
   check_words();
   // First for the name of the case file only; a bad command line is reported below.
   parser_.Parse();
   if (parser_.Good() && !case_file_.empty()) { read(case_file_); }
   miniapp::parse(parser_);
   for (const Option &option : options_)
   {
      if (option.settle) { option.settle(); }
      values_[option.names.name] =
         std::visit([](auto *value) { return nlohmann::ordered_json(*value); }, option.value);
   }
   check_files();
}

const Options::Option &Options::changeable(const std::string &key) const
{
   const std::size_t dots = static_cast<std::size_t>(std::count(key.begin(), key.end(), '.'));
   const std::string name = key.substr(0, key.find('.'));
   std::string known;
   for (const Option &option : options_)
   {
      if (!option.in_cases || of_sweep(option)) { continue; }
      known += (known.empty() ? "" : ", ") + option.names.name;
      if (option.names.name != name) { continue; }
      const std::size_t most = option.kind == Kind::list         ? 1
                               : option.text == Text::statements ? 2
                                                                 : 0;
      require(dots <= most, "option --sweep: '", key, "': option --", name,
              most == 0 ? " has no entries" : " has no entries of entries");
      return option;
   }
   throw InputError("option --sweep: there is no option '" + name + "', must be one of " +
                    known);
}

std::vector<std::string>
Options::command(const std::vector<std::pair<std::string, std::string>> &changes) const
{
   std::map<const Option *, std::string> values;
   for (const auto &[key, value] : changes)
   {
      const Option &option = changeable(key);
      const std::string separators = option.text == Text::statements ? ";" : " ,";
      const nlohmann::ordered_json &now = values_.at(option.names.name);
      std::string &text =
         values.try_emplace(&option, now.is_string() ? now.get<std::string>() : "")
            .first->second;
      text = key == option.names.name ? value : replaced(text, separators, key, value);
   }
   std::vector<std::string> words;
   for (std::size_t i = 1; i < words_.size(); ++i)
   {
      const Option *option = find(words_[i]);
      if (!option) { continue; }
      const bool flag = option->kind == Kind::flag,
                 written = option->kind == Kind::text && option->text > Text::input;
      const std::size_t last = flag ? i : i + 1;
      static const std::set<std::string> of_all = {"json", "csv", "plot", "html"};
      require(!written || of_all.count(option->names.name) > 0, "option ", words_[i],
              " is of one run, a sweep has many");
      if (!written && values.count(option) == 0 && !of_sweep(*option))
      {
         words.insert(words.end(), words_.begin() + i, words_.begin() + last + 1);
      }
      i = last;
   }
   words.insert(words.end(), {"--sweep", "none"}); // a case file may have one
   for (const auto &[option, text] : values)
   {
      const std::string name = "--" + option->names.name;
      std::size_t on = 1;
      if (auto number = std::get_if<int *>(&option->value))
      {
         check_number(name, text, true);
         **number = std::stoi(text);
      }
      else if (auto number = std::get_if<double *>(&option->value))
      {
         check_number(name, text, false);
         **number = std::stod(text);
      }
      else if (option->kind == Kind::flag)
      {
         require(text == "true" || text == "false", "option --sweep: ", name, " is ", text,
                 ", must be true or false");
         on = text == "true" ? 1 : 3;
      }
      else { *std::get<std::string *>(option->value) = text; }
      if (option->settle) { option->settle(); }
      words.push_back(option->names.on[on]);
      if (option->kind != Kind::flag) { words.push_back(text); }
   }
   return words;
}

void Options::read(const std::string &file)
{
   const json keys = read_case(file);
   const std::string where = "case file '" + file + "': ";
   for (const auto &[name, value] : keys.items())
   {
      const Option *option = nullptr;
      std::string known;
      for (const Option &o : options_)
      {
         if (!o.in_cases) { continue; }
         if (o.names.name == name) { option = &o; }
         known += (known.empty() ? "" : ", ") + o.names.name;
      }
      require(option, where, "unknown key '", name, "', must be one of ", known);
      set(*option, value, where + "key '" + name + "'", file);
   }
}

void Options::set(const Option &option, const json &value, const std::string &where,
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
   const auto is_number = [](const json &v) { return v.is_number(); };
   const auto is_attribute = [](const json &v)
   { return v.is_number() && v > 0 && v < 1e9 && v == std::floor(v.get<double>()); };
   const auto is_string = [](const json &v) { return v.is_string(); };
   // A value, or an array of them with something between.
   const auto joined = [&value](const char *between)
   {
      std::string list;
      const json values = value.is_array() ? value : json::array({value});
      for (const json &v : values)
      {
         list += list.empty() ? "" : between;
         list += v.is_string() ? v.get<std::string>() : exact_text(v.get<double>());
      }
      return list;
   };
   if (auto integer = std::get_if<int *>(&option.value))
   {
      constexpr int most = std::numeric_limits<int>::max();
      const double x = value.is_number() ? value.get<double>() : std::nan("");
      expect(x == std::floor(x) && std::abs(x) <= most, "an integer"); // 2.0 is one in JSON
      **integer = static_cast<int>(x);
   }
   else if (auto number = std::get_if<double *>(&option.value))
   {
      expect(value.is_number(), "a number");
      **number = value.get<double>();
   }
   else if (auto flag = std::get_if<bool *>(&option.value))
   {
      expect(value.is_boolean(), "true or false");
      **flag = value.get<bool>();
   }
   else
   {
      std::string &text = *std::get<std::string *>(option.value);
      if (option.kind == Kind::list)
      {
         expect(value.is_number() || all(is_number), "a number or an array of numbers");
         text = joined(" ");
      }
      else if (option.text == Text::attributes)
      {
         expect(value.is_string() || is_attribute(value) || all(is_attribute),
                "boundary attributes: a string such as \"3,4\" or \"3[-1<x<1]\", a positive "
                "integer below 1e9, or an array of positive integers below 1e9");
         text = joined(",");
      }
      else if (option.text == Text::statements)
      {
         expect(value.is_string() || all(is_string), "a string or an array of strings");
         text = joined("; ");
      }
      else
      {
         const bool path = option.text == Text::input;
         expect(value.is_string(), path ? "a string (the path of a file)" : "a string");
         text = value.get<std::string>();
         if (path) { text = (fs::path(file).parent_path() / text).string(); }
      }
   }
}

std::vector<double> numbers(const std::string &option, const std::string &text)
{
   std::vector<double> values;
   if (text == "none") { return values; }
   std::string word;
   for (char c : text + " ")
   {
      if (c != ' ' && c != ',')
      {
         word += c;
         continue;
      }
      if (word.empty()) { continue; }
      char *end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      require(*end == 0 && std::isfinite(value), "option ", option, ": '", word,
              "' is not a number");
      values.push_back(value);
      word.clear();
   }
   return values;
}

} // namespace miniapp
