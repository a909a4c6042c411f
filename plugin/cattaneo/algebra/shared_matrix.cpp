#include <algorithm>
#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/input_error.hpp>
#include <numeric>
#include <utility>

namespace cattaneo
{

bool couples(const SparseView &K, int row, int own)
{
   for (SparseView::InnerIterator entry(K, row); entry; ++entry)
   {
      if (entry.col() != own && entry.value() != 0) { return true; }
   }
   return false;
}

SharedMatrix::SharedMatrix(int size, const int *start, const int *column, const double *value,
                           std::shared_ptr<const void> owner)
   : size_(size), start_(start), column_(column), value_(value), owner_(std::move(owner))
{
}

SharedMatrix::SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor> matrix)
{
   require(matrix.rows() == matrix.cols(), "sparse matrix: it is ", matrix.rows(), "×",
           matrix.cols(), ", must be square");
   matrix.makeCompressed();
   const auto kept =
      std::make_shared<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(std::move(matrix));
   *this = SharedMatrix(static_cast<int>(kept->rows()), kept->outerIndexPtr(),
                        kept->innerIndexPtr(), kept->valuePtr(), kept);
}

double SharedMatrix::diagonal(int row) const
{
   const int *here = std::find(column_ + start_[row], column_ + start_[row + 1], row);
   return here == column_ + start_[row + 1] ? 0.0 : value_[here - column_];
}

bool SharedMatrix::equals(const SharedMatrix &other) const
{
   if (value_ == other.value_) { return true; }
   if (size_ != other.size_ || !std::equal(start_, start_ + size_ + 1, other.start_) ||
       !std::equal(column_, column_ + start_[size_], other.column_))
   {
      return false;
   }
   const Eigen::Map<const Eigen::VectorXd> a(value_, start_[size_]),
      b(other.value_, start_[size_]);
   return (a - b).lpNorm<Eigen::Infinity>() <= 1e-12 * a.lpNorm<Eigen::Infinity>();
}

std::vector<std::vector<int>> SharedMatrix::connected_parts() const
{
   const int n = size_;
   std::vector<int> parent(n);
   std::iota(parent.begin(), parent.end(), 0);
   const auto root = [&parent](int i)
   {
      while (parent[i] != i) { i = parent[i] = parent[parent[i]]; }
      return i;
   };
   for (int i = 0; i < n; ++i)
   {
      for (int k = start_[i]; k < start_[i + 1]; ++k)
      {
         if (column_[k] >= i) { continue; }
         const int a = root(i), b = root(column_[k]);
         // The lower number leads, so that each group is led by its first row.
         if (a < b) { parent[b] = a; }
         else { parent[a] = b; }
      }
   }
   std::vector<int> group(n, -1);
   std::vector<std::vector<int>> parts;
   for (int i = 0; i < n; ++i)
   {
      const int lead = root(i);
      if (group[lead] < 0)
      {
         group[lead] = static_cast<int>(parts.size());
         parts.emplace_back();
      }
      parts[group[lead]].push_back(i);
   }
   return parts;
}

} // namespace cattaneo
