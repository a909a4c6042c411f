#pragma once

#include "common/study.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/output/history.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace miniapp
{

/** A contact that is marched: its solver, its present state, and the marches so far. Its
    counters go to the study. With --csv its increments, see HistoryWriter, go to
    PREFIX_history.csv, those of a second Run to PREFIX_history_2.csv, …, in their order, with a
    time that goes on from one march to the next. If a march begins at another state than the
    end of the one before, the file gets a row of that state. If there is no equilibrium, Run
    says so, writes it into the results (`status`, `message`, `event_time`, `event_loads`,
    `not_unique`) and leaves the study. */
class Run
{
public:
   /// The problem must outlive it.
   Run(Study &study, const cattaneo::ReducedProblem &problem,
       const cattaneo::MarchSettings &settings = {});

   /// Marches from the present loads straight to these; a pattern that is not named keeps its
   /// value.
   const cattaneo::MarchReport &to(const cattaneo::NamedLoads &loads,
                                   const cattaneo::MarchObserver &observe = {});
   /// Marches through several points.
   const cattaneo::MarchReport &through(const std::vector<cattaneo::NamedLoads> &points,
                                        const cattaneo::MarchObserver &observe = {});
   /// Marches a cycle through these points and back to the present loads, so many times (fewer
   /// if it becomes steady and the settings allow it).
   const cattaneo::MarchReport &cycle(const std::vector<cattaneo::NamedLoads> &points,
                                      int cycles, const cattaneo::MarchObserver &observe = {});
   /// Marches any history that begins with the loads of the state. The time of the state begins
   /// anew.
   const cattaneo::MarchReport &march(const cattaneo::LoadHistory &history,
                                      const cattaneo::MarchObserver &observe = {});

   /// Leaves the study with the outcome of the last march, which did not converge. For studies
   /// that first show their results.
   void leave();

   /// The present multiplier of a pattern.
   double load(const std::string &pattern) const;

   /// Does it leave the study if there is no equilibrium? If not, only the report says so. It
   /// always leaves the study if it was stopped.
   bool leaves = true;
   double unit = 1; ///< of the energies of cycles, for a study that is left within them
   cattaneo::ContactState
      state; ///< if it is replaced by an earlier copy, the run goes on from that
   cattaneo::MarchSettings settings;
   /// The report of the last march. The time of its outcome is that of the history; other times
   /// begin with the march.
   cattaneo::MarchReport report;
   double started = 0; ///< time of the history at which the last march began
   cattaneo::FrictionSolver solver;

private:
   std::vector<cattaneo::NamedLoads>
   from_here(const std::vector<cattaneo::NamedLoads> &points) const;
   Study &study_;
   Film *film_;
   std::optional<cattaneo::HistoryWriter> history_;
   double began_ = 0; ///< time of the history, at the start of a march
   /// Displacements and multipliers at the end of the last march.
   std::optional<std::pair<Eigen::VectorXd, Eigen::VectorXd>> left_;
};

/// Options on how a history is marched, the same in every program: --stepping, and --events in
/// programs that report the events of a path.
class SteppingOptions
{
public:
   void declare(Study &study);
   void declare_with_events(Study &study);
   /// After parsing.
   void set(cattaneo::MarchSettings &settings) const;

private:
   std::string stepping_ = "exact";
   bool events_ = false;
};

/// For an exact march: prints the number of its changes of state, and whether increments were
/// taken instead. With MarchSettings::every_event the results get the list of the changes and
/// that of the rows. Does nothing for other marches.
void report_exact_path(Study &study, const Run &run);
/// @param started time of the history at which the march began
void report_exact_path(Study &study, const cattaneo::ReducedProblem &problem,
                       const cattaneo::MarchSettings &settings,
                       const cattaneo::MarchReport &report, double started = 0);

/// The printed values of a load's loop in a cycle; values that are round-off of the energies
/// are left out.
struct LoopFigures
{
   /// Does the place where the load acts move? Held nodes do not.
   bool moves = false;
   double work = 0;
   /// Not known for a load whose place does not move; no loss factor if no energy is lost.
   double stiffness = none, loss_factor = none;
};
LoopFigures figures(const cattaneo::ReducedProblem &problem,
                    const cattaneo::MarchReport &report, const cattaneo::CycleRecord &cycle,
                    std::size_t load);
/// Work of all loads in a cycle; 0 if it is round-off of the energies.
double external_work(const cattaneo::ReducedProblem &problem,
                     const cattaneo::MarchReport &report, const cattaneo::CycleRecord &cycle);

/// A table of the cycles of a march. The rows of Study::rows_before() come first. It has the
/// loops of the loads that vary (cattaneo::Loop), which are also drawn. Writes `dissipation`,
/// `steady_cycle`, `steady_period` and `energy_imbalance` into the results. Energies are
/// printed in multiples of `unit`. If only the rest of a cycle is known, the cycle is left out,
/// and a line says so.
const ResultTable &report_cycles(Study &study, const cattaneo::ReducedProblem &problem,
                                 const cattaneo::MarchReport &report, double unit = 1);

/// Force over displacement in the cycles of a march, for each load that varied in them and
/// whose place moved, in physical units if the size of the load is known: the panel `loops`.
void add_loops(Study &study, const cattaneo::ReducedProblem &problem,
               const cattaneo::MarchReport &report);
/// The same for each load that varied, in a given panel. The label of a curve is the load's
/// name and these words.
void add_loops(Panel &panel, const cattaneo::ReducedProblem &problem,
               const cattaneo::MarchReport &report, const std::string &words = "");

/// Reports the cycle from which on cycles are steady, and the balance of energies:
/// `steady_cycle`, `steady_period` and `energy_imbalance`.
void report_steady(Study &study, const cattaneo::MarchReport &report);

/// Reports the error of the loss, compared with the exact path (MarchSettings::loss_error):
/// `loss_error_bound` or `loss_error_estimate`, and `loss_error_by`. Prints a sentence if
/// increments are not exact.
void report_loss_error(Study &study, const cattaneo::MarchReport &report);

/// Time and loads of an event in words: "time 0.3 (P = 1, 'n = 4' = 0.2)".
std::string event_text(double time, const cattaneo::NamedLoads &loads);

/// Exit code of a march's outcome. Prints where and why the march ended early, was not unique
/// or left its exact path, and the error of friction forces if contact advanced in increments.
int exit_code(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report);
/// Adds the status of a march to the results. If it is not `converged`, also where and why it
/// ended (`message`, `event_time`, `event_loads`), and from where on there may be other states
/// (`not_unique`).
void add_outcome(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report,
                 nlohmann::ordered_json &results);

/// Warns of contact that reached an end of its line although the bodies go on there, once for
/// each end.
void warn_of_cut_off(const std::vector<cattaneo::CutOffContact> &ends);

/// Levels of a load that is reduced, descending from below 1 to `lowest`: steps of 1/steps that
/// shrink with the load, and all of `wanted`. No two levels differ only by round-off, because
/// the states of so small a step would be noise.
std::vector<double> unloading_levels(int steps, double lowest, std::vector<double> wanted);

/// The number of levels at the beginning of a list that lead away from 0 without a reversal.
/// Closed forms for monotonic loading hold for these.
std::size_t levels_one_way(const std::vector<double> &levels);

/// All entries of two lists, each once, in their order.
std::vector<double> joined_once(std::vector<double> first, const std::vector<double> &others);

/// Half-width of a stretch of contact or stick, and the error of its borders. Both are 0 if
/// there is no such stretch.
double half_width(const cattaneo::Zone &zone);
double read_out_error(const cattaneo::Zone &zone);

/// Zones for JSON, each {"state", "from", "to", "from_error_estimate", "to_error_estimate"},
/// with shifted positions. A table prints their states and ends.
nlohmann::ordered_json to_json(const std::vector<cattaneo::Zone> &zones, double shift = 0);

} // namespace miniapp
