#include <cattaneo/algebra/products.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Ref = Eigen::Ref<const MatrixXd>;

MatrixXd product(const Ref &A, const Ref &B)
{
   return A * B;
}

MatrixXd transposed_product(const Ref &A, const Ref &B)
{
   return A.transpose() * B;
}

void add_product(Eigen::Ref<MatrixXd> C, const Ref &A, const Ref &B, double factor)
{
   C.noalias() += factor * A * B;
}

void add_square(Eigen::Ref<MatrixXd> S, const Ref &A, double factor)
{
   S.selfadjointView<Eigen::Lower>().rankUpdate(A, factor);
}

MatrixXd rows_of(const Ref &M, const std::vector<int> &rows)
{
   MatrixXd made(rows.size(), M.cols());
   for (Index j = 0; j < made.cols(); ++j)
   {
      for (Index i = 0; i < made.rows(); ++i)
      {
         made(i, j) = rows[i] < 0 ? 0.0 : M(rows[i], j);
      }
   }
   return made;
}

MatrixXd block_of(const Ref &M, const std::vector<int> &rows, const std::vector<int> &columns)
{
   MatrixXd made = MatrixXd::Zero(rows.size(), columns.size());
   for (Index j = 0; j < made.cols(); ++j)
   {
      for (Index i = 0; i < made.rows() && columns[j] >= 0; ++i)
      {
         if (rows[i] >= 0) { made(i, j) = M(rows[i], columns[j]); }
      }
   }
   return made;
}

} // namespace cattaneo
