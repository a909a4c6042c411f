#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <string>

namespace cattaneo
{

/// A node of one boundary element. Weight and tangent of `node` are those of this element, and
/// its arc length counts from the first node of the element.
struct SegmentNode
{
   int id = 0; ///< the same on all ranks and in all elements
   LineNode node;
   double share = 0; ///< ∫φ ds
   bool on_axis = false;

   /// Calls visit(value&) for every number of the node.
   template <class Visitor>
   void for_each(Visitor visit)
   {
      visit(id);
      for (int &dof : node.dofs) { visit(dof); }
      for (double &x : node.position) { visit(x); }
      for (double &t : node.tangent) { visit(t); }
      visit(node.weight);
      visit(node.arc_length);
      visit(share);
      visit(on_axis);
   }
};

/// The nodes of one boundary element, in the direction with the body on the left.
using Segment = std::vector<SegmentNode>;

/// An outer edge of the body, seen from a node that it shares with the line. (An edge on the
/// line itself leaves the node backwards.)
struct WayOn
{
   int node;
   double x, y; ///< unit vector that leaves the node
};

/** The contact line of boundary elements in any order: it consists of chains, leaves out nodes
    on the axis, and takes the kind of each end from the outer edges at that node. InputError,
    which begins with `where`, if more than two elements meet at a node, nodes coincide, the
    line turns back on itself, or it is not valid (ContactLine::validate). */
ContactLine line_of(const std::vector<Segment> &segments, const std::vector<WayOn> &ways,
                    Formulation formulation, const std::string &where);

} // namespace cattaneo
