#include "common/options.hpp"

#include "common/case_file.hpp"
#include "common/miniapp.hpp"
#include "common/shipped.hpp"
#include "common/table.hpp"
#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>

namespace miniapp
{

using cattaneo::exact_text;
using cattaneo::InputError;
using cattaneo::require;
using json = nlohmann::ordered_json;
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
   "Half-width and depth of a meshed block that takes the place of the half-plane, as a check. "
   "0: the exact half-plane, which has no mesh.";

namespace
{

/// A structure of a case file with the files that it names relative to the program's folder.
nlohmann::ordered_json with_paths(nlohmann::ordered_json structure, const fs::path &folder)
{
   if (!structure.is_structured()) { return structure; }
   for (auto item = structure.begin(); item != structure.end(); ++item)
   {
      const bool file = structure.is_object() && item->is_string() &&
                        (item.key() == "mesh" || item.key() == "matrix" ||
                         item.key() == "deck" || item.key() == "mass");
      *item = file ? nlohmann::ordered_json((folder / item->get<std::string>()).string())
                   : with_paths(*item, folder);
   }
   return structure;
}

/// A structure with another value in the place NAME.KEY.KEY…: the value as JSON, or else as a
/// text.
std::string replaced_in(const std::string &structure, const std::string &by,
                        const std::string &key, const std::string &value)
{
   const std::vector<std::string> path = split(key, ".");
   require(cattaneo::is_utf8(key + value), by, ": its text must be UTF-8");
   auto all = parsed(structure.empty() ? "{}" : structure);
   nlohmann::ordered_json *place = &all;
   for (std::size_t k = 1; k < path.size(); ++k)
   {
      const auto number = path[k].find_first_not_of("0123456789") == std::string::npos
                             ? std::strtoul(path[k].c_str(), nullptr, 10)
                             : std::numeric_limits<unsigned long>::max();
      const bool entry = place->is_array() && number < place->size(),
                 member =
                    place->is_object() && (place->contains(path[k]) || k + 1 == path.size());
      std::vector<std::string> known;
      if (place->is_object())
      {
         for (const auto &item : place->items()) { known.push_back(item.key()); }
      }
      require(entry || member, by, ": '", key, "': there is no key '", path[k], "' in ",
              listed(std::vector<std::string>(path.begin(), path.begin() + long(k)), "."),
              place->is_object() ? ", it has " + listed(known)
              : place->is_array()
                 ? ", a list of " + std::to_string(place->size()) + ", counted from 0"
                 : ", which is one value");
      place = entry ? &(*place)[number] : &(*place)[path[k]];
   }
   try
   {
      *place = parsed(value);
   }
   catch (const json::exception &)
   {
      *place = value;
   }
   return all.dump();
}

/// Replaces entry k in a text of entries; with a load's name, only its part LOAD=value.
std::string replaced(const std::string &text, const std::string &separators,
                     const std::string &by, const std::string &key, const std::string &value)
{
   const std::string where = by + ": '" + key + "'";
   const std::vector<std::string> path = split_unquoted(where, key, ".");
   std::vector<std::string> entries = split_unquoted(where, text, separators);
   char *end = nullptr;
   const long k = std::strtol(path[1].c_str(), &end, 10);
   require(*end == 0 && k >= 0 && k < static_cast<long>(entries.size()), where, ": ", path[0],
           " has ", entries.size(), " entries, must name one of them, counted from 0");
   std::string &entry = entries[static_cast<std::size_t>(k)];
   if (path.size() == 2) { entry = value; }
   else
   {
      std::vector<std::string> loads = split_unquoted(where, entry, ", ");
      const auto same = [&](const std::string &load)
      {
         const bool quoted = load[0] == '\'' || load[0] == '"';
         const std::size_t end = load.find('=', quoted ? load.find(load[0], 1) : 0);
         return unquoted(load.substr(0, end)) == unquoted(path[2]);
      };
      loads.erase(std::remove_if(loads.begin(), loads.end(), same), loads.end());
      loads.insert(loads.begin(), path[2] + "=" + value);
      entry = listed(loads, " ");
   }
   return listed(entries, separators.substr(0, 1));
}

} // namespace

Options::Options(const std::string &source, int argc, char *argv[])
   : source_(source), words_(argv, argv + argc)
{
   add(&case_file_, "case", "JSON file with options; those of the command line override it.",
       Text::input);
   leave_out_of_cases("case");
}

void Options::add(Value value, const Names &names, const char *help, const Check &check)
{
   options_.push_back({names, help, value, check});
   options_.back().group = group_;
}

void Options::add(std::string *value, const Names &names, const char *help, Text kind)
{
   add(value, names, help);
   options_.back().kind = kind;
   options_.back().in_cases = !options_.back().is_written();
}

void Options::add(std::string *value, const Names &names, const char *help,
                  const std::vector<std::string> &choices)
{
   add(value, names, help);
   options_.back().choices = choices;
}

void Options::add_set()
{
   add(&set_, "set",
       "Replaces one value of the case, as 'interfaces.flank.friction=0.5' or "
       "'history.2.Q=0.1'; may be given several times.",
       Text::statements);
   leave_out_of_cases("set");
}

void Options::leave_out_of_cases(const std::string &name)
{
   for (Option &option : options_)
   {
      if (option.names.name == name) { option.in_cases = false; }
   }
}

nlohmann::ordered_json Options::Option::as_json() const
{
   return std::visit(
      [this](auto *x) -> nlohmann::ordered_json
      {
         if constexpr (std::is_same_v<decltype(x), std::vector<double> *>) { return text(); }
         else { return *x; }
      },
      value);
}

std::string Options::Option::text() const
{
   if (const auto *integer = std::get_if<int *>(&value)) { return std::to_string(**integer); }
   if (const auto *number = std::get_if<double *>(&value))
   {
      return std::isnan(**number) ? "" : exact_text(**number);
   }
   if (const auto *flag = std::get_if<bool *>(&value)) { return **flag ? "true" : "false"; }
   if (const auto *words = std::get_if<std::string *>(&value)) { return **words; }
   std::string list;
   for (double x : *std::get<std::vector<double> *>(value))
   {
      list += (list.empty() ? "" : " ") + exact_text(x);
   }
   return list;
}

void Options::Option::set(const std::string &as, const std::string &text) const
{
   const std::string what = "option " + as;
   if (const auto *integer = std::get_if<int *>(&value))
   {
      require(!text.empty() && text.find_first_not_of("+-0123456789") == std::string::npos,
              what, ": '", text, "' is not an integer");
      constexpr int most = std::numeric_limits<int>::max();
      const double x = number(what, text);
      require(std::abs(x) <= most, what, ": ", text, " is too large, must be at most ", most);
      **integer = static_cast<int>(x);
   }
   else if (const auto *real = std::get_if<double *>(&value)) { **real = number(what, text); }
   else if (const auto *flag = std::get_if<bool *>(&value))
   {
      require(text == "true" || text == "false", what, " is ", text, ", must be true or false");
      **flag = text == "true";
   }
   else if (const auto *words = std::get_if<std::string *>(&value)) { **words = text; }
   else { *std::get<std::vector<double> *>(value) = numbers(as, text); }
}

void Options::Option::validate() const
{
   const std::string what = "option --" + names.name;
   require(choices.empty() ||
              std::find(choices.begin(), choices.end(), text()) != choices.end(),
           what, ": '", text(), "' is not one of ", listed(choices));
   std::vector<double> numbers;
   if (const auto *integer = std::get_if<int *>(&value)) { numbers = {double(**integer)}; }
   if (const auto *real = std::get_if<double *>(&value)) { numbers = {**real}; }
   if (is_list()) { numbers = *std::get<std::vector<double> *>(value); }
   for (double x : numbers)
   {
      require((std::isnan(x) && !is_list()) || check.holds(x), what, is_list() ? ": " : " is ",
              x, is_list() ? " " : ", ", check.must);
   }
}

const Options::Option *Options::named(const std::string &name) const
{
   const auto found = std::find_if(options_.begin(), options_.end(),
                                   [&](const Option &one) { return one.names.name == name; });
   return found == options_.end() ? nullptr : &*found;
}

std::string Options::text(const std::string &name) const
{
   const Option *option = named(name);
   return option ? option->text() : "";
}

void Options::refuse_old(const std::string &what, const std::string &name) const
{
   const auto now = renamed_.find(name);
   require(now == renamed_.end(), what, " is called --",
           now == renamed_.end() ? "" : now->second, " now (-h shows its values)");
}

const Options::Option *Options::find(const std::string &word) const
{
   if (word[0] != '-') { return nullptr; }
   const std::string name = word.substr(word.rfind("--", 0) == 0 ? 2 : 1);
   for (const Option &option : options_)
   {
      const Names &names = option.names;
      if (name == names.name || (option.is_flag() && name == names.off)) { return &option; }
   }
   return nullptr;
}

void Options::read_words()
{
   for (std::size_t i = 1; i < words_.size(); ++i)
   {
      const std::string &word = words_[i];
      if (word == "-h" || word == "--help")
      {
         print_help();
         throw Leave();
      }
      const Option *option = find(word);
      const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
      if (!option && word[0] == '-') { refuse_old("option " + word, name); }
      require(option, "Unrecognized option: ", word, " (-h lists the options)");
      Given given{option, word, ""};
      if (option->is_flag()) { given.text = name == option->names.name ? "true" : "false"; }
      else
      {
         require(i + 1 < words_.size() && !find(words_[i + 1]), "option ", word,
                 " has no value");
         given.text = words_[++i];
         require(!option->is_written() || !given.text.empty(), "option ", word,
                 " is empty, must name a file");
      }
      const auto before =
         std::find_if(given_.begin(), given_.end(),
                      [&](const Given &other) { return other.option == option; });
      if (before == given_.end()) { given_.push_back(given); }
      else
      {
         require(option->names.name == "sweep" || option->value == Value(&set_), "option ",
                 word, " is there twice");
         before->text += "; " + given.text;
      }
   }
}

void Options::print_head() const
{
   // The head comment of a program's source has its purpose, its units, and sample runs.
   std::ifstream source(shipped(source_));
   for (std::string line; std::getline(source, line) && line.rfind("//", 0) == 0;)
   {
      std::printf("%s\n", line.substr(std::min<std::size_t>(4, line.size())).c_str());
   }
   std::printf("\n");
}

void Options::print_help() const
{
   print_head();
   std::printf("Options (-h: this list; one dash will do in place of two)\n");
   std::vector<std::string> headings; // in the order of their first options
   for (const Option &option : options_)
   {
      if (std::find(headings.begin(), headings.end(), option.group) == headings.end())
      {
         headings.push_back(option.group);
      }
   }
   for (const std::string &heading : headings)
   {
      std::printf("\n%s:\n", heading.c_str());
      for (const Option &option : options_)
      {
         if (option.group != heading) { continue; }
         static const char *const kinds[] = {"integer", "number", "", "text", "numbers"};
         const std::string now = option.text(), kind = option.choices.empty()
                                                          ? kinds[option.value.index()]
                                                          : listed(option.choices, "|");
         std::printf("   --%s %s%s\n", option.names.name.c_str(),
                     option.is_flag() ? ("or --" + option.names.off).c_str()
                                      : ("<" + kind + ">").c_str(),
                     option.is_flag() || now.empty() ? "" : (", default " + now).c_str());
         std::printf("%s", wrapped(option.help, 8).c_str());
      }
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
      return text && option.kind >= Text::input ? **text : "";
   };
   for (const Option &option : options_)
   {
      const std::string file = named(option), what = "option --" + option.names.name;
      if (file.empty() || option.kind == Text::input) { continue; }
      try
      {
         const bool folder = option.kind == Text::folder;
         if (option.kind == Text::prefix) { cattaneo::require_writable(file + "_….csv"); }
         else if (!folder) { cattaneo::require_writable(file); }
         else
         {
            std::error_code why_not;
            const fs::file_type type = fs::status(file, why_not).type();
            require(type == fs::file_type::not_found || type == fs::file_type::directory, "'",
                    file, "' ",
                    why_not ? "cannot be a folder: " + why_not.message()
                            : "is a file, must be a folder");
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
      require(option.kind != Text::picture || type == ".png" || type == ".pdf" ||
                 type == ".svg",
              what, ": '", file, "' must end in .png, .pdf or .svg");
      require(option.kind != Text::page || type == ".html", what, ": '", file,
              "' must end in .html");
      for (const Option &other : options_)
      {
         if (&other == &option || named(other).empty() || option.kind == Text::prefix)
         {
            continue;
         }
         if (other.kind == Text::prefix)
         {
            const std::string begin = fs::path(named(other) + "_").filename(),
                              name = fs::path(file).filename();
            require(type != ".csv" || name.compare(0, begin.size(), begin) != 0 ||
                       !same(fs::path(file).replace_filename(begin), named(other) + "_"),
                    what, ": '", file, "' is a name for the tables of option --",
                    other.names.name, " ", named(other), ": name another");
            continue;
         }
         require(!same(file, named(other)), what, " would write over '", file,
                 "', the file of option --", other.names.name, ": name another");
      }
   }
}

void Options::echo() const
{
   // Prints the options that were typed; with --verbose also the values of all others.
   const Option *verbose = named("verbose");
   const bool all = !verbose || verbose->text() == "true";
   if (!all && given_.empty()) { return; }
   std::printf("Options%s:\n", all ? "" : " (--verbose prints all)");
   for (const Option &option : options_)
   {
      const bool typed =
         std::any_of(given_.begin(), given_.end(),
                     [&](const Given &given) { return given.option == &option; });
      const std::string text = option.text();
      const Names &names = option.names;
      if (!all && !typed) { continue; }
      if (option.is_flag())
      {
         std::printf("   --%s\n", (text == "true" ? names.name : names.off).c_str());
      }
      else if (!text.empty()) { std::printf("   --%s %s\n", names.name.c_str(), text.c_str()); }
   }
   std::printf("\n");
   std::fflush(stdout);
}

void Options::parse()
{
   read_words();
   for (const Given &given : given_)
   {
      if (given.option->value != Value(&case_file_)) { continue; }
      case_file_ = given.text;
      read(case_file_);
   }
   for (const Given &given : given_)
   {
      given.option->set(given.as, given.text);
      said_.insert(given.option->names.name);
   }
   change();
   echo();
   for (const Option &option : options_)
   {
      try
      {
         option.validate();
      }
      catch (const InputError &error)
      {
         // In a case file the user has written a key.
         const std::string &name = option.names.name, as_option = "option --" + name;
         const std::string said = error.what();
         const bool typed =
            std::any_of(given_.begin(), given_.end(),
                        [&](const Given &given) { return given.option == &option; });
         if (typed || !says(name) || said.rfind(as_option, 0) != 0) { throw; }
         throw InputError("key '" + name + "'" + said.substr(as_option.size()));
      }
      values_[option.names.name] = option.as_json();
   }
   check_files();
}

void Options::only_if(bool used, const std::vector<std::string> &names,
                      const std::string &why) const
{
   for (const std::string &name : names)
   {
      require(used || !says(name), "option --", name, " does nothing in this run: it ", why);
   }
}

const Options::Option &Options::changeable(const std::string &by, const std::string &key) const
{
   const std::size_t dots = split_unquoted(by, key, ".").size() - 1;
   const std::string name = key.substr(0, key.find('.'));
   std::vector<std::string> known;
   for (const Option &option : options_)
   {
      if (!option.has_places()) { continue; }
      known.push_back(option.names.name);
      if (option.names.name != name) { continue; }
      if (option.kind == Text::structure) { return option; }
      const std::size_t most = option.is_list() ? 1 : option.kind == Text::statements ? 2 : 0;
      require(dots <= most, by, ": '", key, "': option --", name,
              most == 0 ? " has no entries" : " has no entries of entries");
      return option;
   }
   refuse_old(by + ": option '" + name + "'", name);
   throw InputError(by + ": there is no option '" + name + "', must be one of " +
                    listed(known));
}

std::string Options::Option::changed(const std::string &now, const std::string &by,
                                     const std::string &key, const std::string &value) const
{
   if (key == names.name) { return value; }
   return kind == Text::structure
             ? replaced_in(now, by, key, value)
             : replaced(now, kind == Text::statements ? ";" : " ,", by, key, value);
}

std::string Options::called(const std::string &name) const
{
   const bool typed =
      changed_.count(name) > 0 ||
      std::any_of(given_.begin(), given_.end(),
                  [&](const Given &given) { return given.option->names.name == name; });
   // For a user of a case, messages name keys, also those that are not in the file.
   const bool of_case = std::any_of(options_.begin(), options_.end(),
                                    [&](const Option &option)
                                    { return option.names.name == name && option.in_cases; });
   return !typed && (says(name) || (!case_file_.empty() && of_case)) ? "key '" + name + "'"
                                                                     : "option --" + name;
}

void Options::change()
{
   const std::string by = "option --set";
   for (const std::string &statement : split_unquoted(by, set_, ";"))
   {
      const auto [key, value] = assignment(by, statement, "interfaces.flank.friction=0.5");
      const Option &option = changeable(by, key);
      const std::string &name = option.names.name;
      option.set("--" + name, option.changed(option.text(), by, key, value));
      said_.insert(name);
      changed_.insert(name);
   }
}

std::vector<std::string>
Options::command(const std::vector<std::pair<std::string, std::string>> &changes) const
{
   std::map<std::string, std::string> values; // by names
   for (const Given &given : given_)
   {
      const std::string &name = given.option->names.name;
      static const std::set<std::string> of_all = {"json", "csv", "plot", "html"};
      require(!given.option->is_written() || of_all.count(name) > 0, "option ", given.as,
              " is of one run, a sweep has many");
      if (!given.option->is_written()) { values[name] = given.text; }
   }
   // The changed places are shown; a key may be swept.
   for (const std::string &name : changed_) { values[name] = named(name)->text(); }
   for (const char *name : {"set", "sweep-results"}) { values.erase(name); }
   // Those of a history are values of the sweep; another program's are its own.
   if (named("amplitude")) { values.erase("amplitudes"); }
   values["sweep"] = "none"; // a case file may have one
   for (const auto &[key, value] : changes)
   {
      const std::string by = "option --sweep";
      const Option &option = changeable(by, key);
      const std::string &name = option.names.name;
      const bool whole = key == name; // not a place within its value
      const auto swept = [&](const Given &given) { return whole && given.option == &option; };
      require(std::none_of(given_.begin(), given_.end(), swept), "option --", name,
              " has a value and is swept, must be one of the two");
      const nlohmann::ordered_json &now = values_.at(name);
      std::string &text =
         values.try_emplace(name, now.is_string() ? now.get<std::string>() : "").first->second;
      text = option.changed(text, by, key, value);
      option.set("--" + name, text);
      option.validate();
   }
   std::vector<std::string> words;
   for (const auto &[name, text] : values)
   {
      const Option &option = *named(name);
      const bool off = text == "false" && option.is_flag();
      words.push_back("--" + (off ? option.names.off : name));
      if (!option.is_flag()) { words.push_back(text); }
   }
   return words;
}

void Options::read(const std::string &file)
{
   const json keys = read_case(file, version_);
   const std::string where = "case file '" + file + "': ";
   for (const auto &[name, value] : keys.items())
   {
      const Option &option = of_case(name, where);
      std::string text = option.from_json(value, where + "key '" + name + "'");
      const fs::path folder = fs::path(file).parent_path();
      if (option.kind == Text::input) { text = (folder / text).string(); }
      if (option.kind == Text::structure) { text = with_paths(value, folder).dump(); }
      option.set("--" + name, text);
      said_.insert(name);
   }
}

const Options::Option &Options::of_case(const std::string &key, const std::string &where) const
{
   std::vector<std::string> known;
   for (const Option &option : options_)
   {
      if (!option.in_cases) { continue; }
      if (option.names.name == key) { return option; }
      known.push_back(option.names.name);
   }
   refuse_old(where + "key '" + key + "'", key);
   throw InputError(where + "unknown key '" + key + "', must be one of " + listed(known));
}

/// A value of a case file, as it would stand on the command line.
std::string Options::Option::from_json(const json &x, const std::string &where) const
{
   const auto expect = [&](bool condition, const char *allowed)
   {
      // Nested values are not shown, because they may be too deep to be written.
      const bool nested =
         std::any_of(x.begin(), x.end(), [](const json &v) { return v.is_structured(); });
      require(condition, where, " is ",
              x.is_object() ? std::string("an object")
              : nested      ? std::string("a list with lists or objects in it")
                            : x.dump(),
              ", must be ", allowed);
   };
   const auto is_whole = [](const json &v)
   { return v.is_number() && v == std::floor(v.get<double>()); }; // 2.0 is one in JSON
   const auto all = [&x](auto is)
   { return x.is_array() && std::all_of(x.begin(), x.end(), is); };
   if (std::holds_alternative<int *>(value))
   {
      constexpr int most = std::numeric_limits<int>::max();
      expect(is_whole(x) && std::abs(x.get<double>()) <= most, "an integer");
   }
   else if (std::holds_alternative<double *>(value)) { expect(x.is_number(), "a number"); }
   else if (is_flag()) { expect(x.is_boolean(), "true or false"); }
   else if (is_list())
   {
      expect(x.is_number() || x == "none" || all([](const json &v) { return v.is_number(); }),
             "a number or an array of numbers, or \"none\"");
   }
   else if (kind == Text::structure)
   {
      expect(x.is_object(), "names with values in braces, as {\"NAME\": …}");
      return x.dump();
   }
   else if (kind == Text::statements)
   {
      expect(x.is_string() || all([](const json &v) { return v.is_string(); }),
             "a string or an array of strings");
   }
   else
   {
      expect(x.is_string(), kind == Text::input ? "a string (the path of a file)" : "a string");
   }
   std::vector<std::string> words;
   for (const json &v : x.is_array() ? x : json::array({x}))
   {
      words.push_back(v.is_string()   ? v.get<std::string>()
                      : v.is_number() ? exact_text(v.get<double>())
                                      : v.dump());
   }
   return listed(words, kind == Text::statements ? "; " : " ");
}

std::pair<std::string, std::string>
assignment(const std::string &by, const std::string &statement, const std::string &example)
{
   // A name in quotes may have an equals sign of its own.
   const std::size_t name = split_unquoted(by, statement, "=").front().size(),
                     equals = statement.find('=', name);
   require(equals != std::string::npos && equals > 0, by, ": '", statement,
           "', must be KEY=VALUE such as '", example, "'");
   return {statement.substr(0, equals), statement.substr(equals + 1)};
}

std::vector<double> numbers(const std::string &option, const std::string &text)
{
   std::vector<double> values;
   for (const std::string &word :
        text == "none" ? std::vector<std::string>() : split(text, " ,"))
   {
      values.push_back(number("option " + option, word));
   }
   return values;
}

} // namespace miniapp
