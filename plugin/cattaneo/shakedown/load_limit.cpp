#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/infinity.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cmath>
#include <cstdio>
#include <optional>

namespace cattaneo
{

namespace
{

/// Share of a node's typical force that rounding can change in a sum over all nodes.
constexpr double round_off = 1e-12;

constexpr const char *never_held =
   "no residual slip keeps the contact stuck and closed even under the "
   "constant loads alone (proven by the mechanism)";

/// The state furthest from all cones.
struct Clearance
{
   ConeSolution solution;
   Eigen::VectorXd slip;
   double reached = -infinity; ///< that the slip has for certain, in typical forces
   double bound = infinity;    ///< of all states, proven by the mechanism of the solution
};

/// A load factor and the slip with which the contact carries it; -infinity if no slip does.
struct Held
{
   double theta = -infinity;
   Eigen::VectorXd slip;
};

/** The largest load factor that is held for certain on the line from a solver's point, @a theta
    and @a slip, to @a inside at load factor 0. The line is also continued beyond the point. The
    solver's point lies inside only to a share of typical forces, and far beyond gross sliding
    round-off of the forces is more than that. The conditions are convex, so all of them gain on
    the way to a state that meets them with room to spare. */
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
   // The violation is convex along the line, so it is negative in one interval.
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

/// A search for the largest load factor.
class LoadLimit : private LimitSearch
{
public:
   LoadLimit(const ReducedProblem &reduced, const ResidualForces &residual,
             const StuckForces &loads, const LimitSettings &settings);
   LimitReport find();

private:
   LimitReport finish(LimitStatus status, const std::string &message);
   /// The largest clearance under the constant loads of a programme.
   Clearance largest_clearance(const ConeProgramme &constant);
   /// The report of an unlimited load. The slip `ray`, in proportion to the load factor, holds
   /// the varying loads however large they are, which is proven up to the load factor `proven`.
   LimitReport unlimited(const Eigen::VectorXd &ray, double proven, const std::string &message);
   /// Seeks a state that holds the constant loads: the stuck one, the one without their shear,
   /// or the one furthest from all cones. If there is none, returns the report that ends the
   /// search.
   std::optional<LimitReport> hold_constant_loads();
   void start_from_settings();
   /// The bounds that a solution of the programme proves.
   void take_bounds(ConeSolution &solution);
   void lower_the_upper(ConeMechanism mechanism);
   bool closed() const;
   /// Is there a slip, in proportion to the load, with which the contact carries every load,
   /// however large? Returns the report that ends the search if there is, or if the mechanism
   /// that was found makes both bounds meet.
   std::optional<LimitReport> try_ray();

