#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace cattaneo
{

struct Eigenpairs
{
   Eigen::VectorXd values;  ///< ascending
   Eigen::MatrixXd vectors; ///< columns, xᵀ M x = 1
   bool all = true;         ///< false: the method did not find as many as were asked for
};

/** The lowest `count` eigenpairs of K x = λ M x on the rows `keep` of both, all other rows of x
    being zero. K is symmetric and semidefinite, M symmetric and definite. By the Lanczos method
    on (K + shift M)⁻¹ M, with one factor. Vectors have all rows.

    InputError if the shifted matrix is not positive definite, or if there are fewer rows than
    pairs. */
Eigenpairs lowest_eigenpairs(const Eigen::SparseMatrix<double, Eigen::RowMajor> &K,
                             const Eigen::SparseMatrix<double, Eigen::RowMajor> &M,
                             const std::vector<int> &keep, int count, double shift);

} // namespace cattaneo
