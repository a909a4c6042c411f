#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/split_line.hpp>
#include <set>
#include <tuple>

namespace cattaneo
{

namespace
{

using DirectedEdge =
   std::pair<long, long>; ///< of an edge, as an element or a line runs along it

DirectedEdge undirected(const DirectedEdge &edge)
{
   return std::minmax(edge.first, edge.second);
}

/// The sides of a triangle or quadrilateral, in the order of its corners.
std::vector<DirectedEdge> sides_of(const GmshMesh::Element &element)
{
   const std::size_t corners = gmsh_types().at(element.type).corners;
   std::vector<DirectedEdge> found;
   for (std::size_t k = 0; k < corners; ++k)
   {
      found.emplace_back(element.nodes[k], element.nodes[(k + 1) % corners]);
   }
   return found;
}

/// Twice the area of an element, positive if its corners are numbered counterclockwise.
double turn(const GmshMesh &mesh, const GmshMesh::Element &element)
{
   double area = 0;
   for (const auto &[a, b] : sides_of(element))
   {
      const std::array<double, 3> &x = mesh.nodes.at(a), &y = mesh.nodes.at(b);
      area += x[0] * y[1] - y[0] * x[1];
   }
   return area;
}

/// Groups of elements around a node that are connected by sides which are not cut.
std::vector<std::vector<std::size_t>> fans(const GmshMesh &mesh,
                                           const std::vector<std::size_t> &around, long node,
                                           const std::set<DirectedEdge> &cut)
{
   std::vector<std::vector<std::size_t>> groups;
   for (std::size_t e : around)
   {
      std::set<DirectedEdge> own;
      for (const DirectedEdge &side : sides_of(mesh.elements[e]))
      {
         const bool there = side.first == node || side.second == node;
         if (there && cut.count(undirected(side)) == 0) { own.insert(undirected(side)); }
      }
      // Join the element with all groups that it touches.
      std::vector<std::size_t> joined{e};
      for (std::size_t g = groups.size(); g-- > 0;)
      {
         const bool touches =
            std::any_of(groups[g].begin(), groups[g].end(),
                        [&](std::size_t other)
                        {
                           const std::vector<DirectedEdge> its = sides_of(mesh.elements[other]);
                           return std::any_of(its.begin(), its.end(),
                                              [&](const DirectedEdge &side)
                                              { return own.count(undirected(side)); });
                        });
         if (!touches) { continue; }
         joined.insert(joined.end(), groups[g].begin(), groups[g].end());
         groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(g));
      }
      groups.push_back(joined);
   }
   return groups;
}

} // namespace

