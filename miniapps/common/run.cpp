#include "common/run.hpp"

#include "common/load_axes.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <tuple>

namespace miniapp
{

using namespace cattaneo;
using nlohmann::ordered_json;

Run::Run(Study &study, const ReducedProblem &problem, const MarchSettings &settings_)
   : state(ContactState::virgin(problem)), settings(settings_),
     solver(problem, settings_.friction), study_(study), film_(study.film(problem))
{
   study_.counters += solver.counters();
   const std::string file = study_.history_file();
   if (file.empty()) { return; }
   study_.begins(file);
   history_.emplace(file, problem);
}

std::vector<NamedLoads> Run::from_here(const std::vector<NamedLoads> &points) const
{
   std::vector<NamedLoads> all = {named(solver.problem(), state.multipliers)};
   for (const NamedLoads &point : points)
   {
      all.push_back(all.back());
      for (const auto &[name, value] : point) { all.back()[name] = value; }
   }
   return all;
}

const MarchReport &Run::to(const NamedLoads &loads, const MarchObserver &observe)
{
   return through({loads}, observe);
}

const MarchReport &Run::through(const std::vector<NamedLoads> &points,
                                const MarchObserver &observe)
{
   return march(LoadHistory::through(solver.problem(), from_here(points)), observe);
}

const MarchReport &Run::cycle(const std::vector<NamedLoads> &points, int cycles,
                              const MarchObserver &observe)
{
   std::vector<NamedLoads> all = from_here(points);
   all.push_back(all.front());
   LoadHistory history = LoadHistory::through(solver.problem(), all);
   history.cycle_start = 0;
   history.cycles = cycles;
   return march(history, observe);
}

const MarchReport &Run::march(const LoadHistory &history, const MarchObserver &observe)
{
   state.time = 0;
   const auto place = [&] { return std::make_pair(state.displacements(), state.multipliers); };
   if (history_ && left_ && *left_ != place())
   {
      IncrementRecord start = record_of(solver.problem(), state);
      start.time = began_;
      history_->add(state, start);
   }
   Watch watch("march");
   settings.monitor = watch.monitor();
   const auto note = [&](const ContactState &reached, const IncrementRecord &record)
   {
      if (film_ || history_)
      {
         IncrementRecord later = record;
         later.time += began_;
         if (film_) { film_->add(solver.problem(), reached, later); }
         if (history_) { history_->add(reached, later); }
      }
      if (observe) { observe(reached, record); }
   };
   report = cattaneo::march(solver, history, state, settings, note);
   settings.monitor = {};
   started = began_;
   began_ += report.time;
   left_ = place();
   study_.counters += report.counters;
   if (report.status != FrictionStatus::converged)
   {
      // Time goes on through all marches of the study, as in its history file.
      report.event_time += started;
      if (report.not_unique) { report.not_unique->time += started; }
   }
   // Ctrl-C ends a sweep as well.
   if (exit_code(solver.problem(), report) != 0 &&
       (leaves || report.status == FrictionStatus::stopped))
   {
      leave();
   }
   return report;
}

void Run::leave()
{
   add_outcome(solver.problem(), report, study_.results);
   // The cycles that were completed are results, if the study has not reported others.
   if (!report.cycles.empty() && !study_.results.contains("dissipation"))
   {
      report_cycles(study_, solver.problem(), report, unit);
   }
   throw Outcome();
}

double Run::load(const std::string &pattern) const
{
   return state.multipliers[solver.problem().pattern(pattern)];
}

void SteppingOptions::declare(Study &study)
{
   study.option(&stepping_, "stepping",
                "exact: from one change of state to the next. With torsion there is no exact "
                "path: increments are halved until contact advances by at most one node. "
                "fixed: equal increments.",
                {"exact", "fixed"});
}

void SteppingOptions::declare_with_events(Study &study)
{
   declare(study);
   study.option(&events_, "events",
                "List all changes of state of the exact path. Tables of the history then have "
                "a row for each change, not for each increment.");
   study.options().leave_out_of_cases("events");
}

void SteppingOptions::set(MarchSettings &settings) const
{
   settings.stepping = stepping_ == "fixed" ? Stepping::fixed : Stepping::exact;
   settings.every_event = events_;
}

void report_exact_path(Study &study, const Run &run)
{
   report_exact_path(study, run.solver.problem(), run.settings, run.report, run.started);
}

void report_exact_path(Study &study, const ReducedProblem &problem,
                       const MarchSettings &settings, const MarchReport &report, double started)
{
   if (settings.stepping != Stepping::exact || problem.components() != 1) { return; }
   study.say(text("exact path: %ld changes of state", report.events));
   study.results["state_changes"] = report.events;
   study.results["fallbacks"] = report.fallbacks;
   study.results["fallback_reason"] = report.fallback_reason;
   if (!settings.every_event) { return; }
   ordered_json &events = study.results["events"] = ordered_json::array();
   for (const StateChange &change : report.changes)
   {
      events.push_back({{"time", started + change.time},
                        {"loads", named(problem, change.multipliers)},
                        {"node", change.node},
                        {"from", name(change.from)},
                        {"to", name(change.to)}});
   }
   // The method that found each row of the march, and the node at whose change of state the row
   // ends.
   ordered_json &steps = study.results["steps"] = ordered_json::array();
   for (const IncrementRecord &record : report.increments)
   {
      steps.push_back({{"time", started + record.time},
                       {"loads", named(problem, record.multipliers)},
                       {"found_by", record.found_by},
                       {"event", record.event}});
   }
}

namespace
{

double product(const Loop &loop)
{
   return loop.force_range() * loop.displacement_range();
}

/// The scale of a loop's energy: the energies of all loads in its cycle, and that of its own
/// load.
double energy_about(const ReducedProblem &problem, const MarchReport &report,
                    const CycleRecord &cycle, std::size_t load)
{
   const Loop &loop = cycle.loops[load];
   const double range = problem.patterns[load].control == Control::force
                           ? loop.force_range()
                           : loop.displacement_range();
   double size = 0;
   for (const Loop &other : cycle.loops) { size = std::max(size, product(other)); }
   for (const IncrementRecord &record : report.increments)
   {
      size = std::max(size, range * std::abs(record.conjugates[static_cast<long>(load)]));
   }
   return size;
}

/// The loads that varied in any whole cycle. The others have no loop.
std::set<std::size_t> varied_loads(const MarchReport &report)
{
   std::set<std::size_t> varied;
   for (const CycleRecord &cycle : report.cycles)
   {
      for (std::size_t k = 0; cycle.whole && k < cycle.loops.size(); ++k)
      {
         if (!std::isnan(cycle.loops[k].stiffness())) { varied.insert(k); }
      }
   }
   return varied;
}

/// The work of a load in a cycle. It is zero if it is round-off of energies of this size or, in
/// a cycle without loss, if it is the error of the increments (CycleRecord::normal_work).
double without_error(double work, const CycleRecord &cycle, double size)
{
   const bool loses = settled(cycle.dissipation, size) != 0;
   if (!loses && std::abs(work) <= 2 * std::abs(cycle.normal_work)) { return 0; }
   return settled(work, size);
}

} // namespace

LoopFigures figures(const ReducedProblem &problem, const MarchReport &report,
                    const CycleRecord &cycle, std::size_t load)
{
   const Loop &loop = cycle.loops[load];
   const double size = energy_about(problem, report, cycle, load);
   LoopFigures of;
   of.moves = std::isnan(loop.stiffness()) || settled(product(loop), size) != 0;
   if (!of.moves) { return of; }
   of.work = without_error(loop.work(), cycle, size);
   of.stiffness = loop.stiffness();
   if (of.work != 0) { of.loss_factor = loop.loss_factor(); }
   return of;
}

double external_work(const ReducedProblem &problem, const MarchReport &report,
                     const CycleRecord &cycle)
{
   double size = 0;
   for (std::size_t k = 0; k < cycle.loops.size(); ++k)
   {
      size = std::max(size, energy_about(problem, report, cycle, k));
   }
   return without_error(cycle.external_work, cycle, size);
}

const ResultTable &report_cycles(Study &study, const ReducedProblem &problem,
                                 const MarchReport &report, double unit)
{
   std::vector<Column> columns = {
      {"cycle", "cycle"},
      {"dissipation", "dissipation" + study.units.total(1), "%.4e"},
      {"external_work", "external work" + study.units.total(1), "%.4e"},
      {"slip_change", "slip change" + study.units.of(0, 1), "%.2e"}};
   const std::vector<ordered_json> before = study.rows_before("cycles");
   std::set<std::size_t> varied = varied_loads(report);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      if (!before.empty() && before[0].contains("work " + problem.patterns[k].name))
      {
         varied.insert(k);
      }
   }
   for (std::size_t k : varied)
   {
      const std::string &load = problem.patterns[k].name;
      columns.push_back({"work " + load});
      columns.push_back(
         {"stiffness " + load,
          "stiffness " + load + load_axes(problem.patterns[k], study.units).stiffness_unit,
          "%.4e"});
      columns.push_back({"loss_factor " + load, "loss factor " + load, "%.4f"});
   }
   ResultTable &cycles = study.table("cycles", columns);
   ordered_json &losses = study.results["dissipation"] = ordered_json::array();
   std::set<std::string> still;
   // The first cycle, and two cycles that show whether they are steady.
   const auto whole = std::count_if(report.cycles.begin(), report.cycles.end(),
                                    [](const CycleRecord &cycle) { return cycle.whole; });
   const auto count = static_cast<long>(before.size()) + whole;
   long number = 0;
   const auto shown = [&]
   {
      ++number;
      return study.verbose() || number == 1 || number > count - 2;
   };
   for (const ordered_json &row : before)
   {
      cycles.quiet(!shown());
      study.row(cycles, cycles.values(row));
      losses.push_back(row["dissipation"]);
   }
   for (const CycleRecord &cycle : report.cycles)
   {
      if (!cycle.whole)
      {
         study.say(text("the march began within cycle %d, so that only a part of this cycle is "
                        "known; it is left out",
                        cycle.cycle));
         continue;
      }
      std::vector<ordered_json> row = {cycle.cycle, cycle.dissipation / unit,
                                       external_work(problem, report, cycle) / unit,
                                       cycle.slip_change};
      for (std::size_t k : varied)
      {
         const LoopFigures of = figures(problem, report, cycle, k);
         if (!of.moves) { still.insert(problem.patterns[k].name); }
         const LoadAxes axes = load_axes(problem.patterns[k], study.units);
         row.insert(row.end(), {of.work / unit, axes.stiffness(of.stiffness), of.loss_factor});
      }
      cycles.quiet(!shown());
      study.row(cycles, row);
      losses.push_back(cycle.dissipation / unit);
   }
   if (count > 3 && !study.verbose())
   {
      study.say(text("the other %ld cycles are in --json and --csv (--verbose prints them)",
                     count - 3));
   }
   for (const std::string &load : still)
   {
      study.say("load " + load +
                " does no work in a cycle, because the place where it acts does not move: it "
                "has no loop");
   }
   report_steady(study, report);
   add_loops(study, problem, report);
   return cycles;
}

