#include <algorithm>
#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;

/// Size of a block, such that two blocks fit into the first cache.
static constexpr int block_width = 32;
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                            block_width, block_width>;

void mirror_lower(Eigen::Ref<MatrixXd> M)
{
   const Index n = M.rows();
   for (Index j = 0; j < n; j += block_width)
   {
      const Index columns = std::min<Index>(block_width, n - j);
      auto diagonal = M.block(j, j, columns, columns);
      diagonal.triangularView<Eigen::StrictlyUpper>() = diagonal.transpose();
      for (Index i = j + columns; i < n; i += block_width)
      {
         const Index rows = std::min<Index>(block_width, n - i);
         M.block(j, i, columns, rows) = M.block(i, j, rows, columns).transpose();
      }
   }
}

double largest_skew(const Eigen::Ref<const MatrixXd> &A, const Eigen::Ref<const MatrixXd> &B)
{
   // If A and B are the same matrix, one triangle is enough.
   const bool one = A.data() == B.data() && A.rows() == B.rows();
   double largest = 0;
   for (Index j = 0; j < A.cols(); j += block_width)
   {
      const Index columns = std::min<Index>(block_width, A.cols() - j);
      for (Index i = one ? j : 0; i < A.rows(); i += block_width)
      {
         const Index rows = std::min<Index>(block_width, A.rows() - i);
         const Block off =
            A.block(i, j, rows, columns) - B.block(j, i, columns, rows).transpose();
         const double most = off.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
         if (std::isnan(most)) { return most; }
         largest = std::max(largest, most);
      }
   }
   return largest;
}

MatrixXd symmetric_times(const Eigen::Ref<const MatrixXd> &S,
                         const Eigen::Ref<const MatrixXd> &X)
{
#ifdef CATTANEO_USE_LAPACK
   MatrixXd Y(X.rows(), X.cols());
   const int n = static_cast<int>(S.rows()), stride = static_cast<int>(S.outerStride()),
             next = 1;
   const double once = 1, nothing = 0;
   const OneThread alone(OneThread::reads_once * n * n);
   for (Index k = 0; k < X.cols(); ++k)
   {
      dsymv_("L", &n, &once, S.data(), &stride, X.col(k).data(), &next, &nothing,
             Y.col(k).data(), &next);
   }
   return Y;
#else
   return S.selfadjointView<Eigen::Lower>() * X;
#endif
}

void remove_motions(MatrixXd &S, const MatrixXd &Q)
{
   const MatrixXd SQ = symmetric_times(S, Q), W = Q * (0.5 * (Q.transpose() * SQ)) - SQ;
   const Index n = S.rows();
   for (Index j = 0; j < n && Q.cols() > 0; j += block_width)
   {
      const Index columns = std::min<Index>(block_width, n - j), rows = n - j;
      S.block(j, j, rows, columns) +=
         Q.bottomRows(rows).lazyProduct(W.middleRows(j, columns).transpose()) +
         W.bottomRows(rows).lazyProduct(Q.middleRows(j, columns).transpose());
   }
   mirror_lower(S);
}

} // namespace cattaneo
