#include <Eigen/Dense>
#include <algorithm>
#include <array>
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

/// What a mesh in a deck has besides elements.
MeshNames names_of(const InputDeck &deck)
{
   MeshNames names;
   names.numbered = false;
   names.axisymmetric = deck.formulation == Formulation::axisymmetric;
   names.passed_over = passed_over(deck);
   for (const std::string &name : deck.sections)
   {
      const auto material = deck.materials.find(name);
      const bool known = material != deck.materials.end();
      names.materials.push_back(
         {name, known ? material->second.young : 0, known ? material->second.poisson : 0});
   }
   return names;
}

void require_section(const InputDeck &deck, const InputDeck::Element &element)
{
   require(deck.sections.empty() || element.section > 0, element.place, ": element ",
           element.number,
           " is in no *SOLID SECTION, must be in one, or there must be none at all");
}

/// Edges of a solid by positions of their corners, in the order of its middle nodes: that of
/// ABAQUS and CalculiX, and Gmsh's. Gmsh's other nodes are in the middles of faces.
struct SolidOrder
{
   long linear, quadratic; ///< Gmsh's types of elements
   std::vector<std::array<int, 2>> edges, in_gmsh;
   std::vector<std::array<int, 4>> faces; ///< quadrilaterals
};

/// By the number of corners.
const std::map<std::size_t, SolidOrder> &solid_orders()
{
   static const std::map<std::size_t, SolidOrder> orders = {
      {4,
       {4,
        11,
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
        {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}},
        {}}},
      {6,
       {6,
        13,
        {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}},
        {{0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}}}},
      {8,
       {5,
        12,
        {{0, 1},
         {1, 2},
         {2, 3},
         {3, 0},
         {4, 5},
         {5, 6},
         {6, 7},
         {7, 4},
         {0, 4},
         {1, 5},
         {2, 6},
         {3, 7}},
        {{0, 1},
         {0, 3},
         {0, 4},
         {1, 2},
         {1, 5},
         {2, 3},
         {2, 6},
         {3, 7},
         {4, 5},
         {4, 7},
         {5, 6},
         {6, 7}},
        {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}}}};
   return orders;
}

/// Solids of a deck as elements of Gmsh. Those of 15 and 20 nodes get nodes in the middles of
/// their faces and of a hexahedron, where their own functions have these points.
class SolidsOfDeck
{
public:
   SolidsOfDeck(const InputDeck &deck, GmshMesh &mesh) : deck_(deck), mesh_(mesh)
   {
      for (const auto &place : deck.places) { next_ = std::max<long>(next_, place.first + 1); }
   }

   void add_solid(const InputDeck::Element &element)
   {
      for (const int node : element.nodes) { add_node(node); }
      const std::size_t count = element.nodes.size(), corners = count < 9 && count != 6 ? count
                                                                : count == 10           ? 4
                                                                : count == 20           ? 8
                                                                                        : 6;
      const SolidOrder &order = solid_orders().at(corners);
      std::vector<long> nodes(element.nodes.begin(),
                              element.nodes.begin() + static_cast<long>(corners));
      const std::vector<long> at = nodes;
      if (count > corners)
      {
         for (std::size_t k = 0; k < order.edges.size(); ++k)
         {
            const auto &[a, b] = order.edges[k];
            middles_[std::minmax(at[a], at[b])] = element.nodes[corners + k];
         }
         for (const auto &[a, b] : order.in_gmsh) { nodes.push_back(middle(at[a], at[b])); }
         for (const auto &[a, b, c, d] : order.faces)
         {
            nodes.push_back(middle_of_face({at[a], at[b], at[c], at[d]}));
         }
         if (corners == 8)
         {
            Eigen::Vector3d centre = Eigen::Vector3d::Zero();
            for (std::size_t k = 0; k < count; ++k)
            {
               centre += (k < 8 ? -0.25 : 0.25) * place(element.nodes[k]);
            }
            nodes.push_back(made_node(centre));
         }
      }
      mesh_.add_element(element.number, count > corners ? order.quadratic : order.linear,
                        {std::max(element.section, 1), 1}, nodes);
   }

