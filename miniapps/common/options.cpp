#include "common/options.hpp"

#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

namespace miniapp
{

using cattaneo::require;
namespace fs = std::filesystem;

void Options::AddOption(int *value, const char *short_name, const char *name, const char *help)
{
   OptionsParser::AddOption(value, short_name, name, help);
   for (const char *known : {short_name, name}) { names_.push_back({known, Kind::integer}); }
}

void Options::AddOption(double *value, const char *short_name, const char *name,
                        const char *help)
{
   OptionsParser::AddOption(value, short_name, name, help);
   for (const char *known : {short_name, name}) { names_.push_back({known, Kind::number}); }
}

void Options::AddOption(bool *value, const char *on, const char *on_name, const char *off,
                        const char *off_name, const char *help)
{
   OptionsParser::AddOption(value, on, on_name, off, off_name, help);
   for (const char *known : {on, on_name, off, off_name})
   {
      names_.push_back({known, Kind::flag});
   }
}

void Options::AddOption(const char **value, const char *short_name, const char *name,
                        const char *help)
{
   OptionsParser::AddOption(value, short_name, name, help);
   for (const char *known : {short_name, name}) { names_.push_back({known, Kind::text}); }
}

void Options::AddOption(std::string *value, const char *short_name, const char *name,
                        const char *help)
{
   OptionsParser::AddOption(value, short_name, name, help);
   for (const char *known : {short_name, name}) { names_.push_back({known, Kind::text}); }
}

void Options::check_words() const
{
   const auto find = [this](const std::string &word)
   {
      return std::find_if(names_.begin(), names_.end(),
                          [&](const Name &known) { return known.name == word; });
   };
   for (std::size_t i = 1; i < words_.size(); ++i)
   {
      const auto option = find(words_[i]);
      if (option == names_.end() || option->kind == Kind::flag) { continue; }
      require(i + 1 < words_.size() && find(words_[i + 1]) == names_.end(), "option ",
              words_[i], " has no value");
      const std::string &word = words_[++i];
      if (option->kind == Kind::text) { continue; }
      const bool integer = option->kind == Kind::integer;
      char *end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      require(!word.empty() && *end == 0 && std::isfinite(value) &&
                 (!integer || word.find_first_not_of("+-0123456789") == std::string::npos),
              "option ", words_[i - 1], ": '", word, "' is not ",
              integer ? "an integer" : "a number");
      constexpr int most = std::numeric_limits<int>::max();
      require(!integer || std::abs(value) <= most, "option ", words_[i - 1], ": ", word,
              " is too large, must be at most ", most);
   }
}

void Options::check_files() const
{
   const auto same = [](const std::string &a, const std::string &b)
   {
      std::error_code error;
      return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
   };
   for (const File &file : files_)
   {
      const std::string name = file.name();
      if (name.empty() || file.what == Names::input) { continue; }
      try
      {
         const bool folder = file.what == Names::folder;
         require(!folder || !fs::exists(name) || fs::is_directory(name), "'", name,
                 "' is a file, must be a folder");
         if (file.what == Names::prefix) { cattaneo::require_writable(name + "_.csv"); }
         else if (!folder) { cattaneo::require_writable(name); }
         else
         {
            fs::path there = name;
            while (!there.empty() && !fs::exists(there)) { there = there.parent_path(); }
            cattaneo::require_writable(there / "file");
         }
      }
      catch (const cattaneo::InputError &error)
      {
         throw cattaneo::InputError("option " + file.option + ": " + error.what());
      }
      const std::string type = fs::path(name).extension();
      require(file.what != Names::picture || type == ".png" || type == ".pdf" || type == ".svg",
              "option ", file.option, ": '", name, "' must end in .png, .pdf or .svg");
      for (const File &other : files_)
      {
         if (&other == &file || other.name().empty() || file.what == Names::prefix ||
             other.what == Names::prefix)
         {
            continue;
         }
         require(!same(name, other.name()), "option ", file.option, " would write over '", name,
                 "', the file of option ", other.option, ": name another");
      }
   }
}

void Options::parse()
{
   check_words();
   miniapp::parse(*this);
   check_files();
}

} // namespace miniapp
