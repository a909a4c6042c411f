#include <algorithm>
#include <array>
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
   std::map<std::pair<int, int>, std::string>
      seen; // the element on the left of each directed edge
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

namespace
{

using Corners = std::vector<std::size_t>; ///< in their order around a face or an element

/// A solid by the number of its corners.
struct Solid
{
   std::vector<Corners> faces;
   std::size_t edges;
};

const std::map<std::size_t, Solid> solids = {
   {4, {{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, 6}},
   {5, {{{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}}, 8}},
   {6, {{{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}, 9}},
   {8,
    {{{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}},
     12}}};

/// Corners of an element with this number of nodes; 0: there is no such element.
std::size_t corners_of(std::size_t nodes)
{
   for (const auto &[corners, solid] : solids)
   {
      // Middles of edges, of quadrilateral faces and of a hexahedron.
      const std::size_t second = corners + solid.edges, inner = corners == 4   ? 0
                                                                : corners == 5 ? 1
                                                                : corners == 6 ? 3
                                                                               : 7;
      if (nodes == corners || nodes == second || nodes == second + inner) { return corners; }
   }
   return 0;
}

/// The middles of the edges and faces of an element of order 2, by sorted corners.
class ElementMiddles
{
public:
   ElementMiddles(const NodalStiffness::Nodes &nodes, const Solid &solid, std::size_t corners,
                  const std::function<Eigen::Vector3d(int)> &place, const std::string &which)
   {
      const bool with_faces = nodes.size() > corners + solid.edges;
      const auto add = [&](Corners of)
      {
         Eigen::Vector3d middle(0, 0, 0);
         for (std::size_t corner : of)
         {
            middle += place(nodes[corner]) / static_cast<double>(of.size());
         }
         std::sort(of.begin(), of.end());
         if (node_.emplace(of, -1).second) { wanted_.emplace_back(std::move(of), middle); }
      };
      for (const Corners &face : solid.faces)
      {
         for (std::size_t a = 0; a < face.size(); ++a)
         {
            add({face[a], face[(a + 1) % face.size()]});
         }
         if (with_faces && face.size() == 4) { add(face); }
      }
      if (nodes.size() == 27) { add({0, 1, 2, 3, 4, 5, 6, 7}); }
      for (std::size_t k = corners; k < nodes.size(); ++k)
      {
         const Eigen::Vector3d at = place(nodes[k]);
         std::size_t nearest = 0;
         for (std::size_t m = 1; m < wanted_.size(); ++m)
         {
            const auto off = [&](std::size_t of) { return (wanted_[of].second - at).norm(); };
            if (off(m) < off(nearest)) { nearest = m; }
         }
         int &own = node_.at(wanted_[nearest].first);
         require(own < 0, which, ": nodes ", own, " and ", nodes[k],
                 " are both nearest to the middle of the same edge or face, each must lie in "
                 "the middle of another one (do its corners come first, in order?)");
         own = nodes[k];
      }
   }
   /// -1: there is none.
   int between(Corners corners) const
   {
      std::sort(corners.begin(), corners.end());
      const auto found = node_.find(corners);
      return found == node_.end() ? -1 : found->second;
   }

private:
   std::map<Corners, int> node_;
   std::vector<std::pair<Corners, Eigen::Vector3d>> wanted_;
};

} // namespace

std::vector<NodalStiffness::Nodes>
outer_faces(const std::vector<NodalStiffness::Nodes> &elements,
            const std::function<Eigen::Vector3d(int)> &place, const std::vector<int> &numbers)
{
   // 1. Faces by their sorted corners, with the element and the side that they are.
   struct Side
   {
      std::array<int, 4> corners;
      std::size_t element;
      const Corners *face;
   };
   std::vector<Side> sides;
   const auto called = [&](std::size_t e)
   { return "element " + std::to_string(numbers.empty() ? static_cast<int>(e) : numbers[e]); };
   for (std::size_t e = 0; e < elements.size(); ++e)
   {
      const NodalStiffness::Nodes &nodes = elements[e];
      const std::size_t corners = corners_of(nodes.size());
      require(corners > 0, called(e), " has ", nodes.size(),
              " nodes, must have 4, 5, 6 or 8, or of order 2 10, 13, 14, 15, 18, 20 or 27");
      for (const Corners &face : solids.at(corners).faces)
      {
         Side side{{-1, -1, -1, -1}, e, &face};
         for (std::size_t a = 0; a < face.size(); ++a) { side.corners[a] = nodes[face[a]]; }
         std::sort(side.corners.begin(), side.corners.end());
         sides.push_back(side);
      }
   }
   std::sort(sides.begin(), sides.end(),
             [](const Side &one, const Side &other) { return one.corners < other.corners; });
   // 2. Faces of one element alone, with the middles of their edges.
   std::vector<NodalStiffness::Nodes> all;
   for (std::size_t k = 0; k < sides.size();)
   {
      std::size_t end = k + 1;
      while (end < sides.size() && sides[end].corners == sides[k].corners) { ++end; }
      const Side &side = sides[k];
      const bool alone = end == k + 1;
      k = end;
      if (!alone) { continue; }
      const NodalStiffness::Nodes &nodes = elements[side.element];
      const Corners &face = *side.face;
      NodalStiffness::Nodes made;
      for (std::size_t corner : face) { made.push_back(nodes[corner]); }
      const std::size_t corners = corners_of(nodes.size());
      if (nodes.size() > corners)
      {
         const ElementMiddles middles(nodes, solids.at(corners), corners, place,
                                      called(side.element));
         for (std::size_t a = 0; a < face.size(); ++a)
         {
            made.push_back(middles.between({face[a], face[(a + 1) % face.size()]}));
         }
         if (const int centre = middles.between(face); centre >= 0 && face.size() == 4)
         {
            made.push_back(centre);
         }
      }
      all.push_back(std::move(made));
   }
   return all;
}

std::vector<NodalStiffness::Nodes> faces_of(const NodalStiffness::Nodes &element)
{
   std::vector<NodalStiffness::Nodes> all;
   const auto solid = solids.find(corners_of(element.size()));
   if (solid == solids.end()) { return all; }
   for (const Corners &face : solid->second.faces)
   {
      all.emplace_back();
      for (std::size_t corner : face) { all.back().push_back(element[corner]); }
   }
   return all;
}

} // namespace cattaneo
