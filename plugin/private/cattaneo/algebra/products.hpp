#pragma once

#include <Eigen/Core>
#include <vector>

/// Products and gathered rows of dense matrices, compiled once: each kind of expression takes
/// the compiler as long as some thirty lines. Not for inner loops over small blocks.
namespace cattaneo
{

/// A B
Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd> &A,
                        const Eigen::Ref<const Eigen::MatrixXd> &B);
/// Aᵀ B
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd> &A,
                                   const Eigen::Ref<const Eigen::MatrixXd> &B);
/// C <- C + factor A B
void add_product(Eigen::Ref<Eigen::MatrixXd> C, const Eigen::Ref<const Eigen::MatrixXd> &A,
                 const Eigen::Ref<const Eigen::MatrixXd> &B, double factor = 1);
/// S <- S + factor A Aᵀ, only in the lower triangle of S.
void add_square(Eigen::Ref<Eigen::MatrixXd> S, const Eigen::Ref<const Eigen::MatrixXd> &A,
                double factor = 1);

/// Rows of M in the given order; -1 gives a row of zeros.
Eigen::MatrixXd rows_of(const Eigen::Ref<const Eigen::MatrixXd> &M,
                        const std::vector<int> &rows);
/// Rows and columns of M in the given order; -1 gives zeros.
Eigen::MatrixXd block_of(const Eigen::Ref<const Eigen::MatrixXd> &M,
                         const std::vector<int> &rows, const std::vector<int> &columns);

} // namespace cattaneo
