#pragma once

#include <cattaneo/condense/smooth_side.hpp>
#include <mfem.hpp>
#include <optional>
#include <vector>

namespace cattaneo
{

/// A free side that keeps the chords of a curve, so that the wall beside it is thinner or
/// thicker than it should be.
struct WallOfChords
{
   Eigen::Vector2d place{0, 0}; ///< the middle of a chord
   double off = 0;              ///< by which the curves thicken the wall there
   double wall = 0;             ///< the wall's thickness between chords
};

/// The result of curve_sides().
struct SmoothSides
{
   int edges = 0;       ///< elements of the sides that are taken for chords of smooth curves
   double most = 0;     ///< the farthest that a curve is from its chord
   bool moved = false;  ///< nodes of the mesh lie on the curves of `chords` now
   int free_edges = 0;  ///< of the body's other sides: chords whose nodes lie on curves now
   int free_chords = 0; ///< of these other sides: chords whose nodes do not
   std::optional<WallOfChords> thinned; ///< of free_chords, whose wall changes most
   /// The edges along those sides, with the curve of each (straight ones too): for
   /// bend_elements(line, chords).
   std::vector<SideChord> chords;
   /// Edges of the sides in contact that are not in `chords`, because the elements beside them
   /// would fold: their nodes stay on the chord. For bend_elements(line, folding).
   std::vector<SideChord> folding;
};

/** Reads sides of a mesh with straight edges as the smooth curves through their vertices
    (smooth_curve()), where there are such, and moves the nodes of elements of `order` 2 or more
    onto them. The mesh gets nodes of that order (mfem::Mesh::SetCurvature). Those along the
    sides move, and those within the elements beside them. Vertices stay. All sides of the body
    are curved, because a wall between a curve and chords would have a wrong thickness. The
    result lists the sides in contact. Real corners stay, and so do sides whose edges are curved
    already. If elements beside the sides would fold, the elements behind them are moved too. If
    that does not help, edges of free sides stay straight, and as the last resort those of sides
    in contact (SmoothSides::folding). With `order` 1 nothing is moved, because contact_line()
    finds the curves by itself.

    @param attributes boundary attributes of the sides in contact
    @param curves of each boundary element the curve of the file that it is on, see
           read_mesh(); empty: not known
    @param planes boundary attributes that supports hold, which may be planes of symmetry: only
           there, and at x = 0, does a curve go on as its mirror image
    @return what was done. InputError for an mfem::ParMesh: call this before it is made. */
SmoothSides curve_sides(mfem::Mesh &mesh, int order, const std::vector<int> &attributes,
                        const std::vector<int> &curves = {},
                        const std::vector<int> &planes = {});

} // namespace cattaneo
