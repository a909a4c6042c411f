#pragma once

#include <Eigen/Sparse>
#include <memory>
#include <vector>

namespace cattaneo
{

/// A sparse matrix, stored by rows, whose arrays belong to another program.
using SparseView = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>;

/// Does the row have an entry other than zero besides the one in column `own`?
bool couples(const SparseView &K, int row, int own);

/// A square sparse matrix by rows that another program may own. It is kept alive but not
/// copied.
class SharedMatrix
{
public:
   SharedMatrix() = default;
   /// Row i has `value[k]` in column `column[k]`, for k from `start[i]` to `start[i + 1]` - 1.
   /// The arrays live as long as `owner`.
   SharedMatrix(int size, const int *start, const int *column, const double *value,
                std::shared_ptr<const void> owner);
   /// Keeps the matrix itself.
   explicit SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor> matrix);

   /// Number of rows.
   int size() const { return size_; }
   /// A view without a copy of the entries; valid as long as this object or a copy of it lives.
   SparseView view() const
   {
      return {size_, size_, start_ ? start_[size_] : 0, start_, column_, value_};
   }
   /// The entry on the diagonal, 0 if none is stored.
   double diagonal(int row) const;
   /// True if the other has the same pattern and entries equal to 1e-12 of the largest.
   bool equals(const SharedMatrix &other) const;
   /// Rows in connected groups (graph of the stored entries), each sorted.
   std::vector<std::vector<int>> connected_parts() const;

private:
   int size_ = 0;
   const int *start_ = nullptr, *column_ = nullptr;
   const double *value_ = nullptr;
   std::shared_ptr<const void> owner_;
};

} // namespace cattaneo