namespace
{

/// Force over displacement of a load in the cycles of a march; empty if it did not vary.
struct LoopCurve
{
   std::vector<double> displacement, force;
};

LoopCurve loop_curve(const ReducedProblem &problem, const MarchReport &report, std::size_t load)
{
   const auto k = static_cast<Eigen::Index>(load);
   const LoadAxes axes = load_axes(problem.patterns[load], {});
   LoopCurve made;
   double least = 0, most = 0; // of its multiplier
   for (const IncrementRecord &record : report.increments)
   {
      // The cycles begin at the last state before them.
      if (record.cycle == 0) { made = {}; }
      const double multiplier = record.multipliers[k], conjugate = record.conjugates[k];
      least = made.force.empty() ? multiplier : std::min(least, multiplier);
      most = made.force.empty() ? multiplier : std::max(most, multiplier);
      made.displacement.push_back(axes.displacement_of(multiplier, conjugate));
      made.force.push_back(axes.force_of(multiplier, conjugate));
   }
   return least == most ? LoopCurve() : made;
}

/// Does the place where a load acts move in the last known cycle? Otherwise the loop is
/// round-off.
bool moves(const ReducedProblem &problem, const MarchReport &report, std::size_t load)
{
   for (auto cycle = report.cycles.rbegin(); cycle != report.cycles.rend(); ++cycle)
   {
      if (cycle->whole) { return figures(problem, report, *cycle, load).moves; }
   }
   return true;
}

/// A label for all curves: their common label if they have one, otherwise a general word.
std::string label_of_all(const std::vector<std::string> &labels, const std::string &otherwise)
{
   const bool same = std::all_of(labels.begin(), labels.end(),
                                 [&](const std::string &one) { return one == labels[0]; });
   return !labels.empty() && same ? labels[0] : otherwise;
}

} // namespace

