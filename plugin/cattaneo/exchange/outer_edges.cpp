#include <algorithm>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/input_error.hpp>
#include <limits>
#include <numeric>
#include <set>

namespace cattaneo
{

using Eigen::Vector2d;

std::vector<NodalStiffness::Nodes>
outer_edges(const std::vector<NodalStiffness::Nodes> &elements,
            const NodalStiffness::Places &places, const std::vector<int> &numbers)
{
   std::map<std::pair<int, int>, std::vector<NodalStiffness::Nodes>> edges;
   std::map<std::pair<int, int>, std::string> seen; // by which element, on the left of the way
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
      if (count > 4)
      {
         // Is each middle node nearest to its own side? The sum of the distances over all sides
         // must be the smallest of all orders of these nodes, because a single node may be far
         // from a strongly curved side.
         std::vector<std::size_t> sides(corners), best;
         std::iota(sides.begin(), sides.end(), 0);
         double least = std::numeric_limits<double>::infinity();
         do {
            double off = 0;
            for (std::size_t a = 0; a < corners; ++a)
            {
               const Vector2d &x = place(sides[a]), &y = place((sides[a] + 1) % corners);
               off += (place(corners + a) - 0.5 * (x + y)).squaredNorm();
            }
            if (off >= least) { continue; }
            least = off;
            best = sides;
         } while (std::next_permutation(sides.begin(), sides.end()));
         for (std::size_t a = 0; a < corners; ++a)
         {
            const int from = nodes[a], to = nodes[(a + 1) % corners],
                      middle = nodes[corners + a];
            const bool between = from == to || (middle != from && middle != to);
            require(
               best[a] == a && between, which, ": node ", nodes[corners + a],
               " is not between its corners ", nodes[a], " and ", nodes[(a + 1) % corners],
               ", must be: list the corners first, then the middle of each side in the same "
               "order");
         }
      }
      for (std::size_t a = 0; a < corners; ++a)
      {
         const std::size_t b = (a + 1) % corners;
         if (nodes[a] == nodes[b]) { continue; } // collapsed to a triangle
         NodalStiffness::Nodes edge{nodes[a], nodes[b]};
         if (count > 4) { edge.insert(edge.begin() + 1, nodes[corners + a]); }
         if (area < 0) { std::reverse(edge.begin(), edge.end()); }
         const auto [other, first] = seen.insert({{edge.front(), edge.back()}, which});
         require(first, which, " and ", other->second,
                 " lie on the same side of their common edge from node ", nodes[a], " to ",
                 nodes[b],
                 ", must not overlap or be listed twice: list the corners in order around "
                 "each element");
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

std::vector<NodalStiffness::Nodes>
outer_faces(const std::vector<NodalStiffness::Nodes> &elements)
{
   using Faces = std::vector<std::vector<std::size_t>>;
   const std::map<std::size_t, Faces> of = {
      {4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}},
      {5, {{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}}},
      {6, {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}},
      {8,
       {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}}};
   std::map<NodalStiffness::Nodes, NodalStiffness::Nodes> once; // by sorted nodes
   std::set<NodalStiffness::Nodes> twice;
   for (std::size_t e = 0; e < elements.size(); ++e)
   {
      const auto found = of.find(elements[e].size());
      require(found != of.end(), "element ", e, " has ", elements[e].size(),
              " nodes, must have 4, 5, 6 or 8");
      for (const std::vector<std::size_t> &corners : found->second)
      {
         NodalStiffness::Nodes face;
         for (std::size_t corner : corners) { face.push_back(elements[e][corner]); }
         NodalStiffness::Nodes sorted = face;
         std::sort(sorted.begin(), sorted.end());
         if (twice.count(sorted) > 0) { continue; }
         const auto [at, is_new] = once.emplace(sorted, face);
         if (is_new) { continue; }
         once.erase(at);
         twice.insert(std::move(sorted));
      }
   }
   std::vector<NodalStiffness::Nodes> all;
   for (auto &[sorted, face] : once) { all.push_back(std::move(face)); }
   return all;
}

} // namespace cattaneo
