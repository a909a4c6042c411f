#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace cattaneo
{

namespace
{

/// Scales every row by its own stiffness. Otherwise a soft node beside a stiff one would look
/// like a node that nothing holds.
Eigen::VectorXd scale_of(const Eigen::MatrixXd &A)
{
   const Eigen::VectorXd own = A.diagonal();
   return (own.array() > 0).select(own.cwiseSqrt().cwiseInverse(), 1.0);
}

/// Is the energy of a motion no more than the rounding of the entries causes? Entries of a
/// condensed matrix are sums of about as many terms as it has rows. Their round-off has either
/// sign, so it grows as the square root of that number.
bool rests(const Eigen::MatrixXd &A, const Eigen::VectorXd &motion)
{
   using Long = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
   const Long x = motion.cast<long double>();
   long double energy = 0, round_off = 0;
   for (Eigen::Index j = 0; j < x.size(); ++j)
   {
      energy += x[j] * A.col(j).cast<long double>().dot(x);
      round_off += std::abs(x[j]) * A.col(j).cwiseAbs().cast<long double>().dot(x.cwiseAbs());
   }
   // A clearly negative energy does not count as rest. The matrix is not semidefinite then.
   return std::abs(energy) <= 8 * std::sqrt(static_cast<long double>(x.size())) *
                                 std::numeric_limits<double>::epsilon() * round_off;
}

} // namespace

SemidefiniteSolver::SemidefiniteSolver(const Eigen::MatrixXd &A,
                                       const Eigen::MatrixXd &null_space)
   : scale_(scale_of(A)), null_(scale_.cwiseInverse().asDiagonal() * null_space)
{
   Eigen::MatrixXd scaled = scale_.asDiagonal() * A * scale_.asDiagonal();
   if (null_.cols() > 0)
   {
      null_ = thin_qr(null_).Q;
      scaled += null_ * null_.transpose();
   }
   ldlt_.compute(scaled);
}

bool SemidefiniteSolver::definite() const
{
   return ldlt_.vectorD().minCoeff() > 1e-13;
}

Eigen::MatrixXd SemidefiniteSolver::solve(const Eigen::MatrixXd &rhs) const
{
   Eigen::MatrixXd x = ldlt_.solve(scale_.asDiagonal() * rhs);
   x -= null_ * (null_.transpose() * x);
   return scale_.asDiagonal() * x;
}

namespace
{

/// With a diagonal of ones a motion of more energy than this cannot be one without energy.
constexpr double soft_energy = 1e-5;

/// Motions of little energy of a large matrix with a diagonal of ones, as orthonormal columns,
/// by inverse iteration from random ones. No answer if the matrix is small or not semidefinite,
/// or has more than a few such motions.
std::optional<Eigen::MatrixXd> few_soft_motions(const Eigen::MatrixXd &scaled)
{
   constexpr Eigen::Index most = 16, large = 256;
   const Eigen::Index n = scaled.rows();
   if (n < large) { return std::nullopt; }
   // 1. Each iteration multiplies a motion without energy by 1e9, and one of more than
   // `soft_energy` by 1e5 at most.
   Eigen::MatrixXd raised = scaled;
   raised.diagonal().array() += 1e-9;
   DenseCholesky factor;
   if (!factor.compute(std::move(raised))) { return std::nullopt; }
   std::mt19937_64 random(1);
   std::uniform_real_distribution<double> uniform(-1, 1);
   Eigen::MatrixXd X = Eigen::MatrixXd::NullaryExpr(n, most, [&] { return uniform(random); });
   for (int k = 0; k < 3; ++k) { X = thin_qr(factor.solved(std::move(X))).Q; }
   // 2. If stiff motions are among the columns too, no soft one is missing.
   const SymmetricModes modes = symmetric_modes(X.transpose() * (scaled * X));
   const Eigen::Index count = (modes.values.array() <= soft_energy).count();
   if (count > most / 2) { return std::nullopt; }
   return X * modes.vectors.leftCols(count);
}

/// The same for any matrix, by pivoted LDLᵀ.
Eigen::MatrixXd soft_motions(const Eigen::MatrixXd &scaled)
{
   const Eigen::Index n = scaled.rows();
   const Eigen::LDLT<Eigen::MatrixXd> ldlt(scaled);
   Eigen::MatrixXd soft(n, 0);
   for (Eigen::Index k = 0; k < n; ++k)
   {
      // A pivot is the energy of the motion that is 1 at the pivot, where a rotation about a
      // point nearby hardly moves.
      if (ldlt.vectorD()[k] > soft_energy) { continue; }
      Eigen::VectorXd motion = Eigen::VectorXd::Unit(n, k);
      ldlt.matrixU().solveInPlace(motion);
      soft.conservativeResize(Eigen::NoChange, soft.cols() + 1);
      soft.rightCols(1) = ldlt.transpositionsP().transpose() * motion.normalized();
   }
   return soft.cols() == 0 ? soft : thin_qr(soft).Q;
}

} // namespace

Eigen::MatrixXd null_space(const Eigen::MatrixXd &A)
{
   const Eigen::Index n = A.rows();
   const Eigen::VectorXd scale = scale_of(A);
   const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
   const std::optional<Eigen::MatrixXd> few = few_soft_motions(scaled);
   Eigen::MatrixXd Q = few ? *few : soft_motions(scaled);
   if (Q.cols() == 0) { return Q; }
   // The candidates have errors of the elimination before them. A motion z without energy obeys
   // (A + Q Qᵀ) z = Q Qᵀ z, so one solution with that matrix reduces the error to round-off.
   const Eigen::MatrixXd held = scaled + Q * Q.transpose();
   DenseCholesky factor;
   Q = thin_qr(factor.compute(held) ? factor.solved(Q) : held.ldlt().solve(Q)).Q;
   Q *= symmetric_modes(Q.transpose() * scaled * Q).vectors;
   std::vector<Eigen::Index> resting;
   for (Eigen::Index k = 0; k < Q.cols(); ++k)
   {
      if (rests(scaled, Q.col(k))) { resting.push_back(k); }
   }
   if (resting.empty()) { return Eigen::MatrixXd(n, 0); }
   return thin_qr(scale.asDiagonal() * Q(Eigen::all, resting)).Q;
}

bool resists_all_but(const Eigen::MatrixXd &A, const Eigen::MatrixXd &motions)
{
   const Eigen::VectorXd scale = scale_of(A);
   Eigen::MatrixXd held = scale.asDiagonal() * A * scale.asDiagonal();
   if (motions.cols() > 0)
   {
      const Eigen::MatrixXd Q = thin_qr(scale.cwiseInverse().asDiagonal() * motions).Q;
      held += Q * Q.transpose();
   }
   // If another motion without energy is left, a pivot is only round-off.
   DenseCholesky factor;
   return factor.compute(std::move(held)) && factor.smallest_pivot() > soft_energy;
}

} // namespace cattaneo
