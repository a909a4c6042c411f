#pragma once

#include "common/figure.hpp"
#include "common/miniapp.hpp"

#include <cattaneo/reduced/reduced_problem.hpp>

namespace miniapp
{

/// Where the results of a study go, and what all studies report. Made first: it holds the
/// clock.
class StudyOutput
{
public:
   /// --json, --csv, --plot and --save.
   void add_options(Options &args);

   /// To be called when the problem has been reduced: prints its size and writes it to the file
   /// of --save, if any.
   void reduced(const cattaneo::ReducedProblem &problem, int dofs);

   /// Prints the table, adds sizes, times, counters and references to the results, and writes
   /// the files that were asked for.
   void write(nlohmann::ordered_json &results, const cattaneo::Counters &counters,
              const ReferenceTable &table, const std::vector<Panel> &panels) const;

private:
   Stopwatch watch_;
   const char *json_ = "", *csv_ = "", *plot_ = "", *save_ = "";
   Eigen::Index nodes_ = 0;
   int dofs_ = 0;
   double seconds_ = 0; ///< up to the reduced problem
};

/// The option --save alone.
void add_save_option(Options &args, const char **file);

} // namespace miniapp
