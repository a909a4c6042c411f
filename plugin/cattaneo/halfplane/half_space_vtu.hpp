#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <string>

namespace cattaneo
{

/** Writes a state of the contact of half-spaces as a VTU file (for ParaView, PyVista, meshio):
    one quadrilateral or triangle for each cell, with `pressure`, `shear` (of the body above)
   and `slip` as vectors, `opening` w + gap, and `state`, the number of its NodeState from
    settled_states(). Files with numbered names, one for each state of a march, are one series
    for ParaView. InputError if the problem is not that of the contact, the state not of the
    problem, or the file cannot be written. */
void write_vtu(const std::string &file, const HalfSpace &contact, const ReducedProblem &problem,
               const ContactState &state);

} // namespace cattaneo
