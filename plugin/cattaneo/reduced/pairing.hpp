#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/condense/contact_surface.hpp>
#include <optional>
#include <string>

namespace cattaneo
{

/// Nodes of two contact lines that face each other.
struct Pairing
{
   std::vector<int> partner; ///< node of line 2 for each node of line 1
   Eigen::VectorXd gap; ///< from geometry: (x1 - x2)·n, positive if apart; n: mean_frame()
};

/// A node of a first line whose tangent is the mean of its own and of the opposite one of the
/// node that faces it: frames and gaps along it do not depend on which body is called the
/// first. Tangents that are opposite to 1e-9 are left as they are.
LineNode mean_frame(LineNode node, const LineNode &other);

/** Pairs every node of line 1 with the node of line 2 that faces it (normals of opposite sense)
    and is nearest to it across the interface, among those whose offset along the tangent is at
    most `tolerance` times the local edge length (the shorter one of the two lines). The tangent
    is the mean of both bodies', so that the pairing does not depend on which body is called the
    first. Offsets along the normal are the gap; one of less than 1e-9 edge lengths is round-off
    of coordinates, and zero. InputError unless every node of both lines has one partner, with
    unmatched nodes (coordinates), a tolerance that would do, and where the lines are. */
Pairing pair_lines(const ContactLine &line1, const ContactLine &line2, double tolerance = 1e-6);
/** The same for the nodes of two surfaces, by their offset perpendicular to the mean normal of
    both. Faces may differ, for instance diagonals of triangles, but not the edges of order 2.
   `what` begins the sentences of InputError. */
Pairing pair_surfaces(const ContactSurface &surface1, const ContactSurface &surface2,
                      double tolerance = 1e-6, const std::string &what = "pairing");
/** Like pair_lines(), but empty unless every node has a partner and both lines have the same
    elements between them (differing_element()). If elements or orders differ, equal tractions
    do not give equal nodal forces on nodes that coincide. */
std::optional<Pairing> matching_nodes(const ContactLine &line1, const ContactLine &line2,
                                      double tolerance = 1e-6);

/** A node of line 1 at an element that has no equal on line 2: one of the same order whose
   nodes are the partners of its own, in the opposite order. -1: there is no such element. If
    the elements of either line are not known: a node whose weight is not that of its partner to
    5 % (weights of lines that curve and part differ by their curvature). InputError if the
    pairing is of other numbers of nodes. */
int differing_element(const ContactLine &line1, const ContactLine &line2,
                      const Pairing &pairing);

} // namespace cattaneo
