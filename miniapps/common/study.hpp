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

/// Leaves a study where there is nothing to go on from: what it has is written, and its exit
/// code is 2. The message has been printed.
struct Outcome
{
};
/// Leaves a study that was to do something else instead, and has (--check).
struct Done
{
};

/** How far a closed form may be from what was computed, in the units of the value: its own
    spread, and the share of the mesh and of the increments, where that can be said. */
struct Allowed
{
   Allowed(double spread_, double mesh_ = 0) : spread(spread_), mesh(mesh_) {}
   double spread, mesh;
};

/** Options, results and outputs of a study, each stated once: an option with its check; a value
    or a row of a table, which is printed, goes to JSON and CSV, may be drawn, and is compared
    with the references of the study (miniapps/data/references.json).

    All studies have the options --case, --json, --csv, --plot, --html, --save, --sweep and
   --verbose, and end with their references, sizes, times, counters and warnings. Made first: it
   holds the clock. */
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
   /// One of some words.
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
   /// Adds those that all studies have, and parses.
   void parse();
   /// True if a picture is wanted.
   bool draws() const { return has_picture() || !html_.empty(); }
   /// Is everything to be printed, and not only what most readers ask for?
   bool verbose() const { return verbose_; }
   /// True if its panels go to a file: JSON, CSV, a picture or the page.
   bool keeps_panels() const { return !json_.empty() || !csv_.empty() || draws(); }
   bool has_picture() const { return !plot_.empty(); }
   bool has_page() const { return !html_.empty(); }
   const std::string &csv() const { return csv_; } ///< prefix of its CSV files, if any

   /// To be called when the problem has been reduced: prints its size, writes it to the file of
   /// --save, if any, and counts what it took. With --check shows the scene, and leaves.
   void reduced(const Scene &scene);
   /// The same in two parts, for a problem that may still prove to be bad input.
   void condensed(const Scene &scene);
   void condensed(const cattaneo::ReducedProblem &problem, int dofs); ///< 0: it was read
   void save(const cattaneo::ReducedProblem &problem);

   /// A file or folder that is written while the study runs, which removes it if it ends as bad
   /// input. @param goes_on with what is there: that stays
   void begins(const std::string &path, bool goes_on = false);

   /// The march of the study goes on with one that ended so many cycles, and left CSV files.
   void goes_on_after(int cycles) { cycles_before_ = cycles; }
   /// Of these cycles the rows of a table that has a column "cycle".
   std::vector<nlohmann::ordered_json> rows_before(const std::string &table) const;
   /// The CSV file of another history of loads; none without --csv.
   std::string history_file();

   /// Frames for ParaView, of a scene that has been reduced, see Scene::fields().
   void write_frames(const std::string &folder, Scene &scene,
                     const std::vector<cattaneo::ContactState> &states);

   /// A heading of what is printed next.
   void title(const std::string &text);
   /// A line that is printed and nothing else.
   void say(const std::string &line);
   /// A number with the estimate of its error, if it has one (`key`_error_estimate in the
   /// results), printed with a label and a unit, if it has a label; without a key it is printed
   /// alone.
   void value(const std::string &key, double x, const std::string &label = "",
              double error = none, const std::string &unit = "");

   /// The table of that name, made if it is not there yet.
   ResultTable &table(const std::string &name, const std::vector<Column> &columns);
   /// A CSV file of a list of results that is printed line by line.
   void list(const std::string &name, const nlohmann::ordered_json &rows);
   /// Adds a row to a table, with the errors of the columns that have one. The row is compared
   /// with references of the key "table/column", whose conditions may name columns.
   void row(ResultTable &table, const std::vector<nlohmann::ordered_json> &values,
            const std::vector<std::pair<std::string, double>> &errors = {},
            const nlohmann::ordered_json &more = {});

   /// A panel of the figure; stays where it is.
   Panel &panel(Panel::Kind kind, const std::string &name, const std::string &title,
                const std::string &x_label, const std::string &y_label);
   /// One of curves.
   Panel &lines(const std::string &name, const std::string &title, const std::string &x_label,
                const std::string &y_label)
   {
      return panel(Panel::Kind::lines, name, title, x_label, y_label);
   }

   /// Where the increments of a march go that the page (--html) is to show; null if there is
   /// no page, or enough on it. Stays where it is.
   Film *film(const cattaneo::ReducedProblem &problem);

   /// A closed form beside what was computed, in the table of references.
   void compare(const std::string &name, double exact, Allowed allowed, double computed);

   nlohmann::ordered_json results;
   /// What the page begins with: "sentence", and "rows" of label, value and meaning.
   nlohmann::ordered_json lead;
   nlohmann::ordered_json sketch; ///< the bodies of the march, see Sketch
   cattaneo::Counters counters;
   Units units;  ///< of what is printed
   int code = 0; ///< that the study ends with, unless it ends early
   Stopwatch watch;

   /// Runs a study: its options, then what it does, then its outputs. The exit code.
   static int run(const std::string &name, int argc, char *argv[],
                  const std::function<void(Study &)> &body);

private:
   void finish();
   /// What --verbose prints at the end.
   void say_more(const cattaneo::BlasKernels &kernels);
   /// Has references.json an entry of this study with that key?
   bool is_compared(const std::string &key);
   /// The package cattaneo_show compares what was found with references.
   void compare_references();
   /// The tables and panels that have something in them.
   std::vector<Sheet> sheets() const;
   /// What pictures and the page show beside the results.
   nlohmann::ordered_json shown(const std::vector<Sheet> &sheets) const;
   void show_results(const nlohmann::ordered_json &run) const;
   /// Increments of more than a megabyte go to a file of their own, FILE.frames beside the
   /// JSON, whose name takes their place.
   void write_long_frames(nlohmann::ordered_json &marches) const;

   Options options_;
   std::string name_, json_, csv_, plot_, html_, save_, sweep_, sweep_results_;
   /// Removes what is in it when it goes.
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
   std::vector<std::function<Sheet()>> sheets_; ///< in the order of the figure
   /// To be compared at the end: values with their keys, and closed forms.
   nlohmann::ordered_json found_ = nlohmann::ordered_json::array(),
                          closed_ = nlohmann::ordered_json::array();
   std::string references_;               ///< the text of references.json, if it has the study
   std::map<std::string, bool> compared_; ///< what is_compared() said
   Eigen::Index nodes_ = 0;
   int dofs_ = 0;
   bool check_ = false, verbose_ = false, checked_ = false, saved_ = false;
   double seconds_ = 0; ///< up to the reduced problem
};

} // namespace miniapp
