#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cmath>
#include <cstdio>
#include <limits>

namespace cattaneo
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Share of a node's typical force that rounding can change in a sum over all nodes.
constexpr double round_off = 1e-12;

/// The state furthest from all cones.
struct Clearance
{
   ConeSolution solution;
   Eigen::VectorXd slip;
   double reached = -infinity; ///< by the slip for certain, in typical forces
   double bound = infinity;    ///< of all states, proven by the mechanism of the solution
};

Clearance largest_clearance(const ReducedProblem &reduced, const ResidualForces &residual,
                            const StuckForces &loads, const Eigen::VectorXd &force_scale,
                            const LimitSettings &settings, LimitReport &report,
                            ProgressReport &progress)
{
   const ConeProgramme programme =
      clearance_programme(residual, loads, 0, reduced.friction,
                          force_scale.replicate(1, loads.vertices()), force_scale);
   ConeStart stuck;
   stuck.r = Eigen::VectorXd::Zero(loads.q0.rows());
   Clearance largest;
   largest.solution = solve_counted(programme, settings, stuck, report, progress);
   if (!usable(largest.solution)) { return largest; }
   largest.slip = residual.flexibility * largest.solution.r;
   largest.reached = -worst_violation(programme, reduced, 0, largest.slip, Rounding::against);
   largest.bound = weak_duality_bound(programme, reduced, largest.solution.mechanism,
                                      slip_size(largest.slip));
   return largest;
}

/// A load factor and the slip that holds it; -infinity if none does.
struct Held
{
   double theta = -infinity;
   Eigen::VectorXd slip;
};

/** The largest load factor that is held for certain on the way from a solver's point, @a theta
    and @a slip, to @a inside at load factor 0, or on the way continued beyond the point. A
   point is found to lie inside to a share of typical forces only, and far beyond gross sliding
   the round-off of the forces is more than that; as the conditions are convex, all of them gain
   on the way to a state that meets them with room to spare. */
Held largest_held(const ConeProgramme &programme, const ReducedProblem &problem, double theta,
                  const Eigen::VectorXd &slip, const Eigen::VectorXd &inside)
{
   const auto at = [&](double share) {
      return Held{(1 - share) * theta, slip + share * (inside - slip)};
   };
   const auto admissible = [&](double share)
   {
      const Held state = at(share);
      return worst_violation(programme, problem, state.theta, state.slip, Rounding::against) <=
             0;
   };
   // The violation is convex along the way: where it is negative is one interval.
   constexpr double unit = 1e-12, furthest = 1e3;
   double good = 0, bad = 0, step = unit;
   if (admissible(0))
   {
      while (step < furthest && admissible(bad = -step))
      {
         good = bad;
         step *= 4;
      }
   }
   else
   {
      while (!admissible(good = step))
      {
         bad = good;
         step *= 4;
         if (step >= 1) { return {}; }
      }
   }
   while (good - bad > unit)
   {
      const double middle = 0.5 * (good + bad);
      (admissible(middle) ? good : bad) = middle;
   }
   return at(good);
}

} // namespace

LimitReport load_limit(const LimitProblem &problem, const LimitSettings &settings)
{
   LimitReport report = load_limit(problem.reduced, problem.residual,
                                   stuck_forces(problem.reduced, problem.cycle), settings);
   report.coupling = problem.coupling;
   return report;
}

