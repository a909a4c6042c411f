#pragma once

#include <cattaneo/reduced/interface_rows.hpp>
#include <map>

namespace cattaneo
{

/// The groups of nodes that rows of contact nodes join; an obstacle counts as body -1.
class JoinedNodes
{
public:
   /// Joins two nodes; false if other rows have joined them already.
   bool join(const NodeOfBody &one, const NodeOfBody &other)
   {
      const NodeOfBody a = root(one), b = root(other);
      if (a != b) { up_[a] = b; }
      return a != b;
   }

private:
   NodeOfBody root(NodeOfBody node) const
   {
      for (auto found = up_.find(node); found != up_.end(); found = up_.find(node))
      {
         node = found->second;
      }
      return node;
   }
   std::map<NodeOfBody, NodeOfBody> up_;
};

/// The rows of an interface of bodies in space, whose nodes match or that lies on an obstacle.
/// Fills in its data in `met`. InputError if sides or pairing do not fit, or supports hold a
/// normal component on both sides.
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
