#include <algorithm>
#include <cattaneo/contact/distributed_solver.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>

#ifdef MFEM_USE_MPI

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;

// Relative residuals, in the preconditioner's norm, whose square is an energy. The first is for
// fields that are used in energies, the second for fields whose forces are used directly.
static constexpr double coarse = 1e-8, fine = 1e-13;

DistributedSolver::DistributedSolver(const ElasticBody &body, const std::vector<int> &contact,
                                     int max_iterations)
   : ranks_(body.ranks()), K_(body.distributed_stiffness()), essential_(body.essential_dofs()),
     max_iterations_(max_iterations)
{
   const int size = K_->Height(), first = body.first_global_dof();
   held_.assign(size, false);
   for (int dof : essential_) { held_[dof] = true; }
   for (int dof : contact)
   {
      const bool mine = dof >= first && dof < first + size;
      contact_.push_back(mine ? dof - first : -1);
      if (mine) { held_[dof - first] = true; }
   }
   mfem::Array<int> rows;
   for (int k = 0; k < size; ++k)
   {
      if (held_[k]) { rows.Append(k); }
   }
   interior_ = std::make_unique<mfem::HypreParMatrix>(*K_);
   delete interior_->EliminateRowsCols(rows);
   preconditioner_ = std::make_unique<mfem::HypreBoomerAMG>(*interior_);
   preconditioner_->SetPrintLevel(0);
   // AMG treats each component by itself (the unknown-based approach). Options for elasticity
   // would take the rotation for a null vector, which is wrong about an axis.
   if (body.components() > 1)
   {
      preconditioner_->SetSystemsOptions(body.components(),
                                         body.space().GetOrdering() == mfem::Ordering::byNODES);
   }
   // Half-planes are meshed by rings of elements, which are needles far away. So only strong
   // couplings may count, and no level may be skipped (docs/ranks.md: 16 iterations instead of
   // 123).
   preconditioner_->SetStrengthThresh(0.7);
   preconditioner_->SetAggressiveCoarsening(0);
}

mfem::Vector DistributedSolver::solve(mfem::Vector b, double to, Counters &counters) const
{
   clear_held(b);
   mfem::Vector x(b.Size());
   x = 0.0;
   mfem::CGSolver solver(K_->GetComm());
   solver.SetRelTol(to);
   solver.SetMaxIter(max_iterations_);
   solver.SetPrintLevel(-1);
   solver.SetOperator(*interior_);
   solver.SetPreconditioner(*preconditioner_);
   solver.iterative_mode = false;
   solver.Mult(b, x);
   ++counters.back_substitutions;
   counters.krylov_iterations += solver.GetNumIterations();
   require(
      solver.GetConverged(), "condense: ", max_iterations_,
      " iterations of conjugate gradients with BoomerAMG did not reach a relative residual "
      "of ",
      to, " (", solver.GetFinalNorm(),
      " was reached): does the body have supports, and is its mesh free of degenerate "
      "elements?");
   clear_held(x);
   return x;
}

ClampedLoads DistributedSolver::loads(const std::vector<BodyLoad> &patterns,
                                      Counters &counters) const
{
   const auto size = static_cast<Index>(held_.size());
   const auto contact = static_cast<Index>(contact_.size());
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
         source = times(source);
         source.Neg();
      }
      F.col(k) = view(source);
      const mfem::Vector u = solve(source, fine, counters);
      U.col(k) = view(u);
      const mfem::Vector Ku = times(u);
      for (Index a = 0; a < contact; ++a)
      {
         const int dof = contact_[a];
         if (dof >= 0) { result.forces(a, k) = Ku(dof) - source(dof); }
      }
   }
   result.response = F.transpose() * U; // U vanishes at the supports and the contact
   for (Index k = 0; k < count; ++k)
   {
      const double sign = patterns[k].control == Control::force ? 1.0 : -1.0;
      for (int dof : essential_)
      {
         result.reaction.row(k) += sign * F(dof, k) * prescribed.row(dof);
      }
   }
   for (MatrixXd *sum : {&result.forces, &result.response, &result.reaction})
   {
      ranks_.sum(*sum);
   }
   return result;
}

Eigen::MatrixXd DistributedSolver::schur(Counters &counters) const
{
   const auto size = static_cast<Index>(held_.size());
   const auto contact = static_cast<Index>(contact_.size());
   // Block by block: an energy is computed as soon as both of its fields are known.
   const Index block = 64;
   MatrixXd W(size, contact), KW(size, block), S = MatrixXd::Zero(contact, contact);
   for (Index start = 0; start < contact; start += block)
   {
      const Index width = std::min(block, contact - start);
      for (Index k = 0; k < width; ++k)
      {
         const int dof = contact_[start + k];
         mfem::Vector unit(static_cast<int>(size));
         unit = 0.0;
         if (dof >= 0) { unit(dof) = 1.0; }
         mfem::Vector b = times(unit);
         b.Neg();
         mfem::Vector w = solve(b, coarse, counters);
         w += unit;
         W.col(start + k) = view(w);
         KW.col(k) = view(times(w));
      }
      S.block(0, start, start + width, width).noalias() =
         W.leftCols(start + width).transpose() * KW.leftCols(width);
   }
   ranks_.sum(S);
   return S.selfadjointView<Eigen::Upper>();
}

Eigen::VectorXd DistributedSolver::recover(const Eigen::VectorXd &contact,
                                           const Eigen::VectorXd &forces,
                                           const Eigen::VectorXd &prescribed,
                                           Counters &counters) const
{
   Eigen::VectorXd known = prescribed;
   for (std::size_t a = 0; a < contact_.size(); ++a)
   {
      if (contact_[a] >= 0) { known[contact_[a]] = contact[a]; }
   }
   mfem::Vector b = times(to_mfem(known));
   b.Neg();
   b += to_mfem(forces);
   return view(solve(b, fine, counters)) + known;
}

Eigen::VectorXd DistributedSolver::forces(const Eigen::VectorXd &field) const
{
   const mfem::Vector all = times(to_mfem(field));
   MatrixXd values = MatrixXd::Zero(static_cast<Index>(contact_.size()), 1);
   for (std::size_t a = 0; a < contact_.size(); ++a)
   {
      if (contact_[a] >= 0) { values(static_cast<Index>(a)) = all(contact_[a]); }
   }
   ranks_.sum(values);
   return values;
}

bool DistributedSolver::equals(const DistributedSolver &other) const
{
   bool same =
      held_ == other.held_ && contact_ == other.contact_ && K_->Height() == other.K_->Height();
   if (!ranks_.any(!same))
   {
      mfem::SparseMatrix diagonal[2], other_columns[2];
      HYPRE_BigInt *numbers[2];
      const auto rows = [](const mfem::SparseMatrix &K)
      { return SharedMatrix(K.Height(), K.GetI(), K.GetJ(), K.GetData(), nullptr); };
      int k = 0;
      for (const DistributedSolver *each : {this, &other})
      {
         each->K_->GetDiag(diagonal[k]);
         each->K_->GetOffd(other_columns[k], numbers[k]);
         ++k;
      }
      same = rows(diagonal[0]).equals(rows(diagonal[1])) &&
             rows(other_columns[0]).equals(rows(other_columns[1])) &&
             std::equal(numbers[0], numbers[0] + other_columns[0].Width(), numbers[1],
                        numbers[1] + other_columns[1].Width());
   }
   return !ranks_.any(!same);
}

} // namespace cattaneo

#endif
