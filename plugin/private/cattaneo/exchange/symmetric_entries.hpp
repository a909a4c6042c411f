#pragma once

#include <Eigen/Sparse>
#include <functional>
#include <string>
#include <vector>

namespace cattaneo
{

/// Entries of a symmetric matrix as a file has them: all, or one of each pair of mirrored ones,
/// in any order of the rows.
class SymmetricEntries
{
public:
   using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

   void add(int row, int column, double value) { entries_.emplace_back(row, column, value); }

   /** The whole matrix. InputError if an entry is listed twice, if an entry and its mirror
       image are both there and differ by more than 1e-10 of the largest, or if a row (one that
       `is_elastic`) has no positive diagonal. The sentence begins with `file`, and names rows
       by `row_name`, and the matrix by `kind`. */
   Matrix matrix(
      int size, const std::string &file, const std::function<std::string(int)> &row_name,
      const std::function<bool(int)> &is_elastic = [](int) { return true; },
      const char *kind = "stiffness") const;

private:
   std::vector<Eigen::Triplet<double>> entries_;
};

} // namespace cattaneo
