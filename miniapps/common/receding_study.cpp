#include "common/receding_study.hpp"

#include <algorithm>
#include <cattaneo/readout/zones.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;

Extent extent(const ReducedProblem &problem, const ContactState &state, bool sticks_first,
              double shift)
{
   Extent result;
   result.zones = zones(problem, state);
   for (Zone &zone : result.zones)
   {
      zone.from.position += shift;
      zone.to.position += shift;
   }
   const std::size_t count = result.zones.size(), open = sticks_first ? count - 1 : 0,
                     held = count - 1 - open;
   // The border on the side of the other end.
   const auto inner = [&](std::size_t k) -> const ZoneBorder &
   { return k == 0 ? result.zones[k].to : result.zones[k].from; };
   if (!closed(result.zones[open].state))
   {
      result.separation = inner(open).position;
      result.separation_error = inner(open).error;
   }
   if (result.zones[held].state == NodeState::stick && count > 1)
   {
      result.stick = inner(held).position;
      result.stick_error = inner(held).error;
      // Slip within the last spacing before the end of contact is not visible.
      const Eigen::Index last =
         sticks_first ? result.zones[held].last + 1 : result.zones[held].first;
      if (!slips(result.zones[sticks_first ? 1 : count - 2].state))
      {
         result.stick_error = problem.arc_length[last] - problem.arc_length[last - 1];
      }
   }
   return result;
}

namespace
{

/// Columns border_1 … border_4 of a table: where the first zones end, with their errors.
void add_borders(const std::vector<Zone> &zones, std::vector<nlohmann::ordered_json> &row,
                 std::vector<std::pair<std::string, double>> &errors)
{
   for (std::size_t k = 0; k < 4; ++k)
   {
      const bool there = k < zones.size();
      row.push_back(there ? zones[k].to.position : none);
      errors.emplace_back(text("border_%zu", k + 1), there ? zones[k].to.error : none);
   }
}

} // namespace

bool has_state(const MarchReport &report)
{
   return report.status == FrictionStatus::converged ||
          report.status == FrictionStatus::not_unique;
}

void map_loads(Study &study, const ResultTable &table, ReducedProblem problem,
               const std::vector<double> &wanted, const std::vector<double> &frictions,
               const std::function<std::string(double)> &load,
               const std::function<void(double, double, const Run &)> &row)
{
   const Stopwatch watch;
   std::vector<std::vector<NodeState>> guesses(wanted.size());
   std::size_t failed = 0;
   for (double friction : frictions)
   {
      set_friction(problem, friction);
      Run run(study, problem);
      run.leaves =
         false; // a state without a solution is a row, and the others are still computed
      for (std::size_t k = 0; k < wanted.size(); ++k)
      {
         run.state = ContactState::virgin(problem);
         // The search starts from the node states at the previous coefficient of friction.
         if (!guesses[k].empty()) { run.state.status = guesses[k]; }
         run.to({{load(wanted[k]), 1}});
         row(friction, wanted[k], run);
         const bool converged = run.report.status == FrictionStatus::converged;
         failed += !converged;
         if (converged) { guesses[k] = run.state.status; }
      }
   }
   study.results["seconds_map"] = watch.seconds();
   study.say(text("map of %zu states in %.2f s", table.json().size(), watch.seconds()));
   if (failed == 0) { return; }
   study.code = 2;
   study.results["status"] = "ended early";
   study.results["message"] = text("%zu of %zu states of the map have no solution, or several",
                                   failed, table.json().size());
   study.say(study.results["message"].get<std::string>());
}

UnloadingPanels unload(Study &study, Run &run, const Receding &receding,
                       const Unloading &wanted,
                       const std::function<void(double, const ContactState &)> &note)
{
   const ReducedProblem &problem = run.solver.problem();
   const std::string &name = receding.level.heading, &along = receding.coordinate;
   const VectorXd x = problem.arc_length.array() + receding.shift;
   const Eigen::Index shown =
      std::isnan(wanted.shown) ? x.size() : (x.array() < wanted.shown).count();
   Panel &profiles = study.lines(wanted.tractions, wanted.title, along, "p/p0, q/(f p0)"),
         &diagram =
            study.panel(Panel::Kind::zones, "zones", "Zones during unloading", name, along);
   const auto add_profile = [&](double level, const ContactState &state)
   { profiles.add_tractions(exact_text(name + " = ", level), x, problem, state, 0, shown); };
   add_profile(1, run.state);
   diagram.add(1.0, receding.extent(run.state).zones);
   ResultTable &table = study.table(
      wanted.table, {receding.level,
                     receding.separation,
                     receding.stick,
                     {"border_1"},
                     {"border_2"},
                     {"border_3"},
                     {"border_4"},
                     {"zones", "zones and their " + wanted.ends + " ends, " + along}});
   const auto observe = [&](const ContactState &now, const IncrementRecord &)
   {
      const double level = named(problem, now.multipliers).at(receding.load);
      const Extent found = receding.extent(now);
      diagram.add(level, found.zones);
      if (note) { note(level, now); }
      const auto target =
         std::find_if(wanted.wanted.begin(), wanted.wanted.end(),
                      [&](double value) { return std::abs(level - value) < 1e-9; });
      if (target == wanted.wanted.end()) { return; }
      std::vector<nlohmann::ordered_json> row = {*target, found.separation, found.stick};
      std::vector<std::pair<std::string, double>> errors = {
         {receding.separation.key, found.separation_error},
         {receding.stick.key, found.stick_error}};
      const nlohmann::ordered_json more = {
         {receding.separation.key + "_error_estimate", found.separation_error},
         {receding.stick.key + "_error_estimate", found.stick_error}};
      add_borders(found.zones, row, errors);
      row.push_back(to_json(found.zones));
      study.row(table, row, errors, more);
      add_profile(*target, now);
   };
   std::vector<NamedLoads> points;
   for (double level : unloading_levels(wanted.steps, wanted.lowest, wanted.wanted))
   {
      points.push_back({{receding.load, level}});
   }
   run.settings.increments = 1;
   run.through(points, observe);
   diagram.say("reversed", "x");
   return {profiles, diagram};
}

