#pragma once

#include <cattaneo/reduced/reduction.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// Largest angle between the normals of two bodies (in radians) that counts as small, as a
/// share of the coefficient of friction. The frame of the node is off either normal by half of
/// the angle, so by at most a tenth of the coefficient.
constexpr double small_turn = 0.2;

/// An edge of a contact side is uneven if it is shorter than this share of an edge beside it.
constexpr double uneven_edges = 0.2;

/** Warnings about the geometry that strongly affect a solution, although the solution does not
    show it. Empty if there are none:

    - nodes that are paired one to one where the elements of the bodies differ;
    - ends of contact lines that are taken for planes of symmetry though the line meets them at
      another angle (LineChain::off_symmetry);
    - nodes that carry a force, where the normals of both bodies differ by an angle that is not
      small compared with the coefficient of friction: the frame is the mean of both, and
      whether the node sticks depends on that. The worst node of each interface is named;
    - nodes with friction that carry a force and that supports hold along an axis to which their
      frames are oblique: the part of the tangential force that the support carries is not
      determined, and friction there is left out;
    - nodes that carry a force and that a load moves along the interface
      (InterfaceReport::moved): their friction is left out;
    - a node at an edge of less than uneven_edges of the length of the edge beside it, if its
      pressure is more than 1.25 times the largest at all other nodes of its interface;
    - sides in space that are tied although they are apart, or overlap, by more than a fiftieth
      of the distance of nodes;
    - straight edges that stay a polygon where the other side is a smooth curve that their
      vertices fit: the gap is wrong by the distance between chord and curve.

    p: normal forces of the nodes, of a state or the largest of a march; a node with more than
    1e-6 of the largest one carries a force. InputError unless there is one for each contact
    node. */
std::vector<std::string> geometry_warnings(const Reduction &reduction,
                                           const Eigen::VectorXd &p);

} // namespace cattaneo
