#include <algorithm>
#include <cattaneo/condense/row_links.hpp>
#include <cmath>

namespace cattaneo
{

void RowEntries::add(const SparseView &K, int row, int own)
{
   for (SparseView::InnerIterator entry(K, row); entry; ++entry)
   {
      if (entry.col() == own)
      {
         diagonal = entry.value();
         continue;
      }
      largest = std::max(largest, std::abs(entry.value()));
      sum += std::abs(entry.value());
   }
}

bool RowEntries::link(double most) const
{
   return stand_out(most) || (largest > 0 && diagonal <= 2 * sum);
}

double largest_beside_diagonal(const SparseView &K, bool square)
{
   RowEntries all;
   for (int row = 0; row < K.rows(); ++row) { all.add(K, row, square ? row : -1); }
   return all.largest;
}

bool is_linked(const SparseView &K, const DofPlaces &places, int dof, double most)
{
   if (!couples(K, dof, dof)) { return false; }
   RowEntries entries;
   entries.add(K, dof, dof);
   if (entries.stand_out(most)) { return true; }
   const int component = places.component[dof];
   if (!entries.link(most)) { return false; }
   if (places.formulation != Formulation::plane && component == 0)
   {
      return entries.diagonal > 0;
   }
   double resistance = 0;
   for (SparseView::InnerIterator entry(K, dof); entry; ++entry)
   {
      if (places.component[entry.col()] == component) { resistance += entry.value(); }
   }
   return std::abs(resistance) <= 1e-6 * entries.sum;
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
