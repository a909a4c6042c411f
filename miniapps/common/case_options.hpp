#pragma once

#include "common/options.hpp"

#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

namespace miniapp
{

/** Options of a miniapp that a JSON case file may give as well. A key of the file is the long
   name of an option without its dashes; the command line overrides the file. */
class CaseOptions
{
public:
   CaseOptions(int argc, char *argv[]);

   /// How a text option is written in JSON.
   enum class Text
   {
      word,       ///< a string
      attributes, ///< a string, a number or an array of numbers
      file,       ///< a string: a path, relative to the folder of the case file
      numbers,    ///< a number or an array of numbers
      statements, ///< a string with statements between semicolons, or an array of them
   };

   void add(int *value, const std::string &name, const char *help);
   void add(double *value, const std::string &name, const char *help);
   void add(bool *value, const std::string &name, const char *help);
   void add(const char **value, const std::string &name, Text text, const char *help);

   /// For options that only the command line may give.
   Options &command_line() { return args_; }

   /// Sets all options, echoes them, prints help for -h, as Options::parse() does; InputError
   /// naming file, key, value and what is allowed for a bad file.
   void parse();

private:
   struct Key
   {
      std::string name;
      std::variant<int *, double *, bool *, const char **> value;
      Text text;
   };

   const char *keep(const std::string &text);
   void read(const std::string &file);
   void set(const Key &key, const nlohmann::json &value, const std::string &where,
            const std::string &file);

   Options args_;
   const char *case_file_ = "";
   std::vector<Key> keys_;
   std::deque<std::string> texts_; ///< MFEM keeps pointers only: these stay where they are
};

} // namespace miniapp
