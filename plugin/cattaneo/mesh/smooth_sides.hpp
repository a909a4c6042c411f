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
   bool moved = false; ///< nodes of the mesh lie on the curves now
   /// Curves that the nodes could not be moved onto without folding an element: none were.
   bool folds = false;
   /// All edges along those sides, with the curve of each (straight ones too): for
   /// bend_elements(), where the mesh stays as it is.
   std::vector<SideChord> chords;
};

/** Takes sides of a mesh with straight edges for the smooth curves that their vertices are of
    (smooth_curve()), where they are, and moves the nodes of elements of `order` 2 or more onto
    them: the mesh gets nodes of that order (mfem::Mesh::SetCurvature), of which those along the
    sides, and those within the elements beside them, move; vertices stay. Real corners stay,
    and so do sides whose edges are curved already. Elements beside the sides that would fold
    take the next ones with them; where that does not help nothing is moved. With `order` 1
    nothing is moved either: contact_line() knows of curves by itself.

    @param attributes boundary attributes of the sides that are looked at
    @param curves of each boundary element the curve of the file that it is on, see
           read_mesh(); empty: not known
    @return what was done. InputError of an mfem::ParMesh: to be called before it is made. */
SmoothSides curve_sides(mfem::Mesh &mesh, int order, const std::vector<int> &attributes,
                        const std::vector<int> &curves = {});

} // namespace cattaneo
