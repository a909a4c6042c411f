#include "common/receding_cycles.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <cattaneo/readout/zones.hpp>

namespace miniapp
{

using namespace cattaneo;

void cycle_the_load(Study &study, Run &run, const std::string &load,
                    const std::vector<double> &lowest, int cycles)
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
                               "Loss in each cycle of the load", "cycle", "D E'/(p0 t)²");
   losses.say("scale: semilogy");
   for (const double low : lowest)
   {
      run.state = loaded;
      run.state.dissipation = 0;
      std::vector<bool> opens(problem.nodes()), closes(problem.nodes());
      run.cycle({{{load, low}}}, cycles,
                [&](const ContactState &now, const IncrementRecord &)
                {
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
