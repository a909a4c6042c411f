#pragma once

#include <Eigen/Core>

/// Passes over large matrices and their transposes, block by block. Entry by entry, one of the
/// two would be read across its columns, which is several times slower.
namespace cattaneo
{

/// Copies the lower triangle into the upper one.
void mirror_lower(Eigen::Ref<Eigen::MatrixXd> M);

/// Largest |A - Bᵀ|, NaN if one of the differences is; 0 without entries. A and B may be the
/// same matrix.
double largest_skew(const Eigen::Ref<const Eigen::MatrixXd> &A,
                    const Eigen::Ref<const Eigen::MatrixXd> &B);

/// S X for a symmetric S, of which only the lower triangle is read, and an X with few columns.
Eigen::MatrixXd symmetric_times(const Eigen::Ref<const Eigen::MatrixXd> &S,
                                const Eigen::Ref<const Eigen::MatrixXd> &X);

/// (1 - Q Qᵀ) S (1 - Q Qᵀ) for a symmetric S and few orthonormal columns, symmetric to the last
/// bit. It removes the resistance to these motions that is only round-off.
void remove_motions(Eigen::MatrixXd &S, const Eigen::MatrixXd &Q);

} // namespace cattaneo
