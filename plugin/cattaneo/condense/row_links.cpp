#include <algorithm>
#include <cattaneo/condense/row_links.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

void RowEntries::add(const SparseView &K, int row, int own, const Eigen::VectorXd &diagonals)
{
   for (SparseView::InnerIterator entry(K, row); entry; ++entry)
   {
      const double value = entry.value();
      if (entry.col() == own)
      {
         diagonal = value;
         continue;
      }
      if (value == 0) { continue; }
      largest = std::max(largest, std::abs(value));
      sum += std::abs(value);
      const double other = diagonals[entry.col()];
      squares += other > 0 ? value / other * value : std::numeric_limits<double>::infinity();
   }
}

bool RowEntries::link(double most) const
{
   return stand_out(most) || (largest > 0 && diagonal <= 2 * sum);
}

Eigen::VectorXd diagonal_of(const SparseView &K)
{
   Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(K.rows());
   for (int row = 0; row < K.rows(); ++row)
   {
      for (SparseView::InnerIterator entry(K, row); entry; ++entry)
      {
         if (entry.col() == row) { diagonal[row] = entry.value(); }
      }
   }
   return diagonal;
}

double largest_beside_diagonal(const SparseView &K, bool square)
{
   double largest = 0;
   for (int row = 0; row < K.rows(); ++row)
   {
      for (SparseView::InnerIterator entry(K, row); entry; ++entry)
      {
         if (square && entry.col() == row) { continue; }
         largest = std::max(largest, std::abs(entry.value()));
      }
   }
   return largest;
}

bool is_linked(const RowEntries &entries, Formulation formulation, int component, double most,
               double resistance)
{
   if (entries.stand_out(most)) { return true; }
   if (!entries.link(most)) { return false; }
   if (formulation != Formulation::plane && component == 0) { return entries.diagonal > 0; }
   return std::abs(resistance) <= 1e-6 * entries.sum;
}

bool is_linked(const SparseView &K, const DofPlaces &places, int dof, double most,
               const Eigen::VectorXd &diagonals)
{
   RowEntries entries;
   entries.add(K, dof, dof, diagonals);
   const int component = places.component[dof];
   double resistance = 0;
   for (SparseView::InnerIterator entry(K, dof); entry; ++entry)
   {
      if (places.component[entry.col()] == component) { resistance += entry.value(); }
   }
   return is_linked(entries, places.formulation, component, most, resistance);
}

SharedMatrix without_links(const SharedMatrix &K, const std::vector<int> &rows)
{
   Eigen::SparseMatrix<double, Eigen::RowMajor> kept = K.view();
   const auto has = [&](Eigen::Index row)
   { return std::binary_search(rows.begin(), rows.end(), static_cast<int>(row)); };
   kept.prune([&](Eigen::Index row, Eigen::Index column, double)
              { return row == column || !(has(row) || has(column)); });
   return SharedMatrix(std::move(kept));
}

} // namespace cattaneo
