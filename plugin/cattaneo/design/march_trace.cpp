#include <atomic>
#include <cattaneo/design/march_trace.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

std::uint64_t next_number()
{
   static std::atomic<std::uint64_t> last{0};
   return ++last;
}

} // namespace

std::size_t MarchTrace::at(double time) const
{
   require(!states.empty() && states.front().state.time <= time &&
              states.back().state.time >= time,
           "march trace: time ", time, " lies outside of the times of its states");
   std::size_t k = last();
   while (states[k].state.time > time) { --k; }
   return k;
}

MarchTrace trace_march(const ReducedProblem &problem, const LoadHistory &history,
                       ContactState &state, const MarchSettings &settings)
{
   MarchTrace trace;
   MarchSettings every = settings;
   every.every_event = true; // between two events the path is straight, which derivatives need

   trace.number = next_number();
   trace.history = history;
   trace.follows_path = settings.stepping != Stepping::fixed;
   trace.states.push_back({state});
   int piece = 0;
   const auto observe = [&](const ContactState &now, const IncrementRecord &record)
   {
      while (piece + 1 < history.pieces() && now.time > history.piece(piece).end) { ++piece; }
      const LoadPiece at = history.piece(piece);
      const double share = std::clamp((now.time - at.start) / at.duration(), 0.0, 1.0);
      trace.states.push_back({now, at.point, share, record.event});
   };
   trace.report = march(problem, history, state, every, observe);
   require(trace.report.taken_up_clearance == 0,
           "trace of march: a free body touches nothing at rest, and was moved by ",
           trace.report.taken_up_clearance,
           " before the march. This shift has no derivatives: the body must touch at the "
           "start, or be supported");
   return trace;
}

MarchTrace trace_march(const ReducedProblem &problem, const LoadHistory &history,
                       const MarchSettings &settings)
{
   ContactState state = ContactState::virgin(problem);
   return trace_march(problem, history, state, settings);
}

MarchTrace trace_wear(const ReducedProblem &problem, const WearLaw &law,
                      const LoadHistory &history, double cycles, WearState &state,
                      const WearSettings &settings)
{
   require(settings.tolerance == 0, "trace of wear: the tolerance is ", settings.tolerance,
           ", must be 0: skipped cycles have no states");
   MarchTrace trace;
   trace.number = next_number();
   trace.history = history;
   trace.history.cycles = static_cast<int>(std::clamp(cycles, 1.0, 1e9));
   trace.follows_path = settings.march.stepping != Stepping::fixed;
   trace.wear = law;
   trace.states.push_back({state.contact});
   trace.states[0].depth = state.depth;
   // The history of one cycle. wear() marches cycle after cycle, and time begins anew in each.
   LoadHistory once = history;
   once.cycles = 1;
   double cycles_before = 0;
   int piece = 0;
   const auto watch =
      [&](const ContactState &now, const IncrementRecord &record, const VectorXd &depth)
   {
      // If the time decreases, the next cycle has begun. Times of the trace continue to
      // increase.
      if (piece > 0 && now.time <= once.piece(piece).start)
      {
         piece = history.cycle_start;
         ++cycles_before;
      }
      while (piece + 1 < once.pieces() && now.time > once.piece(piece).end) { ++piece; }
      const LoadPiece at = once.piece(piece);
      const double share = std::clamp((now.time - at.start) / at.duration(), 0.0, 1.0),
                   cycle = once.piece(once.pieces() - 1).end - once.times[once.cycle_start];
      trace.states.push_back({now, at.point, share, record.event, depth});
      trace.states.back().state.time += cycles_before * cycle;
   };
   const WearReport report = wear(problem, law, history, cycles, state, settings, {}, watch);
   require(report.implicit_cycles == 0, "trace of wear: ", report.implicit_cycles,
           " cycles wore so much that their update was implicit, which has no derivatives: k "
           "must be smaller, because a cycle wears ",
           1 / report.explicit_limit, " of the depth that an explicit update allows");
   trace.report = report.last;
   trace.report.status = report.status;
   trace.report.message = report.message;
   return trace;
}

MarchTrace trace_wear(const ReducedProblem &problem, const WearLaw &law,
                      const LoadHistory &history, double cycles, const WearSettings &settings)
{
   WearState state = WearState::virgin(problem);
   return trace_wear(problem, law, history, cycles, state, settings);
}

std::vector<Tie> ties(const ReducedProblem &problem, const MarchTrace &trace, double tolerance)
{
   require_between("ties: tolerance", tolerance, 0, 1);
   const Index n = problem.nodes(), c = problem.components();
   std::vector<bool> held(n, false);
   for (Index row : problem.held) { held[row % n] = true; }
   std::vector<Tie> found;
   for (std::size_t k = trace.follows_path ? 0 : 1; k < trace.states.size(); ++k)
   {
      const ContactState &now = trace.states[k].state,
                         &before = trace.states[k > 0 ? k - 1 : 0].state;
      // Forces below this count as zero, relative to the largest force so far. At the start,
      // where there is no force yet, that of the first increment is the scale.
      const double tiny =
         tolerance *
         trace.states[std::min(std::max<std::size_t>(k, 1), trace.last())].state.peak_force;
      for (Index i = 0; i < n; ++i)
      {
         const NodeState taken = now.status[i];
         const double own = problem.C()(i, i);
         NodeState other = taken;
         double along = 0, way = 0; // |q| and |Δv|
         for (Index row = i; row < c * n; row += n)
         {
            along = std::hypot(along, now.q[row]);
            way = std::hypot(way, now.v[row] - before.v[row]);
         }
         // An open node that touches could stick.
         if (!closed(taken))
         {
            const VectorXd &worn = trace.states[k].depth;
            const double gap = problem.gap[i] + (worn.size() > 0 ? worn[i] : 0.0);
            if (own * (now.w[i] + gap) <= tiny) { other = NodeState::stick; }
         }
         // A closed node without force could be open.
         else if (now.p[i] <= tiny) { other = NodeState::separation; }
         // A node without friction, or held, has no other state.
         else if (c == 0 || held[i] || problem.friction[i] == 0) { continue; }
         // A slipping node that has hardly moved could stick.
         else if (taken != NodeState::stick)
         {
            if (problem.A()(i, i) * way <= tiny) { other = NodeState::stick; }
         }
         // A sticking node on the friction limit could slip.
         else if (friction_bound(problem, i).at(now.p[i], now.q[i] > 0 ? -1 : 1) - along <=
                  tiny)
         {
            other = c == 2         ? NodeState::slip
                    : now.q[i] < 0 ? NodeState::forward_slip
                                   : NodeState::backward_slip;
         }
         // The node whose event ended this step is not listed, because the path goes on
         // smoothly with its new state.
         if (other != taken && i != trace.states[k].event)
         {
            found.push_back({k, i, taken, other});
         }
      }
   }
   return found;
}

} // namespace cattaneo
