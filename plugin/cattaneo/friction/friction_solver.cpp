#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <set>
#include <sstream>

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
   require_at_least("friction settings: max_attempts", max_attempts, 1);
   require_at_least("friction settings: max_newton", max_newton, 1);
   require_at_least("friction settings: max_sweeps", max_sweeps, 1);
}

namespace
{

/// The methods in the order in which they are tried. docs/increments.md counts how often each
/// of them wins.
struct Method
{
   const char *name;
   Search (*find)(Increment &at);
   bool thorough; ///< not worth its time where a brief answer is wanted
};

const Method methods[] = {
   // Finds nearly every increment.
   {"active set", active_set, false},
   // One tangent or none: strong coupling and stiffness like a Hilbert matrix, where Newton's
   // steps go round in a circle, and free bodies.
   {"path", path, false},
   // Free bodies under loads that nearly balance each other, which tip or roll to their answer
   // (tests/stress/tipping_test).
   {"weak springs", weak_springs, true},
   // Two tangents: strong coupling, nodes at one place, nearly singular stiffness.
   {"damped Newton", damped_newton, true}};

bool find_end(Increment &at, bool thorough = true)
{
   if (at.system.settings.method == FrictionMethod::gauss_seidel)
   {
      at.report.found_by = "sweeps";
      return gauss_seidel(at) == Search::found;
   }
   for (const Method &method : methods)
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

/// Of an end on pieces of laws that bend: is each node that bears on the one that it took?
bool stands_on_law(const Increment &at)
{
   const FrictionSystem &s = at.system;
   bool fits = true;
   for (Index i = 0; i < s.n; ++i)
   {
      const double p = at.F[s.m(i)];
      for (const double sense : {1.0, -1.0})
      {
         const double off = s.laws[i].at(p, sense) - s.bound[i].at(p, sense);
         fits = fits && (!closed(at.status[i]) ||
                         std::abs(off) <= 0.1 * s.settings.tolerance * at.scale());
      }
   }
   return fits;
}

/** A law of friction that bends is taken as the lines of its pieces at the pressures p, and
   then of what these lead to, until they are the pieces there. False where that comes back to
    pieces that it began with. */
bool settles_on_pieces(Increment &at, VectorXd p, bool thorough = false)
{
   FrictionSystem &s = at.system;
   std::set<std::vector<double>> tried;
   while (true)
   {
      s.take_pieces(p);
      std::vector<double> lines;
      for (const FrictionBound &bound : s.bound)
      {
         lines.insert(lines.end(), {bound.intercept(0, 1), bound.intercept(0, -1),
                                    bound.slope(0, 1), bound.slope(0, -1)});
      }
      if (!tried.insert(lines).second || !find_end(at, thorough)) { return false; }
      for (Index i = 0; i < s.n; ++i) { p[i] = closed(at.status[i]) ? at.F[s.m(i)] : 0.0; }
      if (stands_on_law(at)) { return true; }
      at.go_back();
   }
}

/** The end on the pieces of the laws there. Where those of the start do not lead to them, the
    loads come in parts, each from the same start, and pieces and pressures of one lead to those
    of the next. */
bool find_end_on_pieces(Increment &at)
{
   FrictionSystem &s = at.system;
   if (s.laws.empty()) { return find_end(at); }
   VectorXd p = at.start.p;
   if (settles_on_pieces(at, p)) { return true; }
   const VectorXd change = at.multipliers - at.start.multipliers;
   for (double reached = 0, step = 0.5; step > 0.01;)
   {
      at.go_back();
      if (reached + step >= 1)
      {
         if (settles_on_pieces(at, p)) { return true; }
         step /= 2;
         continue;
      }
      const VectorXd loads = at.start.multipliers + (reached + step) * change;
      Increment part(s, at.start, loads);
      if (!settles_on_pieces(part, p))
      {
         step /= 2;
         continue;
      }
      reached += step;
      p = part.end().p;
      step = std::min(2 * step, 1 - reached);
   }
   at.go_back();
   if (settles_on_pieces(at, at.start.p, true)) { return true; }
   // Pieces may lead round in a circle, and a body jump to others: this asks the law itself.
   at.go_back();
   at.report.found_by = "damped Newton";
   return damped_newton(at) == Search::found && stands_on_law(at);
}

/// Displacements so large that round-off hides the forces may be a body that slides away, with
/// an imbalance that no residual shows, or one that nothing holds and that could as well stay.
bool runs_away(Increment &at)
{
   return at.report.round_off > may_hide_sliding &&
          (moves_away(at) || at.springs->bear_nothing);
}

/// Free bodies on springs that bear nothing: what these hold stays where it is.
bool rests(Increment &at)
{
   if (moves_away(at) || !at.springs->bear_nothing) { return false; }
   const ContactState &held = *at.springs->state;
   at.take(at.system.frictionless() ? held.w : held.displacements(), held.status);
   at.report = {};
   at.report.found_by = "rest";
   return ends_with_least_motion(at);
}

/// A frictionless contact with its slip among the unknowns.
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
   const IncrementReport report = whole->solve(state, multipliers);
   system.counters += whole->counters;
   system.counters -= before;
   return report;
}

/// Names the cause why no end of the increment was found.
void explain_failure(Increment &at)
{
   const FrictionSystem &s = at.system;
   const Mechanism &mechanism = at.mechanism;
   IncrementReport &report = at.report;
   std::ostringstream message;
   if (mechanism.exists)
   {
      report.status =
         mechanism.slides ? FrictionStatus::gross_sliding : FrictionStatus::no_solution;
      message << (mechanism.spins
                     ? "the torque exceeds what friction can hold: a body spins about its axis"
                  : mechanism.slides ? "the loads exceed what friction can hold: a body slides"
                                     : "the loads pull the contact apart: a body lifts off");
   }
   else if (at.lost_in_round_off > 0)
   {
      report.status = FrictionStatus::stalled;
      message << "the contact moves so far that its forces are lost in round-off ("
              << at.lost_in_round_off << " of the largest)";
   }
   else if (const Index node = s.above_critical(); node >= 0)
   {
      report.status = FrictionStatus::no_solution;
      message << "no equilibrium was found, and there may be none: friction "
              << s.friction(node) << " at node " << node << " is above its critical value "
              << s.lone.critical[node];
   }
   else
   {
      report.status = FrictionStatus::stalled;
      at.residuals();
      message << "no equilibrium was found";
      if (can_lock(s.problem))
      {
         message
            << ", and there may be none near the last one: the contact can lock itself, and "
               "where it loses its grip a body jumps free";
      }
      message << "; residuals " << report.residual_normal << " (normal) and "
              << report.residual_tangential << " (tangential), tolerance "
              << s.settings.tolerance;
   }
   report.message = message.str();
}

} // namespace

