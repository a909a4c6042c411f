#pragma once

#include "common/figure.hpp"
#include "common/film.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"
#include "common/scene.hpp"
#include "common/table.hpp"
#include "common/text.hpp"
#include "common/units.hpp"

#include <cattaneo/algebra/blas_kernels.hpp>
#include <cattaneo/counters.hpp>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <string>

namespace miniapp
{

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Leaves a study that cannot go on. Its results are written, and its exit code is 2. The
/// message was printed before.
struct Outcome
{
};
/// Leaves a study that has done something else instead, as requested (--check).
struct Done
{
};

/** Allowed difference of a computed value from a closed form, in the units of the value: the
    spread of the closed form, and the errors by mesh and increments, where they are known. */
struct Allowed
{
   Allowed(double spread_, double mesh_ = 0) : spread(spread_), mesh(mesh_) {}
   double spread, mesh;
};

/** Options, results and outputs of a study, each stated once. An option has its check. A value
    or a row of a table is printed, goes to JSON and CSV, may be drawn, and is compared with the
    references of the study (miniapps/data/references.json).

    All studies have the options --case, --json, --csv, --plot, --html, --save, --sweep and
   --verbose, and end with their references, sizes, times, counters and warnings. It must be
   made first, because it measures the time. */
class Study
{
public:
   Study(const std::string &name, int argc, char *argv[]);

   /// An option with its check, see Options::add().
   template <class Value, class... Rest>
   void option(Value *value, const Options::Names &names, const char *help,
               const Rest &...check)
   {
      options_.add(value, names, help, check...);
   }
   /// An option whose value is one of some words.
   void option(std::string *value, const Options::Names &names, const char *help,
               const std::vector<std::string> &choices)
   {
      options_.add(value, names, help, choices);
   }
   Options &options() { return options_; }
   const Options &options() const { return options_; }
   /// See Options::only_if().
   void only_if(bool used, const std::vector<std::string> &names, const std::string &why) const
   {
      options_.only_if(used, names, why);
   }
   /// Adds the options that all studies have, and parses.
   void parse();
   /// True if a picture is wanted.
   bool draws() const { return has_picture() || !html_.empty(); }
   /// Is everything printed, not only the main results?
   bool verbose() const { return verbose_; }
   /// True if its panels go to a file: JSON, CSV, a picture or the page.
   bool keeps_panels() const { return !json_.empty() || !csv_.empty() || draws(); }
   bool has_picture() const { return !plot_.empty(); }
   bool has_page() const { return !html_.empty(); }
   const std::string &csv() const { return csv_; } ///< prefix of its CSV files; empty: none

   /// To be called when the problem has been reduced. Prints its size, writes it to the file of
   /// --save, if any, and adds the time and the counters. With --check it shows the scene and
   /// leaves the study.
   void reduced(const Scene &scene);
   /// The same in two parts, for a problem that may still turn out to be bad input.
   void condensed(const Scene &scene);
   void condensed(const cattaneo::ReducedProblem &problem,
                  int dofs); ///< 0: the problem was read from a file
   void save(const cattaneo::ReducedProblem &problem);

   /// Names a file or folder that is written during the study, and is removed if the study ends
   /// as bad input. @param goes_on it continues an existing file, which stays
   void begins(const std::string &path, bool goes_on = false);

   /// The march of the study continues one that completed so many cycles and left CSV files.
   void goes_on_after(int cycles) { cycles_before_ = cycles; }
   /// The rows of these cycles in a table with a column "cycle".
   std::vector<nlohmann::ordered_json> rows_before(const std::string &table) const;
   /// Name of the CSV file for one more history of loads; empty without --csv.
   std::string history_file();

   /// Series for ParaView of a reduced scene, see Scene::fields().
   void write_frames(const std::string &folder, Scene &scene,
                     const std::vector<cattaneo::ContactState> &states);

   /// Prints a heading.
   void title(const std::string &text);
   /// Prints a line, and does nothing else with it.
   void say(const std::string &line);
   /// Adds a number, with the estimate of its error, if it has one, as `key`_error_estimate.
   /// With a label it is also printed, with its unit. Without a key it is only printed.
   void value(const std::string &key, double x, const std::string &label = "",
              double error = none, const std::string &unit = "");

