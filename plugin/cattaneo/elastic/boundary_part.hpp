#pragma once

#include <cattaneo/input_error.hpp>
#include <limits>
#include <mfem.hpp>
#include <utility>
#include <vector>

namespace cattaneo
{

/// Part of a body's boundary: all boundary elements of the given attributes, or only the piece
/// of them where lo <= coordinate <= hi. The ends of the interval need not be nodes of the
/// mesh, but in space loads and contact need whole faces.
struct BoundaryPart
{
   std::vector<int> attributes; ///< of its boundary elements, from 1
   int axis = 0;                ///< coordinate of the interval: 0 = x, 1 = y, 2 = z
   double lo = -std::numeric_limits<double>::infinity(); ///< lower end of the interval, in the
                                                         ///< mesh's units
   double hi = std::numeric_limits<double>::infinity();  ///< upper end
   /// An interval of a coordinate: 0 = x, 1 = y, 2 = z.
   struct Interval
   {
      int axis;  ///< coordinate
      double lo; ///< lower end, in the mesh's units
      double hi; ///< upper end
   };
   /// In space: further intervals, in all of which the piece lies.
   std::vector<Interval> also = {};
   /// Number of entries of the marker from which it was made; 0: without a marker
   int marked = 0;

   /// All of its intervals.
   std::vector<Interval> intervals() const
   {
      std::vector<Interval> all{{axis, lo, hi}};
      all.insert(all.end(), also.begin(), also.end());
      return all;
   }

   /// All of one attribute.
   BoundaryPart(int attribute) : attributes{attribute} {}
   /// All of some attributes.
   BoundaryPart(std::vector<int> some) : attributes(std::move(some)) {}
   /// From MFEM's marker: 1 for each boundary attribute (from 1) that belongs to the part, else
   /// 0. When the part is used, InputError unless the marker has an entry for each attribute of
   /// the mesh.
   BoundaryPart(const mfem::Array<int> &marker) : marked(marker.Size())
   {
      for (int k = 0; k < marker.Size(); ++k)
      {
         require(marker[k] == 0 || marker[k] == 1, "boundary marker: entry ", k, " of ",
                 marker.Size(), " is ", marker[k],
                 ", must be 0 or 1 (a list of attributes is a std::vector<int>)");
         if (marker[k] == 1) { attributes.push_back(k + 1); }
      }
      require(!attributes.empty(), "boundary marker: none of its ", marker.Size(),
              " entries is 1, at least one must be");
   }
   /// The part of some attributes between `lo_` and `hi_` of coordinate `axis_`.
   BoundaryPart(std::vector<int> some, int axis_, double lo_, double hi_)
      : attributes(std::move(some)), axis(axis_), lo(lo_), hi(hi_)
   {
   }
};

} // namespace cattaneo
