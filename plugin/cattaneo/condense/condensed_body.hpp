#pragma once

#include <cattaneo/condense/sparse_factor.hpp>
#include <cattaneo/contact/contact_line.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/elastic/body.hpp>

namespace cattaneo
{

/** One body reduced to its contact nodes (thesis 3.2):  f = S u + Σ λ_k f_k, in the local
   frames of the contact line: u = {v; w}, f = {q; p}, all tangential entries first.

    Of a torsion body: u = v = u_θ and f = q, circumferential, positive in the direction of the
   twist whatever the line's frames.


    It keeps the sparse factor and what its loads need, but neither the ElasticBody nor the
   mesh. */
class CondensedBody
{
public:
   ContactLine line;
   Geometry geometry = Geometry::plane;
   Eigen::MatrixXd S;                 ///< 2n × 2n (torsion: n × n), symmetric
   std::vector<LoadPattern> patterns; ///< f_k, by name (torsion: p is empty)
   Eigen::MatrixXd H; ///< loads by loads with the contact clamped (see ReducedProblem::H)
   int rigid_modes =
      0; ///< rigid motions that the supports leave free (0 to 3; 0 or 1 about an axis)
   /// The motions of the contact nodes that neither supports nor stiffness resist, in local
   /// frames: rows of S × k, orthonormal columns. S does not resist them to round-off.
   Eigen::MatrixXd free_motions;
   Counters counters;

   /// Displacement of all true dofs for contact displacements {v; w} of *this body* and load
   /// multipliers (order of `patterns`). One solve with the kept factor.
   mfem::Vector recover(const Eigen::VectorXd &u, const Eigen::VectorXd &multipliers);

   /** Relative error of S, an estimate from above by energies, see stiffness_error(); of a body
       condensed by conjugate gradients from S u against the action of the operator, in double
       precision. Materials or elements of great contrast within one body cost digits: 1e-3
      means that stiffnesses, and with them displacements under given forces, are right to 0.1
      %. Infinite: nothing is known of some motion. A few solves with the kept factor.
      Collective. */
   double error_estimate();

   /// The rigid motions of the contact nodes in local frames: plane 2n × 3 (x, y, rotation
   /// about the origin), axisymmetric 2n × 1 (z), torsion n × 1 (rotation).
   Eigen::MatrixXd rigid_motions() const;

   struct Operator; ///< factor and dof lists, shared between equal bodies
   std::shared_ptr<const Operator> op;
   struct Loads; ///< right-hand sides and prescribed values of this body's patterns
   std::shared_ptr<const Loads> loads;
};

struct CondenseSettings
{
   SparseFactor::Backend backend = SparseFactor::Backend::automatic;
   /// Of a body on an mfem::ParMesh: with more dofs than this it is condensed by conjugate
   /// gradients on all of them, below it is gathered and factored by the first. At the default
   /// a factor takes some 1.4 GB (docs/ranks.md).
   int direct_dofs = 500000;
   /// apply_reduction() forms S nevertheless for up to this many contact nodes: it costs the
   /// time of a few increments without it, but 40 × (2n)² bytes a rank (docs/ranks.md).
   int formed_nodes = 5000;
   /// Of conjugate gradients, for each right-hand side; an InputError beyond.
   int max_iterations = 2000;

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/** Condenses a body to the nodes of a contact line: one factorisation, contact dofs last, one
   solve a load pattern. A distributed body is gathered on the first rank, or (see the settings)
   condensed by one iterative solve for each contact dof and load pattern; the counters tell
   which. Either way S and the loads have the same bits on all ranks. If `alike` was condensed
   from an equal operator (entries equal to 1e-12 of the largest, same supports, same contact
   dofs in the same order, as for the second of two equal bodies turned by 180° or shifted) its
   factor is used and nothing is factored.

    InputError, before factoring, if the supports and the contact nodes together leave a rigid
   motion of the body (or of a part that is connected to nothing) free, or if a contact dof is
   fixed or prescribed; afterwards if the operator is not positive definite. */
CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings = {},
                       const CondensedBody *alike = nullptr);

} // namespace cattaneo
