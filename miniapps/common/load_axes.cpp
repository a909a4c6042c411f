#include "common/load_axes.hpp"

#include "common/text.hpp"

namespace miniapp
{

using namespace cattaneo;

namespace
{

/// " along x", " along -y" or " along (0.6, 0.8)"; empty for a load without a direction.
std::string along(const LoadSize &size)
{
   const auto [x, y] = size.direction;
   if (x == 0 && y == 0) { return ""; }
   if (x != 0 && y != 0) { return text(" along (%.3g, %.3g)", x, y); }
   return std::string(" along ") + (x + y < 0 ? "-" : "") + (x != 0 ? "x" : "y");
}

} // namespace

LoadAxes load_axes(const LoadPattern &pattern, const Units &units, bool whole)
{
   const LoadSize &size = pattern.size;
   const std::string &kind = size.kind, &name = pattern.name;
   const std::string place = size.place.empty() ? "" : " of " + size.place,
                     length = units.of(0, 1), force = units.total(0), moment = units.total(1);
   LoadAxes made;
   made.forces = pattern.control == Control::force;
   made.size = size.value;
   if (kind == "force" || kind == "opposite forces")
   {
      made.unit = force;
      made.force = "force " + name + force;
      made.displacement = "displacement" + place +
                          (kind == "force" ? along(size) : " along its forces") + length;
   }
   else if (kind == "displacement")
   {
      made.unit = length;
      made.force = "reaction " + name + force;
      made.displacement = "displacement " + name + place + along(size) + length;
   }
   else if (kind == "moment" || kind == "torque")
   {
      made.unit = moment;
      made.force = kind + " " + name + moment;
      made.displacement = "rotation" + place + " (radians)";
   }
   else if (kind == "rotation")
   {
      made.unit = " (radians)";
      made.force = "moment of " + name + moment;
      made.displacement = "rotation " + name + place + " (radians)";
   }
   else if (kind == "bolt")
   {
      made.unit = force;
      made.force = "pretension of bolt " + name + force;
      made.displacement = "approach of the ends of bolt " + name + length;
   }
   else if (!kind.empty()) // a load without a resultant
   {
      made.unit = kind == "stress" || kind == "pressure" ? units.of(1, -2) : "";
      made.force = kind + " " + name + made.unit;
      made.displacement = "work over " + kind + " " + name;
   }
   else
   {
      const std::string factor = "load factor " + name, per = " per unit of " + factor;
      made.force = made.forces ? factor : "reaction" + per;
      made.displacement = made.forces ? "displacement" + per : factor;
   }
   if (kind == "force" || kind == "opposite forces" || kind == "displacement" || kind == "bolt")
   {
      made.stiffness_unit = units.total(-1);
   }
   else if (kind == "moment" || kind == "torque" || kind == "rotation")
   {
      made.stiffness_unit = moment;
   }
   if (!whole)
   {
      (made.forces ? made.displacement : made.force) += ", the part of the contact alone";
   }
   return made;
}

} // namespace miniapp
