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
   /// How the boundary of the body that carries the nodes goes on beyond the first and the last
   /// node.
   std::array<LineEnd, 2> ends{LineEnd::unknown, LineEnd::unknown};
   std::array<LineEnd, 2> other_ends{
      LineEnd::unknown, LineEnd::unknown}; ///< the same for the body that faces them; a rigid
                                           ///< obstacle goes on smoothly
   /// Number of the body that carries the nodes, then of the one that faces them, as in the
   /// columns of `dofs`. -1 is a rigid obstacle. A body that touches itself is both.
   std::array<int, 2> bodies{0, -1};

   /// Does end 0 (the first node) or 1 (the last) lie on a plane or axis of symmetry of all
   /// bodies that touch there? The contact goes on beyond it as its own mirror image.
   bool mirrored_at(std::size_t end) const;
};

/** Bound of a node's tangential force as a function of its normal force p: polylines from (0,
    0) through points (p, bound), which go on straight beyond the last point. One is for slip
    forward (v grows, q = -bound), one for slip backward. Both are in nodal forces, as the whole
    reduced problem is. set_friction_law() computes them from tractions. */
struct FrictionLaw
{
   Eigen::MatrixX2d forward;  ///< one point or more; p > 0, strictly increasing
   Eigen::MatrixX2d backward; ///< the same

   /// The largest slope of both.
   double steepest() const;
   /// Is no piece of either steeper than the one before, apart from rounding of the points?
   bool concave() const;
};

/** A frictional contact problem reduced to its n contact nodes.

       q = A v + Bᵀ w + Σ ℓ_k q_k         (thesis 3.25)
       p = B v + C  w + Σ ℓ_k p_k

    v is the relative tangential displacement (slip), w the relative normal displacement (w > 0
    opens), q and p the *nodal* tangential and normal forces (p > 0 is compression), ℓ_k the
    multiplier of load pattern k. Per unit thickness in the plane; forces over the full
    circumference in axisymmetry.

    There are c tangential components per node: 1 in the plane, 2 in three dimensions and with
    torsion (first tangents of all nodes, then second ones; about an axis radial and
    circumferential), 0 when the problem was reduced without friction. Plain data: it knows no
    mesh. */
struct ReducedProblem
{
   /// The whole reduced stiffness [A Bᵀ; B C], (c+1)·n × (c+1)·n, symmetric.
   Eigen::MatrixXd K;
   /// Is any entry of B not exactly zero? If not, friction does not affect the normal problem.
   /// Even a very small entry counts.
   bool coupled = false;

   std::vector<LoadPattern> patterns; ///< loads, in the order of multipliers

   /// Conjugates of the loads by the loads with the contact nodes clamped (u = {v; w} = 0), in
   /// the order of the patterns. The conjugate of pattern k (displacement of a force, reaction
   /// of a prescribed displacement) is g = H ℓ ∓ F_kᵀ u, minus for force control, see
   /// conjugates(). Nothing else depends on H. No rows: H is not known.
   Eigen::MatrixXd H;

   Eigen::VectorXd gap;      ///< initial gap g of each of the n nodes: closed where w + g = 0
   Eigen::VectorXd friction; ///< Coulomb coefficient f of each node, size n
   /// Empty: Coulomb's law |q| <= f p. Otherwise a law for each node, size n, whose steepest
   /// slope is the node's `friction`: no law allows more than Coulomb's with that coefficient.
   /// See set_friction_law().
   std::vector<FrictionLaw> laws;
   Eigen::VectorXd weights; ///< consistent weight ∫φ_i of each node: traction = force / weight

   Eigen::VectorXd arc_length; ///< coordinate of each node along the contact line
   /// Coordinates of each node (of body 1): n × 2 of a line, n × 3 of a surface in space.
   Eigen::MatrixXd position;

   /// n × 2k: true dofs (x, y) of each contact node in each of the k bodies, -1 where none.
   Eigen::MatrixXi dofs;

   /// Lines that the nodes form, in the order of the nodes. Each node is on one of them, which
   /// tells its interface and bodies. Empty if the nodes do not follow each other. See also
   /// one_chain().
   std::vector<ContactChain> chains;
   /// Nodes at the rim of a surface in space, beyond which the bodies go on: contact that
   /// reaches the rim is cut off, see cut_off_contact(). On lines the ends of the chains tell
   /// this.
   std::vector<Eigen::Index> rim;
   /// Rigid motions {v; w} that nothing resists (K times them is zero to round-off), in
   /// orthonormal columns: (c+1)·n × k, k = 0 if the bodies are held. complete() finds them for
   /// a problem made by hand, and a file must state all of them. A march does not look for
   /// them.
   Eigen::MatrixXd rigid_motions;
   /// Rows of A (tangential components of nodes) that are held: always v = 0, without a law of
   /// friction. They are coupled to nothing and loaded by nothing, see hold().
   std::vector<Eigen::Index> held;

   /// Number of contact nodes n.
   Eigen::Index nodes() const { return gap.size(); }
   /// Number of tangential components per node, c.
   Eigen::Index components() const { return nodes() ? slips() / nodes() : 0; }
   /// Number of tangential displacements, c·n.
   Eigen::Index slips() const { return K.rows() - nodes(); }