void split_line(GmshMesh &mesh, long group, long right, const std::string &name)
{
   // 1. Find the edges to be cut, and check that they form lines with one direction.
   std::set<DirectedEdge> cut;
   std::vector<std::size_t> lines;
   std::set<long> on_line, starts, stops;
   long last_curve = 0;
   for (std::size_t e = 0; e < mesh.elements.size(); ++e)
   {
      const GmshMesh::Element &element = mesh.elements[e];
      if (gmsh_types().at(element.type).corners != 2) { continue; }
      if (element.tags.size() > 1) { last_curve = std::max(last_curve, element.tags[1]); }
      if (element.tags.empty() || element.tags[0] != group) { continue; }
      lines.push_back(e);
      cut.insert(undirected({element.nodes[0], element.nodes[1]}));
      on_line.insert(element.nodes.begin(), element.nodes.end());
      for (const auto &[of, node, what] : {std::tuple{&starts, element.nodes[0], "begin"},
                                           std::tuple{&stops, element.nodes[1], "end"}})
      {
         require(
            of->insert(node).second, "mesh file: two edges of the line '", name, "' ", what,
            " at node ", node,
            ", must run in one direction from end to end to be split (in Gmsh a minus sign "
            "reverses a curve: Physical Curve(5) = {1, -2};)");
      }
   }
   require(!lines.empty(), "mesh file: the line '", name, "' has no edges, nothing is split");

   // 2. Find the elements on the left and on the right of each edge, and around each node.
   std::map<DirectedEdge, std::size_t> left, on_right;
   std::map<long, std::vector<std::size_t>> around;
   for (std::size_t e = 0; e < mesh.elements.size(); ++e)
   {
      const GmshMesh::Element &element = mesh.elements[e];
      if (gmsh_types().at(element.type).corners < 3) { continue; }
      const bool counterclockwise = turn(mesh, element) > 0;
      for (const auto &[a, b] : sides_of(element))
      {
         if (cut.count(undirected({a, b})) == 0) { continue; }
         // A counterclockwise element is on the left of its sides.
         const DirectedEdge along = counterclockwise ? DirectedEdge{a, b} : DirectedEdge{b, a};
         left[along] = e;
         on_right[{along.second, along.first}] = e;
      }
      for (long node : element.nodes)
      {
         if (on_line.count(node) == 1) { around[node].push_back(e); }
      }
   }
   for (std::size_t line : lines)
   {
      const DirectedEdge ends{mesh.elements[line].nodes[0], mesh.elements[line].nodes[1]};
      require(left.count(ends) == 1 && on_right.count(ends) == 1, "mesh file: the line '", name,
              "' is on the outer boundary at node ", ends.first,
              ", must have elements on both sides to be split");
   }

   // 3. Around each node the first group of elements keeps the node, each other one gets a new
   // node. A tip has one group and so stays one node.
   std::map<std::pair<std::size_t, long>, long> renamed; // of an element's node
   for (const auto &[node, elements] : around)
   {
      const auto groups = fans(mesh, elements, node, cut);
      for (std::size_t g = 1; g < groups.size(); ++g)
      {
         const long own = mesh.nodes.rbegin()->first + 1;
         mesh.add_node(own, mesh.nodes.at(node));
         for (std::size_t e : groups[g]) { renamed[{e, node}] = own; }
      }
   }
   const auto node_of = [&](std::size_t element, long node)
   {
      const auto found = renamed.find({element, node});
      return found == renamed.end() ? node : found->second;
   };
   // 4. Make the two lips. This comes before elements get their new nodes, because elements are
   // found by the old ones.
   long last = 0;
   for (const GmshMesh::Element &element : mesh.elements)
   {
      last = std::max(last, element.number);
   }
   std::vector<GmshMesh::Element> others;
   for (std::size_t line : lines)
   {
      GmshMesh::Element &kept = mesh.elements[line], other = kept;
      const DirectedEdge ends{kept.nodes[0], kept.nodes[1]};
      for (long &node : kept.nodes) { node = node_of(left.at(ends), node); }
      for (long &node : other.nodes) { node = node_of(on_right.at(ends), node); }
      other.number = ++last;
      other.tags[0] = right;
      // If the file names the curve of the edge, the other lip gets a new curve.
      if (other.tags.size() > 1 && other.tags[1] > 0) { other.tags[1] += last_curve; }
      others.push_back(other);
   }
   // 5. Other lines that end on this one get the node of the element whose side they are.
   std::map<DirectedEdge, std::size_t> owner;
   for (std::size_t e = 0; e < mesh.elements.size(); ++e)
   {
      if (gmsh_types().at(mesh.elements[e].type).corners < 3) { continue; }
      for (const DirectedEdge &side : sides_of(mesh.elements[e]))
      {
         owner[undirected(side)] = e;
      }
   }
   for (GmshMesh::Element &element : mesh.elements)
   {
      const bool line = gmsh_types().at(element.type).corners == 2;
      if (!line || (!element.tags.empty() && element.tags[0] == group)) { continue; }
      const auto found = owner.find(undirected({element.nodes[0], element.nodes[1]}));
      if (found == owner.end()) { continue; } // refused later, as no edge of an element
      for (long &node : element.nodes) { node = node_of(found->second, node); }
   }
   for (std::size_t e = 0; e < mesh.elements.size(); ++e)
   {
      if (gmsh_types().at(mesh.elements[e].type).corners < 3) { continue; }
      for (long &node : mesh.elements[e].nodes) { node = node_of(e, node); }
   }
   mesh.elements.insert(mesh.elements.end(), others.begin(), others.end());
}

} // namespace cattaneo
