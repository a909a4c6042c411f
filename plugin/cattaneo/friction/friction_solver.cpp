#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <sstream>
#include <vector>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

const char *name(FrictionStatus status)
{
   const char *const names[] = {"converged",   "gross sliding", "not unique",
                                "no solution", "stalled",       "stopped"};
   return names[static_cast<int>(status)];
}

void FrictionSettings::validate() const
{
   require_between("friction settings: tolerance", tolerance, 0, 1);
   require_at_least("friction settings: sweeps", sweeps, 0);
   require_at_least("friction settings: max_newton", max_newton, 1);
   require_at_least("friction settings: max_sweeps", max_sweeps, 1);
}

namespace
{

/// A method, with the families of problems that need it. docs/increments.md counts how often
/// each of them wins.
struct Method
{
   const char *name;
   Search (*find)(Increment &at);
   bool thorough; ///< left out if a quick answer is requested
};

/// Weak springs: free bodies under loads that nearly balance each other, and, with two
/// tangents, free bodies with stiffness like a Hilbert matrix. Bodies that tip or roll to their
/// answer (tests/stress/tipping_test) seldom need them: Lemke's method and the active set find
/// most.
constexpr Method springs{"weak springs", weak_springs, true};

/// In the order in which they are tried, with one tangent or none:
const std::vector<Method> in_the_plane = {
   // Nearly every increment.
   {"active set", active_set, false},
   // Strong coupling and stiffness like a Hilbert matrix, where Newton's steps repeat
   // themselves, and free bodies.
   {"Lemke", lemke, false},
   springs,
   // A few of the same families, where all departures from the start fail.
   {"Lemke", lemke_from_afar, true}};

/// With two tangents:
const std::vector<Method> in_the_disc = {
   // Nearly every increment.
   {"active set", active_set, false},
   // Large increments of many nodes, friction above critical, free bodies.
   {"growing load", growing_load, false},
   springs,
   // Strong coupling, friction above critical, nodes at one place.
   {"growing friction", growing_friction, true},
   // Free bodies whose stiffness is as ill-conditioned as a Hilbert matrix.
   {"damped Newton", damped_newton, true}};

bool find_end(Increment &at, bool thorough = true)
{
   if (at.system.settings.method == FrictionMethod::gauss_seidel)
   {
      at.report.found_by = "sweeps";
      return gauss_seidel(at) == Search::found;
   }
   for (const Method &method : at.system.disc() ? in_the_disc : in_the_plane)
   {
      if (method.thorough && !thorough) { break; }
      const Search search = method.find(at);
      at.report.found_by = method.name;
      if (search == Search::found) { return true; }
      at.go_back();
      if (search == Search::hopeless) { break; }
   }
   return false;
}

/// Displacements may be so large that round-off hides the forces. Then either a body slides
/// away, with an imbalance that no residual shows, or the loads do not push the body, and any
/// place is a solution.
bool runs_away(Increment &at)
{
   return at.report.round_off > may_hide_sliding &&
          (moves_away(at) || at.springs->bear_nothing);
}

/// Free bodies whose springs carry no force, as under loads that balance each other, stay where
/// the springs hold them.
bool rests(Increment &at)
{
   if (moves_away(at) || !at.springs->bear_nothing) { return false; }
   at.move_to(*at.springs->state);
   at.report = {};
   at.report.found_by = "rest";
   return ends_with_least_motion(at);
}

/// Names the cause why no end of the increment was found.
void explain_failure(Increment &at)
{
   const FrictionSystem &s = at.system;
   const Mechanism &mechanism = at.cause.mechanism;
   IncrementReport &report = at.report;
   const VectorXd p = at.F.tail(s.n);
   std::ostringstream message;
   if (mechanism.exists)
   {
      report.status =
         mechanism.slides ? FrictionStatus::gross_sliding : FrictionStatus::no_solution;
      // The second tangent runs about the axis, except on a surface in space.
      message << (mechanism.spins && s.problem.position.cols() < 3
                     ? "the torque exceeds what friction can hold: a body spins about its axis"
                  : mechanism.slides ? "the loads exceed what friction can hold: a body slides"
                                     : "the loads pull the contact apart: a body lifts off");
   }
   else if (at.cause.lost_in_round_off > 0)
   {
      report.status = FrictionStatus::stalled;
      message
         << "the displacements are so large that the contact forces are lost in round-off ("
         << at.cause.lost_in_round_off << " of the largest force)";
   }
   // If no body can move freely, there is always an equilibrium, with any friction.
   else if (const Index node = s.problem.rigid_motions.cols() > 0 ? s.above_critical(p) : -1;
            node >= 0)
   {
      report.status = FrictionStatus::no_solution;
      message << "no equilibrium was found, and there may be none: friction "
              << s.friction(node, p[node]) << " at node " << node
              << " is above its critical value " << s.lone.critical[node];
   }
   else
   {
      report.status = FrictionStatus::stalled;
      at.residuals();
      message << "no equilibrium was found";
      if (can_lock(s.problem))
      {
         message
            << ", and there may be none near the last one: this contact can lock itself, and a "
               "body jumps free where it unlocks";
      }
      message << "; residuals " << report.residual_normal << " (normal) and "
              << report.residual_tangential << " (tangential), tolerance "
              << s.settings.tolerance;
   }
   report.message = message.str();
}

/// An increment in the unknowns of one system. The state is moved to its end, if one is found.
IncrementReport solve_in(FrictionSystem &system, ContactState &state,
                         const VectorXd &multipliers)
{
   Increment at(system, state, multipliers);
   IncrementReport &report = at.report;
   const Mechanism &mechanism = at.cause.mechanism;
   // 1. If no admissible contact forces balance the loads, there is nothing to search for.
   bool solved = !at.finds_mechanism();
   // 2. The methods, one after the other.
   solved = solved && find_end(at);
   // 3. A body that slides away may look like an answer, even to ends_here().
   solved = solved && !runs_away(at);
   // 4. Free bodies that no load moves. (With a law that bends, the pressures that were found
   // may prove that there is no equilibrium.)
   if (!solved && !mechanism.exists)
   {
      solved = !(system.bends() && at.finds_mechanism()) && rests(at);
   }
   // 5. Status and message.
   if (!solved)
   {
      report.found_by = "";
      explain_failure(at);
      return report;
   }
   if (!system.frictionless()) { at.fit_states(at.next); }
   state = std::move(at.next);
   const IncrementReport unique = system.uniqueness(state);
   report.status = unique.status;
   report.message = unique.message;
   return report;
}

/// Solves a frictionless contact with slip among the unknowns. A pad that rocks on a nearly
/// straight line needs this.
IncrementReport solve_with_slip(FrictionSystem &system, ContactState &state,
                                const VectorXd &multipliers)
{
   std::unique_ptr<FrictionSystem> &whole = system.without_slip->kept;
   if (!whole)
   {
      whole = std::make_unique<FrictionSystem>(system.shared, system.settings, true);
      system.counters += whole->counters;
   }
   const Counters before = whole->counters;
   const IncrementReport report = solve_in(*whole, state, multipliers);
   system.counters += whole->counters;
   system.counters -= before;
   return report;
}

} // namespace

