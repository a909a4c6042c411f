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

/** What an .inp of CalculiX or ABAQUS says of plane bodies. Names are in capitals, those of an
    instance without its own. */
struct InputDeck
{
   using Nodes = NodalStiffness::Nodes;
   struct Element
   {
      int number = 0;
      std::string type, place; ///< place: file and line
      Nodes nodes;             ///< corners, then the middles of its sides
      /// Of plane and axisymmetric ones 3 or 4, of trusses 2, of others 0.
      std::size_t corners = 0;
      int section = 0; ///< which *SOLID SECTION it has, from 1; 0: none
   };

   Formulation formulation = Formulation::plane;
   NodalStiffness::Places places;
   NodalStiffness::Sets node_sets; ///< and surfaces of nodes
   std::vector<Element> elements;
   std::map<std::string, std::vector<std::size_t>> element_sets; ///< indices of elements
   std::vector<Nodes> edges;                                     ///< as outer_edges() has them
   std::map<std::string, std::vector<Nodes>> surfaces;           ///< of these edges
   int sections = 0;
   std::vector<Card> cards;
   std::set<std::string> keywords; ///< all that are there
};

/** Reads nodes, elements, sets, surfaces, sections, and what *CLOAD and *BOUNDARY say in any
    step; *INCLUDE is followed, what else there is passed over. InputError, with file and line,
    for what would make the body another one than is thought: nodes off z = 0, *TRANSFORM,
    couplings of nodes, several parts, instances that are moved, a thickness that is not 1,
    elements of both formulations, surfaces inside of the body. */
InputDeck read_input_deck(const std::string &file);

} // namespace cattaneo
