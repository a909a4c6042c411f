#pragma once

#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** InputError unless the mesh is plane (in the xy plane, coordinates of dimension 2) and each
    of its elements is the image of its reference element one to one:

    - it has an area, beyond the round-off of its coordinates;
    - the determinant of its Jacobian is positive everywhere: it is a polynomial, also for
    curved elements, and its Bernstein coefficients bound it from below; if they do not decide,
    the element is divided into four [Johnen 2013];
    - it lies on the other side of each edge that it shares than its neighbour there. Readers
    reverse elements that are numbered clockwise, so that a node that was dragged across an edge
    does not show as a negative determinant. (This is not checked at hanging edges, nor across
    ranks.)

    The message names the first such element by its number (from 0, as MFEM counts), attribute
    and centre, and says what to do. Collective on an mfem::ParMesh: the number is that of all
    ranks, and all throw. */
void check_elements(mfem::Mesh &mesh);

/// Numbers of the elements of this rank whose own shape does not meet the first two conditions
/// above.
std::vector<int> folded_elements(mfem::Mesh &mesh, const std::vector<int> &elements);

} // namespace cattaneo
