#pragma once

#include <Eigen/Dense>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/sparse_factor.hpp>

namespace cattaneo
{

/** Error of a condensed stiffness in energies: an upper estimate of |uᵀ (S - S*) u| / uᵀ S u
    over all motions u of the contact nodes that the body resists. S* is the stiffness in exact
    arithmetic. Forces of given compliances have about the same relative error. It is infinite
    if S does not resist a motion that the body resists.

    The error is tested with random motions that have the same energy in every direction, and so
    contain a part of the worst motion. For a matrix E = L⁻¹ (S - S*) L⁻ᵀ, S = L Lᵀ, and r
    standard normal vectors ω

       ‖E‖ <= 10 √(2/π) max ‖E ω‖ except with probability 10⁻ʳ

    ([Halko 2011], lemma 4.1); r = 3. The vectors are the same
    each time. */
class StiffnessProbes
{
public:
   /// @a S is the condensed stiffness in global components, as it is used. @a motions are
   /// orthonormal columns that S does not resist.
   StiffnessProbes(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions);
   /// Motions of the contact, one per column; none if S is no longer definite.
   const Eigen::MatrixXd &motions() const { return u_; }
   /// The bound from differences of forces at these motions, one in each column: 10 √(2/π) max
   /// ‖L⁻¹ d‖; infinite without motions.
   double bound(Eigen::MatrixXd differences) const;

private:
   Eigen::MatrixXd Q_, u_;
   DenseCholesky factor_; ///< L, of S with the motions held
};

/** The estimate for a stiffness that comes from a factor. It is the sum of two errors:

    - elimination: S u against the action of K, the stiffness as it was given, W = {-K_II⁻¹ K_IC
      u; u} by the factor, its residual in extended precision, and the residual's own forces by
      the factor again;
    - assembly of K in floating point: random changes of up to 2 ε √(K_ii K_jj) of every entry,
      seen at the contact.

    @a keep, @a contact: as SparseFactor has them. Three right-hand sides are solved, twice, and
    a dense matrix of the size of S is factored. */
double stiffness_error(const SharedMatrix &stiffness, const std::vector<int> &keep, int contact,
                       const SparseFactor &factor, const Eigen::MatrixXd &S,
                       const Eigen::MatrixXd &motions);

} // namespace cattaneo
