#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

LimitReport friction_limit(const LimitProblem &problem, double load_factor,
                           const LimitSettings &settings)
{
   ProgressReport progress(settings.monitor);
   check_limit(problem.reduced, problem.residual, settings);
   require(std::isfinite(load_factor), "shakedown: the load factor is not finite");
   const ReducedProblem &reduced = problem.reduced;
   const Eigen::Index n = reduced.nodes(), m = reduced.slips();
   const StuckForces loads = stuck_forces(reduced, problem.cycle);
   const Eigen::MatrixXd q = loads.q(load_factor), p = loads.p(load_factor);

   LimitReport report;
   report.coupling = problem.coupling;
   report.upper = report.limit = std::numeric_limits<double>::infinity();
   const auto finish = [&](LimitStatus status, const std::string &message)
   {
      report.status = unless_stopped(status, settings.monitor);
      report.message = message;
      report.seconds = progress.seconds();
      progress.end(1.0, report.iterations);
      return report;
   };
   if (q.isZero(0) && p.isZero(0))
   {
      report.limit = report.upper = 0;
      report.slip = Eigen::VectorXd::Zero(m);
      return finish(LimitStatus::certified, "there is no load: no friction is needed");
   }

   const Eigen::VectorXd force_scale = typical_forces(q, p);
   Eigen::MatrixXd weight = force_scale.replicate(1, loads.vertices());

   /// Largest |q| / p with slip v; infinite if a node has p ≤ 0. Takes v over if it is the
   /// best.
   const auto take = [&](const Eigen::VectorXd &v)
   {
      const auto [shear, least] =
         slipped_forces(reduced, loads, load_factor, v, Rounding::against);
      if (least.minCoeff() <= 0) { return; }
      const double worst = shear.cwiseQuotient(least).maxCoeff();
      if (worst < report.upper)
      {
         report.upper = report.limit = worst;
         report.slip = v;
         // Clearance per normal force makes Dinkelbach's iteration superlinear.
         weight = slipped_forces(reduced, loads, load_factor, v, Rounding::ignored)
                     .p.cwiseMax(1e-3 * force_scale.replicate(1, loads.vertices()));
      }
   };

   ConeStart start;
   start.r = Eigen::VectorXd::Zero(m);
   take(start.r);
   if (settings.start && settings.start->slip.size() == m)
   {
      take(settings.start->slip);
      start.r = reduced.A() * settings.start->slip;
   }

   constexpr int max_programmes = 40;
   constexpr double smallest_friction = 1e-7; // below it, counts as zero
   ConeSolution solution;
   int undecided = 0; // trials since one moved a bound
   double f =
      std::min(settings.largest_friction, report.upper * (1 - 0.5 * settings.tolerance));
   for (int k = 0; k < max_programmes && report.upper > smallest_friction; ++k)
   {
      ConeProgramme programme =
         clearance_programme(problem.residual, loads, load_factor,
                             Eigen::VectorXd::Constant(n, f), weight, force_scale);
      // Clearances are compared with f p.
      programme.theta_scale = f;
      solution = solve_counted(programme, settings, start, report, progress);
      if (solution.outcome == ConeOutcome::unavailable)
      {
         return finish(LimitStatus::unavailable, solution.message);
      }
      if (!usable(solution)) { return finish(LimitStatus::failed, solution.message); }
      const Eigen::VectorXd slip = problem.residual.flexibility * solution.r;
      CollapseMechanism mechanism = solution.mechanism;
      const double clearance =
         weak_duality_bound(programme, reduced, mechanism, slip_size(slip));
      const double before = report.upper;
      take(slip);
      if (clearance >= 0 && !(report.upper < before))
      {
         // A slip that friction f wedges without any load holds all loads when it is large.
         ConeProgramme wedge = programme;
         wedge.loads.q0.setZero();
         wedge.loads.p0.setZero();
         wedge.reach = 1e3;
         const ConeSolution wedged =
            solve_counted(wedge, settings, {0, Eigen::VectorXd::Zero(m), {}}, report, progress);
         for (double size = 1; size <= 1e9 && usable(wedged); size *= 10)
         {
            take(size * (problem.residual.flexibility * wedged.r));
         }
      }
      if (clearance < 0)
      {
         report.lower = f;
         report.mechanism = std::move(mechanism);
      }
      if (settings.monitor.stopped()) { break; }
      const double highest = std::min(settings.largest_friction, report.upper);
      if (highest - report.lower <= settings.tolerance * highest) { break; }
      const bool better = report.upper < before;
      if (better || clearance < 0) { undecided = 0; }
      else if (++undecided == 5) { break; }
      if (clearance < 0 || solution.outcome == ConeOutcome::ceiling || undecided > 0)
      {
         // Where so much friction wedges the contact, any residual state is held and there is
         // no best one. Halve the interval until there is one; where the solver does not say,
         // ask elsewhere in it.
         constexpr double share[] = {0.5, 0.5, 0.25, 0.75, 0.1};
         f = report.lower + share[undecided] * (highest - report.lower);
         start = {0, Eigen::VectorXd::Zero(m), {}};
         weight = force_scale.replicate(1, loads.vertices());
      }
      else
      {
         f = report.upper * (1 - 0.5 * settings.tolerance);
         start = {0, solution.r, solution.mechanism};
      }
   }
   if (report.upper <= smallest_friction)
   {
      return finish(LimitStatus::certified, "no friction is needed");
   }
   if (report.slip.size())
   {
      ConeProgramme programme =
         clearance_programme(problem.residual, loads, load_factor,
                             Eigen::VectorXd::Constant(n, report.upper), weight, force_scale);
      report.violation = worst_violation(programme, reduced, 0, report.slip);
   }
   if (report.lower >= settings.largest_friction)
   {
      return finish(LimitStatus::no_solution,
                    "no slip keeps the contact stuck and closed with any friction coefficient "
                    "searched (proven by the mechanism)");
   }
   if (!std::isfinite(report.upper))
   {
      return finish(LimitStatus::failed, "no admissible slip was found. " + solution.message);
   }
   if (report.upper - report.lower <= settings.tolerance * report.upper)
   {
      return finish(LimitStatus::certified, "");
   }
   return finish(LimitStatus::bracketed,
                 "the gap between the bounds is not closed. " + solution.message);
}

} // namespace cattaneo
