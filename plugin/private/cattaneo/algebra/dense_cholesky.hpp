#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/** Cholesky factor L of a dense symmetric positive definite matrix, M = L Lᵀ: LAPACK's, or
    Eigen's if built without it. */
class DenseCholesky
{
public:
   /// Replaces the factor; only the lower triangle is read. False if M is not positive
   /// definite.
   bool compute(Eigen::MatrixXd matrix);
   /// Smallest square of L's diagonal. Each square is the energy of a unit displacement of an
   /// unknown while those before it are free.
   double smallest_pivot() const;
   /// x <- M⁻¹ x
   void solve(Eigen::VectorXd &x) const;
   /// M⁻¹ x, one right-hand side a column.
   Eigen::MatrixXd solved(Eigen::MatrixXd x) const;
   /// x <- L⁻¹ x, one right-hand side a column.
   void solve_half(Eigen::Ref<Eigen::MatrixXd> x) const;
   /// x <- L⁻ᵀ x
   void solve_other_half(Eigen::Ref<Eigen::MatrixXd> x) const;
   /// M⁻¹, symmetric to the last bit.
   Eigen::MatrixXd inverse() const;

private:
   void solve_triangle(const char *transposed, Eigen::Ref<Eigen::MatrixXd> x) const;

   Eigen::MatrixXd factor_;
};

/// S - Yᵀ Y for a symmetric S, symmetric to the last bit.
Eigen::MatrixXd minus_square(Eigen::MatrixXd S, const Eigen::Ref<const Eigen::MatrixXd> &Y);
/// C <- C - Xᵀ Y
void subtract_product(Eigen::MatrixXd &C, const Eigen::Ref<const Eigen::MatrixXd> &X,
                      const Eigen::Ref<const Eigen::MatrixXd> &Y);

} // namespace cattaneo