   /// The table of that name, made if it is not there yet.
   ResultTable &table(const std::string &name, const std::vector<Column> &columns);
   /// A CSV file of a list of results.
   void list(const std::string &name, const nlohmann::ordered_json &rows);
   /// Adds a row to a table, with the errors of the columns that have one. The row is compared
   /// with references of the key "table/column", whose conditions may name columns.
   void row(ResultTable &table, const std::vector<nlohmann::ordered_json> &values,
            const std::vector<std::pair<std::string, double>> &errors = {},
            const nlohmann::ordered_json &more = {});

   /// A new panel of the figure; the reference stays valid.
   Panel &panel(Panel::Kind kind, const std::string &name, const std::string &title,
                const std::string &x_label, const std::string &y_label);
   /// One of curves.
   Panel &lines(const std::string &name, const std::string &title, const std::string &x_label,
                const std::string &y_label)
   {
      return panel(Panel::Kind::lines, name, title, x_label, y_label);
   }

   /// Takes the increments of a march that the page (--html) shows; null if there is no page,
   /// or if the page has enough. The pointer stays valid.
   Film *film(const cattaneo::ReducedProblem &problem);

   /// Adds a closed form and the computed value to the table of references.
   void compare(const std::string &name, double exact, Allowed allowed, double computed);

   nlohmann::ordered_json results;
   /// The beginning of the page: "sentence", and "rows" of label, value and meaning.
   nlohmann::ordered_json lead;
   nlohmann::ordered_json sketch; ///< the bodies of the march, see Sketch
   cattaneo::Counters counters;
   Units units;  ///< of printed numbers
   int code = 0; ///< at the end of the study, unless it ends early
   Stopwatch watch;

   /// Runs a study: its options, its computation, and its outputs. Returns the exit code.
   static int run(const std::string &name, int argc, char *argv[],
                  const std::function<void(Study &)> &body);

private:
   void finish();
   /// Prints the counters and times of --verbose at the end.
   void say_more(const cattaneo::BlasKernels &kernels);
   /// Does references.json have an entry of this study with that key?
   bool is_compared(const std::string &key);
   /// Lets the package cattaneo_show compare the results with references.
   void compare_references();
   /// Data that pictures, the page and CSV files show besides the results.
   nlohmann::ordered_json shown() const;
   void show_results(const nlohmann::ordered_json &run) const;
   /// Increments of more than a megabyte go to a separate file, FILE.frames beside the JSON.
   /// The JSON then has the name of this file.
   void write_long_frames(nlohmann::ordered_json &marches) const;

   Options options_;
   std::string name_, json_, csv_, plot_, html_, save_, sweep_, sweep_results_;
   /// Its destructor removes the files that it names.
   struct Begun
   {
      std::vector<std::string> paths;
      ~Begun();
   } begun_;
   std::deque<ResultTable> tables_;
   std::deque<Panel> panels_;
   std::deque<Film> films_;
   int cycles_before_ = 0, histories_ = 0;
   int more_films_ = 0;                                              ///< not on the page
   nlohmann::ordered_json values_ = nlohmann::ordered_json::array(); ///< as they are printed
   /// Panels in the order of the figure; null without data.
   std::vector<std::function<nlohmann::ordered_json()>> drawn_;
   nlohmann::ordered_json lists_ = nlohmann::ordered_json::array(); ///< with their names
   /// Values with their keys, and closed forms, for the comparison at the end.
   nlohmann::ordered_json found_ = nlohmann::ordered_json::array(),
                          closed_ = nlohmann::ordered_json::array();
   std::string references_;               ///< the text of references.json, if it has the study
   std::map<std::string, bool> compared_; ///< answers of is_compared() so far
   Eigen::Index nodes_ = 0;
   int dofs_ = 0;
   bool check_ = false, verbose_ = false, checked_ = false, saved_ = false;
   double seconds_ = 0; ///< up to the reduced problem
};

} // namespace miniapp
