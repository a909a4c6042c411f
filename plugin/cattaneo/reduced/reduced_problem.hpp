#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace cattaneo
{

/// What a load pattern's multiplier scales: applied forces (thesis 3.2.3) or prescribed
/// displacements (thesis 3.2.4).
enum class Control
{
   force,
   displacement
};

/// The contact nodal forces f^w that one load pattern would cause, per unit multiplier, if no
/// contact node moved (thesis 3.4, 3.17, 3.19).
struct LoadPattern
{
   std::string name;
   Control control = Control::force;
   Eigen::VectorXd q; ///< tangential, size c·n as ReducedProblem::A
   Eigen::VectorXd p; ///< normal, compression positive, size n
};

/** The narrow waist: a frictional contact problem reduced to its n contact nodes.

       q = A v + Bᵀ w + Σ λ_k q_k         (thesis 3.25)
       p = B v + C  w + Σ λ_k p_k

    v is the relative tangential displacement (slip), w the relative normal displacement (w > 0
    opens), q and p the *nodal* tangential and normal forces (p > 0 is compression), λ_k the
    multiplier of load pattern k. Per unit thickness in the plane; forces over the full
    circumference in axisymmetry.

    There are c tangential components a node: 1 in the plane, 2 with torsion (radial for all
   nodes first, then circumferential), 0 when the problem was reduced without friction. Plain
   data: it knows no mesh. */
struct ReducedProblem
{
   Eigen::MatrixXd A; ///< tangential stiffness, c·n × c·n, symmetric
   Eigen::MatrixXd B; ///< coupling, n × c·n: normal force by tangential displacement
   Eigen::MatrixXd C; ///< normal stiffness, n × n, symmetric

   std::vector<LoadPattern> patterns;

   /// Response of the loads to the loads with the contact nodes clamped (u = {v; w} = 0), in
   /// the order of the patterns: the conjugate of pattern k (displacement of a force, reaction
   /// of a prescribed displacement) is g = H λ ∓ F_kᵀ u, minus for force control. It enters the
   /// external work only.
   Eigen::MatrixXd H;

   Eigen::VectorXd gap;      ///< initial gap g, size n: a node is closed where w + g = 0
   Eigen::VectorXd friction; ///< Coulomb coefficient f of each node, size n
   Eigen::VectorXd weights; ///< consistent weight ∫φ_i of each node: traction = force / weight

   Eigen::VectorXd arc_length; ///< coordinate of each node along the contact line
   Eigen::MatrixXd position;   ///< n × 2, coordinates of each node (of body 1)

   /// n × 2k: true dofs (x, y) of each contact node in each of the k bodies, -1 where none.
   Eigen::MatrixXi dofs;

   Eigen::Index nodes() const { return C.rows(); }
   Eigen::Index components() const { return C.rows() ? A.rows() / C.rows() : 0; }

   /// Index of the pattern of that name; InputError with the list of names if there is none.
   int pattern(const std::string &name) const;

   /// f^w = Σ λ_k {q_k; p_k}, size (c+1)·n.
   Eigen::VectorXd clamped_forces(const Eigen::VectorXd &multipliers) const;

   /// The whole reduced stiffness [A Bᵀ; B C].
   Eigen::MatrixXd stiffness() const;

   /// InputError if sizes disagree, entries are not finite, A or C is not symmetric, a diagonal
   /// is not positive, or a friction coefficient is negative.
   void validate() const;
};

/// The same friction coefficient at every node.
void set_friction(ReducedProblem &problem, double coefficient);

/** The equivalent problem without a gap (thesis 3.6.1): u* = u + {0; g}. The forces that close
    the gap become a load pattern "gap" (to be held at multiplier 1), and the gap is zero. */
ReducedProblem absorb_gap(const ReducedProblem &problem);

} // namespace cattaneo
