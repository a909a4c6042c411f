#include "lap_joint/bolted_loop.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <numeric>
#include <sstream>

namespace miniapp
{

using namespace cattaneo;

std::vector<NamedLoads> Joint::tightening(const std::vector<int> &order, double width,
                                          double pressure) const
{
   std::vector<NamedLoads> points(1);
   if (order.size() > 1 && snug > 0)
   {
      points.push_back(points.back());
      for (int bolt : order) { points.back()[pinch_load(bolt, width)] = snug * pressure; }
   }
   for (int bolt : order)
   {
      points.push_back(points.back());
      points.back()[pinch_load(bolt, width)] = pressure;
   }
   return points;
}

BoltedLoop pull(Run &run, std::vector<NamedLoads> points, double load, int cycles,
                const Observer &observe)
{
   BoltedLoop loop;
   const ReducedProblem &problem = run.solver.problem();
   const int tightened = static_cast<int>(points.size()) - 1;
   NamedLoads loaded = points.back(), released = points.back();
   loaded["T"] = load;
   released["T"] = 0;
   points.insert(points.end(), {loaded, released});
   LoadHistory history = LoadHistory::through(problem, points);
   history.cycle_start = tightened;
   history.cycles = cycles;
   SlipRange cycle(problem);
   const auto note = [&](const ContactState &now, const IncrementRecord &)
   {
      if (observe) { observe(now); }
      cycle.note(now);
      const double pieces = now.time - tightened; // of the cycles, complete at their ends
      if (pieces < 0 || std::abs(pieces - std::round(pieces)) >= 1e-12) { return; }
      const int piece = static_cast<int>(std::round(pieces));
      if (piece == 0) { loop.tightened = now; }
      else if (piece % 2 == 1)
      {
         loop.last_peak = now;
         if (piece == 1) { loop.first_peak = now; }
      }
      else
      {
         if (piece == 2) { loop.first_end = now; }
         loop.cycle_zones = zones(problem, loop.last_peak, cycle);
      }
      if (piece % 2 == 0) { cycle.start(now); }
   };
   run.state = ContactState::virgin(problem);
   loop.report = run.march(history, note);
   if (!loop.tightened.status.empty()) { loop.contact = contact_zone(problem, loop.tightened); }
   if (!loop.converged()) { return loop; }
   const auto before = settled_states(problem, loop.tightened),
              after = settled_states(problem, loop.last_peak);
   if ((!closed(before.front()) && closed(after.front())) ||
       (!closed(before.back()) && closed(after.back())))
   {
      warn("a free end of the laps touches under the remote load (option --touch finds where "
           "it begins): its corner presses on the other lap, and the loss there depends on the "
           "spacing of the nodes");
   }
   loop.pulled = contact_zone(problem, loop.first_peak);
   loop.stick_first = stick_zone(problem, loop.first_peak);
   // At a reload peak the nodes between the first and the steady border lie on the friction
   // limit and do not slip: the steady border is that of the nodes which slip in the cycle.
   loop.stick_steady = stick_zone(problem, loop.cycle_zones);
   return loop;
}

double touch_load(FrictionSolver &solver, NamedLoads loads, double limit)
{
   const ReducedProblem &problem = solver.problem();
   ContactState state = ContactState::virgin(problem);
   const auto solves = [&](ContactState &from) {
      return solver.solve(from, problem.multipliers(loads)).status == FrictionStatus::converged;
   };
   if (!solves(state)) { return none; }
   auto touches = [&](const ContactState &s)
   {
      const std::vector<NodeState> settled = settled_states(problem, s);
      return closed(settled.front()) || closed(settled.back());
   };
   if (touches(state)) { return 0; }
   double step = limit / 50, remote = 0;
   while (std::abs(step) > 1e-7 * std::abs(limit))
   {
      loads["T"] = remote + step;
      ContactState next = state;
      if (solves(next) && !touches(next) && std::abs(loads["T"]) <= std::abs(limit))
      {
         state = next;
         remote = loads["T"];
      }
      else { step *= 0.5; }
   }
   const double load = remote + 2 * step;
   return std::abs(load) < 0.999 * std::abs(limit) ? load : none;
}

std::vector<std::vector<int>> orders(const std::string &text, const std::vector<double> &bolts)
{
   const int count = static_cast<int>(bolts.size());
   std::vector<std::vector<int>> result;
   if (text.empty())
   {
      std::vector<int> order(count);
      std::iota(order.begin(), order.end(), 0);
      auto nearer = [&](int i, int k) { return std::abs(bolts[i]) < std::abs(bolts[k]); };
      std::stable_sort(order.begin(), order.end(), nearer);
      result.push_back(order);
      std::stable_sort(order.begin(), order.end(), [&](int i, int k) { return nearer(k, i); });
      if (order != result[0]) { result.push_back(order); }
      return result;
   }
   std::istringstream words(text);
   for (std::string part; std::getline(words, part, '/');)
   {
      std::vector<int> order;
      std::vector<bool> used(count, false);
      for (double number : numbers("--tightening", part))
      {
         const int bolt = static_cast<int>(number) - 1;
         require(bolt >= 0 && bolt < count && number == bolt + 1 && !used[bolt],
                 "option --tightening: ", number, " in '", part,
                 "' must be the number of a bolt (1 to ", count, "), once");
         used[bolt] = true;
         order.push_back(bolt);
      }
      require(static_cast<int>(order.size()) == count, "option --tightening: '", part, "' has ",
              order.size(), " bolts, there are ", count);
      result.push_back(order);
   }
   return result;
}

double asymmetry(const Eigen::VectorXd &forces, double size)
{
   const double largest = forces.cwiseAbs().maxCoeff();
   return largest > round_off * size
             ? (forces - forces.reverse()).cwiseAbs().maxCoeff() / largest
             : 0.0;
}

} // namespace miniapp
