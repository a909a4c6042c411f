#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/friction/status.hpp>
#include <cattaneo/reduced/applied_problem.hpp>

namespace cattaneo
{

/// Where S was formed FrictionSolver works to its own, tighter tolerance, and these have no
/// say.
struct AppliedSettings
{
   /// Largest residual over the largest nodal force so far (FrictionSettings). What applies the
   /// stiffness must be more accurate than that.
   double tolerance = 1e-9;
   int max_newton = 60;      ///< active sets tried
   int max_iterations = 500; ///< of GMRES for one of them

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

struct AppliedReport
{
   FrictionStatus status = FrictionStatus::stalled; ///< converged or stalled, if applied
   std::string message;                             ///< empty if converged
   double residual = 0;   ///< relative, as the tolerance: normal and tangential together
   long newton_steps = 0; ///< active sets solved for
   long applications = 0; ///< of the stiffness
};

/** One increment of plane Coulomb contact with a stiffness that is applied, never formed: a
    Newton–Krylov active set. The states of the nodes stand for linear equations (q = p = 0 at
   open nodes, q ± f p = 0 at slipping ones), which GMRES solves for the displacements of these
   nodes, scaled by the diagonal; what comes out asks for states, until they stay.

    Where the problem brings S formed, FrictionSolver does it instead: it is faster, and helps
   itself where active sets cycle; here the increment is then to be cut. Critical friction and
   gross sliding are not told apart from that: the status is then `stalled`. Unless converged,
   the state is left as it was. */
AppliedReport solve(const AppliedProblem &problem, ContactState &state,
                    const Eigen::VectorXd &multipliers, const AppliedSettings &settings = {});

/// No slip, and all nodes without a gap in stick, before any load.
ContactState virgin(const AppliedProblem &problem);

} // namespace cattaneo
