#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

namespace cattaneo
{

/// What an .inp of CalculiX or ABAQUS says of a matrix that was assembled from it.
struct InputDeck
{
   std::string file;
   Formulation formulation = Formulation::plane;
   NodalStiffness::Places places;
   /// Of nodes, and nodes of the element sets; in capitals.
   NodalStiffness::Sets sets;
   std::vector<std::vector<int>> edges; ///< NodalStiffness::edges

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
   std::vector<Card> cards;
};

/** Reads nodes, plane and axisymmetric elements, sets, and what *CLOAD and *BOUNDARY say in any
    step; *INCLUDE is followed, what else there is passed over. InputError for what would make
    the matrix another one than is thought: nodes off z = 0, *TRANSFORM, several parts,
   instances that are moved, a thickness that is not 1, elements of both formulations. */
InputDeck read_input_deck(const std::string &file);

} // namespace cattaneo
