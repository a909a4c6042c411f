#include <algorithm>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/contact/distributed_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <numeric>

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
                      SparseFactor::Backend backend, const BodySolver *alike)
{
   const Ranks &ranks = body.ranks();
   const AssembledBody all = assembled(body);
   Condensation found;
   if (const auto *other = dynamic_cast<const GatheredSolver *>(alike))
   {
      alike = other->first.get();
   }
   ranks.on_first([&] { found = condense_by_factor(all, contact, backend, alike); });
   if (!ranks.distributed()) { return found; }
   if (ranks.several()) { share(ranks, found); }
   auto solver = std::make_shared<GatheredSolver>();
   solver->ranks = ranks;
   solver->dofs = body.space().GetTrueVSize();
   solver->first = std::move(found.solver);
   found.solver = std::move(solver);
   return found;
}

bool couples(const mfem::SparseMatrix &K, int row, int diagonal)
{
   for (int k = 0; k < K.RowSize(row); ++k)
   {
      if (K.GetRowColumns(row)[k] != diagonal && K.GetRowEntries(row)[k] != 0) { return true; }
   }
   return false;
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
   bool moves = false, felt = false;
   for (int dof = 0; dof < load.values.size(); ++dof)
   {
      if (load.values[dof] == 0) { continue; }
      moves = true;
      felt = felt || (ranks.distributed() ? couples(own, dof, dof) || couples(others, dof, -1)
                                          : couples(body.stiffness(), dof, dof));
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
   return contact;
}

#ifdef MFEM_USE_MPI

class IterativeSolver : public BodySolver
{
public:
   std::shared_ptr<const DistributedSolver> solver; ///< shared by equal bodies
   Eigen::MatrixXd S;                               ///< schur() of it
   std::vector<BodyLoad> loads;

   Eigen::VectorXd recover(const Eigen::VectorXd &contact, const Eigen::VectorXd &multipliers,
                           Counters &counters) const override
   {
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(solver->size()), prescribed = forces;
      for (std::size_t k = 0; k < loads.size(); ++k)
      {
         (loads[k].control == Control::force ? forces : prescribed) +=
            multipliers[static_cast<Eigen::Index>(k)] * loads[k].values;
      }
      return solver->recover(contact, forces, prescribed, counters);
   }
   double error(const Eigen::MatrixXd &stiffness, const Eigen::MatrixXd &motions,
                Counters &counters) const override
   {
      const StiffnessProbes probe(stiffness, motions);
      const Eigen::MatrixXd &u = probe.motions();
      const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(solver->size());
      Eigen::MatrixXd differences = stiffness * u;
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
         differences.col(k) -=
            solver->forces(solver->recover(u.col(k), nothing, nothing, counters));
      }
      return probe.bound(differences);
   }
};

