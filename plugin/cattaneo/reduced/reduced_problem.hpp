#pragma once

#include <Eigen/Dense>
#include <array>
#include <cattaneo/line_end.hpp>
#include <cattaneo/load_pattern.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/** Contact nodes that follow each other along a line, where "the next node" means something:
    nodes `first` … `first + nodes - 1` of the problem, in the order of their arc length. */
struct ContactChain
{
   std::string interface;  ///< name of the interface it belongs to
   Eigen::Index first = 0; ///< first node
   Eigen::Index nodes = 0; ///< number of nodes
   bool loop = false;      ///< the last node is followed by the first
   /// How the boundary goes on beyond the first and the last node, of the body that carries the
   /// nodes and of the other one (a rigid obstacle goes on smoothly).
   std::array<LineEnd, 2> ends{LineEnd::unknown, LineEnd::unknown};
   std::array<LineEnd, 2> other_ends{
      LineEnd::unknown, LineEnd::unknown}; ///< the same of the body that faces them
   /// Numbers of the bodies that carry the nodes and that face them, as in the columns of
   /// `dofs`; the same of a body that touches itself, -1: a rigid obstacle.
   std::array<int, 2> bodies{0, -1};

   /// True if end 0 (the first node) or 1 (the last) lies on a plane or axis of symmetry of all
   /// that touches there: the contact goes on beyond it as its own mirror image.
   bool mirrored_at(std::size_t end) const;
};

/** What the tangential force of a node is bounded by, over its normal force p: polylines from
    (0, 0) through points (p, bound), which go on straight beyond the last. One for slip forward
    (v grows, q = -bound), one for slip backward. Nodal forces, as all of the reduced problem;
    set_friction_law() makes them of tractions. */
struct FrictionLaw
{
   Eigen::MatrixX2d forward;  ///< at least one point; p grows from above zero
   Eigen::MatrixX2d backward; ///< the same

   /// The largest slope of both.
   double steepest() const;
   /// No piece of either is steeper than the one before, but for rounding of their points.
   bool concave() const;
};

/** The narrow waist: a frictional contact problem reduced to its n contact nodes.

       q = A v + Bᵀ w + Σ λ_k q_k         (thesis 3.25)
       p = B v + C  w + Σ λ_k p_k

    v is the relative tangential displacement (slip), w the relative normal displacement (w > 0
    opens), q and p the *nodal* tangential and normal forces (p > 0 is compression), λ_k the
    multiplier of load pattern k. Per unit thickness in the plane; forces over the full
    circumference in axisymmetry.

    There are c tangential components a node: 1 in the plane, 2 in three dimensions and with
    torsion (first tangents of all nodes, then second ones; about an axis radial and
    circumferential), 0 when the problem was reduced without friction. Plain data: it knows no
    mesh. */
struct ReducedProblem
{
   /// The whole reduced stiffness [A Bᵀ; B C], (c+1)·n × (c+1)·n, symmetric.
   Eigen::MatrixXd K;
   /// Is B not zero? Where it is, to the last bit, the normal problem does not know of
   /// friction. Nothing below the reduction takes a small B for zero.
   bool coupled = false;

   std::vector<LoadPattern> patterns; ///< loads, in the order of multipliers

   /// Response of the loads to the loads with the contact nodes clamped (u = {v; w} = 0), in
   /// the order of the patterns: the conjugate of pattern k (displacement of a force, reaction
   /// of a prescribed displacement) is g = H λ ∓ F_kᵀ u, minus for force control, see
   /// conjugates(); nothing else depends on it. No rows: not known.
   Eigen::MatrixXd H;

   Eigen::VectorXd gap;      ///< initial gap g of each of the n nodes: closed where w + g = 0
   Eigen::VectorXd friction; ///< Coulomb coefficient f of each node, size n
   /// None: Coulomb's law |q| <= f p. Else another one of each node, size n, of which
   /// `friction` is the steepest slope, so that Coulomb's would hold more: see
   /// set_friction_law().
   std::vector<FrictionLaw> laws;
   Eigen::VectorXd weights; ///< consistent weight ∫φ_i of each node: traction = force / weight

   Eigen::VectorXd arc_length; ///< coordinate of each node along the contact line
   /// Coordinates of each node (of body 1): n × 2 of a line, n × 3 of a surface in space.
   Eigen::MatrixXd position;

   /// n × 2k: true dofs (x, y) of each contact node in each of the k bodies, -1 where none.
   Eigen::MatrixXi dofs;

   /// Lines that the nodes form, in their order, each node on one: the interface and the bodies
   /// of each node. Empty for nodes that do not follow each other, see also one_chain().
   std::vector<ContactChain> chains;
   /// Nodes of a surface at its rim, beyond which the bodies go on: contact there is cut off,
   /// see cut_off_contact(). Lines have the ends of their chains.
   std::vector<Eigen::Index> rim;
   /// Rigid motions {v; w} that nothing resists, one orthonormal column each, as they were
   /// imposed on the stiffness: (c+1)·n × k, k = 0 if the bodies are held. Of a problem made by
   /// hand complete() seeks them, and files must state all of them; a march does not seek.
   Eigen::MatrixXd rigid_motions;
   /// Rows of A (tangential components of nodes) that are held: v = 0 there whatever happens,
   /// and no law of friction. They are coupled to nothing and loaded by nothing, see hold().
   std::vector<Eigen::Index> held;

