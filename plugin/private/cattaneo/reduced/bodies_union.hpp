#pragma once

#include <cattaneo/reduced/relative_displacement.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

/** Bodies on the relative displacements of contact nodes: the formula of reduce(bodies,
    interfaces). `groups`: numbers of the bodies that interfaces join, those that touch a rigid
    obstacle left out (nothing moves them together without moving them against it). */
Block united(const std::vector<CondensedBody> &bodies, const std::vector<ContactRow> &rows,
             const std::vector<std::vector<int>> &groups, const Reduction::PatternIndex &index,
             const std::vector<LoadPattern> &patterns);

/// The contact nodes of a union over interfaces, of which some are tied.
struct UnionRows
{
   std::vector<ContactRow> rows;
   std::vector<std::vector<int>> groups; ///< see united()
   std::vector<int> free, tied;          ///< numbers of rows
};

/// The block of bodies on the nodes that are not tied; their components one after the other.
Block united(const std::vector<CondensedBody> &bodies, const UnionRows &rows,
             const Reduction::PatternIndex &index, const std::vector<LoadPattern> &patterns);

/// reduce(bodies, interfaces) by the rows of interfaces, whatever matches.
Reduction reduce_by_rows(std::vector<CondensedBody> bodies,
                         const std::vector<Interface> &interfaces);

/// What a body is called in a sentence.
std::string called(const std::vector<CondensedBody> &bodies, int body);
/// What some of them are called.
std::string called(const std::vector<CondensedBody> &bodies, const std::vector<int> &some);

} // namespace cattaneo
