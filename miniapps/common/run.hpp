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

/** A contact under way: its solver, the state that it stands in, and how it got there. What it
    counts goes to the study, and with --csv its increments, see HistoryWriter, to
    PREFIX_history.csv, of another one to PREFIX_history_2.csv, …, in the order in which they
    were marched, with a time that goes on from one march to the next. One that sets out from
    another state than the one before ended with begins there with a row of that state. Where
    there is no equilibrium it says so, notes it in the results
    (`status`, `message`, `event_time`, `event_loads`, `not_unique`) and leaves the study. */
class Run
{
public:
   /// The problem must outlive it.
   Run(Study &study, const cattaneo::ReducedProblem &problem,
       const cattaneo::MarchSettings &settings = {});

   /// From where it stands straight to these loads; a pattern that is not named keeps its
   /// value.
   const cattaneo::MarchReport &to(const cattaneo::NamedLoads &loads,
                                   const cattaneo::MarchObserver &observe = {});
   /// The same through several points.
   const cattaneo::MarchReport &through(const std::vector<cattaneo::NamedLoads> &points,
                                        const cattaneo::MarchObserver &observe = {});
   /// A cycle through these points and back to where it stands, so many times (fewer once it is
   /// steady, if the settings say so).
   const cattaneo::MarchReport &cycle(const std::vector<cattaneo::NamedLoads> &points,
                                      int cycles, const cattaneo::MarchObserver &observe = {});
   /// Any history that begins with the loads of the state, whose time it starts anew.
   const cattaneo::MarchReport &march(const cattaneo::LoadHistory &history,
                                      const cattaneo::MarchObserver &observe = {});

   /// Leaves the study with the outcome of the last march, which did not converge: for those
   /// that first show what there is.
   void leave();

   /// The multiplier of a pattern.
   double load(const std::string &pattern) const;

   /// Whether it leaves the study where there is no equilibrium; else the report says so, and
   /// nothing is noted. It leaves the study where it was stopped, whatever this says.
   bool leaves = true;
   double unit = 1; ///< of the energies of cycles, if it leaves the study within them
   cattaneo::ContactState state; ///< a copy put back is where the run goes on from
   cattaneo::MarchSettings settings;
   /// Of the last march; the time of what it came to is the history's, the others begin with
   /// the march.
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
   /// Displacements and multipliers that the last march ended with.
   std::optional<std::pair<Eigen::VectorXd, Eigen::VectorXd>> left_;
};

/// How a history is marched, the same in every program: --stepping, and --events where the
/// events of a path are reported.
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

/// Of an exact march: the number of its changes of state, printed, and with
/// MarchSettings::every_event their list and that of the rows, in the results; and whether
/// increments were taken instead. Nothing for other marches.
void report_exact_path(Study &study, const Run &run);
/// @param started time of the history at which the march began
void report_exact_path(Study &study, const cattaneo::ReducedProblem &problem,
                       const cattaneo::MarchSettings &settings,
                       const cattaneo::MarchReport &report, double started = 0);

/// What is printed of the loop of a load in a cycle, without what is round-off of the energies
/// that are there.
struct LoopFigures
{
   /// Does the load move what it acts on? Forces on held nodes do not.
   bool moves = false;
   double work = 0;
   /// None of a load that moves nothing, and no loss factor of one that loses nothing.
   double stiffness = none, loss_factor = none;
};
LoopFigures figures(const cattaneo::ReducedProblem &problem,
                    const cattaneo::MarchReport &report, const cattaneo::CycleRecord &cycle,
                    std::size_t load);
/// Work of all loads in a cycle, likewise.
double external_work(const cattaneo::ReducedProblem &problem,
                     const cattaneo::MarchReport &report, const cattaneo::CycleRecord &cycle);

/// A table of the cycles of a march, after those that Study::rows_before() has, with the loops
/// of the loads that vary (cattaneo::Loop), which are drawn, and from where on they are steady;
/// `dissipation`, `steady_cycle`, `steady_period` and `energy_imbalance` of the results.
/// Energies are printed in `unit`s. A cycle of which the rest alone is known is left out, and
/// that is said.
const ResultTable &report_cycles(Study &study, const cattaneo::ReducedProblem &problem,
                                 const cattaneo::MarchReport &report, double unit = 1);

/// Force over displacement in the cycles of a march, of each load that varied in them and moved
/// what it acts on, in physical units where the size of the load is known: the panel `loops`.
void add_loops(Study &study, const cattaneo::ReducedProblem &problem,
               const cattaneo::MarchReport &report);
/// The same of each load that varied, in a panel that is there. A curve has the load's name and
/// these words.
void add_loops(Panel &panel, const cattaneo::ReducedProblem &problem,
               const cattaneo::MarchReport &report, const std::string &words = "");

/// From where on the cycles are steady, and how well energies balance: `steady_cycle`,
/// `steady_period` and `energy_imbalance`.
void report_steady(Study &study, const cattaneo::MarchReport &report);

/// How far the loss may be from that of the path (MarchSettings::loss_error):
/// `loss_error_bound` or `loss_error_estimate`, and `loss_error_by`. A sentence where
/// increments are not exact.
void report_loss_error(Study &study, const cattaneo::MarchReport &report);

/// Where a march came to an event, in words: "time 0.3 (P = 1, 'n = 4' = 0.2)".
std::string event_text(double time, const cattaneo::NamedLoads &loads);

/// Exit code of a march's outcome; prints where and why it ended early, was not unique or left
/// its exact path, and by how much its increments matter where contact advanced with friction.
int exit_code(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report);
/// Adds the status of a march and, of one that is not `converged`, what there is to say: where
/// and why it ended (`message`, `event_time`, `event_loads`), and from where on its states are
/// one of several (`not_unique`).
void add_outcome(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report,
                 nlohmann::ordered_json &results);

/// Warns of contact that reached an end of its line where the bodies go on, once for each end.
void warn_of_cut_off(const std::vector<cattaneo::CutOffContact> &ends);

/// Levels of a load that is taken back, descending from below 1 to `lowest`: steps of 1/steps
/// that shrink with the load, and all of `wanted`. None is a round-off away from another: the
/// states of so small a step would be noise.
std::vector<double> unloading_levels(int steps, double lowest, std::vector<double> wanted);

/// The number of levels of a load, the first of a list, that lead away from 0 without turning
/// back: what is known of monotonic loading holds for these.
std::size_t levels_one_way(const std::vector<double> &levels);

/// Of two lists all that is in either, once, in this order.
std::vector<double> joined_once(std::vector<double> first, const std::vector<double> &others);

/// Of a stretch of contact or stick: none is of width 0, and borders have errors.
double half_width(const cattaneo::Zone &zone);
double read_out_error(const cattaneo::Zone &zone);

/// Zones as they go to JSON, each {"state", "from", "to", "from_error_estimate",
/// "to_error_estimate"}, with positions that are shifted. A table prints their states and where
/// they end.
nlohmann::ordered_json to_json(const std::vector<cattaneo::Zone> &zones, double shift = 0);

} // namespace miniapp
