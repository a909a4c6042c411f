#include <cattaneo/exchange/symmetric_entries.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <set>

namespace cattaneo
{

SymmetricEntries::Matrix
SymmetricEntries::matrix(int size, const std::string &file,
                         const std::function<std::string(int)> &row_name,
                         const std::function<bool(int)> &is_elastic, const char *kind) const
{
   const auto place = [&](int row, int column)
   { return "file '" + file + "': entry (" + row_name(row) + ", " + row_name(column) + ")"; };
   Matrix K(size, size);
   K.setFromTriplets(entries_.begin(), entries_.end());
   const auto known = static_cast<Eigen::Index>(entries_.size());
   std::set<std::pair<int, int>> seen;
   bool twice = false; // both triangles are there
   for (const Eigen::Triplet<double> &e : entries_)
   {
      twice = twice || (e.row() != e.col() && e.value() != 0 && K.coeff(e.col(), e.row()) != 0);
      if (K.nonZeros() == known || seen.insert({e.row(), e.col()}).second) { continue; }
      require(false, place(e.row(), e.col()), " is listed twice, must be listed once");
   }
   const double allowed = known > 0 ? 1e-10 * K.coeffs().cwiseAbs().maxCoeff() : 0.0;
   const Matrix mirrored = K.transpose(),
                skew = twice ? Matrix(K - mirrored) : Matrix(size, size);
   for (int row = 0; row < size; ++row)
   {
      for (Matrix::InnerIterator e(skew, row); e; ++e)
      {
         const auto column = static_cast<int>(e.col());
         if (std::abs(e.value()) <= allowed) { continue; }
         require(false, place(row, column), " is ", K.coeff(row, column),
                 " and its mirror image ", K.coeff(column, row), ", the ", kind,
                 " must be symmetric (one triangle of it, or both)");
      }
   }
   for (int row = 0; row < size; ++row)
   {
      if (K.coeff(row, row) > 0 || !is_elastic(row)) { continue; }
      // An empty row may be a support that was eliminated, which is checked later.
      if (Matrix(K.row(row)).norm() == 0 && Matrix(mirrored.row(row)).norm() == 0) { continue; }
      require(false, place(row, row), " is ", K.coeff(row, row), ", the diagonal of a ", kind,
              " must be positive");
   }
   return twice ? K : Matrix(K + mirrored - Matrix(K.diagonal().asDiagonal()));
}

} // namespace cattaneo
