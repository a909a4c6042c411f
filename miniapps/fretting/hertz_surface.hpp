#pragma once

#include "fretting/pad.hpp"

namespace miniapp
{

/** Tractions and stress on the surface of the specimen under a cylinder, MPa over x in mm from
    the middle of contact: Hertz, Mindlin, and with bulk stress Nowell and Hills. At peak load;
    in a cycle with the load ratio -1 <= R < 1 they are those of the first loading. */
class HertzSurface
{
public:
   explicit HertzSurface(const Pad &pad);
   /// Is the stick zone within the contact? If not, the bulk stress is so large that an edge
   /// slips against the shear, and there is no closed form.
   bool valid() const;
   double pressure(double x) const;
   double shear(double x) const;  ///< on the specimen, along x
   double stress(double x) const; ///< σ_xx

   double half_width, stick, shift; ///< of the stick zone: its half-width and its middle

private:
   double sign_, peak_, friction_, bulk_;
};

} // namespace miniapp