void add_loops(Study &study, const ReducedProblem &problem, const MarchReport &report)
{
   std::vector<std::pair<std::string, LoopCurve>> curves;
   std::vector<LoadAxes> axes;
   std::vector<std::string> x, y;
   bool known = false, straight = true; // forces over displacements, no moments
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      LoopCurve curve = loop_curve(problem, report, k);
      if (curve.force.empty() || !moves(problem, report, k)) { continue; }
      curves.emplace_back(pattern.name, std::move(curve));
      axes.push_back(load_axes(pattern, study.units, problem.knows_loads()));
      x.push_back(axes.back().displacement);
      y.push_back(axes.back().force);
      known = known || !pattern.size.kind.empty();
      straight =
         straight && (pattern.size.kind == "force" || pattern.size.kind == "opposite forces" ||
                      pattern.size.kind == "displacement" || pattern.size.kind == "bolt");
   }
   // Loads of a study without sizes keep their own words.
   Panel &panel = study.lines(
      "loops",
      known ? "Force over displacement of each load, in its cycles" : "Force over displacement",
      !known ? "displacement"
             : label_of_all(x, straight ? "displacement" + study.units.of(0, 1)
                                        : "displacement or rotation"),
      !known ? "force"
             : label_of_all(y, straight ? "force" + study.units.total(0) : "force or moment"));
   for (std::size_t k = 0; k < curves.size(); ++k)
   {
      const auto &[name, curve] = curves[k];
      if (known)
      {
         panel.say("label x", name + "=" + x[k]);
         panel.say("label y", name + "=" + y[k]);
      }
      panel.add(name, curve.displacement, curve.force);
   }
}

