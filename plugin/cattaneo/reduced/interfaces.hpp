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
};

/** Which side carries the nodes of the reduced problem. Nodes are nearer to each other or not
    in the (geometric) mean; if they are as near the first side is taken, unless it is ten times
    as stiff as the second one. The coarser one is the
    choice that is safe: it has no more forces than either body has displacements. A finer slave
    that is stiff, on a coarse soft master, has tractions that swing from node to node
    (docs/interfaces.md has figures). Where the side that is taken cannot be the slave
    (supports hold nodes of it, or all carry rows already) the other one is. */
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
   /// Initial gap as a function of the contact nodes' places, instead of that of the geometry;
   /// 0.0: closed, whatever chordal errors say. A rigid obstacle is closed unless this is
   /// given.
   std::optional<ScalarField> gap = std::nullopt;
   /// Largest overlap of the geometry that is taken for what it is, in lengths of the slave's
   /// elements.
   double most_overlap = 0.1;
   /// The sides are joined, u = 0 on all nodes, whatever the gap: glued, welded, or one body
   /// meshed in two. The nodes are none of the reduced problem.
   bool tied = false;
   /// Nodes of both lines one to one, of the first side, which has them then, whatever `slave`
   /// says; with the gap of each unless `gap` is given. Where elements of both sides differ it
   /// is taken all the same, which InterfaceReport::differing says.
   std::optional<Pairing> pairing = std::nullopt;
};

/** Any number of bodies over any number of interfaces. With U the contact displacements of all
    bodies and S their stiffnesses, each contact node has u = G U, the relative displacement of
    its Mortar row; with U = R u + Z y (y: all contact dofs that are no slave's)

       K = Rᵀ[S - S Z (Zᵀ S Z)⁻¹ Zᵀ S] R,

    for two bodies S_s - S_s P (S_m + Pᵀ S_s P)⁻¹ Pᵀ S_s, and the loads likewise. Two bodies
    with nodes and elements that match at their only interface (matching_nodes()) go to
    reduce(body1, body2, pairing), one on an obstacle to reduce(body, gap); nodes that match
   have P = 1 in any union.

    A body is condensed once, to joined() of all its lines, whatever the number of its
    interfaces; nodes of it that no interface has are free. A node is a slave once: of a second
    interface that has it as well it carries no row, nor where rows would go in a ring (crack
    tips of a body that touches itself, interfaces that meet at one point), nor at an end of its
    line that supports hold in both components. Relative
    displacements of the nodes are in the common frame of both sides; on a plane of symmetry of
    both that is across it.

    Nodes of tied interfaces have u = 0: their rows and columns are left out, and
    Reduction::tied_forces() says what they transfer.

    Rigid motions that supports leave free are known from the bodies: those that bodies which
    touch have in common are at rest in the mean over their traces, which takes nothing from
    what happens at interfaces; loads that push them are refused. If the slave of an interface
    is much stiffer than its master digits are lost: of a ratio of 1e6 of the stiffnesses six.

    InputError, with the names of interface and bodies and coordinates, if numbers of bodies or
    nodes do not fit, a body is at no interface, sides do not face each other or overlap by more
    than Interface::most_overlap, a contact node is fixed across the line, or along it while the
    other side is not, or nothing holds the bodies together. */
Reduction reduce(std::vector<CondensedBody> bodies, const std::vector<Interface> &interfaces);

/// What chords of curved sides (InterfaceReport::chords) make of pressures, as shares of the
/// largest one. Estimates, of gaps alone.
struct ChordalError
{
   double at_a_node = 0; ///< the largest change of the pressure of a node
   /// The change of the largest pressure, which may move to another node; at least the fall of
   /// the pressure at the node that has it now, as others may then be largest only because
   /// pressures swing from node to node, of linear elements above all.
   double of_peak = 0;
};

/** How pressures would change if gaps were those of the curves, with the displacements along
   the interface as they are. 0 where sides are straight, their elements match, or are linear
   and gaps are those of nodes (on obstacles, on half-planes and paired): vertices are on the
   curve. Where nothing bears both are infinite if smooth sides may meet, else 0.

    @param p normal forces of the contact nodes
    @param w their normal displacements, which tell how far nodes are open that may close; left
           out, open nodes stay open
    @return the shares. InputError unless there is one of each for each contact node. */
ChordalError chordal_error(const Reduction &reduction, const Eigen::VectorXd &p,
                           const Eigen::VectorXd &w = {});

/** Bodies that meet at interfaces but keep displacements of their own, for programs of joint
    dynamics. U: contact displacements of all bodies that are not held, {v; w} of each in the
    frames of its line, one body after the other; u = {v; w}: the relative ones of the contact
    nodes, in the order of reduce() where nodes do not match.

       K U + Σ λ_k f_k = Lᵀ {q; p},    u = L U */
struct SeparateBodies
{
   Eigen::MatrixXd K; ///< the bodies' S, one block each
   Eigen::SparseMatrix<double, Eigen::RowMajor>
      L; ///< u = L U: relative displacements {v; w} of the rows by displacements of all bodies
   Eigen::MatrixXd loads;             ///< one column f_k a pattern
   std::vector<LoadPattern> patterns; ///< names and controls alone
};

/// InputError as of reduce(bodies, interfaces).
SeparateBodies separate(const std::vector<CondensedBody> &bodies,
                        const std::vector<Interface> &interfaces);

} // namespace cattaneo
