#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/stay_closed.hpp>

namespace cattaneo
{

using Eigen::Index;

StayedClosed stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                         double load_factor, int cycles, const Monitor &monitor)
{
   cycle.validate(problem);
   require(cycles >= 1, "stay_closed: there are ", cycles, " cycles, must be at least 1");
   const Eigen::MatrixXd vertices = cycle.multipliers(load_factor);
   std::vector<Eigen::VectorXd> points = {Eigen::VectorXd::Zero(cycle.constant.size()),
                                          cycle.constant};
   for (Index j = 0; j < vertices.cols(); ++j) { points.emplace_back(vertices.col(j)); }
   points.emplace_back(vertices.col(0));
   LoadHistory history = LoadHistory::through(points);
   history.cycle_start = 2;
   history.cycles = cycles;
   std::vector<bool> closed_so_far(static_cast<std::size_t>(problem.nodes()), true);
   const auto observe = [&](const ContactState &now, const IncrementRecord &record)
   {
      if (record.time < 1) { return; }
      const std::vector<NodeState> states = settled_states(problem, now);
      for (std::size_t i = 0; i < states.size(); ++i)
      {
         closed_so_far[i] = closed_so_far[i] && closed(states[i]);
      }
   };
   MarchSettings settings;
   settings.monitor = monitor;
   ContactState state = ContactState::virgin(problem);
   StayedClosed stayed;
   stayed.march = march(problem, history, state, settings, observe);
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      if (closed_so_far[static_cast<std::size_t>(i)]) { stayed.nodes.push_back(i); }
   }
   return stayed;
}

} // namespace cattaneo
