#pragma once

#include <array>
#include <optional>
#include <string>

namespace cattaneo
{

/** Motion of a part of a boundary that moves as a rigid block: a grip, a stiff plate, a
    bearing. Its motions are along x, along y and about its centre; about an axis of revolution
    only the one along the axis; in space three along the axes and three about them. For each
    motion either the force or the displacement is given
    as a load. The other one is its conjugate. */
struct Guide
{
   /// How it moves along one of its motions.
   enum class Motion
   {
      held,
      free,
      force,       ///< its load is the force on the block, about the centre a moment
      displacement ///< its load is how far it moves, about the centre an angle
   };
   /// One of its motions.
   struct Along
   {
      Motion motion = Motion::free; ///< along this motion
      std::string load = {};        ///< name of the pattern, of force or displacement
      double value = 1;             ///< per unit multiplier
   };

   Along x;                      ///< along x, to the right
   Along y;                      ///< along y (the axis), upwards
   Along rotation{Motion::held}; ///< about the centre, counter-clockwise; angles in radians
   /// Not given: the middle of the box around the part. The third coordinate is used in space.
   std::optional<std::array<double, 3>> centre = std::nullopt;
   Along z = {};                   ///< in space along z
   Along rotation_x{Motion::held}; ///< in space about x; `rotation` is about z
   Along rotation_y{Motion::held}; ///< in space about y

   /// The motions in space: along x, y and z, about x, y and z.
   std::array<const Along *, 6> in_space() const
   {
      return {&x, &y, &z, &rotation_x, &rotation_y, &rotation};
   }
};

} // namespace cattaneo
