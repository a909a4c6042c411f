#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/infinity.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

constexpr double smallest_friction = 1e-7; // below it, counts as zero

/// A search for the smallest friction.
class FrictionLimit : private LimitSearch
{
public:
   FrictionLimit(const LimitProblem &problem, double load_factor, const LimitSettings &settings)
      : LimitSearch(problem.reduced, problem.residual,
                    stuck_forces(problem.reduced, problem.cycle), settings),
        load_factor_(load_factor), q_(loads_.q(load_factor)), p_(loads_.p(load_factor)),
        force_scale_(typical_forces(q_, p_))
   {
      report_.coupling = problem.coupling;
      report_.upper = report_.limit = infinity;
   }
   LimitReport find();

private:
   /// The result of a trial coefficient of friction.
   struct Trial
   {
      ConeSolution solution;
      bool better = false;   ///< a slip was found that less friction holds than any before
      bool excluded = false; ///< no slip suffices with this friction (proven)
   };

   void forget_best();
   void take(const Eigen::VectorXd &slip);
   void start_from_settings();
   void take_wedged(ConeProgramme programme);
   Trial attempt(double friction);
   bool closed() const;
   double next_friction(const Trial &trial, double last);
   LimitReport conclude(const std::string &message);

   ConeProgramme clearance(double friction) const
   {
      ConeProgramme programme;
      programme.residual = &residual_;
      programme.friction.setConstant(p_.rows(), p_.cols(), friction);
      programme.loads = {q_, Eigen::MatrixXd::Zero(q_.rows(), q_.cols()), p_,
                         Eigen::MatrixXd::Zero(p_.rows(), p_.cols())};
      programme.force_scale = force_scale_;
      return clearance_programme(std::move(programme), weight_);
   }
   double highest() const { return std::min(settings_.largest_friction, report_.upper); }

   const double load_factor_;
   const Eigen::MatrixXd q_, p_; // of the loads at that factor
   const Eigen::VectorXd force_scale_;
   Eigen::MatrixXd weight_; // of the clearances
   ConeStart start_;
   int undecided_ = 0; // trials since one moved a bound
};

/// Starts again from the stuck state, with typical forces as weights.
void FrictionLimit::forget_best()
{
   start_ = {0, no_slip_, {}};
   weight_ = force_scale_.replicate(1, loads_.vertices());
}

/// Keeps a slip if it needs less friction than the best one so far. It needs its largest |q| /
/// p, if all nodes are pressed. Round-off counts against it, so that the bound is proven.
void FrictionLimit::take(const Eigen::VectorXd &slip)
{
   const SlippedForces at =
      slipped_forces(reduced_, loads_, load_factor_, slip, Rounding::against);
   const Eigen::Index n = reduced_.nodes();
   const Eigen::MatrixXd shear =
                            tangential_lengths(at.q, n) + tangential_lengths(at.q_error, n),
                         least = at.p - at.p_error;
   if (least.minCoeff() <= 0) { return; }
   const double worst = shear.cwiseQuotient(least).maxCoeff();
   if (!(worst < report_.upper)) { return; }
   report_.upper = report_.limit = worst;
   report_.slip = slip;
   // Clearance per normal force makes Dinkelbach's iteration superlinear.
   weight_ = slipped_forces(reduced_, loads_, load_factor_, slip, Rounding::ignored)
                .p.cwiseMax(1e-3 * force_scale_.replicate(1, loads_.vertices()));
}

void FrictionLimit::start_from_settings()
{
   if (!settings_.start || settings_.start->slip.size() != no_slip_.size()) { return; }
   take(settings_.start->slip);
   start_.r = reduced_.A() * settings_.start->slip;
}

/// If friction can wedge the contact without any load, a large multiple of that slip holds all
/// loads. Tries multiples until they no longer improve the bound.
void FrictionLimit::take_wedged(ConeProgramme programme)
{
   programme.loads.q0.setZero();
   programme.loads.p0.setZero();
   programme.reach = 1e3;
   const ConeSolution wedged = solve(programme, {0, no_slip_, {}});
   for (double size = 1; size <= 1e9 && usable(wedged); size *= 10)
   {
      take(size * (residual_.flexibility * wedged.r));
   }
}

FrictionLimit::Trial FrictionLimit::attempt(double friction)
{
   ConeProgramme programme = clearance(friction);
   programme.theta_scale = friction; // clearances are compared with f p
   Trial trial{solve(programme, start_)};
   if (!usable(trial.solution)) { return trial; }
   const Eigen::VectorXd slip = residual_.flexibility * trial.solution.r;
   ConeMechanism mechanism = trial.solution.mechanism;
   // Weak duality bounds the clearance from above. A negative bound proves that no slip
   // suffices with this friction. There is none where a state with positive clearance is known.
   const double bound =
      trial.solution.theta > 0
         ? infinity
         : weak_duality_bound(programme, reduced_, mechanism, slip_size(slip));
   const double before = report_.upper;
   take(slip);
   trial.excluded = bound < 0;
   if (bound >= 0 && !(report_.upper < before)) { take_wedged(programme); }
   trial.better = report_.upper < before;
   if (trial.excluded)
   {
      report_.lower = friction;
      report_.mechanism = mechanism.at_vertices(programme, loads_.vertices());
   }
   return trial;
}

