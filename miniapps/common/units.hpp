#pragma once

#include <string>

namespace miniapp
{

/// The units that a case names, for what is printed. Nothing is converted: all numbers are in
/// them, or in consistent ones that nobody has named.
struct Units
{
   std::string length, force; ///< empty: not named
   /// Forces that add up over the thickness are those of one unit of length of it.
   bool per_thickness = false;

   /// " [N/mm²]" of (1, -2), the powers of force and length; nothing without names.
   std::string of(int forces, int lengths) const;
   /// The same of what adds up over the thickness: forces (0), moments and energies (1),
   /// stiffnesses (-1).
   std::string total(int lengths) const { return of(1, lengths - (per_thickness ? 1 : 0)); }
};

/// A heading with its unit; nothing where there is no heading.
inline std::string headed(const std::string &heading, const std::string &unit)
{
   return heading.empty() ? "" : heading + unit;
}

} // namespace miniapp
