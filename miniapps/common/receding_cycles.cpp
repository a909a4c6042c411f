#include "common/receding_cycles.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <utility>

namespace miniapp
{

using namespace cattaneo;

void cycle_the_load(Study &study, Run &run, const LoadCycles &wanted)
{
   const ReducedProblem &problem = run.solver.problem();
   const ContactState loaded = run.state;
   study.title("Cycles of the load (observed, not proven)");
   Table &table = study.table("load_cycles", {{"lowest", "lowest p/p0", "%.3g"},
                                              {"first_loss", "first loss", "%.3e"},
                                              {"last_loss", "last loss", "%.3e"},
                                              {"cycles", "cycles"},
                                              {"opening", "nodes that open and close"},
                                              {"outcome", "outcome"}});
   Panel &losses = study.panel(Panel::Kind::lines, "load_losses",
                               "Loss in each cycle of the load", "cycle", wanted.loss),
         &diagram =
            study.panel(Panel::Kind::zones, "load_cycle_zones",
                        exact_text("Zones in two cycles down to p/p0 = ", wanted.lowest[0]),
                        "load step", wanted.coordinate),
         &profiles = study.panel(Panel::Kind::lines, "load_cycle_tractions",
                                 "Pressure p and shear q over f in the cycles",
                                 wanted.coordinate, "p/p0, q/(f p0)");
   losses.say("scale: semilogy");
   const auto shown = [&](double arc_length) { return arc_length + wanted.shift; };
   const Eigen::VectorXd x = problem.arc_length.array() + wanted.shift;
   diagram.add(0, zones(problem, loaded), shown);
   profiles.add_tractions("loaded", x, problem, loaded);
   for (const double low : wanted.lowest)
   {
      run.state = loaded;
      run.state.dissipation = 0;
      std::vector<bool> opens(problem.nodes()), closes(problem.nodes());
      run.cycle(
         {{{wanted.load, low}}}, wanted.cycles,
         [&](const ContactState &now, const IncrementRecord &)
         {
            if (low == wanted.lowest[0] && now.time < 4 + 1e-9)
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
         });
      std::vector<double> number, loss;
      for (const CycleRecord &cycle : run.report.cycles)
      {
         number.push_back(cycle.cycle);
         loss.push_back(cycle.dissipation > 0 ? cycle.dissipation : none);
      }
      losses.add(exact_text("p/p0 down to ", low), number, loss, "marked");
      long both = 0;
      for (std::size_t i = 0; i < opens.size(); ++i) { both += opens[i] && closes[i]; }
      const double first = run.report.cycles.front().dissipation,
                   last = run.report.cycles.back().dissipation;
      const char *const outcome = last <= 1e-9 * first          ? "shaken down"
                                  : run.report.steady_cycle > 0 ? "slips for ever"
                                                                : "not steady yet";
      study.row(table, {low, first, last, run.report.cycles.size(), both, outcome});
   }
   run.state = loaded;
}

} // namespace miniapp
