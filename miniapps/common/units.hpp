#pragma once

#include <string>

namespace miniapp
{

/// The units that a case names, for printed results. Nothing is converted: all numbers are in
/// these units, or in any consistent ones if none are named.
struct Units
{
   std::string length, force; ///< empty: not named
   /// True: forces are per unit of thickness.
   bool per_thickness = false;

   /// " [N/mm²]" of (1, -2), the powers of force and length; nothing without names.
   std::string of(int forces, int lengths) const;
   /// The same for quantities that add up over the thickness: forces (0), moments and energies
   /// (1), stiffnesses (-1).
   std::string total(int lengths) const { return of(1, lengths - (per_thickness ? 1 : 0)); }
};

/// A heading with its unit; empty without a heading.
inline std::string headed(const std::string &heading, const std::string &unit)
{
   return heading.empty() ? "" : heading + unit;
}

} // namespace miniapp
