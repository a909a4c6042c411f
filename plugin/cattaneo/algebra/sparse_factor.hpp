#pragma once

#include <Eigen/Dense>
#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/input_error.hpp>
#include <memory>
#include <string>
#include <vector>

namespace cattaneo
{

/// The matrix to be factored has a pivot that is not positive.
class NotPositiveDefinite : public InputError
{
public:
   /// The failure was found at a row of the whole matrix.
   NotPositiveDefinite(int row_of_K, const std::string &message)
      : InputError(message), row(row_of_K)
   {
   }
   int row; ///< row of the whole matrix at which it was found
};

/** A sparse Cholesky factor of a symmetric positive definite matrix whose last rows (the
    "trailing" ones) were ordered last, so that the trailing Schur complement can be read off
    it:

       [K11 K12]   [L11    ] [L11ᵀ L21ᵀ]
       [K21 K22] = [L21 L22] [     L22ᵀ],   K22 - K21 K11⁻¹ K12 = L22 L22ᵀ.

    Only this class uses CHOLMOD; without it (CATTANEO_USE_CHOLMOD=OFF, or Backend::eigen) Eigen
    does the same, slower, with permissive licences only. Not safe for use by several threads at
    once. */
class SparseFactor
{
public:
   /// Which library factors.
   enum class Backend
   {
      automatic, ///< CHOLMOD if built with it
      eigen
   };

   /// Factors K(keep, keep) + diag(shift on the trailing rows). `keep`: rows of K in any order,
   /// of which the last `trailing` are the trailing ones. K is assumed to be symmetric: only
   /// one triangle is read, and K is not kept. Throws NotPositiveDefinite (an InputError)
   /// naming the row of K. `nodes`: a number for each row of `keep`, the same for rows of one
   /// node. With it, and if CHOLMOD was built with METIS, rows are ordered by nested dissection
   /// of the graph of nodes. For bodies in space the factor then takes a half to a quarter of
   /// the work. Otherwise the order is one of constrained minimum degree.
   SparseFactor(const SparseView &K, const std::vector<int> &keep, int trailing, double shift,
                Backend backend = Backend::automatic, const std::vector<int> &nodes = {});
   ~SparseFactor();

   /// Schur complement of the trailing rows, in the order of `keep`, without the shift.
   Eigen::MatrixXd schur() const;
   /// Forces on the trailing rows, in the order of `keep`, that belong to displacements x
   /// there, one per column: (S + shift) x.
   Eigen::MatrixXd push(const Eigen::MatrixXd &x) const;
   /// Solves with the factored (shifted) matrix, one right-hand side per column; rows in the
   /// order of `keep`.
   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const;
   /// Number of rows that were factored.
   int rows() const;

   struct Implementation;

private:
   std::unique_ptr<Implementation> impl_;
};

} // namespace cattaneo
