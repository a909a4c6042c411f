#include <algorithm>
#include <cattaneo/condense/row_links.hpp>
#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/contact/condense_by_iterations.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

namespace
{

constexpr const char *was_eliminated =
   ": was the operator eliminated? Pass it as assembled (SpMat() after Finalize), or fix them "
   "in the body too";

/// Solver of a body that was gathered on the first rank. Its results are sent to all ranks.
class GatheredSolver : public BodySolver
{
public:
   Ranks ranks;
   int dofs = 0;                            ///< true dofs of this rank
   std::shared_ptr<const BodySolver> first; ///< on the first rank

   Eigen::VectorXd recover(const Eigen::VectorXd &contact, const Eigen::VectorXd &multipliers,
                           Counters &counters) const override
   {
      Eigen::VectorXd field, here(dofs);
      if (first) { field = first->recover(contact, multipliers, counters); }
      else { ++counters.back_substitutions; }
      ranks.deal(field, dofs, here.data());
      return here;
   }
   double error(const Eigen::MatrixXd &S, const Eigen::MatrixXd &motions,
                Counters &counters) const override
   {
      Eigen::MatrixXd error(1, 1);
      Counters of_first;
      ranks.on_first([&] { error(0) = first->error(S, motions, of_first); });
      ranks.share(error);
      counters.back_substitutions += 6;
      return error(0);
   }
};

/// Sends the results of the first rank to all.
void share(const Ranks &ranks, Condensation &found)
{
   Eigen::MatrixXd counts(3, 1);
   counts << found.free.count, found.counters.factorisations, found.counters.back_substitutions;
   for (Eigen::MatrixXd *matrix :
        {&counts, &found.S, &found.free.contact, &found.free.resultant, &found.clamped.forces,
         &found.clamped.response, &found.clamped.reaction})
   {
      ranks.share(*matrix);
   }
   found.free.count = static_cast<int>(counts(0));
   found.counters.factorisations = static_cast<long>(counts(1));
   found.counters.back_substitutions = static_cast<long>(counts(2));
}

Condensation gathered(const ElasticBody &body, const std::vector<int> &contact,
                      const BodySolver *alike)
{
   const Ranks &ranks = body.ranks();
   const AssembledBody all = assembled(body);
   Condensation found;
   if (const auto *other = dynamic_cast<const GatheredSolver *>(alike))
   {
      alike = other->first.get();
   }
   ranks.on_first(
      [&]
      {
         const std::string gone = all.eliminated_warning();
         require(gone.empty(), "condense: ", gone.substr(0, gone.find(": they are")),
                 was_eliminated);
         found = condense_by_factor(all, contact, alike);
      });
   if (!ranks.distributed()) { return found; }
   if (ranks.several()) { share(ranks, found); }
   auto solver = std::make_shared<GatheredSolver>();
   solver->ranks = ranks;
   solver->dofs = body.space().GetTrueVSize();
   solver->first = std::move(found.solver);
   found.solver = std::move(solver);
   return found;
}

/// The rows of a body's stiffness that this rank has.
class RowsHere
{
public:
   explicit RowsHere(const ElasticBody &body) : ranks_(body.ranks())
   {
#ifdef MFEM_USE_MPI
      if (ranks_.distributed())
      {
         const mfem::HypreParMatrix &K = *body.distributed_stiffness();
         HYPRE_BigInt *columns = nullptr;
         K.GetDiag(own_);
         K.GetOffd(others_, columns);
         other_diagonals_ = diagonals_of_others(K, diagonal_of(view(own_)));
      }
#endif
      rows_ = &(ranks_.distributed() ? own_ : body.stiffness());
      diagonals_ = diagonal_of(view(*rows_));
      most_ = largest_beside_diagonal(view(*rows_));
      if (!ranks_.distributed()) { return; }
      most_ = ranks_.max(std::max(most_, largest_beside_diagonal(view(others_), false)));
   }
   RowEntries entries(int dof) const
   {
      RowEntries entries;
      entries.add(view(*rows_), dof, dof, diagonals_);
      if (ranks_.distributed()) { entries.add(view(others_), dof, -1, other_diagonals_); }
      return entries;
   }
   /// The largest magnitude off the diagonal, of all ranks.
   double most() const
   {
      return most_;
   }

private:
#ifdef MFEM_USE_MPI
   /// The diagonal of K in the columns of other ranks that are coupled with rows of this one.
   static Eigen::VectorXd diagonals_of_others(const mfem::HypreParMatrix &K,
                                              const Eigen::VectorXd &here)
   {
      hypre_ParCSRMatrix *matrix = K;
      if (!hypre_ParCSRMatrixCommPkg(matrix)) { hypre_MatvecCommPkgCreate(matrix); }
      hypre_ParCSRCommPkg *package = hypre_ParCSRMatrixCommPkg(matrix);
      const auto sends = hypre_ParCSRCommPkgNumSends(package);
      Eigen::VectorXd sent(hypre_ParCSRCommPkgSendMapStart(package, sends));
      for (Eigen::Index k = 0; k < sent.size(); ++k)
      {
         sent[k] = here[hypre_ParCSRCommPkgSendMapElmt(package, k)];
      }
      Eigen::VectorXd received(hypre_CSRMatrixNumCols(hypre_ParCSRMatrixOffd(matrix)));
      hypre_ParCSRCommHandleDestroy(
         hypre_ParCSRCommHandleCreate(1, package, sent.data(), received.data()));
      return received;
   }
#endif

