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

/// Of a body that was gathered: the first rank's solver, what it finds on all.
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

/// What the first rank found, on all.
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
                 ": was the operator eliminated? Pass it as assembled (SpMat() after "
                 "Finalize), or fix them in the body too");
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

/// InputError, on all ranks, for a load of displacements that nothing in the body feels.
void require_felt(const ElasticBody &body, const BodyLoad &load)
{
   const Ranks &ranks = body.ranks();
   mfem::SparseMatrix own, others;
#ifdef MFEM_USE_MPI
   if (ranks.distributed())
   {
      HYPRE_BigInt *columns = nullptr;
      body.distributed_stiffness()->GetDiag(own);
      body.distributed_stiffness()->GetOffd(others, columns);
   }
#endif
   const SparseView rows = view(ranks.distributed() ? own : body.stiffness());
   double most = largest_beside_diagonal(rows);
   if (ranks.distributed())
   {
      most = ranks.max(std::max(most, largest_beside_diagonal(view(others), false)));
   }
   bool moves = false, felt = false;
   for (int dof = 0; dof < load.values.size(); ++dof)
   {
      if (load.values[dof] == 0) { continue; }
      moves = true;
      RowEntries entries;
      entries.add(rows, dof, dof);
      if (ranks.distributed()) { entries.add(view(others), dof, -1); }
      felt = felt || entries.link(most);
   }
   const bool anywhere = ranks.any(felt);
   require(!ranks.any(moves) || anywhere, "condense: load '", load.name, "' ",
           AssembledBody::feels_nothing);
}

/// contact_dofs() of an MFEM body, global numbers, and which are held. InputError, on all
/// ranks, if one is displaced by a load pattern.
ContactDofs contact_dofs(const ElasticBody &body, const ContactLine &line)
{
   ContactDofs contact = contact_dofs(line, body.formulation(), body.dofs());
   const mfem::Array<int> essential = body.essential_dofs();
   // On all ranks alike, the owner of a dof knows.
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
   for (const BodyLoad &load : body.patterns())
   {
      if (load.control == Control::force) { continue; }
      require_felt(body, load);
      require_unmoved(line, load.name,
                      known_by_owner([&](int dof) { return load.values[dof] != 0; }));
   }
   for (const BlockMotion &block : body.blocks())
   {
      require_unmoved(line, "",
                      known_by_owner([&](int dof) { return block.motion[dof] != 0; }));
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
   const ContactDofs dofs = contact_dofs(body, line);
   const std::vector<int> contact = dofs.free();
   const BodySolver *other = alike ? alike->solver.get() : nullptr;
   Condensation found;
#ifdef MFEM_USE_MPI
   if (body.ranks().distributed() && body.dofs() > settings.direct_dofs)
   {
      require(body.blocks().empty(),
              "condense: the body has guides, which only a factor knows: "
              "CondenseSettings::direct_dofs must be above its ",
              body.dofs(), " dofs");
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

} // namespace cattaneo
