#pragma once

#include <functional>
#include <mfem.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/** MFEM's options, with what MFEM leaves open: numbers that are none, or too large, are refused
   with the name of their option, and so are options without a value. Files to be read and
   written are known as such, so that a run does not end, after all its work, with nowhere to
   write to, or writes over what it reads. */
class Options : public mfem::OptionsParser
{
public:
   Options(int argc, char *argv[]) : OptionsParser(argc, argv), words_(argv, argv + argc) {}

   /// What the value of an option names.
   enum class Names
   {
      input,   ///< a file that is read
      output,  ///< a file that is written
      prefix,  ///< the beginning of the names of files that are written
      folder,  ///< a folder for files, made with those above it if there is none
      picture, ///< a file of matplotlib's: png, pdf or svg
   };

   void AddOption(int *value, const char *short_name, const char *name, const char *help);
   void AddOption(double *value, const char *short_name, const char *name, const char *help);
   void AddOption(bool *value, const char *on, const char *on_name, const char *off,
                  const char *off_name, const char *help);
   void AddOption(const char **value, const char *short_name, const char *name,
                  const char *help);
   void AddOption(std::string *value, const char *short_name, const char *name,
                  const char *help);
   /// An option that names files.
   template <class Text>
   void add(Names what, Text *value, const char *short_name, const char *name, const char *help)
   {
      AddOption(value, short_name, name, help);
      note(what, value, name);
   }
   /// Says of an option what it names.
   template <class Text>
   void note(Names what, Text *value, const char *name)
   {
      files_.push_back({name, what, [value] { return std::string(*value); }});
   }

   /// InputError for a word of the command line that its option cannot take.
   void check_words() const;

   /// Parses the options, echoes them, prints help for -h. Leaves through run() as
   /// miniapp::parse() does; InputError for a value or a file that cannot be used.
   void parse();

private:
   enum class Kind
   {
      integer,
      number,
      text,
      flag
   };
   struct Name
   {
      std::string name;
      Kind kind;
   };
   struct File
   {
      std::string option;
      Names what;
      std::function<std::string()> name; ///< empty: none
   };

   void check_files() const;

   const std::vector<std::string> words_; ///< of the command line
   std::vector<Name> names_;              ///< short and long
   std::vector<File> files_;
};

} // namespace miniapp