   /// Number of contact nodes n.
   Eigen::Index nodes() const { return gap.size(); }
   /// Number of tangential components a node, c.
   Eigen::Index components() const { return nodes() ? slips() / nodes() : 0; }
   /// Number of tangential displacements, c·n.
   Eigen::Index slips() const { return K.rows() - nodes(); }

   /// Tangential stiffness, c·n × c·n; a view of K, as the other two.
   auto A() const { return K.topLeftCorner(slips(), slips()); }
   /// The same, to be written to.
   auto A() { return K.topLeftCorner(slips(), slips()); }
   /// Coupling, n × c·n: normal force by tangential displacement. K has its transpose as well:
   /// who writes B calls complete().
   auto B() const { return K.bottomLeftCorner(nodes(), slips()); }
   /// The same, to be written to.
   auto B() { return K.bottomLeftCorner(nodes(), slips()); }
   /// Normal stiffness, n × n.
   auto C() const { return K.bottomRightCorner(nodes(), nodes()); }
   /// The same, to be written to.
   auto C() { return K.bottomRightCorner(nodes(), nodes()); }

   /// Is H known? Else conjugates are known but for a part that is linear in the loads.
   bool knows_loads() const { return H.rows() > 0 || patterns.empty(); }

   /// Names of the patterns, in their order.
   std::vector<std::string> load_names() const;
   /// Index of the pattern of that name; InputError with the list of names if there is none.
   int pattern(const std::string &name) const;

   /// Multipliers in the order of the patterns, zero for those that are not named; InputError
   /// for a name that no pattern has.
   Eigen::VectorXd multipliers(const NamedLoads &loads) const;

   /// f^w = Σ λ_k {q_k; p_k}, size (c+1)·n.
   Eigen::VectorXd clamped_forces(const Eigen::VectorXd &multipliers) const;

   /// K of its blocks, with the rigid motions that are known. Gap and friction are zero unless
   /// they have the size of C already. InputError if the sizes of the blocks disagree.
   void set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                      const Eigen::MatrixXd &C, const Eigen::MatrixXd &rigid_motions);
   /// For a problem made by hand: the same, then complete() and require_semidefinite().
   void set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                      const Eigen::MatrixXd &C);

   /// InputError if sizes disagree, entries are not finite, K is not symmetric, a diagonal
   /// is not positive, `coupled` is wrong, a friction coefficient is negative, a law of
   /// friction is none or has another steepest slope, chains do not cover the nodes, a rigid
   /// motion is resisted, or a held row is coupled or loaded.
   void validate() const;
};

/// Completes a problem whose A, B or C were written by hand: Bᵀ in K, whether it is coupled,
/// and the rigid motions, which are those that the stiffness does not resist by more than the
/// rounding of its entries.
void complete(ReducedProblem &problem);
/// The same for who knows the rigid motions {v; w}, which are not sought: columns, (c+1)·n × k,
/// which need not be orthonormal. InputError if they are not independent, one of them is
/// resisted, or one that nothing resists is not among them. Costs a Cholesky factor.
void complete(ReducedProblem &problem, const Eigen::MatrixXd &rigid_motions);
/// InputError if the stiffness does not resist a motion that the problem does not state.
void require_all_motions_stated(const ReducedProblem &problem);
/// The first two of these alone, without a check.
void join_coupling(ReducedProblem &problem);
/// InputError if some displacement of the nodes meets energy below zero, which no body does:
/// such a stiffness has several answers, and what is proven of them does not hold. Costs a
/// Cholesky factor: asked of problems made by hand and of files, not by validate().
void require_semidefinite(const ReducedProblem &problem);

/// One chain of all nodes, in their order, for problems made by hand.
std::vector<ContactChain> one_chain(Eigen::Index nodes);

/// Rigid motions that are slips alone (c·n × k, their openings are zero), as orthonormal
/// columns. rigid_openings() has those that are openings alone (n × k). They are all that A and
/// C do not resist, because K is semidefinite.
Eigen::MatrixXd rigid_slips(const ReducedProblem &problem);
/// Those that are openings alone, n × k, see rigid_slips().
Eigen::MatrixXd rigid_openings(const ReducedProblem &problem);

/// Coulomb's law with the same friction coefficient at every node.
void set_friction(ReducedProblem &problem, double coefficient);

/** Another law of friction, of these nodes (none given: of all): points (pressure, shear
    strength) of tractions, for slip forward and backward, from which those of nodal forces
    follow by the nodes' weights. A single point (1, f) is Coulomb's law. InputError without
    weights, for a node that does not exist, or if the law is none: its pressures do not grow
    from above zero, a strength falls or is negative, or with two tangents, where slip has no
    sense, both differ. */
void set_friction_law(ReducedProblem &problem, const FrictionLaw &law,
                      const std::vector<Eigen::Index> &nodes = {});
/// The same law whichever way the nodes slip.
void set_friction_law(ReducedProblem &problem, const Eigen::MatrixX2d &points,
                      const std::vector<Eigen::Index> &nodes = {});
/// InputError "WHO …" for a problem with laws of friction other than Coulomb's.
void require_coulomb(const ReducedProblem &problem, const char *who);

/// Holds the given rows of A (see ReducedProblem::held), of a node on a plane of symmetry for
/// instance. InputError if a row does not exist.
void hold(ReducedProblem &problem, const std::vector<Eigen::Index> &rows);

/** The equivalent problem without a gap (thesis 3.6.1): u* = u + {0; g}. The forces that close
    the gap become a load pattern "gap" (to be held at multiplier 1), and the gap is zero. */
ReducedProblem absorb_gap(const ReducedProblem &problem);

} // namespace cattaneo
