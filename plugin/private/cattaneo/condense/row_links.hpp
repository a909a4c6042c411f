#pragma once

#include <Eigen/Core>
#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <optional>
#include <vector>

namespace cattaneo
{

/// Entries of a row of a stiffness on the diagonal and off it.
struct RowEntries
{
   double diagonal = 0;
   double largest = 0; ///< largest magnitude off the diagonal
   double sum = 0;     ///< of the magnitudes off the diagonal
   double squares = 0; ///< sum of k_ij²/k_jj off the diagonal; infinite if a k_jj is 0

   /// Adds the row of K, whose diagonal is in column `own` (-1: in none). `diagonals`: of the
   /// matrix, in the columns of K.
   void add(const SparseView &K, int row, int own, const Eigen::VectorXd &diagonals);
   /// Do entries above round-off link the row with others? Entries off the diagonal are
   /// round-off if they are at most 1e-12 of `most`, the largest such entry of the matrix,
   /// unless the diagonal is as small as they are, as in a soft material beside a stiff one.
   bool link(double most) const;
   /// Is any entry off the diagonal larger than the round-off of `most` and of the diagonal?
   bool stand_out(double most) const { return largest > 1e-12 * most && !holds_alone(); }
   /** Does the diagonal alone hold the dof, however the others move? Then other dofs move it by
       at most 1e-12 of their own displacement, and it adds less than a rounding to their
       stiffness: Σ k_ij²/(k_ii k_jj) ≤ 1e-16. It acts as a support, be it a stiff spring or an
       eliminated row whose zeros are round-off of a large diagonal. */
   bool holds_alone() const { return sum <= 1e-12 * diagonal && squares <= 1e-16 * diagonal; }
};

/// The diagonal of a square K.
Eigen::VectorXd diagonal_of(const SparseView &K);

/// The largest magnitude off the diagonal in rows of K. `square`: rows and columns belong to
/// the same dofs; otherwise there is no diagonal.
double largest_beside_diagonal(const SparseView &K, bool square = true);

/** Is the dof linked with others by more than round-off?

    If all entries of a row are round-off (of the largest entries or of its own diagonal), it
    belongs either to an eliminated support, whatever its diagonal is, or to a material that is
    much softer than another one in the body. A row of such a material does not resist a
    translation along its own component (about an axis: along z only).
    @param diagonals of K */
bool is_linked(const SparseView &K, const DofPlaces &places, int dof, double most,
               const Eigen::VectorXd &diagonals);
/// The same for a row whose entries are known. `resistance` is the force in this row that a
/// translation of all dofs along its component causes.
bool is_linked(const RowEntries &entries, Formulation formulation, int component, double most,
               double resistance);

/// A direction of a node in which nothing links the node with others.
struct AloneDirection
{
   int x = 0, y = 0;          ///< the node's dofs
   Eigen::Vector2d direction; ///< of length 1, neither along x nor along y
   double diagonal = 0;       ///< stiffness along it
};

/** In the plane and about an axis: the first node with a direction oblique to the axes that
    only a diagonal holds, to 1e-12 of the stiffness in the node's rows. It is a support on a
    slope that was eliminated in its own axes before K was turned back to x and y. Rows of
    `fixed` dofs (sorted) are skipped.

    Both rows of the node then have entries off the diagonal, but one is a multiple of the
    other. The direction that they do not resist is a principal one of the node's own 2 × 2
    block. */
std::optional<AloneDirection> alone_on_a_slope(const SparseView &K, const DofPlaces &places,
                                               const std::vector<int> &fixed);

/// K without the entries that link the sorted `rows` with others. In eliminated rows these are
/// round-off.
SharedMatrix without_links(const SharedMatrix &K, const std::vector<int> &rows);

} // namespace cattaneo
