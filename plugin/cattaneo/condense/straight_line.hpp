#pragma once

#include <cattaneo/condense/contact_line.hpp>

namespace cattaneo
{

/** The trace of a body above y = 0 without a mesh: elements of one order that end at the given
    places, x (or r), increasing. In axisymmetry and torsion a node on the axis is left out. Its
    weights are not known. InputError if the places do not increase. */
ContactLine straight_line(const std::vector<double> &grid, int order,
                          Formulation formulation = Formulation::plane);

} // namespace cattaneo
