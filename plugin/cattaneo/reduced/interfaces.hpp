#pragma once

#include <Eigen/SparseCore>
#include <cattaneo/reduced/reduction.hpp>
#include <optional>

namespace cattaneo
{

/// One side of an interface: a part of a body's trace.
struct InterfaceSide
{
   int body = -1;    ///< number of the body; -1: a rigid obstacle, which has no line
   ContactLine line; ///< all of its nodes are nodes of the condensed body's line
   /// In space: all of its nodes are nodes of the condensed body's surface.
   ContactSurface surface = {};
};

/** Which side carries the nodes of the reduced problem (the slave). The coarser side is the one
    whose nodes are farther apart in the geometric mean. If both are alike it is the first one,
    unless that is ten times as stiff as the second one. The coarser side is the safe choice: it
    has no more forces than either body has displacements. A finer, stiff slave on a coarse,
    soft master has tractions that oscillate from node to node (docs/interfaces.md has figures).
    If the chosen side cannot be the slave (supports hold nodes of it, or all of them carry rows
    already) the other one is. */
enum class SlaveSide
{
   coarser,
   finer,
   first,
   second
};

/// Where two bodies may touch, or a body and a rigid obstacle, or two parts of one body.
struct Interface
{
   std::string name = "contact";         ///< unique among the interfaces
   InterfaceSide first;                  ///< body 1 of its frames
   InterfaceSide second;                 ///< the other body, or a rigid obstacle
   SlaveSide slave = SlaveSide::coarser; ///< which of the two has the nodes
   /// Initial gap as a function of the contact nodes' places, instead of that of the geometry.
   /// 0.0 closes the interface, whatever the chordal errors. A rigid obstacle is closed unless
   /// this is given.
   std::optional<ScalarField> gap = std::nullopt;
   /// Largest overlap of the geometry that is accepted, in lengths of the slave's elements.
   double most_overlap = 0.1;
   /// The sides are joined, u = 0 on all nodes, whatever the gap: glued, welded, or one body
   /// meshed in two parts. The reduced problem does not contain these nodes.
   bool tied = false;
   /// Pairs the nodes of both lines one to one, with the gap of each pair unless `gap` is
   /// given. The first side is then the slave, whatever `slave` says. The pairing is used even
   /// if elements of both sides differ; InterfaceReport::differing tells where.
   std::optional<Pairing> pairing = std::nullopt;
   /// In space: the initial gap of each node of the side that has the nodes, instead of that of
   /// the geometry (gaps_to_plane(), …).
   std::optional<Eigen::VectorXd> node_gaps = std::nullopt;
};

/** Any number of bodies that touch at any number of interfaces. U are the contact displacements
    of all bodies, S their stiffnesses. Contact nodes have the relative displacements u = G U of
    their Mortar rows. With U = R u + Z y (y: all contact dofs that are not a slave's)

       K = Rᵀ[S - S Z (Zᵀ S Z)⁻¹ Zᵀ S] R,

    for two bodies S_s - S_s P (S_m + Pᵀ S_s P)⁻¹ Pᵀ S_s, and the loads likewise. Two bodies
    with nodes and elements that match at their only interface (matching_nodes()) go to
    reduce(body1, body2, pairing), one on an obstacle to reduce(body, gap); nodes that match
   have P = 1 in any union.

    A body is condensed once, to joined() of all its lines, whatever the number of its
    interfaces. Its nodes that belong to no interface are free. A node is a slave once. It
    carries no row for a second interface that contains it too, nor where rows would go in a
    ring (crack tips of a body that touches itself, interfaces that meet at one point), nor at
    an end of its line that supports hold in both components. Relative displacements of the
    nodes are in the common frame of both sides, which on a plane of symmetry of both is across
    that plane.

    Nodes of tied interfaces have u = 0. Their rows and columns are left out;
    Reduction::tied_forces() has the forces that they transfer.

    Rigid motions that supports leave free are known from the bodies. A motion that touching
    bodies have in common is set to zero in the mean over their traces, which does not affect
    the interfaces; loads that push along it are refused. If the slave of an interface is much
    stiffer than its master, digits are lost: six at a ratio of 1e6 of the stiffnesses.

    Bodies in space meet at surfaces, or lie on rigid obstacles. Where nodes and faces of both
    sides match they are paired (SlaveSide::second keeps the nodes of the second side), else
    SurfaceMortar couples them. Unless it is named, a side within the other one is the slave. A
    row that would close a ring is left out (InterfaceReport::in_rings). First tangents of all
    nodes come first, then second ones, then the normals.

    InputError, with the names of interface and bodies and coordinates, if numbers of bodies or
    nodes do not fit, a body is at no interface, sides do not face each other or overlap by more
    than Interface::most_overlap, a contact node is fixed across the line, or along it while the
    other side is not, or nothing holds the bodies together. */
Reduction reduce(std::vector<CondensedBody> bodies, const std::vector<Interface> &interfaces);

/// Error of the pressures because curved sides are meshed as chords (InterfaceReport::chords),
/// as shares of the largest pressure. An estimate, from the error of the gaps alone.
struct ChordalError
{
   double at_a_node = 0; ///< the largest change of the pressure of a node
   /// The change of the largest pressure, which may move to another node. It is at least the
   /// fall of the pressure at the node where it is largest now. A rise at another node does not
   /// reduce it, because it may come merely from pressures that oscillate from node to node,
   /// above all with linear elements.
   double of_peak = 0;
};

/** How pressures would change if gaps were those of the curves, with unchanged displacements
    along the interface. The change is 0 if sides are straight or their elements match. It is
    also 0 for linear elements with gaps from node to node (on obstacles, on half-planes and
    paired), as the vertices are on the curve. If no node carries a force, both shares are
    infinite if the smooth sides may meet, else 0.

    @param p normal forces of the contact nodes
    @param w their normal displacements, which give the openings of nodes that may close;
    without them open nodes stay open
    @return the shares. InputError unless there is one of each for each contact node. */
ChordalError chordal_error(const Reduction &reduction, const Eigen::VectorXd &p,
                           const Eigen::VectorXd &w = {});

/** Bodies that meet at interfaces but keep their own displacements, for programs of joint
    dynamics. U are the contact displacements of all bodies that are not held: {v; w} of each
    body in the frames of its line, one body after the other. u = {v; w} are the relative
    displacements of the contact nodes, in the order of reduce() for nodes that do not match.

       K U + Σ ℓ_k f_k = Lᵀ {q; p},    u = L U */
struct SeparateBodies
{
   Eigen::MatrixXd K; ///< the bodies' S, one block each
   /// u = L U: relative displacements {v; w} of the rows by displacements of all bodies
   Eigen::SparseMatrix<double, Eigen::RowMajor> L;
   Eigen::MatrixXd loads;             ///< one column f_k a pattern
   std::vector<LoadPattern> patterns; ///< only names and controls
};

/// InputError as of reduce(bodies, interfaces).
SeparateBodies separate(const std::vector<CondensedBody> &bodies,
                        const std::vector<Interface> &interfaces);

} // namespace cattaneo
