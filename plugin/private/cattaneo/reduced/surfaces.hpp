#pragma once

#include <cattaneo/reduced/interface_rows.hpp>
#include <map>

namespace cattaneo
{

/** What the rows of contact nodes in space determine. Rows of two nodes join them into groups;
    an obstacle counts as body -1. One node of a group determines the others. A row of the
   mortar determines its slave, and thereby the slave's group, by nodes of other groups. */
class JoinedNodes
{
public:
   /// Joins two nodes; false if other rows determine one by the other, or both, already.
   bool join(const NodeOfBody &one, const NodeOfBody &other);
   /// Determines a slave by other nodes; false if other rows determine it already, or if it
   /// would depend on itself.
   bool determine(const NodeOfBody &slave, const std::vector<NodeOfBody> &by);

private:
   NodeOfBody root(NodeOfBody node) const;
   bool is_determined(const NodeOfBody &root) const;
   /// Does one group depend on another one, or is it the same?
   bool depends(const NodeOfBody &root_of_one, const NodeOfBody &root_of_other) const;

   std::map<NodeOfBody, NodeOfBody> up_;
   /// Of groups with a slave: the nodes that determine it.
   std::map<NodeOfBody, std::vector<NodeOfBody>> by_;
};

/// The rows of an interface of bodies in space: of nodes that match, or on an obstacle, or of
/// the mortar. Fills in its data in `met`. InputError if sides or pairing do not fit, or
/// supports hold a normal component on both sides.
std::vector<ContactRow> rows_on_surfaces(const Interface &given,
                                         const std::vector<CondensedBody> &bodies,
                                         JoinedNodes &joined, MetInterface &met);

/// InputError unless the rows of bodies in space determine each node at most once, and no node
/// that supports hold.
void require_dependents(const std::vector<CondensedBody> &bodies,
                        const std::vector<ContactRow> &rows);

/// The report of an interface in space, with the rows of its nodes.
InterfaceReport report_on_surfaces(const MetInterface &met,
                                   const std::vector<ContactRow> &rows);

/// Fills in the gaps, weights, places and dofs of the nodes of an interface in space that is
/// not tied, which begin at `first`.
void add_surface_facts(ReducedProblem &problem, Eigen::Index first, const MetInterface &met);

} // namespace cattaneo