   /// Tangential stiffness, c·n × c·n; a view of K, as B and C are.
   auto A() const { return K.topLeftCorner(slips(), slips()); }
   /// The same, to be written to.
   auto A() { return K.topLeftCorner(slips(), slips()); }
   /// Coupling, n × c·n: normal force by tangential displacement. K also contains its
   /// transpose, so call complete() after writing to B.
   auto B() const { return K.bottomLeftCorner(nodes(), slips()); }
   /// The same, to be written to.
   auto B() { return K.bottomLeftCorner(nodes(), slips()); }
   /// Normal stiffness, n × n.
   auto C() const { return K.bottomRightCorner(nodes(), nodes()); }
   /// The same, to be written to.
   auto C() { return K.bottomRightCorner(nodes(), nodes()); }

   /// Is H known? If not, conjugates lack a part that is linear in the loads.
   bool knows_loads() const { return H.rows() > 0 || patterns.empty(); }

   /// Names of the patterns, in their order.
   std::vector<std::string> load_names() const;
   /// Index of the pattern of that name; InputError with the list of names if there is none.
   int pattern(const std::string &name) const;

   /// Multipliers in the order of the patterns, zero for patterns that `loads` does not name.
   /// InputError for a name that no pattern has.
   Eigen::VectorXd multipliers(const NamedLoads &loads) const;

   /// f^w = Σ ℓ_k {q_k; p_k}, size (c+1)·n.
   Eigen::VectorXd clamped_forces(const Eigen::VectorXd &multipliers) const;

   /// Sets K from its blocks, and the rigid motions, which are known. Gap and friction become
   /// zero unless they have the size of C already. InputError if the sizes of the blocks
   /// disagree.
   void set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                      const Eigen::MatrixXd &C, const Eigen::MatrixXd &rigid_motions);
   /// For a problem made by hand: the same, then complete() and require_semidefinite().
   void set_stiffness(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B,
                      const Eigen::MatrixXd &C);

   /// InputError if sizes disagree, entries are not finite, K is not symmetric, a diagonal is
   /// not positive, `coupled` is wrong, a friction coefficient is negative, a law of friction
   /// is not valid or has another steepest slope, chains do not cover the nodes, a rigid motion
   /// is resisted, or a held row is coupled or loaded.
   void validate() const;
};

/// Completes a problem whose A, B or C were written by hand: copies B into its transpose in K,
/// sets `coupled`, and finds the rigid motions. Those are the motions that the stiffness
/// resists by no more than the rounding of its entries.
void complete(ReducedProblem &problem);
/// The same with given rigid motions {v; w}: columns, (c+1)·n × k, which need not be
/// orthonormal. InputError if they are not independent, one of them is resisted, or one that
/// nothing resists is missing. Costs a Cholesky factor.
void complete(ReducedProblem &problem, const Eigen::MatrixXd &rigid_motions);
/// InputError if the stiffness does not resist a motion that is missing in rigid_motions.
void require_all_motions_stated(const ReducedProblem &problem);
/// Copies B into its transpose and sets `coupled`, without a check and without rigid motions.
void join_coupling(ReducedProblem &problem);
/// InputError if the energy of some displacement of the nodes is negative, which is impossible
/// for bodies. With such a stiffness a problem has several solutions, and the theorems do not
/// hold. Costs a Cholesky factor: checked for problems made by hand and for files, not by
/// validate().
void require_semidefinite(const ReducedProblem &problem);

/// One chain of all nodes, in their order, for problems made by hand.
std::vector<ContactChain> one_chain(Eigen::Index nodes);

/// Rigid motions that are only slips (c·n × k, their openings are zero), as orthonormal
/// columns. They are all that A and C do not resist, because K is semidefinite.
Eigen::MatrixXd rigid_slips(const ReducedProblem &problem);
/// Rigid motions that are only openings, n × k. With rigid_slips() they are all motions that A
/// and C do not resist, because K is semidefinite.
Eigen::MatrixXd rigid_openings(const ReducedProblem &problem);

/// Coulomb's law with the same friction coefficient at every node.
void set_friction(ReducedProblem &problem, double coefficient);

/** Sets another law of friction for these nodes (none given: for all). Its points (pressure,
    shear strength) are tractions, for slip forward and backward; the nodes' weights turn them
    into nodal forces. A single point (1, f) is Coulomb's law. InputError without weights, for a
    node that does not exist, or if the law is not valid: its pressures do not grow from above
    zero, a strength falls or is negative, or the two directions differ although a node has two
    tangents, where slip has no forward and backward. */
void set_friction_law(ReducedProblem &problem, const FrictionLaw &law,
                      const std::vector<Eigen::Index> &nodes = {});
/// The same law for both directions of slip.
void set_friction_law(ReducedProblem &problem, const Eigen::MatrixX2d &points,
                      const std::vector<Eigen::Index> &nodes = {});
/// InputError "WHO …" for a problem with laws of friction other than Coulomb's.
void require_coulomb(const ReducedProblem &problem, const char *who);

/// Marks the given rows of A as held (see ReducedProblem::held), for instance those of a node
/// on a plane of symmetry. InputError if a row does not exist.
void hold(ReducedProblem &problem, const std::vector<Eigen::Index> &rows);

/** The equivalent problem without a gap (thesis 3.6.1): u* = u + {0; g}. The forces that close
    the gap become a load pattern "gap" (to be held at multiplier 1), and the gap is zero. */
ReducedProblem absorb_gap(const ReducedProblem &problem);

} // namespace cattaneo
