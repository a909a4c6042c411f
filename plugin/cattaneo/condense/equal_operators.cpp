#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/condense/equal_operators.hpp>

namespace cattaneo
{

bool equal_operators(const mfem::SparseMatrix &A, const mfem::SparseMatrix &B)
{
   if (&A == &B) { return true; }
   const int n = A.Height(), entries = A.NumNonZeroElems();
   if (B.Height() != n || B.NumNonZeroElems() != entries ||
       !std::equal(A.GetI(), A.GetI() + n + 1, B.GetI()) ||
       !std::equal(A.GetJ(), A.GetJ() + entries, B.GetJ()))
   {
      return false;
   }
   const Eigen::Map<const Eigen::VectorXd> a(A.GetData(), entries), b(B.GetData(), entries);
   return (a - b).lpNorm<Eigen::Infinity>() <= 1e-12 * a.lpNorm<Eigen::Infinity>();
}

} // namespace cattaneo
