#pragma once

#include "common/run.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace miniapp
{

/// Extent of a contact that sticks at one end of its line and is open at the other: where it
/// separates and where stick ends, NaN where there is no such place.
struct Extent
{
   double separation = none, stick = none, separation_error = 0, stick_error = 0;
   std::vector<cattaneo::Zone> zones; ///< shifted like both of these

   /// The errors and the zones.
   nlohmann::ordered_json json() const
   {
      return {{"separation_error_estimate", separation_error},
              {"stick_error_estimate", stick_error},
              {"zones", to_json(zones)}};
   }
   std::vector<std::pair<std::string, double>> errors() const
   {
      return {{"separation", separation_error}, {"stick", stick_error}};
   }
};

/// @param sticks_first it sticks at the first node, else at the last one
/// @param shift added to arc lengths
Extent extent(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state,
              bool sticks_first, double shift);

/// A contact that recedes under one load, and how a study shows it.
struct Receding
{
   std::string load;                ///< the pattern
   Column level, separation, stick; ///< multiplier of the load, and its meaning
   std::string coordinate;          ///< the coordinate along the contact in pictures, …
   double shift = 0;                ///< … and its difference from the arc length
   std::string loss;                ///< name of the loss in a cycle
   std::function<Extent(const cattaneo::ContactState &)> extent;
};

/// Did the march reach the full load, with a state that is the only one or one of several?
bool has_state(const cattaneo::MarchReport &report);

/// Loads by name from rest, at several coefficients of friction: one condensed pair serves all.
/// A state without a solution, or with several, does not end a map: it is a row, and its
/// outcome is printed at the end. @param load name of the load of each of `wanted` @param row
/// takes the friction, the member of `wanted`, and the contact
void map_loads(Study &study, const ResultTable &table, cattaneo::ReducedProblem problem,
               const std::vector<double> &wanted, const std::vector<double> &frictions,
               const std::function<std::string(double)> &load,
               const std::function<void(double, double, const Run &)> &row);

/// The load is reduced to `lowest`, in steps of 1/steps that shrink with it.
struct Unloading
{
   int steps;
   double lowest;
   std::vector<double> wanted; ///< levels to report
   /// Names of the table and of the panel of tractions, the panel's title, and a word for
   /// the ends of zones in the table.
   std::string table, tractions, title, ends;
   double shown = none; ///< up to which coordinate tractions are drawn; none: all
};

/// Panels of an unloading, in which states are marked.
struct UnloadingPanels
{
   Panel &tractions, &zones;
};

/// Reduces the load from the loaded state of the run (thesis 5.3.2). @param note takes every
/// level and its state
UnloadingPanels
unload(Study &study, Run &run, const Receding &receding, const Unloading &wanted,
       const std::function<void(double, const cattaneo::ContactState &)> &note = {});

/** Marches cycles of the load between 1 and each of `lowest`, from the loaded state of the run
    (thesis 8.2, item 5). Reports the loss of each cycle, whether it dies out, and for the first
    `lowest` the zones and tractions of two cycles. Nodes open and close in a cycle, so that no
    theorem of shakedown applies: the result holds for the march from this start only. */
void cycle_the_load(Study &study, Run &run, const Receding &receding,
                    const std::vector<double> &lowest, int cycles);

/** Value of a parameter at which a quantity changes its sign. The first interval with a change,
    from `from` on, is divided again and again. NaN if there is no change. @param figures the
    quantity as a function of the parameter */
double changing(double from, double to,
                const std::function<std::vector<double>(const std::vector<double> &)> &figures);

} // namespace miniapp