bool find_end_quickly(Increment &at)
{
   return find_end(at, false);
}

IncrementReport FrictionSystem::solve(ContactState &state, const VectorXd &multipliers)
{
   // 1. The increment. Without friction, slip is eliminated.
   IncrementReport report = solve_in(*this, state, multipliers);
   // 2. For a free body without friction on a nearly straight line the elimination may have
   // cost the digits. A motion that carries a body away has another status.
   const bool eliminated = without_slip && without_slip->tangential;
   if (eliminated && report.status == FrictionStatus::stalled)
   {
      report = solve_with_slip(*this, state, multipliers);
   }
   return report;
}

FrictionSolver::FrictionSolver(const ReducedProblem &problem, const FrictionSettings &settings)
   : copy_(std::make_shared<ReducedProblem>(problem)),
     system_(std::make_unique<FrictionSystem>(copy_, settings))
{
}
FrictionSolver::FrictionSolver(std::shared_ptr<const ReducedProblem> problem,
                               const FrictionSettings &settings)
   : system_(std::make_unique<FrictionSystem>(std::move(problem), settings))
{
}
FrictionSolver::~FrictionSolver() = default;
FrictionSolver::FrictionSolver(FrictionSolver &&) noexcept = default;

IncrementReport FrictionSolver::solve(ContactState &state, const VectorXd &multipliers)
{
   const ReducedProblem &of = problem();
   state.validate(of);
   require(multipliers.size() == static_cast<Index>(of.patterns.size()),
           "friction solver: ", multipliers.size(),
           " load multipliers, must be one for each of the ", of.patterns.size(),
           " load patterns");
   for (Index k = 0; k < multipliers.size(); ++k)
   {
      require(std::isfinite(multipliers[k]),
              "friction solver: the multiplier of load pattern '", of.patterns[k].name, "' is ",
              multipliers[k], ", must be finite");
   }
   return system_->solve(state, multipliers);
}
const ReducedProblem &FrictionSolver::problem() const
{
   return system_->problem;
}
const FrictionSettings &FrictionSolver::settings() const
{
   return system_->settings;
}
void FrictionSolver::set_gap(const VectorXd &gap)
{
   require(gap.size() == problem().nodes() && gap.allFinite(), "friction solver: the gap has ",
           gap.size(), " entries, must have a finite one for each of the ", problem().nodes(),
           " contact nodes");
   if (!copy_)
   {
      copy_ = std::make_shared<ReducedProblem>(problem());
      const Counters before = counters();
      system_ = std::make_unique<FrictionSystem>(copy_, system_->settings);
      system_->counters += before;
   }
   copy_->gap = gap;
}
bool FrictionSolver::frictionless() const
{
   return system_->frictionless();
}
IncrementReport FrictionSolver::judge(const ContactState &before, const ContactState &after,
                                      const VectorXd &slip_error)
{
   before.validate(problem());
   after.validate(problem());
   require(slip_error.size() == 0 || slip_error.size() == problem().slips(),
           "friction solver: ", slip_error.size(),
           " errors of slips are given, must be none or ", problem().slips());
   return system_->judge(before, after, slip_error);
}
const Counters &FrictionSolver::counters() const
{
   return system_->counters;
}

} // namespace cattaneo
