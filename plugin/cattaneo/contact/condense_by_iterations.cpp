#include <algorithm>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/contact/condense_by_iterations.hpp>
#include <cattaneo/contact/distributed_solver.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <numeric>

#ifdef MFEM_USE_MPI

namespace cattaneo
{

namespace
{

class IteratedBodySolver : public BodySolver
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

/// Free motions of a body on several ranks, which is assumed to be connected: those that its
/// supports and the places of its contact nodes leave free, and that K does not resist. Throws
/// the same errors as find_free_motions().
FreeMotions free_motions_on_ranks(const ElasticBody &body, const ContactLine &line)
{
   const Ranks &ranks = body.ranks();
   const DofPlaces own = places_of(body);
   const mfem::Array<int> essential = body.essential_dofs();
   const auto size = static_cast<int>(own.component.size());
   std::vector<double> supports;
   const Eigen::AlignedBox3d box = body.box();
   for (int dof : essential)
   {
      supports.insert(supports.end(),
                      {own.x[dof], own.y[dof], static_cast<double>(own.component[dof])});
   }
   supports = ranks.gather(supports);

   // The same on all ranks: supports, contact nodes, and corners of the bounding box, where
   // every motion is largest; then the dofs of this rank.
   std::vector<double> x, y;
   DofPlaces places;
   places.formulation = body.formulation();
   const auto add = [&](double px, double py, int component)
   {
      x.push_back(px);
      y.push_back(py);
      places.component.push_back(component);
   };
   for (std::size_t a = 0; a < supports.size(); a += 3)
   {
      add(supports[a], supports[a + 1], static_cast<int>(supports[a + 2]));
   }
   const auto held = static_cast<int>(x.size());
   for (int c = 0; c < body.components(); ++c)
   {
      for (const LineNode &node : line.nodes) { add(node.position[0], node.position[1], c); }
   }
   const int contact = static_cast<int>(x.size()) - held;
   for (int c = 0; c < body.components(); ++c)
   {
      add(box.min()[0], box.min()[1], c);
      add(box.max()[0], box.max()[1], c);
   }
   for (int dof = 0; dof < size; ++dof) { add(own.x[dof], own.y[dof], own.component[dof]); }
   places.x = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
   places.y = Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
   std::vector<int> all(x.size());
   std::iota(all.begin(), all.end(), 0);
   // Rigid motions that remain free if the first `count` places are held; zero on dofs of this
   // rank that are fixed.
   const auto left_by = [&](int count)
   {
      std::vector<bool> holding(all.size(), false);
      std::fill(holding.begin(), holding.begin() + count, true);
      Eigen::MatrixXd motions = free_rigid_motions(places, all, holding);
      for (int dof : essential) { motions.bottomRows(size).row(dof).setZero(); }
      return motions;
   };
   const mfem::HypreParMatrix &K = *body.distributed_stiffness();
   const auto unresisted_of = [&](const Eigen::MatrixXd &motions) -> Eigen::MatrixXd
   {
      const Eigen::MatrixXd own_motions = motions.bottomRows(size);
      Eigen::MatrixXd forces(size, motions.cols());
      Eigen::MatrixXd sizes(1, 1);
      sizes(0, 0) = 0;
      mfem::Vector force(size);
      for (Eigen::Index m = 0; m < motions.cols(); ++m)
      {
         K.Mult(to_mfem(own_motions.col(m)), force);
         forces.col(m) = view(force);
         K.AbsMult(1, to_mfem(own_motions.col(m).cwiseAbs()), 0, force);
         sizes(0, 0) += own_motions.col(m).cwiseAbs().dot(view(force));
      }
      Eigen::MatrixXd energy = own_motions.transpose() * forces;
      ranks.sum(energy);
      ranks.sum(sizes);
      return motions * unresisted_combinations(energy, sizes(0, 0));
   };
   // A user's operator may contain elastic foundations.
   const bool grounded = !body.has_material();
   const Eigen::MatrixXd still = left_by(held + contact);
   require((grounded ? unresisted_of(still) : still).cols() == 0,
           "unsupported body: supports (", held, " dofs) and contact nodes (", line.size(),
           ") together leave rigid motions free, must leave none");
   const Eigen::MatrixXd possible = left_by(held), rigid = unresisted_of(possible);
   const auto &patterns = body.patterns();
   FreeMotions free;
   free.count = static_cast<int>(grounded ? rigid.cols() : possible.cols());
   free.contact = rigid.middleRows(held, contact);
   free.resultant = Eigen::MatrixXd::Zero(rigid.cols(), patterns.size());
   for (std::size_t p = 0; p < patterns.size(); ++p)
   {
      if (patterns[p].control != Control::force) { continue; }
      free.resultant.col(static_cast<Eigen::Index>(p)) =
         rigid.bottomRows(size).transpose() * patterns[p].values;
   }
   ranks.sum(free.resultant);
   return free;
}

} // namespace

Condensation condense_by_iterations(const ElasticBody &body, const ContactLine &line,
                                    const ContactDofs &dofs, int max_iterations,
                                    const BodySolver *alike)
{
   Condensation found;
   const std::vector<int> contact = dofs.free();
   found.free = free_motions_on_ranks(body, line);
   found.free.contact = found.free.contact(dofs.free_positions(), Eigen::all).eval();
   auto solver = std::make_shared<IteratedBodySolver>();
   solver->loads = body.patterns();
   solver->solver = std::make_shared<const DistributedSolver>(body, contact, max_iterations);
   const auto *other = dynamic_cast<const IteratedBodySolver *>(alike);
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

} // namespace cattaneo

#endif
