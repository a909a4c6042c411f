#pragma once

#include <cattaneo/condense/smooth_side.hpp>
#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/// What curve_sides() found and did.
struct SmoothSides
{
   int edges = 0;      ///< boundary elements that are taken for chords of smooth curves
   double most = 0;    ///< the farthest that a curve is from its chord
   bool moved = false; ///< nodes of the mesh lie on the curves of `chords` now
   /// The edges along those sides, with the curve of each (straight ones too): for
   /// bend_elements(line, chords).
   std::vector<SideChord> chords;
   /// Those of them that are not in `chords`, as the elements beside them would fold: their
   /// nodes stay on the chord, for bend_elements(line, folding).
   std::vector<SideChord> folding;
};

/** Takes sides of a mesh with straight edges for the smooth curves that their vertices are of
    (smooth_curve()), where they are, and moves the nodes of elements of `order` 2 or more onto
    them: the mesh gets nodes of that order (mfem::Mesh::SetCurvature), of which those along the
    sides, and those within the elements beside them, move; vertices stay. Real corners stay,
    and so do sides whose edges are curved already. Elements beside the sides that would fold
    take the next ones with them; where that does not help their edges stay straight
    (SmoothSides::folding), and only theirs. With `order` 1 nothing is moved: contact_line()
    knows of curves by itself.

    @param attributes boundary attributes of the sides that are looked at
    @param curves of each boundary element the curve of the file that it is on, see
           read_mesh(); empty: not known
    @return what was done. InputError of an mfem::ParMesh: to be called before it is made. */
SmoothSides curve_sides(mfem::Mesh &mesh, int order, const std::vector<int> &attributes,
                        const std::vector<int> &curves = {});

} // namespace cattaneo
