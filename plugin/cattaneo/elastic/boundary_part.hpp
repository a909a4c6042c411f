#pragma once

#include <cattaneo/scalar_field.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace cattaneo
{

/// Part of a body's boundary: all boundary elements of the given attributes, or only the piece
/// of them where lo <= coordinate <= hi. The ends of the interval need not be nodes of the
/// mesh.
struct BoundaryPart
{
   std::vector<int> attributes;
   int axis = 0; ///< coordinate of the interval: 0 = x, 1 = y
   double lo = -std::numeric_limits<double>::infinity();
   double hi = std::numeric_limits<double>::infinity();

   BoundaryPart(int attribute) : attributes{attribute} {}
   BoundaryPart(std::vector<int> some) : attributes(std::move(some)) {}
   BoundaryPart(std::vector<int> some, int axis_, double lo_, double hi_)
      : attributes(std::move(some)), axis(axis_), lo(lo_), hi(hi_)
   {
   }
};

} // namespace cattaneo
