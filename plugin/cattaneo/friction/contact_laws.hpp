#pragma once

#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

/// What arithmetic leaves of the sums K u + f, row by row: 4 ε (|K| |u| + |f|). All rows are
/// given the bound by the largest row sum, which is cheaper, where it is below 1e-11 of the
/// largest f and the diagonal of K spans less than four decades.
class RoundOff
{
public:
   /// Keeps a reference to K, symmetric.
   explicit RoundOff(const Eigen::Ref<const Eigen::MatrixXd> &K);
   /// `size`: bound of |u| entry by entry; f: forces with u = 0.
   Eigen::VectorXd rows(const Eigen::VectorXd &size, const Eigen::VectorXd &f) const;

private:
   const Eigen::Ref<const Eigen::MatrixXd> K_;
   double norm_ = 0;
   bool graded_ = false;
};

/// Tangential entries of one node, one or two.
using NodeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;

/// How far a state is from an answer of an increment, in forces.
struct LawCheck
{
   double normal = 0, tangential = 0; ///< largest violations
   bool obeyed = true;                ///< no node is violated by more than is allowed to it
};

/** Judges the end of an increment that began with the slip v_old, from the problem as it is
    given: the stated forces are those of the stated displacements, F = K u + Σ λ_k f_k, and
    these obey the laws: no penetration, no tension, no pressure across a gap, no friction
   beyond f p, and what slips does so against a friction force of f p. A gap and a slip count by
   the node's own stiffness; a slip x that does not oppose its friction by the smaller of the
   force that is missing, |q + f p x/|x||, and of that of the slip itself.

    `forces`: K u + Σ λ_k f_k of the state's own displacements, {q; p}, formed anew by the
   caller from the stiffness as it is given. `allowed`: what is allowed to each node, a force
   (tolerance); `round_off` what arithmetic leaves, for each row of {q; p}. The direction of a
   slip in the disc is known to the round-off of displacements over its length only, which is
   allowed too (and counted all the same). */
LawCheck check_laws(const ReducedProblem &problem, const Eigen::VectorXd &v_old,
                    const ContactState &state, const Eigen::VectorXd &forces, double allowed,
                    const Eigen::VectorXd &round_off);

/// The tangential part for one node with tangential forces q, slip x, own stiffness k and
/// friction bound f p, one or two entries each. `uncertain`: what round-off leaves of x, which
/// excuses that much of an angle.
double slip_violation(const NodeVector &q, const NodeVector &x, double k, double bound,
                      double uncertain = 0);
/// That of displacements of such size.
double slip_round_off(double size);

} // namespace cattaneo
