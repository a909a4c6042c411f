#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <set>

namespace cattaneo
{

/// A *CLOAD or *BOUNDARY card.
struct Card
{
   std::string name;
   Control control = Control::force;
   struct Value
   {
      NodeDof at;
      double value = 0;
   };
   std::vector<Value> values;
};

/// An elastic *MATERIAL, isotropic and the same at all temperatures.
struct DeckMaterial
{
   double young = 0, poisson = 0;
};

/** Contents of an .inp of CalculiX or ABAQUS: plane bodies, or solids. Names are in capitals.
   Of several instances only the chosen one is kept, and its sets lose the name of the instance.
 */
struct InputDeck
{
   using Nodes = NodalStiffness::Nodes;
   struct Element
   {
      int number = 0;
      std::string type, place; ///< place: file and line
      Nodes nodes; ///< corners, then the middles of its sides. The number of corners is 3 or 4
                   ///< for plane and axisymmetric elements, 2 for trusses, 0 for others.
      std::size_t corners = 0;
      bool is_solid = false; ///< C3D4 to C3D20; not in the plane
      int section = 0;       ///< number of its *SOLID SECTION, from 1; 0: none
   };

   Formulation formulation = Formulation::plane;
   NodalStiffness::Places places;
   NodalStiffness::Sets node_sets; ///< and surfaces of nodes
   std::vector<Element> elements;
   std::map<std::string, std::vector<std::size_t>> element_sets; ///< indices of elements
   std::vector<Nodes> edges;                                     ///< as outer_edges() has them
   std::map<int, double> z;  ///< in space: the third coordinate of each node
   std::vector<Nodes> faces; ///< in space: as outer_faces() has them
   std::map<std::string, std::vector<Nodes>> surfaces; ///< of these edges or faces
   std::vector<std::string> sections;                  ///< the names of their materials
   /// Materials by name, without those that are not isotropic or not elastic.
   std::map<std::string, DeckMaterial> materials;
   std::vector<Card> cards;
   std::set<std::string> keywords; ///< all that exist
};

/// What a deck is read for.
enum class DeckUse
{
   stiffness, ///< nodes, supports and loads of a matrix
   mesh,      ///< only elements and names, of a plane body
   solids     ///< the same of a body in space
};

/// Which body of a deck is read.
struct DeckPart
{
   std::string name; ///< of an instance, else of a set of elements; empty: there is one body
   /// The instance to use if there are several and none is named.
   std::string usual = {};
};

/** Reads nodes, elements, sets, surfaces, sections and materials; for DeckUse::stiffness also
    *CLOAD and *BOUNDARY of all steps. *INCLUDE is followed. All other cards are ignored:
    contact pairs, steps and loads of a mesh. Each *INSTANCE is a copy of its part that may be
    moved and turned in the plane.

    InputError, with file and line, for cards that would change the body without being read:
    cards that generate nodes or elements, couplings of nodes, nodes that are not in one plane,
    to 1e-9 of the extent of the body, a thickness that is not 1, elements of both formulations,
    surfaces inside of the body, several instances or parts if `part` names none of them. With a
    matrix also for *TRANSFORM, contact pairs and a second instance. */
InputDeck read_input_deck(const std::string &file, DeckUse use, const DeckPart &part = {});

} // namespace cattaneo
