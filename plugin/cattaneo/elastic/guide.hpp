#pragma once

#include <array>
#include <optional>
#include <string>

namespace cattaneo
{

/** How a part of a boundary moves that is a rigid block: a grip, a stiff plate, a bearing. Its
    motions are along x, along y and about its centre; about an axis of revolution the one along
    it alone is left. The missing one of both is the conjugate of the load: the displacement of
    a force, the reaction of a displacement. */
struct Guide
{
   /// How it moves in one way.
   enum class Motion
   {
      held,
      free,
      force,       ///< its load is the force on the block, about the centre a moment
      displacement ///< its load is how far it moves, about the centre an angle
   };
   /// One of its three motions.
   struct Along
   {
      Motion motion = Motion::free; ///< in this way
      std::string load = {};        ///< name of the pattern, of force or displacement
      double value = 1;             ///< per unit multiplier
   };

   Along x;                      ///< along x, to the right
   Along y;                      ///< along y (the axis), upwards
   Along rotation{Motion::held}; ///< about the centre, counter-clockwise; angles in radians
   /// Not given: the middle of the box around the part.
   std::optional<std::array<double, 2>> centre = std::nullopt;
};

} // namespace cattaneo
