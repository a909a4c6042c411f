#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/condense/free_motions.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/load_pattern.hpp>
#include <memory>

namespace cattaneo
{

/// The way back from the contact nodes of a condensed body to all of it. All in global
/// components.
class BodySolver
{
public:
   virtual ~BodySolver() = default;
   /// Displacements of all dofs (of this rank's, if the body is on several) for those of the
   /// contact dofs and load multipliers.
   virtual Eigen::VectorXd recover(const Eigen::VectorXd &contact,
                                   const Eigen::VectorXd &multipliers,
                                   Counters &counters) const = 0;
   /// CondensedBody::error_estimate() of the stiffness S, which does not resist `motions`.
   virtual double error(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions,
                        Counters &counters) const = 0;
};

/** One body reduced to its contact nodes (thesis 3.2):  f = S u + Σ λ_k f_k, in the local
   frames of the contact line: u = {v; w}, f = {q; p}, all tangential entries first.

    Of a torsion body: u = v = u_θ and f = q, circumferential, positive in the direction of the
   twist whatever the line's frames.

    Nothing of the program that assembled the body is kept but its matrix. */
class CondensedBody
{
public:
   std::string name; ///< what sentences about unions call it; may be empty
   ContactLine line;
   /// 2n × 2n (torsion: n × n), symmetric; zero in the rows and columns that are held.
   Eigen::MatrixXd S;
   /// Rows of S of components that supports hold, increasing. At a node of which one component
   /// is held the frame of the line lies along it.
   std::vector<int> held;
   std::vector<LoadPattern> patterns; ///< f_k, by name (torsion: p is empty)
   Eigen::MatrixXd H; ///< loads by loads with the contact clamped (see ReducedProblem::H)
   int rigid_modes =
      0; ///< rigid motions that the supports leave free (0 to 3; 0 or 1 about an axis)
   /// The motions of the contact nodes that neither supports nor stiffness resist, in local
   /// frames: rows of S × k, orthonormal columns. S does not resist them to round-off.
   Eigen::MatrixXd free_motions;
   Counters counters;

   /// Displacement of all dofs (of this rank's, if the body is on several) for contact
   /// displacements {v; w} of *this body* and load multipliers (order of `patterns`). One solve
   /// with the kept factor. Displacements of held components are not asked for.
   Eigen::VectorXd recover(const Eigen::VectorXd &u, const Eigen::VectorXd &multipliers);

   /** Relative error of S, an estimate from above by the energies of its solves; of a body
       condensed by conjugate gradients from S u against the action of the operator, in double
       precision. Materials or elements of great contrast within one body cost digits: 1e-3
      means that stiffnesses, and with them displacements under given forces, are right to 0.1
      %. Infinite: nothing is known of some motion. A few solves with the kept factor.
      Collective. */
   double error_estimate();

   /// The rigid motions of the contact nodes in local frames: plane 2n × 3 (x, y, rotation
   /// about the origin), axisymmetric 2n × 1 (z), torsion n × 1 (rotation).
   Eigen::MatrixXd rigid_motions() const;

   std::shared_ptr<const BodySolver> solver; ///< shared by copies, of the free components

private:
   /// Positions in {x; y} of all nodes of the components that are free.
   std::vector<int> free_positions() const;
};

/// What load patterns do to a body whose contact nodes are clamped, in global components.
struct ClampedLoads
{
   Eigen::MatrixXd forces;   ///< contact forces, one column a pattern
   Eigen::MatrixXd response; ///< F_kᵀ K_II⁻¹ F_j of the patterns' interior forces
   /// Work of pattern k's forces (or those of its motion) at the supports on the motion that
   /// pattern j prescribes.
   Eigen::MatrixXd reaction;
};

/// What a solver finds of a body, in global components, of contact dofs that are free.
struct Condensation
{
   Eigen::MatrixXd S;
   FreeMotions free;
   ClampedLoads clamped;
   Counters counters;
   std::shared_ptr<const BodySolver> solver;
};

/// Dofs of a contact line, {x; y} of all its nodes (torsion: the twist), and which of them
/// supports hold: no part of the body's trace.
struct ContactDofs
{
   std::vector<int> all;
   std::vector<int> held; ///< positions in `all`, increasing

   std::vector<int> free() const;
   std::vector<int> free_positions() const;
};

/// Of a line whose body has so many dofs; InputError if the line is not sound
/// (ContactLine::validate), is of another formulation, or its dofs are not from 0 to dofs - 1.
ContactDofs contact_dofs(const ContactLine &line, Formulation formulation, int dofs);

/// InputError that names the node and the pattern if a load displaces a contact dof: `moved`
/// are positions of those.
void require_unmoved(const ContactLine &line, const std::string &pattern,
                     const std::vector<int> &moved);

/// The same in the frames of the contact line, freed of what round-off makes of rigid motions.
/// Of `loads` names and controls alone are asked for. InputError if one component of a node is
/// held and the line meets it at neither 0 nor 90 degrees, to LineChain::smooth_turn.
CondensedBody in_local_frames(const ContactLine &line, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found);

} // namespace cattaneo
