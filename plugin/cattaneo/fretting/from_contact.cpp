#include <algorithm>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo::fretting
{

using Eigen::Index;

Edge near_edge(const ContactEdge &edge)
{
   require(edge.why_not.empty(), edge.why_not);
   return {edge.k_n.value, edge.k_t.value, edge.friction};
}

EnergyComparison compare_energy(const ReducedProblem &problem, const ContactEdge &edge,
                                const CycleRecord &cycle, double k_t_range, double modulus)
{
   require(cycle.node_dissipation.size() == problem.nodes(),
           "the cycle has the dissipation of ", cycle.node_dissipation.size(),
           " nodes, must have that of all ", problem.nodes(), " nodes of the problem.");
   edge.validate(problem);
   EnergyComparison result;
   result.predicted_total = slip_energy_total(near_edge(edge), k_t_range, modulus);
   result.predicted_max = slip_energy_max(k_t_range, modulus);
   // Nodes beyond the edge may be in contact, and lose energy, at other times of the cycle.
   Index first = edge.first, last = edge.last;
   const auto rubs = [&](Index i)
   { return i >= 0 && i < problem.nodes() && cycle.node_dissipation[i] != 0; };
   if (edge.side > 0)
   {
      while (rubs(first - 1)) { first--; }
   }
   else
   {
      while (rubs(last + 1)) { last++; }
   }
   for (Index i = first; i <= last; i++)
   {
      result.computed_total += cycle.node_dissipation[i];
      if (problem.weights[i] > 0)
      {
         result.computed_max =
            std::max(result.computed_max, cycle.node_dissipation[i] / problem.weights[i]);
      }
   }
   return result;
}

} // namespace cattaneo::fretting