   /// An outer face; its corners come first.
   void add_face(long number, int attribute, const Nodes &face)
   {
      const bool triangle = face.size() == 3 || face.size() == 6;
      const std::size_t corners = triangle ? 3 : 4;
      std::vector<long> nodes(face.begin(), face.begin() + static_cast<long>(corners));
      const std::vector<long> at = nodes;
      const bool quadratic = face.size() > corners;
      for (std::size_t k = 0; quadratic && k < corners; ++k)
      {
         nodes.push_back(middle(at[k], at[(k + 1) % corners]));
      }
      if (quadratic && !triangle)
      {
         nodes.push_back(middle_of_face({at[0], at[1], at[2], at[3]}));
      }
      mesh_.add_element(number, triangle ? (quadratic ? 9 : 2) : (quadratic ? 10 : 3),
                        {attribute, 1}, nodes);
   }

private:
   Eigen::Vector3d place(int node) const
   {
      const Eigen::Vector2d &at = deck_.places.at(node);
      return {at[0], at[1], deck_.z.at(node)};
   }
   Eigen::Vector3d place_of(long node) const
   {
      const std::array<double, 3> &at = mesh_.nodes.at(node);
      return {at[0], at[1], at[2]};
   }
   void add_node(int node)
   {
      if (mesh_.nodes.count(node) > 0) { return; }
      const Eigen::Vector3d at = place(node);
      mesh_.add_node(node, {at[0], at[1], at[2]});
   }
   long made_node(const Eigen::Vector3d &at)
   {
      mesh_.add_node(next_, {at[0], at[1], at[2]});
      return next_++;
   }
   long middle(long a, long b) const { return middles_.at(std::minmax(a, b)); }
   /// One node for both elements beside a face.
   long middle_of_face(const std::array<long, 4> &corners)
   {
      std::array<long, 4> key = corners;
      std::sort(key.begin(), key.end());
      const auto found = of_faces_.find(key);
      if (found != of_faces_.end()) { return found->second; }
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < 4; ++k)
      {
         at += 0.5 * place_of(middle(corners[k], corners[(k + 1) % 4])) -
               0.25 * place_of(corners[k]);
      }
      return of_faces_[key] = made_node(at);
   }

   const InputDeck &deck_;
   GmshMesh &mesh_;
   long next_ = 1;
   std::map<std::pair<long, long>, long> middles_;
   std::map<std::array<long, 4>, long> of_faces_;
};

/// The corners of a face, in order of their numbers.
Nodes sorted_corners(const Nodes &face)
{
   const bool triangle = face.size() == 3 || face.size() == 6;
   Nodes corners(face.begin(), face.begin() + (triangle ? 3 : 4));
   std::sort(corners.begin(), corners.end());
   return corners;
}

/// Parts of the boundary by their names, as sets of sorted_corners(). A set of nodes that is no
/// part of the boundary has no faces.
std::map<std::string, std::set<Nodes>> faces_of_parts(const InputDeck &deck)
{
   std::map<std::string, std::set<Nodes>> parts;
   for (const auto &[name, faces] : deck.surfaces)
   {
      for (const Nodes &face : faces) { parts[name].insert(sorted_corners(face)); }
   }
   for (const auto &[name, nodes] : deck.node_sets)
   {
      const std::set<int> its(nodes.begin(), nodes.end());
      std::set<int> covered;
      std::set<Nodes> faces;
      for (const Nodes &face : deck.faces)
      {
         const bool whole = std::all_of(face.begin(), face.end(),
                                        [&](int node) { return its.count(node) == 1; });
         if (!whole) { continue; }
         faces.insert(sorted_corners(face));
         covered.insert(face.begin(), face.end());
      }
      parts.emplace(name, covered == its ? faces : std::set<Nodes>());
   }
   return parts;
}

DeckMesh deck_solids(const std::string &file, const MeshPart &part)
{
   const InputDeck deck = read_input_deck(file, DeckUse::solids, {part.name, part.usual});
   DeckMesh made;
   made.names = names_of(deck);
   SolidsOfDeck solids(deck, made.mesh);
   long last = 0;
   for (const InputDeck::Element &element : deck.elements)
   {
      require(element.is_solid, element.place, ": element ", element.number, " is a ",
              element.type, ", must be a C3D of 4, 6, 8, 10, 15 or 20 nodes, or be left out");
      require_section(deck, element);
      last = std::max<long>(last, element.number);
      solids.add_solid(element);
   }
   require(last > 0, "file '", file,
           "' has no elements, must have C3D of 4, 6, 8, 10, 15 or 20 nodes");
   const std::map<std::string, std::set<Nodes>> parts = faces_of_parts(deck);
   for (const auto &one : parts) { made.names.boundary[one.first]; }
   // A face has one attribute. Faces with the same names share it.
   std::map<std::vector<std::string>, int> attributes;
   for (const Nodes &face : deck.faces)
   {
      const Nodes corners = sorted_corners(face);
      std::vector<std::string> names;
      for (const auto &[name, faces] : parts)
      {
         if (faces.count(corners)) { names.push_back(name); }
      }
      const auto [known, is_new] =
         attributes.emplace(names, static_cast<int>(attributes.size()) + 1);
      for (std::size_t k = 0; k < names.size() && is_new; ++k)
      {
         made.names.boundary[names[k]].push_back(known->second);
      }
      solids.add_face(++last, known->second, face);
   }
   return made;
}

} // namespace

DeckMesh deck_mesh(const std::string &file, const MeshPart &part)
{
   if (part.dimension == 3) { return deck_solids(file, part); }
   const InputDeck deck = read_input_deck(file, DeckUse::mesh, {part.name, part.usual});
   DeckMesh made;
   made.names = names_of(deck);

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
      require_section(deck, element);
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
