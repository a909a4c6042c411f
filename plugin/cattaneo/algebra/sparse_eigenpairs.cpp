#include <Spectra/SymGEigsShiftSolver.h>
#include <algorithm>
#include <cattaneo/algebra/sparse_eigenpairs.hpp>
#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

namespace
{

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// y = (K - σ M)⁻¹ x, as the Lanczos method asks for it.
class ShiftedInverse
{
public:
   using Scalar = double; ///< asked for by the method
   explicit ShiftedInverse(const SparseFactor &factor) : factor_(factor) {}
   Eigen::Index rows() const { return factor_.rows(); }
   Eigen::Index cols() const { return factor_.rows(); }
   void set_shift(double) {} // the factor has it
   void perform_op(const double *x, double *y) const
   {
      const Eigen::Map<const Eigen::VectorXd> from(x, rows());
      Eigen::Map<Eigen::VectorXd>(y, rows()) = factor_.solve(from);
   }

private:
   const SparseFactor &factor_;
};

/// y = M x on some rows.
class MassProduct
{
public:
   using Scalar = double; ///< asked for by the method
   MassProduct(const RowMatrix &M, const std::vector<int> &keep)
      : M_(M), keep_(keep), whole_(Eigen::VectorXd::Zero(M.rows()))
   {
   }
   Eigen::Index rows() const { return static_cast<Eigen::Index>(keep_.size()); }
   Eigen::Index cols() const { return rows(); }
   void perform_op(const double *x, double *y) const
   {
      whole_(keep_) = Eigen::Map<const Eigen::VectorXd>(x, rows());
      const Eigen::VectorXd product = M_ * whole_;
      Eigen::Map<Eigen::VectorXd>(y, rows()) = product(keep_);
   }

private:
   const RowMatrix &M_;
   const std::vector<int> &keep_;
   mutable Eigen::VectorXd whole_; // zero beyond the rows
};

} // namespace

Eigenpairs lowest_eigenpairs(const RowMatrix &K, const RowMatrix &M,
                             const std::vector<int> &keep, int count, double shift)
{
   const auto rows = static_cast<int>(keep.size());
   require(count >= 1 && count < rows, "eigenpairs: ", count, " are asked for of ", rows,
           " rows, must be from 1 to ", rows - 1);
   const RowMatrix shifted = K + shift * M;
   const SparseFactor factor({shifted.rows(), shifted.cols(), shifted.nonZeros(),
                              shifted.outerIndexPtr(), shifted.innerIndexPtr(),
                              shifted.valuePtr()},
                             keep, 0, 0.0);
   ShiftedInverse inverse(factor);
   MassProduct mass(M, keep);
   Spectra::SymGEigsShiftSolver<ShiftedInverse, MassProduct, Spectra::GEigsMode::ShiftInvert>
      solver(inverse, mass, count, std::min(rows, std::max(2 * count + 1, 20)), -shift);
   solver.init();
   solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-13, Spectra::SortRule::SmallestAlge);
   Eigenpairs found;
   found.all = solver.info() == Spectra::CompInfo::Successful;
   found.values = solver.eigenvalues();
   found.vectors = Eigen::MatrixXd::Zero(K.rows(), found.values.size());
   found.vectors(keep, Eigen::all) = solver.eigenvectors();
   // The lowest first, and of unit mass to round-off.
   for (Eigen::Index k = 0; k < found.values.size(); ++k)
   {
      auto x = found.vectors.col(k);
      x /= std::sqrt(x.dot(M * x));
      found.values[k] = x.dot(K * x);
   }
   std::vector<Eigen::Index> order(found.values.size());
   for (std::size_t k = 0; k < order.size(); ++k) { order[k] = static_cast<Eigen::Index>(k); }
   std::sort(order.begin(), order.end(),
             [&](auto i, auto j) { return found.values[i] < found.values[j]; });
   found.values = Eigen::VectorXd(found.values(order));
   found.vectors = Eigen::MatrixXd(found.vectors(Eigen::all, order));
   return found;
}

} // namespace cattaneo
