#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cmath>

namespace cattaneo
{

ContactAreas contact_areas(const ReducedProblem &problem, const ContactState &state)
{
   const Eigen::Index n = problem.nodes();
   require(problem.components() == 2, "contact areas: the problem has ", problem.components(),
           " tangential components, must have 2: on a line use zones()");
   require(problem.weights.size() == n,
           "contact areas: the problem has no weights of its nodes, which areas need");
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

RadialEdges radial_edges(const ReducedProblem &problem, const ContactState &state,
                         const Eigen::Vector2d &centre)
{
   const Eigen::Index n = problem.nodes();
   require(
      problem.position.rows() == n && problem.position.cols() == 3,
      "radial edges: the problem has no surface, must have a place in space for each node");
   const ContactAreas areas = contact_areas(problem, state);
   const std::vector<NodeState> states = settled_states(problem, state);
   const Eigen::VectorXd way =
      (problem.position.leftCols(2).rowwise() - centre.transpose()).rowwise().norm();
   const double half = 0.5 * std::sqrt(problem.weights.mean());
   const auto edge = [&](double area, const auto &within)
   {
      double last = 0, first = way.maxCoeff();
      bool outside = false;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         if (within(states[static_cast<std::size_t>(i)])) { last = std::max(last, way[i]); }
         else
         {
            first = std::min(first, way[i]);
            outside = true;
         }
      }
      RadialEdge result;
      result.radius = std::sqrt(area / M_PI);
      result.error = std::max(std::abs(last - result.radius), half);
      if (outside) { result.error = std::max(result.error, std::abs(first - result.radius)); }
      return result;
   };
   return {edge(areas.contact.area, [](NodeState node) { return closed(node); }),
           edge(areas.stick.area, [](NodeState node) { return node == NodeState::stick; })};
}

} // namespace cattaneo
