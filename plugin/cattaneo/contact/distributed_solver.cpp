#include <algorithm>
#include <cattaneo/contact/distributed_solver.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

#ifdef MFEM_USE_MPI

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;

namespace
{

// Relative residuals (in the preconditioner's norm, whose square is an energy): of fields that
// enter energies, and of those whose forces are read off.
const double coarse = 1e-8, fine = 1e-13;

} // namespace

struct DistributedSolver::Implementation
{
   Ranks ranks;
   std::shared_ptr<const mfem::HypreParMatrix> K;
   std::unique_ptr<mfem::HypreParMatrix> interior; ///< K with unit rows at the other dofs
   std::unique_ptr<mfem::HypreBoomerAMG> preconditioner;
   mfem::Array<int> essential; ///< true dofs of this rank
   std::vector<int> contact;   ///< true dof of this rank of each contact dof, -1 elsewhere
   std::vector<bool> held;     ///< essential or contact, by true dof of this rank
   int max_iterations;

   /// K_II x = b; entries of b at held dofs are ignored, those of x zero.
   mfem::Vector solve(mfem::Vector b, double to, Counters &counters) const;
   mfem::Vector times(const mfem::Vector &x) const
   {
      mfem::Vector y(x.Size());
      K->Mult(x, y);
      return y;
   }
   /// Values at the contact dofs, on all ranks.
   Eigen::VectorXd at_contact(const mfem::Vector &x) const
   {
      MatrixXd values = MatrixXd::Zero(static_cast<Index>(contact.size()), 1);
      for (std::size_t a = 0; a < contact.size(); ++a)
      {
         if (contact[a] >= 0) { values(static_cast<Index>(a)) = x(contact[a]); }
      }
      ranks.sum(values);
      return values;
   }
   void clear_held(mfem::Vector &x) const
   {
      for (int k = 0; k < x.Size(); ++k)
      {
         if (held[k]) { x(k) = 0; }
      }
   }
};

DistributedSolver::DistributedSolver(const ElasticBody &body, const std::vector<int> &contact,
                                     int max_iterations)
   : impl_(std::make_unique<Implementation>())
{
   Implementation &my = *impl_;
   my.ranks = body.ranks();
   my.K = body.distributed_stiffness();
   my.essential = body.essential_dofs();
   my.max_iterations = max_iterations;
   const int size = my.K->Height(), first = body.first_global_dof();
   my.held.assign(size, false);
   for (int dof : my.essential) { my.held[dof] = true; }
   for (int dof : contact)
   {
      const bool mine = dof >= first && dof < first + size;
      my.contact.push_back(mine ? dof - first : -1);
      if (mine) { my.held[dof - first] = true; }
   }
   mfem::Array<int> rows;
   for (int k = 0; k < size; ++k)
   {
      if (my.held[k]) { rows.Append(k); }
   }
   my.interior = std::make_unique<mfem::HypreParMatrix>(*my.K);
   delete my.interior->EliminateRowsCols(rows);
   my.preconditioner = std::make_unique<mfem::HypreBoomerAMG>(*my.interior);
   my.preconditioner->SetPrintLevel(0);
   // The unknown-based approach: safe in the plane and about an axis, where rotation is no null
   // vector.
   if (body.components() > 1)
   {
      my.preconditioner->SetSystemsOptions(body.components(), body.space().GetOrdering() ==
                                                                 mfem::Ordering::byNODES);
   }
   // Half-planes are rings of elements that are needles far away: only strong couplings must
   // count, and no level be skipped (docs/ranks.md: 16 iterations instead of 123).
   my.preconditioner->SetStrengthThresh(0.7);
   my.preconditioner->SetAggressiveCoarsening(0);
}

DistributedSolver::~DistributedSolver() = default;

mfem::Vector DistributedSolver::Implementation::solve(mfem::Vector b, double to,
                                                      Counters &counters) const
{
   clear_held(b);
   mfem::Vector x(b.Size());
   x = 0.0;
   mfem::CGSolver solver(K->GetComm());
   solver.SetRelTol(to);
   solver.SetMaxIter(max_iterations);
   solver.SetPrintLevel(-1);
   solver.SetOperator(*interior);
   solver.SetPreconditioner(*preconditioner);
   solver.iterative_mode = false;
   solver.Mult(b, x);
   ++counters.back_substitutions;
   counters.krylov_iterations += solver.GetNumIterations();
   require(
      solver.GetConverged(), "condense: ", max_iterations,
      " iterations of conjugate gradients with BoomerAMG did not reach a relative residual "
      "of ",
      to, " (", solver.GetFinalNorm(), " left): is the body held, and its mesh sound?");
   clear_held(x);
   return x;
}

