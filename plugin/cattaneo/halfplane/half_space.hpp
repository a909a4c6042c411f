#pragma once

#include <cattaneo/material.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <optional>
#include <vector>

namespace cattaneo
{

/** Two elastic half-spaces that meet in the plane z = 0, or one on a rigid body: frictional
    contact in three dimensions without a mesh of the bodies. The surface that may touch is cut
    into cells on which tractions are uniform: equal rectangles, where the laws of contact hold
    at the centres [Kalker 1990], or triangles of any size, where they hold in the mean over
    each of them, so that the flexibility is symmetric. Displacements are Boussinesq's and
    Cerruti's, integrated over each cell in closed form [Love 1929], with the coupling between
    normal and tangential directions. They are relative to infinity.

    A cell is a contact node: the first tangent is x, the second y, and the normal z, into the
    body above. Forces are those that this body takes, displacements its own less those of the
    body below. */
struct HalfSpace
{
   Material material; ///< material of the body above; plane strain
   std::optional<Material>
      other;                   ///< material of the body below, plane strain; empty: it is rigid
   Eigen::Vector2d size{1, 1}; ///< edges of each rectangle along x and y, > 0
   /// Centres of the n rectangles that may touch, n × 2. They lie on one grid (they differ by
   /// whole edges), and may be any of its cells, in any order. Empty if there are triangles.
   Eigen::MatrixX2d centres;
   Eigen::MatrixX2d vertices; ///< x and y, of the triangles
   /// Corners of the n triangles that may touch, n × 3: rows of `vertices`, from 0, in either
   /// sense. Two triangles with a common edge share its two vertices.
   Eigen::MatrixX3i triangles;
   /// Is the body above free to turn about the normal through x = y = 0? It never tilts.
   bool turns = false;
   /// Does a body end at the rim of the cells, as a flat punch does? If not, contact that is
   /// compressed there is cut off, and reports say so.
   bool ends = false;

   /// InputError for a material that is not valid or is of plane stress, edges that are not
   /// positive, rectangles that do not lie on one grid, to 1e-9 of an edge, or are there twice,
   /// triangles without area (1e-12 of their longest edge squared), with vertices that do not
   /// exist, or two of which lie on the same side of an edge, or both kinds of cells.
   void validate() const;

   Eigen::Index nodes() const;       ///< number n of the cells
   Eigen::VectorXd areas() const;    ///< of the cells
   Eigen::MatrixX2d middles() const; ///< centres of area of the cells, n × 2

   /** Outlines of some cells, those of true entries (size n), along their edges: closed lines
       k × 2 of which the last point is the first one. The cells lie on their left, so that
       they run counter-clockwise around a part and clockwise around a hole; parts that touch
       with a corner alone have an outline each. With states from settled_states() they are the
       edges of contact and of stick. InputError as of validate(), or for another size. */
   std::vector<Eigen::MatrixX2d> outlines(const std::vector<bool> &cells) const;

   /** The frictional contact of these bodies with a gap of each cell (size n), measured at the
       centre of a rectangle, or the mean over a triangle, without friction until
       set_friction(). It has two tangential components, areas as weights, middles as positions
       (n × 3, z = 0), and, unless a body `ends` there, a rim: the rectangles that lack one of
       four neighbours, or the triangles that have an edge without a neighbour.

       The body above moves freely under its far forces. Patterns "P" (towards the other body),
       "Q1" and "Q2" (along x and y) have a unit force each, and, if it `turns`, "T" a unit
       moment about z. Their conjugates are the approach, the shifts and the turn of the far
       body. These motions are the problem's rigid motions.

       Costs a Cholesky factor of 3n rows, or of 2n and of n where nothing couples normal and
       tangential directions: between equal materials, and where the combined constant
       (1 - 2ν)/G of both bodies is the same.

       InputError as of validate(), for a gap of another size, one cell alone, or cells so many
       and long that their flexibility is not positive definite. */
   ReducedProblem problem(const Eigen::VectorXd &gap) const;

   /** Displacements at points of the surface (m × 2) under nodal forces {q; p} of the cells
       (size 3n): those of the body above less those of the body below, m × 3 along x, y and z.
       The rigid motions of the far bodies are not included. InputError as of validate(), or for
       other sizes. */
   Eigen::MatrixX3d displacements(const Eigen::MatrixX2d &points,
                                  const Eigen::VectorXd &forces) const;

   /// Resultant on the body above of nodal forces {q; p} of the cells (size 3n): force and
   /// moment about x = y = 0, along x, y and z. InputError as of validate(), or for another
   /// size.
   Eigen::Matrix<double, 6, 1> resultant(const Eigen::VectorXd &forces) const;

   /** Stresses at points (m × 3) inside of the bodies under nodal forces {q; p} of the cells
       (size 3n): m × 6, xx, yy, zz, yz, zx and xy, positive in tension. Points with z > 0 lie
       in the body above, with z < 0 in the one below, at z = 0 just inside of the body above.
       On an edge of a cell at z = 0 stresses jump or have no limit. InputError as of
       validate(), for other sizes, or for a point in a rigid body. */
   Eigen::Matrix<double, Eigen::Dynamic, 6> stresses(const Eigen::MatrixX3d &points,
                                                     const Eigen::VectorXd &forces) const;
};

} // namespace cattaneo
