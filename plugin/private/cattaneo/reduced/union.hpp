#pragma once

#include <cattaneo/reduced/reduction.hpp>
#include <cattaneo/reduced/relative_displacement.hpp>

namespace cattaneo
{

/// The contact nodes of all interfaces, of which some are tied.
struct UnionRows
{
   std::vector<ContactRow> rows;
   /// Numbers of the bodies that interfaces join. Bodies that touch a rigid obstacle are left
   /// out, because a motion of the whole group moves them against it.
   std::vector<std::vector<int>> groups;
   std::vector<int> free, tied; ///< numbers of rows
};

/// Bodies on relative displacements: f = S u + Σ ℓ_k f_k.
struct Block
{
   Eigen::MatrixXd S, f, H;
   Eigen::MatrixXd motions;                   ///< motions that nothing resists, orthonormal
   std::vector<int> held;                     ///< rows that no body moves
   std::vector<InterfaceReport::Moved> moved; ///< see there
   std::shared_ptr<const Reduction::Union> way_back; ///< to the bodies' displacements
};

/** Bodies on the relative displacements of the contact nodes that are not tied, components one
    after the other: the formula of reduce(bodies, interfaces). InputError if a common motion of
    a group is loaded, or if bodies can move where all contact nodes stick. */
Block united(const std::vector<CondensedBody> &bodies, const UnionRows &rows,
             const Reduction::PatternIndex &index, const std::vector<LoadPattern> &patterns);

/// Makes a reduced problem of the block, without gaps and friction, with `components` per node.
void take(Block block, int components, ReducedProblem &problem);

/// Index of each body's patterns in `all`. Appends new patterns to `all`.
Reduction::PatternIndex join(const std::vector<CondensedBody> &bodies,
                             std::vector<LoadPattern> &all);

/// Forces {q; p} of a body's patterns as columns, in the order of the joined patterns.
Eigen::MatrixXd clamped_forces(const CondensedBody &body, const std::vector<int> &index,
                               Eigen::Index count);

/// Motions of a group of bodies as one, which nothing resists, as orthonormal columns in U.
Eigen::MatrixXd common_motions(const std::vector<CondensedBody> &bodies,
                               const std::vector<int> &group, const RelativeDisplacement &map);
/// Free motions of all bodies, orthogonal to the common motions Y among them, as columns in U.
Eigen::MatrixXd motions_apart(const std::vector<CondensedBody> &bodies,
                              const RelativeDisplacement &map, const Eigen::MatrixXd &Y);

/// The name of a body in messages.
std::string called(const std::vector<CondensedBody> &bodies, int body);
/// The names of some bodies in messages.
std::string called(const std::vector<CondensedBody> &bodies, const std::vector<int> &some);

} // namespace cattaneo
