#include <cattaneo/friction/lemke.hpp>
#include <vector>

namespace cattaneo
{

namespace
{

using Tableau = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Row that leaves the basis: least ratio of the right-hand side to the entering column; ties
/// are decided by the rows of the basis inverse (lexicographic rule). -1 if no entry is
/// positive.
Eigen::Index leaving_row(const Tableau &T, const Eigen::VectorXd &column, Eigen::Index rhs,
                         const std::vector<Eigen::Index> &basis, Eigen::Index artificial)
{
   const Eigen::Index N = T.rows();
   const double pivot_floor = 1e-11 * std::max(1.0, column.cwiseAbs().maxCoeff());
   std::vector<Eigen::Index> tied;
   double least = std::numeric_limits<double>::infinity();
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (column[i] <= pivot_floor) { continue; }
      least = std::min(least, T(i, rhs) / column[i]);
   }
   const double slack = 1e-13 * std::max(std::abs(least), 1e-300);
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (column[i] > pivot_floor && T(i, rhs) / column[i] <= least + slack)
      {
         tied.push_back(i);
      }
   }
   if (tied.empty()) { return -1; }
   // The artificial variable leaves whenever it can: that ends the method.
   for (Eigen::Index i : tied)
   {
      if (basis[i] == artificial) { return i; }
   }
   for (Eigen::Index k = 0; tied.size() > 1 && k < N; ++k)
   {
      double smallest = std::numeric_limits<double>::infinity();
      for (Eigen::Index i : tied) { smallest = std::min(smallest, T(i, k) / column[i]); }
      std::vector<Eigen::Index> still;
      for (Eigen::Index i : tied)
      {
         if (T(i, k) / column[i] <= smallest + 1e-14 * std::abs(smallest))
         {
            still.push_back(i);
         }
      }
      tied = still;
   }
   return tied.front();
}

} // namespace

LemkeReport lemke(const Eigen::MatrixXd &M, const Eigen::VectorXd &b,
                  const Eigen::VectorXd &cover, long max_pivots)
{
   const Eigen::Index N = b.size();
   LemkeReport report;
   report.z = Eigen::VectorXd::Zero(N);
   if (N == 0 || b.minCoeff() >= 0)
   {
      report.solved = true;
      return report;
   }
   // Columns: s (0 … N-1), z (N … 2N-1), the artificial variable (2N), right-hand side (2N+1).
   const Eigen::Index artificial = 2 * N, rhs = 2 * N + 1;
   Tableau T(N, 2 * N + 2);
   T.leftCols(N).setIdentity();
   T.middleCols(N, N) = -M;
   T.col(artificial) = -cover;
   T.col(rhs) = b;
   std::vector<Eigen::Index> basis(N);
   for (Eigen::Index i = 0; i < N; ++i) { basis[i] = i; }

   Eigen::Index row = 0, entering = artificial;
   b.cwiseQuotient(cover).minCoeff(&row);
   while (true)
   {
      const Eigen::VectorXd column = T.col(entering);
      T.row(row) /= column[row];
      for (Eigen::Index i = 0; i < N; ++i)
      {
         if (i != row && column[i] != 0) { T.row(i) -= column[i] * T.row(row); }
      }
      ++report.pivots;
      const Eigen::Index left = basis[row];
      basis[row] = entering;
      if (left == artificial)
      {
         report.solved = true;
         break;
      }
      if (report.pivots >= max_pivots) { return report; }
      entering = left < N ? left + N : left - N; // the complement of what left
      row = leaving_row(T, T.col(entering), rhs, basis, artificial);
      if (row < 0) { return report; }
   }
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (basis[i] >= N && basis[i] < artificial) { report.z[basis[i] - N] = T(i, rhs); }
   }
   return report;
}

} // namespace cattaneo
