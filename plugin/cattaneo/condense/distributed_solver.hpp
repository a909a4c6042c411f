#pragma once

#include <Eigen/Dense>
#include <cattaneo/counters.hpp>
#include <cattaneo/elastic/body.hpp>
#include <memory>
#include <vector>

namespace cattaneo
{

/// What load patterns do to a body whose contact nodes are clamped, in global components.
struct ClampedLoads
{
   Eigen::MatrixXd forces;   ///< contact forces, one column a pattern
   Eigen::MatrixXd response; ///< F_kᵀ K_II⁻¹ F_j of the patterns' interior forces
   /// Work of pattern k's forces (or those of its motion) at the supports on the motion that
   /// pattern j prescribes.
   Eigen::MatrixXd reaction;
};

#ifdef MFEM_USE_MPI

/** Condensation and recovery on several ranks: conjugate gradients preconditioned by hypre's
    BoomerAMG on the interior dofs, one solve a contact dof and load pattern.

    With W_j = {U_j; e_j} the field of contact dof j, the entries are energies, S_ij = W_iᵀ K
   W_j, whose error is the product of two errors of the fields: solves to a relative 1e-8 give S
   to round-off. That asks for all fields at once: interior dofs of the rank × contact dofs
   numbers. */
class DistributedSolver
{
public:
   /// `contact`: global true dofs. InputError, on all ranks, if a solve needs more than
   /// `max_iterations`.
   DistributedSolver(const ElasticBody &body, const std::vector<int> &contact,
                     int max_iterations);
   ~DistributedSolver();

   /// Schur complement of the contact dofs, the same bits on every rank.
   Eigen::MatrixXd schur(Counters &counters) const;
   ClampedLoads loads(const std::vector<ElasticBody::Pattern> &patterns,
                      Counters &counters) const;
   /// Field on this rank's true dofs for contact displacements in global components, forces and
   /// prescribed displacements.
   mfem::Vector recover(const Eigen::VectorXd &contact, const mfem::Vector &forces,
                        const mfem::Vector &prescribed, Counters &counters) const;
   /// Forces at the contact dofs of a field on this rank's true dofs, on all ranks.
   Eigen::VectorXd forces(const mfem::Vector &field) const;
   /// Diagonal entries of the stiffness at the contact dofs, on all ranks.
   Eigen::VectorXd diagonal() const;
   int size() const; ///< true dofs of this rank
   /// True on every rank if the other stands for an equal operator, supports and contact.
   bool equals(const DistributedSolver &other) const;

private:
   struct Implementation;
   std::unique_ptr<Implementation> impl_;
};

#endif

} // namespace cattaneo
