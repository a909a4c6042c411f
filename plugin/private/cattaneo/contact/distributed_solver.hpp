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
    BoomerAMG on the interior dofs, with one solve for each contact dof and load pattern.

    With W_j = {U_j; e_j} the field of contact dof j, the entries are energies, S_ij = W_iᵀ K
    W_j, whose error is the product of two errors of the fields: solves to a relative 1e-8 give
    S to round-off. For this all fields are kept at once: on each rank interior dofs × contact
    dofs numbers. */
class DistributedSolver
{
public:
   /// `contact` are global true dofs. InputError, on all ranks, if a solve needs more than
   /// `max_iterations`.
   DistributedSolver(const ElasticBody &body, const std::vector<int> &contact,
                     int max_iterations);

   /// Schur complement of the contact dofs, with the same bits on every rank.
   Eigen::MatrixXd schur(Counters &counters) const;
   ClampedLoads loads(const std::vector<BodyLoad> &patterns, Counters &counters) const;
   /// Field on this rank's true dofs for contact displacements in global components, forces and
   /// prescribed displacements.
   Eigen::VectorXd recover(const Eigen::VectorXd &contact, const Eigen::VectorXd &forces,
                           const Eigen::VectorXd &prescribed, Counters &counters) const;
   /// Forces at the contact dofs of a field on this rank's true dofs, on all ranks.
   Eigen::VectorXd forces(const Eigen::VectorXd &field) const;
   /// True dofs of this rank.
   int size() const { return static_cast<int>(held_.size()); }
   /// True on every rank if the other solver has an equal operator, supports and contact.
   bool equals(const DistributedSolver &other) const;

private:
   /// K_II x = b; entries of b at held dofs are ignored, those of x zero.
   mfem::Vector solve(mfem::Vector b, double to, Counters &counters) const;
   mfem::Vector times(const mfem::Vector &x) const
   {
      mfem::Vector y(x.Size());
      K_->Mult(x, y);
      return y;
   }
   void clear_held(mfem::Vector &x) const
   {
      for (int k = 0; k < x.Size(); ++k)
      {
         if (held_[k]) { x(k) = 0; }
      }
   }

   Ranks ranks_;
   std::shared_ptr<const mfem::HypreParMatrix> K_;
   std::unique_ptr<mfem::HypreParMatrix> interior_; ///< K with unit rows at the other dofs
   std::unique_ptr<mfem::HypreBoomerAMG> preconditioner_;
   mfem::Array<int> essential_; ///< true dofs of this rank
   std::vector<int> contact_;   ///< true dof of this rank of each contact dof, -1 elsewhere
   std::vector<bool> held_;     ///< essential or contact, by true dof of this rank
   int max_iterations_;
};

#endif

} // namespace cattaneo
