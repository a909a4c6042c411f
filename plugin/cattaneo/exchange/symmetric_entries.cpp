#include <algorithm>
#include <cattaneo/exchange/symmetric_entries.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <tuple>

namespace cattaneo
{

SymmetricEntries::Matrix
SymmetricEntries::matrix(int size, const std::string &file,
                         const std::function<std::string(int)> &row_name,
                         const std::function<bool(int)> &is_elastic) const
{
   const auto place = [&](const Entry &e) {
      return "file '" + file + "': entry (" + row_name(e.row) + ", " + row_name(e.column) + ")";
   };
   const auto triangle = [](const Entry &e)
   { return std::make_tuple(std::min(e.row, e.column), std::max(e.row, e.column), e.row); };
   std::vector<Entry> sorted = entries_;
   std::sort(sorted.begin(), sorted.end(),
             [&](const Entry &a, const Entry &b) { return triangle(a) < triangle(b); });
   double largest = 0;
   bool upper = false, lower = false;
   for (const Entry &e : sorted)
   {
      largest = std::max(largest, std::abs(e.value));
      upper = upper || e.row < e.column;
      lower = lower || e.row > e.column;
   }
   const auto twice = std::adjacent_find(sorted.begin(), sorted.end(),
                                         [](const Entry &a, const Entry &b)
                                         { return a.row == b.row && a.column == b.column; });
   if (twice != sorted.end())
   {
      require(false, place(*twice), " is there twice, must be there once");
   }
   std::vector<Eigen::Triplet<double>> all;
   std::vector<double> diagonal(size, 0.0);
   for (std::size_t k = 0; k < sorted.size(); ++k)
   {
      const Entry &e = sorted[k];
      all.emplace_back(e.row, e.column, e.value);
      if (e.row == e.column)
      {
         diagonal[e.row] = e.value;
         continue;
      }
      const bool paired = k + 1 < sorted.size() && sorted[k + 1].row == e.column &&
                          sorted[k + 1].column == e.row;
      const double mirrored = paired ? sorted[++k].value : upper && lower ? 0.0 : e.value;
      if (std::abs(mirrored - e.value) > 1e-10 * largest)
      {
         require(false, place(e), " is ", e.value, " and its mirror image ", mirrored,
                 ", the stiffness must be symmetric (one triangle of it, or both)");
      }
      all.emplace_back(e.column, e.row, e.value);
   }
   for (int row = 0; row < size; ++row)
   {
      if (diagonal[row] > 0 || !is_elastic(row)) { continue; }
      require(false, place({row, row, 0}), " is ", diagonal[row],
              ", the diagonal of a stiffness must be positive");
   }
   Matrix K(size, size);
   K.setFromTriplets(all.begin(), all.end());
   return K;
}

} // namespace cattaneo
