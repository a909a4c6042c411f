#pragma once

#include <Eigen/Dense>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/elastic/body.hpp>
#include <memory>
#include <vector>

namespace cattaneo
{

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
   ClampedLoads loads(const std::vector<BodyLoad> &patterns, Counters &counters) const;
   /// Field on this rank's true dofs for contact displacements in global components, forces and
   /// prescribed displacements.
   Eigen::VectorXd recover(const Eigen::VectorXd &contact, const Eigen::VectorXd &forces,
                           const Eigen::VectorXd &prescribed, Counters &counters) const;
   /// Forces at the contact dofs of a field on this rank's true dofs, on all ranks.
   Eigen::VectorXd forces(const Eigen::VectorXd &field) const;
   int size() const; ///< true dofs of this rank
   /// True on every rank if the other stands for an equal operator, supports and contact.
   bool equals(const DistributedSolver &other) const;

private:
   struct Implementation;
   std::unique_ptr<Implementation> impl_;
};

#endif

} // namespace cattaneo
