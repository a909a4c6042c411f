#pragma once

namespace cattaneo
{

/// How the boundary of a body goes on beyond an end of a contact line.
enum class LineEnd : signed char
{
   unknown,
   smooth,   ///< the tangent goes on, so contact may go on too
   corner,   ///< it turns there
   symmetry, ///< the end lies on a plane or the axis of symmetry
   open      ///< the line goes on with nodes that are assumed to stay open (closed_contact())
};

} // namespace cattaneo