   const Ranks &ranks_;
   mfem::SparseMatrix own_, others_;
   const mfem::SparseMatrix *rows_ = nullptr;
   Eigen::VectorXd diagonals_, other_diagonals_;
   double most_ = 0;
};

/// InputError, on all ranks, for a load of displacements that causes no forces in the body.
void require_felt(const ElasticBody &body, const BodyLoad &load)
{
   const Ranks &ranks = body.ranks();
   const RowsHere rows(body);
   bool moves = false, felt = false;
   for (int dof = 0; dof < load.values.size(); ++dof)
   {
      if (load.values[dof] == 0) { continue; }
      moves = true;
      felt = felt || rows.entries(dof).link(rows.most());
   }
   const bool anywhere = ranks.any(felt);
   require(!ranks.any(moves) || anywhere, "condense: load '", load.name, "' ",
           AssembledBody::feels_nothing);
}

#ifdef MFEM_USE_MPI

/// InputError, on all ranks, for rows of an operator on them that are those of supports which
/// were eliminated: see AssembledBody::eliminated().
void require_not_eliminated(const ElasticBody &body)
{
   if (body.has_material()) { return; }
   const Ranks &ranks = body.ranks();
   const RowsHere rows(body);
   const DofPlaces places = places_of(body);
   const mfem::Array<int> essential = body.essential_dofs();
   const auto size = static_cast<int>(places.component.size());
   std::vector<double> first; // of this rank: its place and component
   long alone = 0;
   for (int c = 0; c < body.components(); ++c)
   {
      // Forces of a translation along the component.
      Eigen::VectorXd moved(size);
      for (int dof = 0; dof < size; ++dof) { moved[dof] = places.component[dof] == c; }
      mfem::Vector forces(size);
      body.distributed_stiffness()->Mult(to_mfem(moved), forces);
      bool connected = false; // any row of the component
      std::vector<int> gone;
      for (int dof = 0; dof < size; ++dof)
      {
         if (places.component[dof] != c) { continue; }
         if (is_linked(rows.entries(dof), places.formulation, c, rows.most(), forces[dof]))
         {
            connected = true;
         }
         else if (!std::binary_search(essential.begin(), essential.end(), dof))
         {
            gone.push_back(dof);
         }
      }
      if (!ranks.any(connected)) { continue; } // a bed of springs
      alone += static_cast<long>(gone.size());
      if (first.empty() && !gone.empty())
      {
         first = {places.x[gone[0]], places.y[gone[0]], static_cast<double>(c)};
      }
   }
   alone = ranks.sum(alone);
   first = ranks.gather(first);
   if (alone == 0) { return; }
   require(false, "condense: ",
           eliminated_rows(static_cast<std::size_t>(alone), places.formulation,
                           static_cast<int>(first[2]),
                           as_text(Eigen::Vector2d(first[0], first[1]))),
           was_eliminated);
}

#endif

/// The contact dofs of an MFEM body as global numbers, which of them supports hold, and which
/// ones loads move. InputError, on all ranks, if one is in a guide.
ContactDofs contact_dofs(const ElasticBody &body, const ContactLine &line)
{
   ContactDofs contact = contact_dofs(line, body.formulation(), body.dofs());
   const mfem::Array<int> essential = body.essential_dofs();
   // The owner of a dof tells all ranks.
   const auto known_by_owner = [&](auto said_of)
   {
      std::vector<double> here;
      for (std::size_t a = 0; a < contact.all.size(); ++a)
      {
         const int dof = contact.all[a] - body.first_global_dof();
         if (std::binary_search(essential.begin(), essential.end(), dof) && said_of(dof))
         {
            here.push_back(static_cast<double>(a));
         }
      }
      here = body.ranks().gather(here);
      std::vector<int> positions(here.begin(), here.end());
      std::sort(positions.begin(), positions.end());
      return positions;
   };
   contact.held = known_by_owner([](int) { return true; });
   const DofPlaces places = places_of(body);
   const std::vector<int> fixed(essential.begin(), essential.end());
   for (const int position : contact.held)
   {
      if (body.ranks().any(moves_plane(line, position, places, fixed, body.patterns())))
      {
         contact.in_moved_plane.push_back(position);
      }
   }
   const std::vector<BodyLoad> &loads = body.patterns();
   for (std::size_t k = 0; k < loads.size(); ++k)
   {
      if (loads[k].control == Control::force) { continue; }
      require_felt(body, loads[k]);
      const auto by = [&](int dof) { return loads[k].values[dof]; };
      const std::vector<int> moved = known_by_owner([&](int dof) { return by(dof) != 0; });
      Eigen::MatrixXd all(moved.size(), 1);
      for (std::size_t a = 0; a < moved.size(); ++a)
      {
         const int dof = contact.all[moved[a]] - body.first_global_dof();
         const bool here = std::binary_search(essential.begin(), essential.end(), dof);
         all(static_cast<Eigen::Index>(a)) = here ? by(dof) : 0.0;
      }
      body.ranks().sum(all);
      for (std::size_t a = 0; a < moved.size(); ++a)
      {
         contact.move(moved[a], static_cast<Eigen::Index>(k), all(static_cast<Eigen::Index>(a)),
                      line, loads);
      }
   }
   for (const BlockMotion &block : body.blocks())
   {
      const std::vector<int> moved =
         known_by_owner([&](int dof) { return block.motion[dof] != 0; });
      if (!moved.empty()) { refuse_motion(line, moved[0], in_guide); }
   }
   return contact;
}

} // namespace

