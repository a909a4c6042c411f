#pragma once

#include <cattaneo/counters.hpp>
#include <cattaneo/monitor.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>
#include <cattaneo/shakedown/residual_forces.hpp>
#include <limits>
#include <string>
#include <vector>

namespace cattaneo
{

/** A shakedown limit by Melan's static theorem ([Melan 1936], thesis 4.3.2): is there a slip v,
    constant in time, with which all nodes stick, closed (w = 0), throughout the load cycle? Its
    bounds are proven for a contact whose nodes all stay closed. With nodes that open the
    problem is different, and marches may shake down above the limit except at those nodes
    (transient.hpp). closed_contact is for contacts that are partly open throughout. The limit
    is the upper one, λ2: above it every start ends in cyclic slip; below it some start shakes
    down, and all do if the problem is uncoupled (lower_limit.hpp). If the limit is decided
    where the stuck tractions are singular, at the edges of contact, it is a limit of the mesh,
    and falls with the spacing. */
struct LimitProblem
{
   ReducedProblem reduced;  ///< without a gap, its friction is that of a load limit
   ResidualForces residual; ///< of `reduced`; does not depend on friction or loads
   double coupling = 0;     ///< degree_of_coupling of `reduced`
   LoadCycle cycle;         ///< of loads, to be changed along a sweep
};

/// Computes the residual forces and the coupling, the expensive part. For a sweep, change
/// the cycle or the friction in the result.
LimitProblem limit_problem(ReducedProblem reduced, LoadCycle cycle);

/// Outcome of the search for a limit.
enum class LimitStatus
{
   certified,   ///< lower ≤ limit ≤ upper are proven and the gap is within the tolerance
   bracketed,   ///< the bounds are proven, but the gap is wider than requested
   unlimited,   ///< no limit: a slip in proportion to the load factor, `ray`, keeps the contact
                ///< stuck at any load factor. Proven; if forces lie on their cones, only to
                ///< round-off and up to `lower`
   no_solution, ///< no slip keeps the contact stuck and closed under the constant loads or, of
                ///< a friction limit, with any coefficient searched (proven by the mechanism)
   failed,      ///< the solver ended without a usable point
   stopped,     ///< it was asked to (Monitor::stop): bounds are proven as far as they are known
   unavailable  ///< built without Ipopt
};

/// As it is printed, in words.
const char *name(LimitStatus status);

/** Motions dual to the limit: at load vertex j node i slips by `slip` and opens by `opening`,
    with opening ≥ f |slip|. This is the flow rule associated with the friction cone. For
    another law than Coulomb's it is the sum over its pieces. */
struct CollapseMechanism
{
   Eigen::MatrixXd slip;    ///< c·n × vertices
   Eigen::MatrixXd opening; ///< n × vertices
};

struct LimitReport;

/// How a limit is searched. The defaults need no tuning.
struct LimitSettings
{
   /// Largest gap between the proven bounds, relative to the limit, or to 1e-4 of the load that
   /// makes all nodes slide.
   double tolerance = 1e-6;
   int max_iterations = 300; ///< of Ipopt, in one programme
   /// Load factors are searched up to this multiple of (friction × normal force) / shear. If
   /// there is no limit up to there, the program tries to prove that there is none. If it
   /// cannot, the search goes on.
   double largest_factor = 1e4;
   /// The smallest friction coefficient is searched up to here.
   double largest_friction = 100;
   /// Compute the lower limit λ1 of a load limit as well (LimitReport::every_start). If the
   /// contact is coupled and has more than two nodes this is one more programme.
   bool every_start = false;
   /// An earlier report of a sweep over the same contact to start from. Not owned; may be null.
   const LimitReport *start = nullptr;
   /// Called in every iteration; may stop the search. The number of iterations is not known
   /// before, so the share that is done is NaN until the end.
   Monitor monitor;

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/** A limit with its proven bounds, the assumption of the proof, the starts for which it holds,
    and whether the mesh decides it. statement() has all of this in sentences. */
struct LimitReport
{
   LimitStatus status = LimitStatus::failed; ///< outcome of the search
   std::string message;                      ///< what is proven, in one sentence
   /// The safe side: `lower` of a load factor, infinite if it is unlimited, `upper` of a
   /// friction coefficient.
   double limit = 0;
   /// Proven lower bound. For a load, plain arithmetic shows that `slip` is admissible at this
   /// load factor. For a friction coefficient, weak duality excludes all below it. For an
   /// unlimited load that is held to round-off only, the factor up to which that holds.
   double lower = 0;
   /// Proven upper bound: weak duality excludes all load factors above it, or `slip` is
   /// admissible at this friction coefficient.
   double upper = 0;
   /// Largest (|q| - f p) / nodal force over nodes and vertices at the limit, from slip, A and
   /// B; at most 0.
   double violation = 0;
   Eigen::VectorXd slip; ///< the optimal slip v, c·n, without rigid part
   /// Unlimited: the proof. Under the load factor λ, however large, slip + λ ray is admissible
   /// (if forces lie on their cones, only to round-off and up to the λ in the message).
   Eigen::VectorXd ray;
   /// The dual mechanism. Load limit: scaled to work 1 on the varying loads.
   CollapseMechanism mechanism;
   double coupling = 0; ///< of the problem
   /// Slip changes the pressures: *some* start shakes down below the limit
   bool coupled = false;
   /// The lower limit λ1 of a load limit, or a proven lower bound of λ1. Below it every start
   /// shakes down. NaN: it is not known, or was not requested.
   double every_start = std::numeric_limits<double>::quiet_NaN();
   std::string starts; ///< which starts shake down, in one sentence
   /// The reason why the limit belongs to this mesh only and not to the bodies, in one
   /// sentence. Empty if there is no such reason, see mesh_statement().
   std::string of_the_mesh;
   int iterations = 0; ///< of Ipopt, summed over the programmes
   double seconds = 0; ///< wall time
   Counters counters;  ///< limit_solves: programmes solved

   /// Certified or bracketed: `lower` and `upper` are bounds.
   bool proven() const
   {
      return status == LimitStatus::certified || status == LimitStatus::bracketed;
   }
   /// Three sentences: the assumption, the starts for which the limit holds, and whether it is
   /// a limit of the mesh only. None without a limit.
   std::vector<std::string> statement() const;
};

/// The assumption of the bounds of all limits.
inline constexpr const char *limit_assumption =
   "all nodes of the contact stay closed throughout the cycle";

/// A number within a sentence on limits.
std::string nine_digits(double value);

/** Largest λ ≥ 0 for the friction of the problem, Coulomb's or a concave law (InputError for
    another), and the shape of the cycle. First the constant loads, λ = 0: `no_solution` if they
    cannot be carried. */
LimitReport load_limit(const LimitProblem &problem, const LimitSettings &settings = {});

/// The same for given forces on the stuck contact instead of the load patterns'
/// (lower_limit.hpp).
LimitReport load_limit(const ReducedProblem &reduced, const ResidualForces &residual,
                       const StuckForces &loads, const LimitSettings &settings = {});

/** Smallest coefficient of friction, the same at all nodes, for the loads constant + @a
    load_factor × varying. The problem's own friction is not used. InputError for a problem with
    other laws. It is the least f of a quasi-convex problem. Each step finds the state with the
    greatest clearance from the cones of a trial f. The largest |q|/p of that state is the next
    f [Dinkelbach 1967], until duality shows that no state exists at f (1 - tolerance/2). */
LimitReport friction_limit(const LimitProblem &problem, double load_factor,
                           const LimitSettings &settings = {});

} // namespace cattaneo