bool FrictionLimit::closed() const
{
   return highest() - report_.lower <= settings_.tolerance * highest();
}

/// The friction of the next trial, after one with `last`.
double FrictionLimit::next_friction(const Trial &trial, double last)
{
   if (trial.excluded || trial.solution.outcome == ConeOutcome::ceiling || undecided_ > 0)
   {
      // With enough friction to wedge the contact any residual state is held, and there is no
      // best one. The interval is halved until there is one. If the solver gives no answer,
      // other places in the interval are tried.
      constexpr double share[] = {0.5, 0.5, 0.25, 0.75, 0.1};
      forget_best();
      const auto place = [&]
      { return report_.lower + share[undecided_] * (highest() - report_.lower); };
      // The middle was tried already, if the last trial was there.
      if (undecided_ == 1 && place() == last) { ++undecided_; }
      return place();
   }
   start_ = {0, trial.solution.r, trial.solution.mechanism};
   // Dinkelbach's step: the friction that the best slip needs, a little less, so that the next
   // trial either improves or excludes it.
   return report_.upper * (1 - 0.5 * settings_.tolerance);
}

LimitReport FrictionLimit::conclude(const std::string &message)
{
   if (report_.upper <= smallest_friction)
   {
      return ended(LimitStatus::certified, "no friction is needed");
   }
   if (report_.slip.size())
   {
      report_.violation = worst_violation(clearance(report_.upper), reduced_, 0, report_.slip);
   }
   if (report_.lower >= settings_.largest_friction)
   {
      return ended(LimitStatus::no_solution, "no residual slip keeps the contact stuck and "
                                             "closed with any friction coefficient in the "
                                             "searched range (proven by the mechanism)");
   }
   if (!std::isfinite(report_.upper))
   {
      return ended(LimitStatus::failed, "no admissible slip was found" + because(message));
   }
   if (report_.upper - report_.lower <= settings_.tolerance * report_.upper)
   {
      return ended(LimitStatus::certified, "");
   }
   return ended(LimitStatus::bracketed, not_closed(message));
}

LimitReport FrictionLimit::find()
{
   if (q_.isZero(0) && p_.isZero(0))
   {
      report_.limit = report_.upper = 0;
      report_.slip = no_slip_;
      return ended(LimitStatus::certified, "there is no load: no friction is needed");
   }
   forget_best();
   take(no_slip_);
   start_from_settings();
   constexpr int max_programmes = 40;
   std::string message;
   double f =
      std::min(settings_.largest_friction, report_.upper * (1 - 0.5 * settings_.tolerance));
   for (int k = 0; k < max_programmes && report_.upper > smallest_friction; ++k)
   {
      const Trial trial = attempt(f);
      message = trial.solution.message;
      if (trial.solution.outcome == ConeOutcome::unavailable)
      {
         return ended(LimitStatus::unavailable, message);
      }
      if (!usable(trial.solution)) { return ended(LimitStatus::failed, message); }
      if (settings_.monitor.stopped() || closed()) { break; }
      undecided_ = trial.better || trial.excluded ? 0 : undecided_ + 1;
      if (undecided_ == 5) { break; }
      f = next_friction(trial, f);
   }
   return conclude(message);
}

} // namespace

LimitReport friction_limit(const LimitProblem &problem, double load_factor,
                           const LimitSettings &settings)
{
   require(std::isfinite(load_factor), "shakedown: the load factor is not finite");
   problem.reduced.validate();
   require_coulomb(problem.reduced, "the smallest friction coefficient");
   LimitReport report = FrictionLimit(problem, load_factor, settings).find();
   report.coupled = !problem.residual.uncoupled;
   if (!report.proven()) { return report; }
   report.starts = report.coupled
                      ? "coupled (degree " + nine_digits(problem.coupling) +
                           "): with more friction some start shakes down, but not every start "
                           "has to, and a march "
                           "from rest may slip for ever; for a given friction lower_limit() "
                           "computes the load below "
                           "which every start shakes down"
                      : "uncoupled: every start shakes down with more friction (proven)";
   report.of_the_mesh = mesh_statement(
      problem.reduced, stuck_forces(problem.reduced, problem.cycle), report, load_factor, true);
   return report;
}

} // namespace cattaneo