bool find_held_end(Increment &at)
{
   return at.system.laws.empty() ? find_end(at, false) : settles_on_pieces(at, at.start.p);
}

IncrementReport FrictionSystem::solve(ContactState &state, const VectorXd &multipliers)
{
   Increment at(*this, state, multipliers);
   IncrementReport &report = at.report;
   if (!laws.empty()) { take_pieces(state.p); }
   // 1. Loads that no admissible contact forces balance: there is nothing to search for.
   bool solved = !at.finds_mechanism();
   // 2. The methods, one after the other.
   solved = solved && find_end_on_pieces(at);
   // 3. A body that slides away may look like an answer.
   solved = solved && !runs_away(at);
   // 4. Free bodies that nothing moves. (Of a law that bends other pieces may prove now that
   // there is no equilibrium.)
   if (!solved && !at.mechanism.exists)
   {
      solved = (laws.empty() || !at.finds_mechanism()) && rests(at);
   }
   // 5. A free body without friction on a line that is nearly straight: that slip was
   // eliminated may have cost the digits. All is solved with it once more.
   const bool eliminated = without_slip && without_slip->tangential;
   if (!solved && !at.mechanism.exists && eliminated)
   {
      return solve_with_slip(*this, state, multipliers);
   }
   if (!solved)
   {
      report.found_by = "";
      explain_failure(at);
      return report;
   }
   if (!frictionless()) { at.name_states(at.next); }
   state = std::move(at.next);
   const IncrementReport unique = uniqueness(state);
   report.status = unique.status;
   report.message = unique.message;
   return report;
}

FrictionSolver::FrictionSolver(const ReducedProblem &problem, const FrictionSettings &settings)
   : own_(std::make_shared<ReducedProblem>(problem)),
     system_(std::make_unique<FrictionSystem>(own_, settings))
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
           "friction solver: ", multipliers.size(), " load multipliers for ",
           of.patterns.size(), " load patterns");
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
   require(gap.size() == problem().nodes() && gap.allFinite(), "friction solver: a gap of ",
           gap.size(), " entries for ", problem().nodes(),
           " contact nodes, must be one finite number for each");
   if (!own_)
   {
      own_ = std::make_shared<ReducedProblem>(problem());
      const Counters before = counters();
      system_ = std::make_unique<FrictionSystem>(own_, system_->settings);
      system_->counters += before;
   }
   own_->gap = gap;
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
           "friction solver: ", slip_error.size(), " errors of slips, must be none or ",
           problem().slips());
   return system_->judge(before, after, slip_error);
}
const Counters &FrictionSolver::counters() const
{
   return system_->counters;
}

} // namespace cattaneo
