#pragma once

#include <cattaneo/contact/contact_line.hpp>

namespace cattaneo
{

/// Nodes of two contact lines that face each other.
struct Pairing
{
   std::vector<int> partner; ///< node of line 2 for each node of line 1
   Eigen::VectorXd gap;      ///< from geometry: (x1 - x2)·n1, positive if apart
};

/** Pairs every node of line 1 with the node of line 2 nearest to it along the tangent: the
   offset along the tangent may be at most `tolerance` times the local edge length. Offsets
   along the normal are the gap. InputError with both lists of unmatched nodes (coordinates)
   otherwise. */
Pairing pair_lines(const ContactLine &line1, const ContactLine &line2, double tolerance = 1e-6);

} // namespace cattaneo