   const bool nothing_constant_, nothing_varies_;
   const Eigen::VectorXd varying_scale_;
   ConeProgramme programme_; // whose largest θ is the limit
   // The limit with the varying loads alone. They may be so large that the strengths which do
   // not grow with p count for nothing, so these are left out.
   ConeProgramme alone_;
   double sliding_ = 0; // size of the load factor of gross sliding
   ConeStart start_;
   bool held_ = false;          // first_slip_ holds the constant loads, to round-off
   Eigen::VectorXd first_slip_; // the slip to begin with
};

LoadLimit::LoadLimit(const ReducedProblem &reduced, const ResidualForces &residual,
                     const StuckForces &loads, const LimitSettings &settings)
   : LimitSearch(reduced, residual, loads, settings),
     nothing_constant_(loads.q0.isZero(0) && loads.p0.isZero(0)),
     nothing_varies_(loads.q1.isZero(0) && loads.p1.isZero(0)),
     varying_scale_(typical_forces(loads.q1, loads.p1)),
     programme_(friction_cones(reduced, loads))
{
   programme_.residual = &residual;
   programme_.ceiling = settings.largest_factor;
   programme_.force_scale =
      nothing_constant_ ? varying_scale_ : typical_forces(loads.q0, loads.p0);
   // The load factor at which the varying loads exhaust the friction of the constant ones,
   // summed over the contact.
   const Eigen::VectorXd &f = reduced.friction;
   const double varying =
      std::max((f.asDiagonal() * loads.p1).cwiseAbs().colwise().sum().maxCoeff(),
               loads.q1.cwiseAbs().colwise().sum().maxCoeff());
   const Eigen::MatrixXd strength =
      programme_.bound(0, programme_.force_scale.replicate(1, programme_.friction.cols()));
   if (varying > 0) { programme_.theta_scale = strength.rowwise().minCoeff().sum() / varying; }
   sliding_ = programme_.theta_scale;
   alone_ = programme_;
   alone_.loads.q0 = programme_.loads.q1;
   alone_.loads.p0 = programme_.loads.p1;
   alone_.loads.q1.setZero();
   alone_.loads.p1.setZero();
   alone_.strength0.setZero();
   alone_.force_scale = varying_scale_;
   report_.upper = infinity;
}

LimitReport LoadLimit::finish(LimitStatus status, const std::string &message)
{
   report_.limit = report_.lower;
   return ended(status, message);
}

Clearance LoadLimit::largest_clearance(const ConeProgramme &constant)
{
   ConeProgramme programme = clearance_programme(
      constant, constant.force_scale.replicate(1, constant.loads.vertices()));
   programme.theta_scale = 1;
   Clearance largest;
   largest.solution = solve(programme, {0, no_slip_, {}});
   if (!usable(largest.solution)) { return largest; }
   largest.slip = residual_.flexibility * largest.solution.r;
   largest.reached = -worst_violation(programme, reduced_, 0, largest.slip, Rounding::against);
   largest.bound = weak_duality_bound(programme, reduced_, largest.solution.mechanism,
                                      slip_size(largest.slip));
   return largest;
}

LimitReport LoadLimit::unlimited(const Eigen::VectorXd &ray, double proven,
                                 const std::string &message)
{
   report_.ray = ray;
   report_.mechanism = {};
   report_.lower = infinity;
   finish(LimitStatus::unlimited, message);
   report_.lower = proven;
   return report_;
}

std::optional<LimitReport> LoadLimit::hold_constant_loads()
{
   const auto take = [&](const Eigen::VectorXd &slip, const Eigen::VectorXd &r)
   {
      const double violation = worst_violation(programme_, reduced_, 0, slip);
      if (start_.r.size() && !(violation < report_.violation)) { return; }
      report_.violation = violation;
      report_.slip = slip;
      start_.r = r;
   };
   take(no_slip_, no_slip_);
   if (report_.violation > -1e-3)
   {
      const Eigen::VectorXd relief = -(residual_.flexibility * loads_.q0.col(0));
      take(relief, reduced_.A() * relief);
      Clearance constant = largest_clearance(programme_);
      if (constant.solution.outcome == ConeOutcome::unavailable)
      {
         return finish(LimitStatus::unavailable, constant.solution.message);
      }
      if (constant.bound < 0)
      {
         report_.mechanism =
            constant.solution.mechanism.at_vertices(programme_, loads_.vertices());
         return finish(LimitStatus::no_solution, never_held);
      }
      if (constant.slip.size()) { take(constant.slip, constant.solution.r); }
   }
   // Nodes without force lie on the surface of their cones, to round-off.
   held_ = report_.violation <= round_off;
   first_slip_ = report_.slip;
   return std::nullopt;
}

void LoadLimit::start_from_settings()
{
   const auto *start = settings_.start;
   if (!start || start->slip.size() != reduced_.slips() || !std::isfinite(start->limit))
   {
      return;
   }
   start_.theta = start->limit;
   start_.r = reduced_.A() * start->slip;
   // With laws of several pieces the earlier mechanism is a sum over the pieces. Its parts are
   // not known, so the search starts without it.
   if (reduced_.laws.empty() && start->mechanism.slip.cols() == loads_.vertices())
   {
      const CollapseMechanism &known = start->mechanism;
      start_.mechanism = {known.slip, known.opening.cwiseQuotient(programme_.friction)};
   }
}

void LoadLimit::take_bounds(ConeSolution &solution)
{
   const Eigen::VectorXd slip = residual_.flexibility * solution.r;
   const Held best =
      largest_held(programme_, reduced_, solution.theta, slip, held_ ? first_slip_ : slip);
   if (best.theta > report_.lower)
   {
      report_.lower = best.theta;
      report_.slip = best.slip;
      report_.violation = worst_violation(programme_, reduced_, best.theta, best.slip);
   }
   lower_the_upper(std::move(solution.mechanism));
}

void LoadLimit::lower_the_upper(ConeMechanism mechanism)
{
   const double bound =
      weak_duality_bound(programme_, reduced_, mechanism, slip_size(report_.slip));
   if (!(bound < report_.upper)) { return; }
   report_.upper = bound;
   report_.mechanism = mechanism.at_vertices(programme_, loads_.vertices());
}

bool LoadLimit::closed() const
{
   // Relative to a limit, or to a ten-thousandth of gross sliding if that is more.
   const double gap = settings_.tolerance * (report_.upper + 1e-4 * sliding_);
   return std::isfinite(report_.upper) && report_.upper - report_.lower <= gap;
}

std::optional<LimitReport> LoadLimit::try_ray()
{
   Clearance ray = largest_clearance(alone_);
   if (held_ && ray.reached > 0)
   {
      report_.slip = first_slip_;
      return unlimited(ray.slip, infinity,
                       "there is no upper limit: for any load factor a residual slip in "
                       "proportion to it keeps the contact stuck (proven)");
   }
   lower_the_upper(std::move(ray.solution.mechanism));
   if (closed()) { return finish(LimitStatus::certified, ""); }
   const Eigen::VectorXd relief = -(residual_.flexibility * loads_.q1.rowwise().mean());
   const double relieved = -worst_violation(alone_, reduced_, 0, relief, Rounding::against);
   if (!(ray.reached > relieved))
   {
      ray.slip = relief;
      ray.reached = relieved;
   }
   if (!held_ || std::isfinite(report_.upper) || !(ray.reached > -1e-9))
   {
      return std::nullopt;
   }
   // The slip holds any load only to round-off. Find the load factor up to which it does.
   const auto holds = [&](double factor)
   {
      return worst_violation(programme_, reduced_, factor, first_slip_ + factor * ray.slip,
                             Rounding::in_favour) <= round_off;
   };
   double factor = 1e12 * sliding_;
   while (factor > 1e3 * sliding_ && !holds(factor)) { factor /= 10; }
   if (!holds(factor)) { return std::nullopt; }
   report_.slip = first_slip_;
   char text[150];
   std::snprintf(text, sizeof text,
                 "within round-off there is no upper limit: a residual slip in proportion to "
                 "the load factor keeps the contact stuck; proven up to "
                 "%.0e",
                 factor);
   return unlimited(ray.slip, factor, text);
}

LimitReport LoadLimit::find()
{
   for (Eigen::Index i = 0; i < reduced_.nodes(); ++i)
   {
      require(reduced_.friction[i] > 0, "shakedown: friction coefficient ",
              reduced_.friction[i], " at node ", i,
              ", must be positive: a node without friction never sticks");
   }
   if (nothing_constant_ && nothing_varies_)
   {
      report_.slip = no_slip_;
      return unlimited(no_slip_, infinity, "there is no load");
   }
   if (const auto end = hold_constant_loads()) { return *end; }
   if (held_ && (nothing_varies_ || worst_violation(alone_, reduced_, 0, no_slip_) <= 0))
   {
      return unlimited(no_slip_, infinity,
                       nothing_varies_ ? "no load varies, so there is nothing to limit"
                                       : "every varying load adds more friction than shear");
   }
   start_from_settings();
   report_.lower = held_ ? 0 : -infinity;
   std::string message;
   constexpr int max_ceilings = 3;
   for (int k = 0; k < max_ceilings; ++k)
   {
      ConeSolution solution = solve(programme_, start_);
      if (solution.outcome == ConeOutcome::unavailable)
      {
         return finish(LimitStatus::unavailable, solution.message);
      }
      message = solution.message;
      if (usable(solution)) { take_bounds(solution); }
      if (closed()) { return finish(LimitStatus::certified, ""); }
      if (k == 0)
      {
         if (const auto end = try_ray()) { return *end; }
      }
      if (solution.outcome != ConeOutcome::ceiling || settings_.monitor.stopped()) { break; }
      programme_.theta_scale *= programme_.ceiling;
      programme_.reach *= programme_.ceiling;
   }
   if (!std::isfinite(report_.lower))
   {
      report_.lower = 0;
      // A limit below zero: not even the constant loads are held.
      if (report_.upper < 0)
      {
         report_.upper = infinity;
         return finish(LimitStatus::no_solution, never_held);
      }
      return finish(LimitStatus::failed, "no admissible slip was found" + because(message));
   }
   return finish(LimitStatus::bracketed, not_closed(message));
}

} // namespace

LimitReport load_limit(const LimitProblem &problem, const LimitSettings &settings)
{
   const StuckForces stuck = stuck_forces(problem.reduced, problem.cycle);
   LimitReport report = load_limit(problem.reduced, problem.residual, stuck, settings);
   report.coupling = problem.coupling;
   report.coupled = !problem.residual.uncoupled;
   if (report.status == LimitStatus::unlimited)
   {
      report.starts = report.coupled
                         ? "coupled: under any load some start shakes down, but not "
                           "every start has to"
                         : "uncoupled: every start shakes down under any load";
   }
   if (!report.proven()) { return report; }
   report.of_the_mesh = mesh_statement(problem.reduced, stuck, report, report.limit, false);
   // The lower limit costs nothing if it is the upper limit itself, or if the contact has only
   // two nodes.
   const bool free =
      !report.coupled || (problem.reduced.nodes() == 2 && problem.reduced.components() == 1);
   if (free || settings.every_start)
   {
      const LowerLimitReport lower = lower_limit(problem, report, settings);
      report.counters += lower.counters;
      tell_starts(report, lower);
      return report;
   }
   tell_starts(report, {});
   return report;
}

LimitReport load_limit(const ReducedProblem &reduced, const ResidualForces &residual,
                       const StuckForces &loads, const LimitSettings &settings)
{
   return LoadLimit(reduced, residual, loads, settings).find();
}

} // namespace cattaneo
