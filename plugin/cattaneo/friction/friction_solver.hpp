#pragma once

#include <cattaneo/counters.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <memory>

namespace cattaneo
{

struct FrictionSystem;

/// Outcome of a friction solve or a march. All statuses but the first are properties of the
/// problem, or a failure of the solver. None is an exception.
enum class FrictionStatus
{
   converged,
   gross_sliding, ///< a body slides (or rolls, or spins) away: no equilibrium beyond the
                  ///< reported load
   not_unique,    ///< solved, but friction is above its critical value at the named node
   no_solution,   ///< no equilibrium was found, with friction above critical or the body lifted
                  ///< off
   stalled,       ///< no method reached the tolerance: residuals in the report
   stopped        ///< a march was asked to stop (Monitor::stop)
};

/// As it is printed, in words.
const char *name(FrictionStatus status);

/// How an increment is solved.
enum class FrictionMethod
{
   automatic, ///< One method after the other, as docs/increments.md tells. With one tangential
              ///< component or none: Newton's steps on node states after a few Gauss–Seidel
              ///< sweeps, Lemke's method, weak springs on the rigid motions of free bodies, and
              ///< Lemke's method from random places. With two: Newton's steps, the same for
              ///< parts of the loads, weak springs, a path along which friction grows, and
              ///< damped Newton from several starts, also random ones. At last free bodies may
              ///< stay where springs hold them without force.
   gauss_seidel ///< node by node only (thesis 3.5, appendix D)
};

/// The defaults need no tuning.
struct FrictionSettings
{
   FrictionMethod method = FrictionMethod::automatic; ///< the other one is for comparison
   /// Largest violation of an equation or a law, over the largest nodal force so far (of the
   /// loads with the contact clamped, of the contact, of initial slip or interference). If
   /// round-off is larger than this, round-off is the tolerance, which the report tells.
   double tolerance = 1e-12;
   /// Gauss–Seidel sweeps before Newton's steps, with one tangential component or none.
   int sweeps = 2;
   int max_newton = 60;      ///< Newton's steps of one attempt
   long max_sweeps = 100000; ///< sweeps of the pure Gauss–Seidel method

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// The result of an increment.
struct IncrementReport
{
   /// A solution was found if converged or not_unique
   FrictionStatus status = FrictionStatus::stalled;
   std::string message; ///< empty if converged; docs/increments.md says where each comes from
   /// If a solution was found: its largest violation of the given equations and of the laws,
   /// over the largest force so far, computed in double precision. The true one is larger by
   /// the round-off at most. If none was found no state is returned. If the message names these
   /// numbers, they are then residuals of the natural map where the sweeps ended, or at the
   /// start without sweeps. Otherwise they mean nothing.
   double residual_normal = 0;     ///< of normal displacements and forces
   double residual_tangential = 0; ///< of slip and friction forces
   double round_off = 0; ///< estimate of the smallest residual that round-off allows, relative
   const char *found_by = ""; ///< the method that found the solution, if one was found
};

/** Solves increments of the frictional contact of a reduced problem: given the state at the
   start of an increment and the loads at its end, finds the state at its end (thesis 3.5
   and 3.6).

    With two tangential components per node the friction force is a vector in the disc
    |q| <= f p, opposed to the slip increment.

    If there are several solutions, the one found need not be the nearest to the state at the
    start, and a jump of a body to it is not reported.

    The rate is replaced by the difference over the increment. Nothing is remembered between
    increments but factors of matrices, which depend on the set of node states only: the same
   state and loads give the same bits, whatever was solved before. */
class FrictionSolver
{
public:
   /// Validates both. The problem is copied. If friction is zero at all nodes, the tangential
   /// unknowns are eliminated here, for all increments.
   FrictionSolver(const ReducedProblem &problem, const FrictionSettings &settings = {});
   /// The same with a problem that is shared and not copied, as a stiffness of thousands of
   /// nodes fills memory. It must not be changed.
   FrictionSolver(std::shared_ptr<const ReducedProblem> problem,
                  const FrictionSettings &settings = {});
   ~FrictionSolver();
   /// Solvers can be moved, not copied.
   FrictionSolver(FrictionSolver &&) noexcept;

   /// Advances `state` to the loads `multipliers`. Unless a solution is found (converged,
   /// not_unique) the state stays as it was. InputError if the state does not fit the problem
   /// (ContactState::validate), or if a multiplier is missing or not finite.
   IncrementReport solve(ContactState &state, const Eigen::VectorXd &multipliers);

   /// The problem, with the present gap.
   const ReducedProblem &problem() const;
   /// As they were given.
   const FrictionSettings &settings() const;
   /// Sets another initial gap of each node, size n, from the next increment on, for instance
   /// if wear opens the gap between two increments. InputError for another size or an entry
   /// that is not finite.
   void set_gap(const Eigen::VectorXd &gap);
   /// Is friction zero at all nodes?
   bool frictionless() const;
   /// Is `after` the end of an increment from `before`, by the equations and the laws as they
   /// are given, however it was found? The answer is converged, or not_unique if a closed node
   /// has friction above its critical value (see CriticalFriction), both with residuals;
   /// otherwise stalled, with the violation. `slip_error` has the error of each slip between
   /// them, a length >= 0 for each tangential displacement, for instance if the closed nodes
   /// hardly hold a body. A shorter slip need not oppose its friction. Empty: the error is
   /// round-off. InputError as solve(), and for another size.
   IncrementReport judge(const ContactState &before, const ContactState &after,
                         const Eigen::VectorXd &slip_error = {});
   /// Counts of all operations since the solver was made.
   const Counters &counters() const;

private:
   std::shared_ptr<ReducedProblem> copy_; ///< none if it is shared
   std::unique_ptr<FrictionSystem> system_;
};

} // namespace cattaneo
