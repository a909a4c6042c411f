#include <algorithm>
#include <cattaneo/exchange/input_deck.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/mesh/deck_mesh.hpp>
#include <cattaneo/words.hpp>
#include <filesystem>
#include <set>

namespace cattaneo
{

namespace
{

using Nodes = InputDeck::Nodes;
using Ends = std::pair<int, int>;

Ends ends(const Nodes &edge)
{
   return std::minmax(edge.front(), edge.back());
}

/// Parts of the boundary by their names. Each has the ends of its edges. A set of nodes that is
/// no part of the boundary has no edges.
std::map<std::string, std::set<Ends>> parts_of_boundary(const InputDeck &deck)
{
   std::map<std::string, std::set<Ends>> parts;
   for (const auto &[name, edges] : deck.surfaces)
   {
      for (const Nodes &edge : edges) { parts[name].insert(ends(edge)); }
   }
   std::set<Ends> outer;
   for (const Nodes &edge : deck.edges) { outer.insert(ends(edge)); }
   // The middle node of a truss stands between its ends or, as Gmsh writes it, after them.
   const auto line = [&](const InputDeck::Element &element)
   {
      const Ends behind = std::minmax(element.nodes[0], element.nodes[1]);
      return outer.count(behind) ? behind : ends(element.nodes);
   };
   for (const InputDeck::Element &element : deck.elements)
   {
      require(element.corners != 2 || outer.count(line(element)), element.place, ": element ",
              element.number, ", a line (", element.type,
              "), must be an edge of the body's boundary, or be left out");
   }
   for (const auto &[name, elements] : deck.element_sets)
   {
      for (std::size_t e : elements)
      {
         if (deck.elements[e].corners == 2) { parts[name].insert(line(deck.elements[e])); }
      }
   }
   for (const auto &[name, nodes] : deck.node_sets)
   {
      const std::set<int> its(nodes.begin(), nodes.end());
      std::set<int> covered;
      std::set<Ends> edges;
      for (const Nodes &edge : deck.edges)
      {
         const bool whole = std::all_of(edge.begin(), edge.end(),
                                        [&](int node) { return its.count(node) == 1; });
         if (!whole) { continue; }
         edges.insert(ends(edge));
         covered.insert(edge.begin(), edge.end());
      }
      parts.emplace(name, covered == its ? edges : std::set<Ends>());
   }
   return parts;
}

} // namespace

bool is_deck(const std::string &file)
{
   return upper_case(std::filesystem::path(file).extension().string()) == ".INP";
}

namespace
{

/// Cards that are not read, in a list.
std::string passed_over(const InputDeck &deck)
{
   static const std::set<std::string> read = {
      "HEADING",  "PREPRINT",     "PART",          "END PART", "ASSEMBLY", "END ASSEMBLY",
      "INSTANCE", "END INSTANCE", "NODE",          "ELEMENT",  "NSET",     "ELSET",
      "SURFACE",  "MATERIAL",     "SOLID SECTION", "ELASTIC",  "INCLUDE",  "END STEP"};
   std::vector<std::string> cards;
   for (const std::string &name : deck.keywords)
   {
      const bool with_type = name.find(", TYPE=") != std::string::npos;
      if (read.count(name) == 0 && !with_type) { cards.push_back("*" + name); }
   }
   return listed(cards);
}

} // namespace

DeckMesh deck_mesh(const std::string &file, const MeshPart &part)
{
   const InputDeck deck = read_input_deck(file, DeckUse::mesh, {part.name, part.usual});
   DeckMesh made;
   made.names.numbered = false;
   made.names.axisymmetric = deck.formulation == Formulation::axisymmetric;
   made.names.passed_over = passed_over(deck);
   for (const std::string &name : deck.sections)
   {
      const auto material = deck.materials.find(name);
      made.names.materials.push_back(
         {name, material == deck.materials.end() ? 0 : material->second.young,
          material == deck.materials.end() ? 0 : material->second.poisson});
   }

   std::set<int> used;
   long last = 0;
   for (const InputDeck::Element &element : deck.elements)
   {
      last = std::max<long>(last, element.number);
      require(element.corners > 2 || (element.corners == 2 && element.section == 0),
              element.place, ": element ", element.number, " is a ", element.type,
              element.corners == 2 ? " with a *SOLID SECTION" : "",
              ", must be a CPS, CPE or CAX of 3, 4, 6 or 8 nodes, or an M3D9, or be left out");
      if (element.corners < 3) { continue; }
      require(deck.sections.empty() || element.section > 0, element.place, ": element ",
              element.number,
              " is in no *SOLID SECTION, must be in one, or there must be none at all");
      for (int node : element.nodes)
      {
         if (!used.insert(node).second) { continue; }
         const Eigen::Vector2d &at = deck.places.at(node);
         made.mesh.add_node(node, {at[0], at[1], 0});
      }
   }
   for (const InputDeck::Element &element : deck.elements)
   {
      // Programs without materials write CPS for any plane element.
      if (element.section == 0 || element.type.size() < 3) { continue; }
      const std::string family = element.type.substr(0, 3);
      if (family == "CPS" || family == "CPE") { made.names.plane_elements.insert(family); }
   }
   require(!used.empty(), "file '", file,
           "' has no elements, must have CPS, CPE or CAX of 3, 4, 6 or 8 nodes");
   for (const InputDeck::Element &element : deck.elements)
   {
      if (element.corners < 3) { continue; }
      static const std::map<std::size_t, long> types = {
         {3, 2}, {4, 3}, {6, 9}, {8, 16}, {9, 10}};
      made.mesh.add_element(element.number, types.at(element.nodes.size()),
                            {std::max(element.section, 1), 1},
                            {element.nodes.begin(), element.nodes.end()});
   }
   const std::map<std::string, std::set<Ends>> parts = parts_of_boundary(deck);
   for (const auto &part : parts) { made.names.boundary[part.first]; }
   // An edge has one attribute. Edges with the same names share it.
   std::map<std::vector<std::string>, int> attributes;
   for (const Nodes &edge : deck.edges)
   {
      std::vector<std::string> names;
      for (const auto &[name, edges] : parts)
      {
         if (edges.count(ends(edge))) { names.push_back(name); }
      }
      const auto [known, is_new] =
         attributes.emplace(names, static_cast<int>(attributes.size()) + 1);
      for (std::size_t k = 0; k < names.size() && is_new; ++k)
      {
         made.names.boundary[names[k]].push_back(known->second);
      }
      std::vector<long> nodes{edge.front(), edge.back()};
      if (edge.size() == 3) { nodes.push_back(edge[1]); }
      made.mesh.add_element(++last, edge.size() == 3 ? 8 : 1, {known->second, 1}, nodes);
   }
   return made;
}

} // namespace cattaneo