/// Free motions of a body on several ranks, taken for connected, from what holds it: the places
/// of the supports and of the contact nodes. The errors of find_free_motions().
FreeMotions free_motions_by_places(const ElasticBody &body, const ContactLine &line)
{
   // Two unheld corners of the bounding box carry the body's size.
   const Ranks &ranks = body.ranks();
   const mfem::DenseMatrix &x = body.node_coordinates();
   double box[4] = {-1e300, -1e300, -1e300, -1e300}; // -lo, hi
   std::vector<double> supports;
   const mfem::Array<int> essential = body.essential_dofs();
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < 2; ++c)
      {
         box[c] = std::max(box[c], -x(c, node));
         box[2 + c] = std::max(box[2 + c], x(c, node));
      }
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0 && std::binary_search(essential.begin(), essential.end(), dof))
         {
            supports.insert(supports.end(), {x(0, node), x(1, node), double(c)});
         }
      }
   }
   for (double &side : box) { side = ranks.max(side); }
   supports = ranks.gather(supports);
   const auto n = line.size();
   const int held = static_cast<int>(supports.size() / 3),
             contact = body.components() * static_cast<int>(n),
             count = held + contact + 2 * body.components();
   DofPlaces places{Eigen::VectorXd(count), Eigen::VectorXd(count), std::vector<int>(count),
                    body.formulation()};
   int k = 0;
   const auto add = [&](double px, double py, int component)
   {
      places.x[k] = px;
      places.y[k] = py;
      places.component[k++] = component;
   };
   for (int a = 0; a < held; ++a)
   {
      add(supports[3 * a], supports[3 * a + 1], static_cast<int>(supports[3 * a + 2]));
   }
   for (int c = 0; c < body.components(); ++c)
   {
      for (const LineNode &node : line.nodes) { add(node.position[0], node.position[1], c); }
   }
   for (int c = 0; c < body.components(); ++c)
   {
      add(-box[0], -box[1], c);
      add(box[2], box[3], c);
   }
   std::vector<int> all(count);
   std::iota(all.begin(), all.end(), 0);
   std::vector<bool> supported(count, false), both(count, false);
   std::fill(supported.begin(), supported.begin() + held, true);
   std::fill(both.begin(), both.begin() + held + contact, true);
   require(free_rigid_motions(places, all, both).cols() == 0, "unsupported body: supports (",
           held, " dofs) and contact nodes (", n,
           ") together leave rigid motions free, must leave none");
   const Eigen::MatrixXd rigid = free_rigid_motions(places, all, supported);

   // Each motion as a linear field of each component, from its values where the body is not
   // held, to find its work with the loads.
   const auto &patterns = body.patterns();
   FreeMotions free;
   free.count = static_cast<int>(rigid.cols());
   free.contact = rigid.middleRows(held, contact);
   free.resultant = Eigen::MatrixXd::Zero(rigid.cols(), patterns.size());
   for (Eigen::Index m = 0; m < rigid.cols(); ++m)
   {
      Eigen::MatrixXd field(3, body.components());
      for (int c = 0; c < body.components(); ++c)
      {
         const int corner = held + contact + 2 * c;
         Eigen::MatrixXd rows(n + 2, 3);
         Eigen::VectorXd values(n + 2);
         for (Eigen::Index i = 0; i < n + 2; ++i)
         {
            const auto at = i < n ? held + c * n + i : corner + i - n;
            rows.row(i) << 1, places.x[at], places.y[at];
            values[i] = rigid(at, m);
         }
         field.col(c) = rows.completeOrthogonalDecomposition().solve(values);
      }
      for (int node = 0; node < x.Width(); ++node)
      {
         for (int c = 0; c < body.components(); ++c)
         {
            const int dof = body.true_dof(node, c);
            if (dof < 0) { continue; }
            const double motion =
               field(0, c) + field(1, c) * x(0, node) + field(2, c) * x(1, node);
            for (std::size_t p = 0; p < patterns.size(); ++p)
            {
               if (patterns[p].control != Control::force) { continue; }
               free.resultant(m, static_cast<Eigen::Index>(p)) +=
                  motion * patterns[p].values[dof];
            }
         }
      }
   }
   ranks.sum(free.resultant);
   return free;
}

Condensation by_iterations(const ElasticBody &body, const ContactLine &line,
                           const ContactDofs &dofs, int max_iterations, const BodySolver *alike)
{
   Condensation found;
   const std::vector<int> contact = dofs.free();
   found.free = free_motions_by_places(body, line);
   found.free.contact = found.free.contact(dofs.free_positions(), Eigen::all).eval();
   auto solver = std::make_shared<IterativeSolver>();
   solver->loads = body.patterns();
   solver->solver = std::make_shared<const DistributedSolver>(body, contact, max_iterations);
   const auto *other = dynamic_cast<const IterativeSolver *>(alike);
   if (other && solver->solver->equals(*other->solver))
   {
      solver->solver = other->solver;
      solver->S = other->S;
   }
   else
   {
      solver->S = solver->solver->schur(found.counters);
      ++found.counters.factorisations;
   }
   found.clamped = solver->solver->loads(solver->loads, found.counters);
   found.S = solver->S;
   found.solver = std::move(solver);
   return found;
}

#endif

} // namespace

void CondenseSettings::validate() const
{
   require(direct_dofs >= 0, "condense: direct_dofs is ", direct_dofs,
           ", must not be negative");
   require(max_iterations >= 1, "condense: max_iterations is ", max_iterations,
           ", must be at least 1");
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
      found = by_iterations(body, line, dofs, settings.max_iterations, other);
   }
   else
#endif
   {
      found = gathered(body, contact, settings.backend, other);
   }
   found.counters += body.counters();
   return in_local_frames(line, body.patterns(), dofs, std::move(found));
}

} // namespace cattaneo