ClampedLoads DistributedSolver::loads(const std::vector<BodyLoad> &patterns,
                                      Counters &counters) const
{
   const Implementation &my = *impl_;
   const auto size = static_cast<Index>(my.held.size());
   const auto contact = static_cast<Index>(my.contact.size());
   const auto count = static_cast<Index>(patterns.size());
   ClampedLoads result{MatrixXd::Zero(contact, count), MatrixXd::Zero(count, count),
                       MatrixXd::Zero(count, count)};
   MatrixXd F(size, count), U(size, count), prescribed = MatrixXd::Zero(size, count);
   for (Index k = 0; k < count; ++k)
   {
      // Forces F, or those of the prescribed motion, F = -K d.
      const bool force = patterns[k].control == Control::force;
      mfem::Vector source = to_mfem(patterns[k].values);
      if (!force)
      {
         prescribed.col(k) = view(source);
         source = my.times(source);
         source.Neg();
      }
      F.col(k) = view(source);
      const mfem::Vector u = my.solve(source, fine, counters);
      U.col(k) = view(u);
      const mfem::Vector Ku = my.times(u);
      for (Index a = 0; a < contact; ++a)
      {
         const int dof = my.contact[a];
         if (dof >= 0) { result.forces(a, k) = Ku(dof) - source(dof); }
      }
   }
   result.response = F.transpose() * U; // U vanishes at the supports and the contact
   for (Index k = 0; k < count; ++k)
   {
      const double sign = patterns[k].control == Control::force ? 1.0 : -1.0;
      for (int dof : my.essential)
      {
         result.reaction.row(k) += sign * F(dof, k) * prescribed.row(dof);
      }
   }
   for (MatrixXd *sum : {&result.forces, &result.response, &result.reaction})
   {
      my.ranks.sum(*sum);
   }
   return result;
}

Eigen::MatrixXd DistributedSolver::schur(Counters &counters) const
{
   const Implementation &my = *impl_;
   const auto size = static_cast<Index>(my.held.size());
   const auto contact = static_cast<Index>(my.contact.size());
   // Block by block: an energy as soon as both of its fields are there.
   const Index block = 64;
   MatrixXd W(size, contact), KW(size, block), S = MatrixXd::Zero(contact, contact);
   for (Index start = 0; start < contact; start += block)
   {
      const Index width = std::min(block, contact - start);
      for (Index k = 0; k < width; ++k)
      {
         const int dof = my.contact[start + k];
         mfem::Vector unit(static_cast<int>(size));
         unit = 0.0;
         if (dof >= 0) { unit(dof) = 1.0; }
         mfem::Vector b = my.times(unit);
         b.Neg();
         mfem::Vector w = my.solve(b, coarse, counters);
         w += unit;
         W.col(start + k) = view(w);
         KW.col(k) = view(my.times(w));
      }
      S.block(0, start, start + width, width).noalias() =
         W.leftCols(start + width).transpose() * KW.leftCols(width);
   }
   my.ranks.sum(S);
   return S.selfadjointView<Eigen::Upper>();
}

Eigen::VectorXd DistributedSolver::recover(const Eigen::VectorXd &contact,
                                           const Eigen::VectorXd &forces,
                                           const Eigen::VectorXd &prescribed,
                                           Counters &counters) const
{
   const Implementation &my = *impl_;
   Eigen::VectorXd known = prescribed;
   for (std::size_t a = 0; a < my.contact.size(); ++a)
   {
      if (my.contact[a] >= 0) { known[my.contact[a]] = contact[a]; }
   }
   mfem::Vector b = my.times(to_mfem(known));
   b.Neg();
   b += to_mfem(forces);
   return view(my.solve(b, fine, counters)) + known;
}

Eigen::VectorXd DistributedSolver::forces(const Eigen::VectorXd &field) const
{
   return impl_->at_contact(impl_->times(to_mfem(field)));
}

int DistributedSolver::size() const
{
   return static_cast<int>(impl_->held.size());
}

bool DistributedSolver::equals(const DistributedSolver &other) const
{
   const Implementation &my = *impl_, &its = *other.impl_;
   bool same =
      my.held == its.held && my.contact == its.contact && my.K->Height() == its.K->Height();
   if (!my.ranks.any(!same))
   {
      mfem::SparseMatrix diagonal[2], other_columns[2];
      HYPRE_BigInt *numbers[2];
      const auto rows = [](const mfem::SparseMatrix &K)
      { return SharedMatrix(K.Height(), K.GetI(), K.GetJ(), K.GetData(), nullptr); };
      int k = 0;
      for (const Implementation *each : {&my, &its})
      {
         each->K->GetDiag(diagonal[k]);
         each->K->GetOffd(other_columns[k], numbers[k]);
         ++k;
      }
      same = rows(diagonal[0]).equals(rows(diagonal[1])) &&
             rows(other_columns[0]).equals(rows(other_columns[1])) &&
             std::equal(numbers[0], numbers[0] + other_columns[0].Width(), numbers[1],
                        numbers[1] + other_columns[1].Width());
   }
   return !my.ranks.any(!same);
}

} // namespace cattaneo

#endif
