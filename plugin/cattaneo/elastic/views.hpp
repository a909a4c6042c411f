#pragma once

#include <algorithm>
#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/input_error.hpp>
#include <mfem.hpp>

namespace cattaneo
{

/// MFEM's vectors and matrices as those of Eigen, without copying.
inline Eigen::Map<const Eigen::VectorXd> view(const mfem::Vector &x)
{
   return {x.GetData(), x.Size()};
}
/// InputError for a matrix that is not finalized. Valid as long as it lives.
inline SparseView view(const mfem::SparseMatrix &K)
{
   require(K.Finalized(), "sparse matrix: the matrix (", K.Height(), "×", K.Width(),
           ") is not finalized, it must be (SparseMatrix::Finalize)");
   return {K.Height(), K.Width(), K.NumNonZeroElems(), K.GetI(), K.GetJ(), K.GetData()};
}
/// Keeps the matrix alive.
inline SharedMatrix shared(const std::shared_ptr<const mfem::SparseMatrix> &K)
{
   return {K->Height(), K->GetI(), K->GetJ(), K->GetData(), K};
}
/// A copy.
inline mfem::Vector to_mfem(const Eigen::VectorXd &x)
{
   mfem::Vector copy(static_cast<int>(x.size()));
   std::copy(x.data(), x.data() + x.size(), copy.GetData());
   return copy;
}

} // namespace cattaneo
