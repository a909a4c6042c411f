#pragma once

#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/reduced/reduction.hpp>

namespace cattaneo
{

/// Of two bodies whose nodes match.
class PairUnion : public Reduction::Union
{
public:
   DenseCholesky sum; ///< of S1 + S2 (+ springs on common rigid motions) where both are free
   Eigen::MatrixXd difference;    ///< f1 - f2 of each pattern
   std::vector<int> held1, held2; ///< rows that a body holds: the other alone moves there
   Eigen::MatrixXd of_held;       ///< columns of S1 that body 2 holds
   std::vector<int> partner;
   FrameChange frames; ///< from body 2's own frames (in the order of body 1)

   /// Where body 2 has the rows of body 1's order.
   std::vector<int> order(Eigen::Index rows) const;
   Eigen::VectorXd own(const std::vector<CondensedBody> &bodies, int b,
                       const Eigen::VectorXd &relative,
                       const Eigen::VectorXd &multipliers) const override;

private:
   Eigen::VectorXd to_second(const Eigen::VectorXd &u) const;
};

/// Do supports hold a component of a contact node, 0 along its frame or 1 across?
bool holds(const CondensedBody &body, int node, int component);

/// One or two bodies on relative displacements: f = S u + Σ λ_k f_k.
struct Block
{
   Eigen::MatrixXd S, f, H;
   Eigen::MatrixXd motions;                          ///< that nothing resists, orthonormal
   std::vector<int> held;                            ///< rows that no body moves
   std::shared_ptr<const Reduction::Union> way_back; ///< of several bodies
};

/// Numbers of the bodies' patterns among all, which grow by those that are new.
Reduction::PatternIndex join(const std::vector<CondensedBody> &bodies,
                             std::vector<LoadPattern> &all);

/// One body on a rigid obstacle, of `count` patterns.
Block alone(const CondensedBody &body, const std::vector<int> &index, Eigen::Index count);

/// Forces {q; p} of a body's patterns as columns, in the order of the joined patterns.
Eigen::MatrixXd clamped_forces(const CondensedBody &body, const std::vector<int> &index,
                               Eigen::Index count);
void add_response(const CondensedBody &body, const std::vector<int> &index, Eigen::MatrixXd &H);

/// InputError if a load pattern does work on motions that nothing resists; else the rounding of
/// that work is taken from the forces. `motions`: orthonormal columns; `forces`: a column a
/// pattern; `scale`: their size; `bodies`: whose motions they are.
void balance(const Eigen::MatrixXd &motions, Eigen::MatrixXd &forces,
             const Eigen::VectorXd &scale, const std::vector<LoadPattern> &patterns,
             const std::string &bodies);

/// Stiffness, loads, motions and held components of a reduced problem of two components a node,
/// without gaps and friction.
void take(Block block, ReducedProblem &problem);

/// Two bodies, by the formulas of reduce().
Block united(const CondensedBody &first, const CondensedBody &second,
             const std::vector<int> &partner, const Reduction::PatternIndex &index,
             const std::vector<LoadPattern> &patterns);

} // namespace cattaneo
