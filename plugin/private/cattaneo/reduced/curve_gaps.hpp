#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <vector>

namespace cattaneo
{

/// How gaps between opposite nodes change because elements are chords of smooth curves
/// (LineElement::bend); n numbers in each. Changes of less than 1e-9 of the distance of nodes
/// are round-off, and set to zero.
struct CurveGaps
{
   Eigen::VectorXd moved; ///< gaps between the outlines less gaps between the nodes' places
   Eigen::VectorXd left; ///< the same for curves that are not used, because lines are as meshed
                         ///< or stay polygons
   Eigen::VectorXd curved; ///< gaps between the outlines less gaps between the chords
};

/// Gaps of n nodes of a line in frames with these tangents (n × 2). `partner` has the node of
/// the other line that faces each node. The line of an obstacle is empty.
CurveGaps curve_gaps(const ContactLine &line, const std::vector<int> &nodes,
                     const Eigen::MatrixX2d &tangents, const ContactLine &other = {},
                     const std::vector<int> &partner = {});

} // namespace cattaneo
