#pragma once

#include <Eigen/Dense>
#include <memory>
#include <mfem.hpp>

namespace cattaneo
{

/** A sparse Cholesky factor of a symmetric positive definite matrix whose last rows (the
   "trailing" ones) were ordered last, so that the trailing Schur complement can be read off it.
   The one place that knows CHOLMOD; without it (CATTANEO_USE_CHOLMOD=OFF, or backend::eigen)
   Eigen does the same, slower, with permissive licences only. */
class SparseFactor
{
public:
   enum class Backend
   {
      automatic, ///< CHOLMOD if built with it
      cholmod,
      eigen
   };
   static bool has_cholmod();

   /// Factors K(keep, keep) + diag(shift on the trailing rows). `keep`: rows of K in any order,
   /// of which the last `trailing` are the trailing ones. InputError naming the row of K if the
   /// matrix is not positive definite.
   SparseFactor(const mfem::SparseMatrix &K, const std::vector<int> &keep, int trailing,
                double shift, Backend backend = Backend::automatic);
   ~SparseFactor();
   SparseFactor(SparseFactor &&) noexcept;
   SparseFactor &operator=(SparseFactor &&) noexcept;

   /// Schur complement of the trailing rows, in the order of `keep`, without the shift.
   Eigen::MatrixXd schur() const;
   /// Solves with the factored (shifted) matrix; x in the order of `keep`.
   Eigen::MatrixXd solve(const Eigen::MatrixXd &rhs) const;
   int rows() const;
   /// Number of non-zeros of the factor.
   long nonzeros() const;

private:
   struct Implementation;
   std::unique_ptr<Implementation> impl_;
};

} // namespace cattaneo
