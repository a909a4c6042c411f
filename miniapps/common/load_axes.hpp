#pragma once

#include "common/units.hpp"

#include <cattaneo/load_pattern.hpp>
#include <string>

namespace miniapp
{

/// A load in physical units: force over displacement, where its size is known
/// (cattaneo::LoadSize).
struct LoadAxes
{
   std::string force, displacement; ///< labels of axes, with the units of the case
   /// Units of the size and of force over displacement, " [N]"; empty if not known.
   std::string unit, stiffness_unit;
   bool forces = true; ///< does the multiplier scale forces?
   double size = 1;

   double force_of(double multiplier, double conjugate) const
   {
      return forces ? size * multiplier : conjugate / size;
   }
   double displacement_of(double multiplier, double conjugate) const
   {
      return forces ? conjugate / size : size * multiplier;
   }
   /// Force over displacement, from multiplier over conjugate or the other way round.
   double stiffness(double of_multipliers) const
   {
      return forces ? of_multipliers * size * size : of_multipliers / (size * size);
   }
};

/// @param whole false: its conjugate is only the part of the contact
LoadAxes load_axes(const cattaneo::LoadPattern &pattern, const Units &units, bool whole = true);

} // namespace miniapp
