#pragma once

#include <deque>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace miniapp
{

/// A condition for a number, and the words for it: "must be positive".
struct Check
{
   std::function<bool(double)> holds;
   std::string must;
};
extern const Check any, positive, not_negative;
Check at_least(double least);
Check above(double low);
Check between(double low, double high);        ///< neither bound
Check above_up_to(double low, double high);    ///< without the lower bound
Check at_least_below(double low, double high); ///< without the upper bound
Check within(double low, double high);         ///< both bounds
Check none_or_above(double low);               ///< 0, or a value above the bound

/// The kind of a text option, on the command line and in a case file.
enum class Text
{
   word,
   statements, ///< a string with statements between semicolons, or an array of them
   structure,  ///< an object, here as JSON; files in it have the keys mesh and matrix
   input,      ///< a file that is read; a path in a case file is relative to its folder
   output,     ///< a file that is written
   prefix,     ///< the beginning of the names of files that are written
   folder,     ///< a folder for files, made with those above it if there is none
   picture,    ///< a picture by matplotlib: png, pdf or svg
   page        ///< an html file
};

/// Help of --domain, which every study with a half-plane has. With 0 the half-plane has no
/// mesh.
extern const char *const domain_help;

/** Options of a program, each declared once, with its check. A text that is no number, a number
    that is too large, and an option without a value are refused with the name of the option.
    Files to be read and written are known as such, so that a run does not find at its end that
    it cannot write, and does not overwrite a file that it reads.

    --case FILE.json gives options as well, by their names without dashes; the command line
    overrides it. Files that are written are named on the command line only. The case file may
    have comments, as in C++. */
class Options
{
public:
   /// @param source of the program, in the repository: -h prints its head comment first
   Options(const std::string &source, int argc, char *argv[]);

   /// The name of an option, typed as --name or -name, and the name that turns a flag off,
   /// which is --no-name unless another is given.
   struct Names
   {
      Names(const char *name) : Names(std::string(name)) {}
      Names(const std::string &name) : Names(name, "no-" + name) {}
      Names(const std::string &name, const std::string &off) : name(name), off(off) {}
      std::string name, off;
   };

   /// Where the value goes. NaN means that no number was given; checks are not applied to it. A
   /// list is written with spaces or commas; "none" and "" are the empty list.
   using Value = std::variant<int *, double *, bool *, std::string *, std::vector<double> *>;

   /// @param check of a number, or of each in a list
   void add(Value value, const Names &names, const char *help, const Check &check = any);
   void add(std::string *value, const Names &names, const char *help, Text kind);
   /// An option whose value is one of some words.
   void add(std::string *value, const Names &names, const char *help,
            const std::vector<std::string> &choices);

   /// The heading in -h above the options that are added from now on.
   void group(const std::string &heading) { group_ = heading; }
   /// From now on case files must name this version of their form. Without this call they need
   /// not name any.
   void require_version(int version) { version_ = version; }
   /// Adds --set, which gives a place in an option another value: KEY=VALUE, with a key as in
   /// command(). It comes after the case file and all other options.
   void add_set();
   /// Names options that are not part of a case: where results go, or which of them are shown.
   void leave_out_of_cases(const std::string &name);

   /// Options that were renamed, as pairs of old and new name. The old names are refused with
   /// the new ones in the message.
   void renamed(const std::map<std::string, std::string> &names) { renamed_ = names; }

   /// Sets all options and echoes those that were typed (with --verbose all); -h prints them
   /// all and leaves the program (Leave). InputError for an unknown option, and for a value or
   /// a file that cannot be used.
   void parse();

   /** The words of a command that runs the same study with some values changed, and without its
       output files; a key is an option's name, NAME.k for entry k (from 0) of a list or of
       statements, or NAME.k.LOAD for a load's multiplier at point k of a history. To be called
       after parse(). In a structure a key is NAME.KEY.KEY…, with numbers (from 0) for entries
       of arrays. InputError if a key is none or an option does not allow its value. */
   std::vector<std::string>
   command(const std::vector<std::pair<std::string, std::string>> &changes) const;

   /// The value of an option; empty if there is no such option.
   std::string text(const std::string &name) const;
   /// Does the command line or the case file give it?
   bool says(const std::string &name) const { return said_.count(name) > 0; }
   /// Its name in an error: "key 'cycles'" if a case gives it, otherwise "option --cycles".
   std::string called(const std::string &name) const;

   /// InputError if one of these is given in a run that does not use it. @param why as in "goes
   /// with --map"
   void only_if(bool used, const std::vector<std::string> &names, const std::string &why) const;

   /// The parsed values by names, lists as text.
   const nlohmann::ordered_json &values() const { return values_; }

private:
   struct Option
   {
      Names names;
      std::string help;
      Value value;
      Check check = any;
      Text kind = Text::word;
      std::vector<std::string> choices = {};
      bool in_cases = true;
      std::string group = {}; ///< heading above it in -h

      bool is_flag() const { return std::holds_alternative<bool *>(value); }
      bool is_list() const { return std::holds_alternative<std::vector<double> *>(value); }
      bool is_written() const { return kind > Text::input; }
      /// Does it have places that --sweep and --set can change?
      bool has_places() const
      {
         const std::string &name = names.name;
         return in_cases && name != "sweep" && name != "sweep-results" && name != "set";
      }
      std::string text() const;               ///< its value
      nlohmann::ordered_json as_json() const; ///< as above, a list as text
      /// A value of a case file as it would stand on the command line.
      std::string from_json(const nlohmann::ordered_json &x, const std::string &where) const;
      /// @param as what the option is called in an error
      void set(const std::string &as, const std::string &text) const;
      /// A text of its value with another value in the place `key`, which option `by` gives.
      std::string changed(const std::string &now, const std::string &by, const std::string &key,
                          const std::string &value) const;
      void validate() const; ///< its value
   };
   /// The options of the command line.
   struct Given
   {
      const Option *option;
      std::string as, text; ///< the option's name as it was typed, and its value
   };

   /// The option of a name, or null.
   const Option *named(const std::string &name) const;
   /// InputError, which begins with `what`, if this is the old name of an option.
   void refuse_old(const std::string &what, const std::string &name) const;
   /// The option that a word of the command line is, or null.
   const Option *find(const std::string &word) const;
   void read_words();
   void print_head() const;
   void print_help() const;
   void echo() const;
   void check_files() const;
   void read(const std::string &file);
   const Option &of_case(const std::string &key, const std::string &where) const;
   /// The option in which a key is a place. @param by the option that gives the key
   const Option &changeable(const std::string &by, const std::string &key) const;
   /// What --set says.
   void change();

   const std::string source_;
   const std::vector<std::string> words_; ///< of the command line
   std::deque<Option> options_;           ///< these stay where they are
   std::vector<Given> given_;
   std::set<std::string> said_, changed_; ///< names
   std::map<std::string, std::string> renamed_;
   std::string case_file_, set_, group_ = "A case file";
   int version_ = 0;
   nlohmann::ordered_json values_;
};

/// KEY and VALUE of a statement KEY=VALUE of option `by`; InputError, with the example, if it
/// is no such statement.
std::pair<std::string, std::string>
assignment(const std::string &by, const std::string &statement, const std::string &example);

/// Numbers of a list option, separated by spaces or commas, or "none"; InputError naming the
/// option.
std::vector<double> numbers(const std::string &option, const std::string &text);

} // namespace miniapp