void CondenseSettings::validate() const
{
   require_at_least("condense: direct_dofs", direct_dofs, 0);
   require_at_least("condense: max_iterations", max_iterations, 1);
}

CondensedBody condense(const ElasticBody &body, const ContactLine &line,
                       const CondenseSettings &settings, const CondensedBody *alike)
{
   settings.validate();
   require(body.formulation() != Formulation::space,
           "condense: the body is in space, must be condensed to a contact surface");
   const ContactDofs dofs = contact_dofs(body, line);
   const std::vector<int> contact = dofs.free();
   const BodySolver *other = alike ? alike->solver.get() : nullptr;
   Condensation found;
#ifdef MFEM_USE_MPI
   if (body.ranks().distributed() && body.dofs() > settings.direct_dofs)
   {
      require(body.blocks().empty(),
              "condense: a body with guides can be condensed by a factor only: "
              "CondenseSettings::direct_dofs must be above its ",
              body.dofs(), " dofs");
      require_not_eliminated(body);
      found = condense_by_iterations(body, line, dofs, settings.max_iterations, other);
   }
   else
#endif
   {
      found = gathered(body, contact, other);
   }
   found.counters += body.counters();
   return in_local_frames(line, body.patterns(), dofs, std::move(found));
}

CondensedBody condense(const ElasticBody &body, const ContactSurface &surface,
                       const CondensedBody *alike)
{
   require(body.formulation() == Formulation::space, "condense: the body is ",
           name(body.formulation()), ", must be in space to have a contact surface");
   const AssembledBody all = assembled(body);
   const std::string gone = all.eliminated_warning();
   require(gone.empty(), "condense: ", gone.substr(0, gone.find(": they are")), was_eliminated);
   CondensedBody made = condense(all, surface, alike);
   made.counters += body.counters();
   return made;
}

} // namespace cattaneo
