#include <algorithm>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

using Eigen::Vector2d;

std::vector<NodalStiffness::Nodes>
outer_edges(const std::vector<NodalStiffness::Nodes> &elements,
            const NodalStiffness::Places &places, const std::vector<int> &numbers)
{
   std::map<std::pair<int, int>, std::vector<NodalStiffness::Nodes>> edges;
   for (std::size_t e = 0; e < elements.size(); ++e)
   {
      const NodalStiffness::Nodes &nodes = elements[e];
      const std::size_t count = nodes.size();
      const std::string which =
         "element " + std::to_string(numbers.empty() ? static_cast<int>(e) : numbers[e]);
      require(count == 3 || count == 4 || (count >= 6 && count <= 9), which, " has ", count,
              " nodes, must have 3, 4, 6, 7, 8 or 9");
      const std::size_t corners = count == 3 || count == 6 || count == 7 ? 3 : 4;
      const auto place = [&](std::size_t a) -> const Vector2d &
      {
         const auto found = places.find(nodes[a]);
         require(found != places.end(), which, " has node ", nodes[a], ", which has no place");
         return found->second;
      };
      double area = 0; // twice, of its corners
      for (std::size_t a = 0; a < corners; ++a)
      {
         const Vector2d &x = place(a), &y = place((a + 1) % corners);
         area += x[0] * y[1] - x[1] * y[0];
      }
      for (std::size_t a = 0; a < corners; ++a)
      {
         const std::size_t b = (a + 1) % corners;
         NodalStiffness::Nodes edge{nodes[a], nodes[b]};
         if (count > 4)
         {
            // Nearer to the middle of its own side than to that of any other.
            const auto distance = [&](std::size_t side)
            {
               const Vector2d middle = 0.5 * (place(side) + place((side + 1) % corners));
               return (place(corners + a) - middle).norm();
            };
            for (std::size_t other = 0; other < corners; ++other)
            {
               require(distance(a) <= distance(other), which, ": node ", nodes[corners + a],
                       " is not between its corners ", nodes[a], " and ", nodes[b],
                       ", must be: corners come first, then the middle of each side from the "
                       "first on");
            }
            edge.insert(edge.begin() + 1, nodes[corners + a]);
         }
         if (area < 0) { std::reverse(edge.begin(), edge.end()); }
         edges[std::minmax(edge.front(), edge.back())].push_back(edge);
      }
   }
   std::vector<NodalStiffness::Nodes> outer;
   for (const auto &[ends, shared] : edges)
   {
      if (shared.size() == 1) { outer.push_back(shared.front()); }
   }
   return outer;
}

} // namespace cattaneo