void add_loops(Panel &panel, const ReducedProblem &problem, const MarchReport &report,
               const std::string &words)
{
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoopCurve curve = loop_curve(problem, report, k);
      panel.add(problem.patterns[k].name + words, curve.displacement, curve.force);
   }
}

void report_steady(Study &study, const MarchReport &report)
{
   if (report.steady_cycle > 0)
   {
      study.say(
         text("steady from cycle %d, period %d", report.steady_cycle, report.steady_period));
   }
   else if (!report.cycles.empty())
   {
      study.say(text("not steady after cycle %d", report.cycles.back().cycle));
   }
   study.results["steady_cycle"] = report.steady_cycle;
   study.results["steady_period"] = report.steady_period;
   study.results["energy_imbalance"] = report.energy_imbalance;
}

void report_loss_error(Study &study, const MarchReport &report)
{
   const LossError &error = report.loss_error;
   if (error.by.empty()) { return; } // no friction
   const char *word = error.bound ? "bound" : "estimate";
   study.results[std::string("loss_error_") + word] = error.value;
   study.results["loss_error_by"] = error.by;
   if (report.status == FrictionStatus::stopped) { return; } // on request
   if (std::isnan(error.value))
   {
      study.say("The error of the loss by the increments is not known: " + error.by);
   }
   else if (error.value > 0)
   {
      study.say(
         "The increments change the loss (the largest change, in all or of a cycle) by up to " +
         error_text(error.value) + " (" + word + ": " + error.by + ")");
   }
}

std::string event_text(double time, const NamedLoads &loads)
{
   std::vector<std::string> words;
   for (const auto &[name, value] : loads)
   {
      // Names of loads in studies contain numbers.
      const char *quote = name.find(' ') == std::string::npos ? "" : "'";
      words.push_back(told(quote, name, quote, " = ", value));
   }
   return told("time ", time, " (", listed(words), ")");
}