LimitReport load_limit(const ReducedProblem &reduced, const ResidualForces &residual,
                       const StuckForces &loads, const LimitSettings &settings)
{
   ProgressReport progress(settings.monitor);
   check_limit(reduced, residual, settings);
   const Eigen::Index n = reduced.nodes(), m = reduced.slips();
   for (Eigen::Index i = 0; i < n; ++i)
   {
      require(reduced.friction[i] > 0, "shakedown: friction coefficient ", reduced.friction[i],
              " at node ", i, ", must be positive: a node without friction never sticks");
   }

   LimitReport report;
   report.upper = infinity;
   const auto finish = [&](LimitStatus status, const std::string &message)
   {
      report.status = unless_stopped(status, settings.monitor);
      report.message = message;
      report.limit = report.lower;
      report.seconds = progress.seconds();
      progress.end(1.0, report.iterations);
      return report;
   };

   ConeProgramme programme;
   programme.residual = &residual;
   programme.friction = reduced.friction;
   programme.loads = loads;
   programme.ceiling = settings.largest_factor;
   const bool nothing_constant = loads.q0.isZero(0) && loads.p0.isZero(0);
   const bool nothing_varies = loads.q1.isZero(0) && loads.p1.isZero(0);
   if (nothing_constant && nothing_varies)
   {
      report.lower = infinity;
      report.slip = report.ray = Eigen::VectorXd::Zero(m);
      return finish(LimitStatus::unlimited, "there is no load");
   }
   const Eigen::VectorXd varying_scale = typical_forces(loads.q1, loads.p1);
   programme.force_scale =
      nothing_constant ? varying_scale : typical_forces(loads.q0, loads.p0);
   // The load factor at which the varying loads exhaust the friction of the constant ones,
   // summed over the contact: the size of gross sliding.
   const Eigen::VectorXd &f = programme.friction;
   const double varying =
      std::max((f.asDiagonal() * loads.p1).cwiseAbs().colwise().sum().maxCoeff(),
               loads.q1.cwiseAbs().colwise().sum().maxCoeff());
   if (varying > 0) { programme.theta_scale = f.dot(programme.force_scale) / varying; }

   // First a state under the constant loads: the stuck one, the one without their shear, or the
   // one furthest from all cones.
   ConeStart start;
   const auto take = [&](const Eigen::VectorXd &slip, const Eigen::VectorXd &r)
   {
      const double violation = worst_violation(programme, reduced, 0, slip);
      if (start.r.size() && !(violation < report.violation)) { return; }
      report.violation = violation;
      report.slip = slip;
      start.r = r;
   };
   const Eigen::VectorXd no_slip = Eigen::VectorXd::Zero(m);
   take(no_slip, no_slip);
   if (report.violation > -1e-3)
   {
      const Eigen::VectorXd relief = -(residual.flexibility * loads.q0.col(0));
      take(relief, reduced.A() * relief);
      Clearance constant = largest_clearance(reduced, residual, loads, programme.force_scale,
                                             settings, report, progress);
      if (constant.solution.outcome == ConeOutcome::unavailable)
      {
         return finish(LimitStatus::unavailable, constant.solution.message);
      }
      if (constant.bound < 0)
      {
         report.mechanism = std::move(constant.solution.mechanism);
         return finish(LimitStatus::no_solution,
                       "no slip keeps the contact stuck and closed under the constant loads "
                       "alone (proven by the mechanism)");
      }
      if (constant.slip.size()) { take(constant.slip, constant.solution.r); }
   }
   // Forces that touch their cones, as where there are none, do so to round-off.
   const bool held = report.violation <= round_off;

   // A slip in proportion to the load factor that holds the varying loads by itself holds them
   // however large they are.
   const auto unlimited =
      [&](const Eigen::VectorXd &ray, double proven, const std::string &message)
   {
      report.ray = ray;
      report.mechanism = {};
      report.lower = infinity;
      finish(LimitStatus::unlimited, message);
      report.lower = proven;
      return report;
   };
   ConeProgramme alone = programme; // the varying loads
   alone.loads = {loads.q1, 0 * loads.q1, loads.p1, 0 * loads.p1};
   alone.force_scale = varying_scale;
   if (held && (nothing_varies || worst_violation(alone, reduced, 0, no_slip) <= 0))
   {
      return unlimited(no_slip, infinity,
                       nothing_varies ? "no load varies: there is nothing to limit"
                                      : "every varying load presses more than it shears");
   }

   if (settings.start && settings.start->slip.size() == m &&
       std::isfinite(settings.start->limit))
   {
      start.theta = settings.start->limit;
      start.r = reduced.A() * settings.start->slip;
      if (settings.start->mechanism.slip.cols() == loads.vertices())
      {
         start.mechanism = settings.start->mechanism;
      }
   }
   const Eigen::VectorXd first_slip = report.slip;
   const double sliding = programme.theta_scale;
   const auto lower_the_upper = [&](CollapseMechanism mechanism)
   {
      const double bound =
         weak_duality_bound(programme, reduced, mechanism, slip_size(report.slip));
      if (!(bound < report.upper)) { return; }
      report.upper = bound;
      report.mechanism = std::move(mechanism);
   };
   const auto closed = [&]
   {
      // Relative to a limit, or to a ten-thousandth of gross sliding if that is more.
      const double gap = settings.tolerance * (report.upper + 1e-4 * sliding);
      return std::isfinite(report.upper) && report.upper - report.lower <= gap;
   };
   report.lower = held ? 0 : -infinity;
   std::string message;
   constexpr int max_ceilings = 3;
   for (int k = 0; k < max_ceilings; ++k)
   {
      ConeSolution solution = solve_counted(programme, settings, start, report, progress);
      if (solution.outcome == ConeOutcome::unavailable)
      {
         return finish(LimitStatus::unavailable, solution.message);
      }
      message = solution.message;
      if (usable(solution))
      {
         const Eigen::VectorXd slip = residual.flexibility * solution.r;
         const Held best =
            largest_held(programme, reduced, solution.theta, slip, held ? first_slip : slip);
         if (best.theta > report.lower)
         {
            report.lower = best.theta;
            report.slip = best.slip;
            report.violation = worst_violation(programme, reduced, best.theta, best.slip);
         }
         lower_the_upper(std::move(solution.mechanism));
      }
      if (closed()) { return finish(LimitStatus::certified, ""); }
      if (k == 0)
      {
         Clearance ray = largest_clearance(reduced, residual, alone.loads, varying_scale,
                                           settings, report, progress);
         if (held && ray.reached > 0)
         {
            report.slip = first_slip;
            return unlimited(ray.slip, infinity,
                             "a slip in proportion to the load holds any load (proven)");
         }
         lower_the_upper(std::move(ray.solution.mechanism));
         if (closed()) { return finish(LimitStatus::certified, ""); }
         const Eigen::VectorXd relief = -(residual.flexibility * loads.q1.rowwise().mean());
         const double relieved = -worst_violation(alone, reduced, 0, relief, Rounding::against);
         if (!(ray.reached > relieved))
         {
            ray.slip = relief;
            ray.reached = relieved;
         }
         if (held && !std::isfinite(report.upper) && ray.reached > -1e-9)
         {
            // It does so to round-off: up to which load factor?
            const auto holds = [&](double factor)
            {
               return worst_violation(programme, reduced, factor,
                                      first_slip + factor * ray.slip) <= round_off;
            };
            double factor = 1e12 * sliding;
            while (factor > 1e3 * sliding && !holds(factor)) { factor /= 10; }
            if (holds(factor))
            {
               report.slip = first_slip;
               char text[150];
               std::snprintf(text, sizeof text,
                             "a slip in proportion to the load holds any load to round-off; "
                             "proven up to %.0e",
                             factor);
               return unlimited(ray.slip, factor, text);
            }
         }
      }
      if (solution.outcome != ConeOutcome::ceiling || settings.monitor.stopped()) { break; }
      programme.theta_scale *= programme.ceiling;
      programme.reach *= programme.ceiling;
   }
   if (!std::isfinite(report.lower))
   {
      report.lower = 0;
      return finish(LimitStatus::failed, "no admissible slip was found. " + message);
   }
   return finish(LimitStatus::bracketed,
                 "the gap between the bounds is not closed. " + message);
}

} // namespace cattaneo
