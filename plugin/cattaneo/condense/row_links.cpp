#include <algorithm>
#include <cattaneo/condense/row_links.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

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
   if (about_axis(formulation) && component == 0) { return entries.diagonal > 0; }
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

namespace
{

/// The direction of alone_on_a_slope() of the node with the dofs x and y.
std::optional<AloneDirection> alone_direction(const SparseView &K, int x, int y)
{
   // Entries of the two rows, within the node's block and outside it.
   Eigen::Matrix2d block = Eigen::Matrix2d::Zero();
   std::map<Eigen::Index, Eigen::Vector2d> beside;
   for (int k = 0; k < 2; ++k)
   {
      for (SparseView::InnerIterator entry(K, k == 0 ? x : y); entry; ++entry)
      {
         if (entry.col() == x) { block(k, 0) = entry.value(); }
         else if (entry.col() == y) { block(k, 1) = entry.value(); }
         else
         {
            beside.try_emplace(entry.col(), Eigen::Vector2d::Zero()).first->second[k] =
               entry.value();
         }
      }
   }
   // The direction t of the longest column, and n perpendicular to it.
   Eigen::Vector2d t = Eigen::Vector2d::Zero();
   for (const auto &[column, entries] : beside)
   {
      if (entries.norm() > t.norm()) { t = entries; }
   }
   const double longest = t.norm();
   if (longest == 0) { return std::nullopt; }
   t /= longest;
   const Eigen::Vector2d n(-t[1], t[0]);
   // If the direction is along an axis, it is a single row, which is_linked() recognizes.
   if (std::min(std::abs(n[0]), std::abs(n[1])) < 1e-12) { return std::nullopt; }
   for (const auto &[column, entries] : beside)
   {
      if (std::abs(n.dot(entries)) > 1e-12 * longest) { return std::nullopt; }
   }
   const double size = block.norm(), diagonal = n.dot(block * n);
   // A bar at an angle has no stiffness across its direction, and is not a support.
   if (std::abs(t.dot(block * n)) > 1e-12 * size || diagonal <= 1e-14 * size)
   {
      return std::nullopt;
   }
   return AloneDirection{x, y, n, diagonal};
}

} // namespace

std::optional<AloneDirection> alone_on_a_slope(const SparseView &K, const DofPlaces &places,
                                               const std::vector<int> &fixed)
{
   if (places.formulation == Formulation::space) { return std::nullopt; }
   // The two components in the plane; about an axis they are radial and axial.
   std::map<std::pair<double, double>, std::pair<std::vector<int>, std::vector<int>>> nodes;
   for (int dof = 0; dof < K.rows(); ++dof)
   {
      const int component = places.component[dof];
      if (component > 1 || std::binary_search(fixed.begin(), fixed.end(), dof)) { continue; }
      auto &[x, y] = nodes[{places.x[dof], places.y[dof]}];
      (component == 0 ? x : y).push_back(dof);
   }
   // Several nodes may be at one place: the dofs of two of them fail the test.
   for (const auto &[place, dofs] : nodes)
   {
      for (const int x : dofs.first)
      {
         for (const int y : dofs.second)
         {
            if (const auto found = alone_direction(K, x, y)) { return found; }
         }
      }
   }
   return std::nullopt;
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