namespace
{

/// Has the loss of the first cycle vanished, apart from the round-off of friction and slip?
bool dies_out(const std::vector<double> &losses, const ContactState &loaded)
{
   const double rubbed = loaded.q.cwiseAbs().dot(loaded.v.cwiseAbs());
   return losses.back() <= std::max(1e-9 * losses.front(), 1e-12 * rubbed);
}

/// Factor by which the loss falls per cycle, from the last cycle and the one a period before; 1
/// if it falls by less than a thousandth, so that it has settled.
double falls(const std::vector<double> &losses, int period)
{
   constexpr double settled = 1e-3;
   const auto count = static_cast<int>(losses.size());
   if (count <= period) { return 1; }
   const double factor = losses[count - 1] / losses[count - 1 - period];
   return factor < 1 - settled ? std::pow(factor, 1.0 / period) : 1;
}

} // namespace

void cycle_the_load(Study &study, Run &run, const Receding &receding,
                    const std::vector<double> &lowest, int cycles)
{
   const ReducedProblem &problem = run.solver.problem();
   const ContactState loaded = run.state;
   study.title("Cycles of the load (observed, not proven)");
   ResultTable &table = study.table("load_cycles", {{"lowest", "lowest p/p0", "%.3g"},
                                                    {"first_loss", "first loss", "%.3e"},
                                                    {"last_loss", "last loss", "%.3e"},
                                                    {"cycles", "cycles"},
                                                    {"opening", "nodes that open and close"},
                                                    {"outcome", "outcome"}});
   Panel &losses = study.lines("load_losses", "Loss in each cycle of the load", "cycle",
                               receding.loss),
         &diagram = study.panel(Panel::Kind::zones, "load_cycle_zones",
                                exact_text("Zones in two cycles down to p/p0 = ", lowest[0]),
                                "time", receding.coordinate),
         &profiles =
            study.lines("load_cycle_tractions", "Pressure p and shear q over f in the cycles",
                        receding.coordinate, "p/p0, q/(f p0)");
   losses.say("scale", "semilogy");
   const auto shown = [&](double arc_length) { return arc_length + receding.shift; };
   const Eigen::VectorXd x = problem.arc_length.array() + receding.shift;
   diagram.add(0, zones(problem, loaded), shown);
   profiles.add_tractions("loaded", x, problem, loaded);
   for (const double low : lowest)
   {
      run.state = loaded;
      run.state.dissipation = 0;
      std::vector<bool> opens(problem.nodes()), closes(problem.nodes());
      std::vector<double> all; // the loss of each cycle
      const auto march_on = [&](int count)
      {
         const bool begins = all.empty();
         const auto observe = [&](const ContactState &now, const IncrementRecord &)
         {
            if (begins && low == lowest[0] && now.time < 4 + 1e-9)
            {
               diagram.add(now.time, zones(problem, now), shown);
               for (const auto &[time, name] :
                    {std::pair{1, "taken back"}, {2, "loaded again"}, {3, "taken back again"}})
               {
                  if (std::abs(now.time - time) > 1e-9) { continue; }
                  profiles.add_tractions(name, x, problem, now);
               }
            }
            const std::vector<NodeState> states = settled_states(problem, now);
            for (std::size_t i = 0; i < states.size(); ++i)
            {
               (closed(states[i]) ? closes : opens)[i] = true;
            }
         };
         run.cycle({{{receding.load, low}}}, count, observe);
         for (const CycleRecord &cycle : run.report.cycles)
         {
            all.push_back(cycle.dissipation);
         }
      };
      march_on(cycles);
      // Slip counts as steady once its change is small compared with all slip. A loss that
      // still falls by a constant factor in each cycle goes to zero nevertheless.
      const int period = std::max(1, run.report.steady_period);
      while (static_cast<int>(all.size()) < cycles && !dies_out(all, loaded) &&
             falls(all, period) < 1)
      {
         march_on(1);
      }
      std::vector<double> number, loss;
      for (double one : all)
      {
         number.push_back(static_cast<double>(number.size() + 1));
         loss.push_back(one > 0 ? one : none);
      }
      losses.add(exact_text("p/p0 down to ", low), number, loss, "marked");
      long both = 0;
      for (std::size_t i = 0; i < opens.size(); ++i) { both += opens[i] && closes[i]; }
      const double factor = falls(all, period);
      const std::string outcome = dies_out(all, loaded) ? "shaken down"
                                  : factor < 1
                                     ? text("still falls, by a factor %.2g a cycle", factor)
                                  : run.report.steady_cycle > 0 ? "slips for ever"
                                                                : "not steady yet";
      study.row(table, {low, all.front(), all.back(), all.size(), both, outcome});
   }
   run.state = loaded;
}

double changing(double from, double to,
                const std::function<std::vector<double>(const std::vector<double> &)> &figures)
{
   constexpr int parts = 16, rounds = 3;
   for (int round = 0; round < rounds; ++round)
   {
      std::vector<double> at;
      for (int k = 0; k <= parts; ++k) { at.push_back(from + (to - from) * k / parts); }
      const std::vector<double> values = figures(at);
      int k = 1;
      while (k <= parts && (values[k] > 0) == (values[0] > 0)) { ++k; }
      if (k > parts) { return none; }
      from = at[k - 1];
      to = at[k];
   }
   return 0.5 * (from + to);
}

} // namespace miniapp
