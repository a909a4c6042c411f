#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/contact/applied_reduction.hpp>
#include <cattaneo/contact/distributed_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>

namespace cattaneo
{

#ifdef MFEM_USE_MPI

namespace
{

AppliedProblem distributed(const ElasticBody &body, const ContactLine &line,
                           const ScalarField &gap, const CondenseSettings &settings,
                           Counters *counters)
{
   const ContactDofs contact = contact_dofs(body, line);
   require(contact.held.empty(), "apply reduction: ", contact.held.size(),
           " components of contact nodes are fixed, none may be of a stiffness that is not "
           "formed (CondenseSettings::formed_nodes)");
   const auto solver =
      std::make_shared<const DistributedSolver>(body, contact.all, settings.max_iterations);
   const Equilibrium equilibrium(free_motions_by_places(body, line));
   const FrameChange frames = FrameChange::of(line, body.formulation());
   Counters own;
   Eigen::MatrixXd forces = solver->loads(body.patterns(), own).forces;
   if (counters) { *counters += own; }
   equilibrium.impose_on_forces(forces);
   forces = frames.rows(forces);

   AppliedProblem result;
   const Eigen::Index n = line.size();
   for (std::size_t k = 0; k < body.patterns().size(); ++k)
   {
      const auto &pattern = body.patterns()[k];
      const auto force = forces.col(static_cast<Eigen::Index>(k));
      result.patterns.push_back({pattern.name, pattern.control, force.head(n), force.tail(n)});
   }
   result.friction = Eigen::VectorXd::Zero(n);
   result.gap.resize(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      result.gap[i] = gap(line.position(i, 0), line.position(i, 1));
   }
   // Of the diagonal blocks of the stiffness, without their off-diagonal entries.
   const Eigen::VectorXd d = solver->diagonal();
   result.diagonal.resize(2 * n);
   result.diagonal << frames.a.cwiseAbs2().cwiseProduct(d.head(n)) +
                         frames.b.cwiseAbs2().cwiseProduct(d.tail(n)),
      frames.c.cwiseAbs2().cwiseProduct(d.head(n)) +
         frames.d.cwiseAbs2().cwiseProduct(d.tail(n));
   const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(solver->size());
   result.apply = [=](const Eigen::VectorXd &u) -> Eigen::VectorXd
   {
      Counters here;
      const Eigen::VectorXd x = equilibrium.without_motions(frames.transposed().rows(u).col(0));
      const Eigen::VectorXd field = solver->recover(x, nothing, nothing, here);
      if (counters) { *counters += here; }
      return frames.rows(equilibrium.without_motions(solver->forces(field))).col(0);
   };
   return result;
}

} // namespace

#endif

AppliedProblem apply_reduction(const ElasticBody &body, const ContactLine &line,
                               const ScalarField &gap, const CondenseSettings &settings,
                               Counters *counters)
{
   settings.validate();
   require(body.formulation() != Formulation::torsion,
           "apply reduction: the body is one of torsion, must be plane or axisymmetric");
#ifdef MFEM_USE_MPI
   if (body.ranks().distributed() && body.dofs() > settings.direct_dofs &&
       line.size() > settings.formed_nodes)
   {
      AppliedProblem result = distributed(body, line, gap, settings, counters);
      result.validate();
      return result;
   }
#endif
   Reduction reduction = reduce(condense(body, line, settings), gap);
   if (counters) { *counters += reduction.counters; }
   AppliedProblem result = applied(reduction.problem);
   result.formed = std::make_shared<const ReducedProblem>(std::move(reduction.problem));
   return result;
}

} // namespace cattaneo
