#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

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

/** What an .inp of CalculiX or ABAQUS says of a matrix that was assembled from it: formulation,
    places, edges and sets (also nodes of the element sets), and the cards. Reads nodes, plane
   and axisymmetric elements, sets, and what *CLOAD and *BOUNDARY say in any step; *INCLUDE is
   followed, what else there is passed over. InputError for what would make the matrix another
   one than is thought: nodes off z = 0, *TRANSFORM, several parts, instances that are moved, a
   thickness that is not 1, elements of both formulations. */
std::vector<Card> read_input_deck(const std::string &file, NodalStiffness &body);

} // namespace cattaneo
