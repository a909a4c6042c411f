#include <cattaneo/friction/advance.hpp>
#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

using Eigen::Index;

bool closes(const ReducedProblem &problem, const ContactState &before,
            const ContactState &after)
{
   const std::vector<NodeState> settled = settled_states(problem, after);
   for (std::size_t i = 0; i < settled.size(); ++i)
   {
      if (closed(settled[i]) && !closed(before.status[i])) { return true; }
   }
   return false;
}

bool advances_too_far(const ReducedProblem &problem, const ContactState &before,
                      const ContactState &after)
{
   // Nodes that touch without force open and close by round-off. This does not count as an
   // advance.
   const std::vector<NodeState> settled = settled_states(problem, after);
   for (const ContactChain &chain : problem.chains)
   {
      const Index first = chain.first, count = chain.nodes;
      const auto was_closed = [&](Index k)
      {
         if (chain.loop) { k = (k + count) % count; }
         return k >= 0 && k < count && closed(before.status[first + k]);
      };
      bool bore = false;
      Index low = count, high = -1, alone = 0; // newly closed, without a closed neighbour
      for (Index k = 0; k < count; ++k)
      {
         bore = bore || was_closed(k);
         if (!closed(settled[first + k]) || was_closed(k) || was_closed(k - 1) ||
             was_closed(k + 1))
         {
            continue;
         }
         low = std::min(low, k);
         high = k;
         ++alone;
      }
      const bool beside = high == low + 1 || (chain.loop && high - low == count - 1);
      if (alone > 0 && (bore || alone > 2 || (alone == 2 && !beside))) { return true; }
   }
   return false;
}

double changed_while_closing(const ReducedProblem &problem, const ContactState &before,
                             const ContactState &after)
{
   if (after.q.size() == 0 || !closes(problem, before, after)) { return 0; }
   return tangential_lengths(after.q - before.q, problem.nodes()).maxCoeff();
}

} // namespace cattaneo
