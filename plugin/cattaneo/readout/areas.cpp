#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cmath>

namespace cattaneo
{

ContactAreas contact_areas(const ReducedProblem &problem, const ContactState &state)
{
   const Eigen::Index n = problem.nodes();
   require(problem.components() == 2, "contact areas: the problem has ", problem.components(),
           " tangential components, must have two; zones() are those of a line");
   require(problem.weights.size() == n,
           "contact areas: the problem has no weights of its nodes, and so no areas");
   state.validate(problem);
   ContactAreas areas;
   const auto add = [&](SurfacePart &part, Eigen::Index node)
   {
      part.area += problem.weights[node];
      ++part.nodes;
   };
   const std::vector<NodeState> states = settled_states(problem, state);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const NodeState node = states[static_cast<std::size_t>(i)];
      if (closed(node)) { add(areas.contact, i); }
      add(!closed(node)              ? areas.separation
          : node == NodeState::stick ? areas.stick
                                     : areas.slip,
          i);
   }
   for (SurfacePart *part : {&areas.contact, &areas.stick})
   {
      if (part->nodes == 0) { continue; }
      const double edge = std::sqrt(part->area / static_cast<double>(part->nodes));
      part->error = 0.5 * edge * std::sqrt(4 * M_PI * part->area);
   }
   areas.separation.error = areas.contact.error;
   areas.slip.error = areas.contact.error + areas.stick.error;
   return areas;
}

} // namespace cattaneo