int exit_code(const ReducedProblem &problem, const MarchReport &report)
{
   ProgressLine::clear();
   warn_of_cut_off(report.cut_off);
   const auto say = [](const auto &...parts) {
      std::cout << "\n" << told(parts...) << std::endl;
   };
   if (report.fallbacks > 0)
   {
      // If a body is free to move, nothing proves that an increment has only one solution.
      const bool several = problem.rigid_motions.cols() > 0 && problem.friction.maxCoeff() > 0;
      say(report.fallbacks,
          " increments where there is no exact path: ", report.fallback_reason,
          several
             ? "; if only friction holds bodies such an increment may have several answers, of "
               "which one was chosen, and other increments or units may find another"
             : "");
   }
   if (report.advance_error > 1e-6)
   {
      say("Contact advanced with friction, so that friction forces depend on the increments: "
          "by up to ",
          error_text(report.advance_error), " of the largest nodal force");
   }
   if (report.stalled > 0)
   {
      const bool passed = report.status == FrictionStatus::converged ||
                          report.status == FrictionStatus::not_unique;
      say(report.stalled, " increments stalled and ",
          passed ? "were passed by shorter ones" : "shorter ones were tried in their place");
   }
   if (report.taken_up_clearance > 0)
   {
      say("Free bodies that touched nothing were moved before the march, by up to ",
          text("%.4g", report.taken_up_clearance),
          ", to where the first loads press them together");
   }
   if (report.status == FrictionStatus::converged) { return 0; }
   if (const auto &first = report.not_unique)
   {
      say("Not unique: from ", event_text(first->time, named(problem, first->multipliers)),
          " on, the states are one of several:\n  ", first->message);
   }
   if (report.status != FrictionStatus::not_unique)
   {
      say("Ended with status '", name(report.status), "' at ",
          event_text(report.event_time, named(problem, report.event_multipliers)), ":\n  ",
          report.message);
   }
   return 2;
}

void add_outcome(const ReducedProblem &problem, const MarchReport &report,
                 ordered_json &results)
{
   results["status"] = name(report.status);
   if (report.status == FrictionStatus::converged) { return; }
   results["message"] = report.message;
   results["event_time"] = report.event_time;
   results["event_loads"] = named(problem, report.event_multipliers);
   if (const auto &first = report.not_unique)
   {
      results["not_unique"] = {{"time", first->time},
                               {"loads", named(problem, first->multipliers)},
                               {"message", first->message}};
   }
}

void warn_of_cut_off(const std::vector<CutOffContact> &ends)
{
   // Once for each end, however many marches a study consists of.
   static std::set<std::tuple<Eigen::Index, bool, double, double>> known;
   for (const CutOffContact &end : ends)
   {
      if (known.insert({end.node, end.at_first, end.x, end.y}).second) { warn(end.message()); }
   }
}

std::vector<double> unloading_levels(int steps, double lowest, std::vector<double> wanted)
{
   double level = 1;
   while (level > lowest)
   {
      level = std::max(lowest, level - std::min(1.0 / steps, 0.2 * level));
      wanted.push_back(level);
   }
   std::sort(wanted.rbegin(), wanted.rend());
   std::vector<double> levels;
   for (double p : wanted)
   {
      if (p < 1 && (levels.empty() || levels.back() - p > 1e-9)) { levels.push_back(p); }
   }
   return levels;
}

std::size_t levels_one_way(const std::vector<double> &levels)
{
   std::size_t count = 0;
   double before = 0;
   for (; count < levels.size(); before = levels[count++])
   {
      const double now = levels[count];
      if (now * levels.front() < 0 || std::abs(now) < std::abs(before)) { break; }
   }
   return count;
}

std::vector<double> joined_once(std::vector<double> first, const std::vector<double> &others)
{
   for (double x : others)
   {
      if (std::find(first.begin(), first.end(), x) == first.end()) { first.push_back(x); }
   }
   return first;
}

double half_width(const Zone &zone)
{
   return zone.last < zone.first ? 0.0 : 0.5 * (zone.to.position - zone.from.position);
}

double read_out_error(const Zone &zone)
{
   return std::max(zone.from.error, zone.to.error);
}

ordered_json to_json(const std::vector<Zone> &zones, double shift)
{
   ordered_json list = ordered_json::array();
   for (const Zone &zone : zones)
   {
      list.push_back({{"state", name(zone.state)},
                      {"from", zone.from.position + shift},
                      {"to", zone.to.position + shift},
                      {"from_error_estimate", zone.from.error},
                      {"to_error_estimate", zone.to.error}});
   }
   return list;
}

} // namespace miniapp
