#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <limits>

namespace cattaneo
{

/** Marches in time on either side of a limit (thesis 4.4): does the contact that starts with a
    given slip shake down under a load factor, and how fast?

    History: the constant loads in one increment, then the cycle's vertices again and again. The
    cycle starts at the constant loads if they lie on its last edge (between the last and the
    first vertex), as for a shear cycled through zero; else at its first vertex. */
struct TransientSettings
{
   int cycles = 200; ///< largest number of cycles that are marched
   /// A slip that decays from cycle to cycle counts as ended when the loss of a cycle is below
   /// this share of the loss of the first cycle, or of the elastic energy of the stuck contact
   /// if that is more.
   double shaken_down = 1e-6;
   /// A proven upper limit, LimitReport::upper. No march above it counts as shaken down.
   double upper = std::numeric_limits<double>::infinity();
   MarchSettings march; ///< of each of them

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/** The verdict on the slip, and its measure:

    - A steady cycle is judged by its slip. A node slips if it carries a force at some time of
      the cycle and moves by more than 1e-9 of TransientReport::elastic_slip in it, however
      little that loses.
    - A cycle that is not steady yet is judged by its loss. The loss has ended when it is below
      TransientSettings::shaken_down and falls towards zero: three losses, ten cycles apart,
      continued as a geometric series, leave less than half of the last one. A cycle whose loss
      falls like that is not steady, however little its slip changes.

    Above an upper limit that is known (TransientSettings::upper) nothing is said to have shaken
    down: a slip that seems to have ended is `slips_and_opens` if nodes open, however little
    they move, else `still_slipping`. */
enum class TransientVerdict
{
   shaken_down,     ///< the slip has ended
   slips_and_opens, ///< ended except at nodes that open and slip in every cycle
   cyclic_slip,     ///< a steady cycle with slip at nodes that stay closed
   still_slipping,  ///< neither steady nor ended after all cycles
   no_equilibrium,  ///< the march ended early; status and message have the reason
   stopped          ///< it was asked to (Monitor::stop)
};

/// As it is printed, in words.
const char *name(TransientVerdict verdict);

/** The theorems behind limits hold for a contact whose nodes all stay closed. If nodes open in
    the march (`opened`), its verdict belongs to another problem and need not agree with a
    bound. At the corner of a square punch a few nodes open and close for ever, below the upper
    limit and above it. They lose 1e-7 of the loss of the first cycle. Such a contact has not
    shaken down. */
struct TransientReport
{
   FrictionStatus status = FrictionStatus::converged; ///< of the march
   std::string message; ///< of the march, empty if it went to its end
   /// As MarchReport, of a status that is not `converged`; of constant loads that have no
   /// equilibrium time 0 and these loads.
   double event_time = 0;
   Eigen::VectorXd event_multipliers; ///< of the load patterns, at that time
   double load_factor = 0;            ///< λ of the march
   TransientVerdict verdict = TransientVerdict::no_equilibrium; ///< verdict on the slip
   std::vector<double> dissipation;                             ///< of each cycle, until steady
   /// Elastic energy that the slip of a stuck contact could release, the scale of dissipation:
   /// the largest ½ qᵀ A⁻¹ q over the vertices.
   double energy = 0;
   /// The largest slip if a stuck contact loses all friction, |A⁻¹ q| over the vertices, the
   /// scale of `cycle_slip`.
   double elastic_slip = 0;
   /// Length of the slip path in the last cycle, of each node that is in contact at some time
   /// of it, size n. If the steady state is not known to have period 1, the longer one of the
   /// last two cycles.
   Eigen::VectorXd cycle_slip;
   NodeList opened;        ///< nodes that are open at some time of the last cycle
   double opened_loss = 0; ///< dissipation at these in the last cycle
   /// Loss of a cycle over that of the one before, at the nodes that are not `opened`. It is
   /// the geometric mean over the later half of the cycles before shakedown, or of all cycles
   /// without shakedown. 0 if there are too few.
   double decay = 0;
   int steady_cycle = 0;               ///< as MarchReport
   int steady_period = 0;              ///< as MarchReport
   Eigen::VectorXd slip;               ///< at the end
   std::vector<CutOffContact> cut_off; ///< as MarchReport
   Counters counters;                  ///< of the march
};

/// Marches the load cycle at @a load_factor from the slip @a start (size c·n). The friction is
/// that of the problem; `solver` must have been made from the same problem.
TransientReport transient(FrictionSolver &solver, const LimitProblem &problem,
                          double load_factor, const Eigen::VectorXd &start,
                          const TransientSettings &settings = {});

/// The three starts of thesis 4.4, below and above the limit.
struct TransientBracket
{
   /// zero, optimal and negative optimal slip, at limit × (1 - margin) and limit × (1 +
   /// margin).
   std::vector<TransientReport> below; ///< at limit × (1 - margin)
   std::vector<TransientReport> above; ///< at limit × (1 + margin)
};

/// @a limit is the report of load_limit.
TransientBracket transient_bracket(const LimitProblem &problem, const LimitReport &limit,
                                   double margin, const TransientSettings &settings = {});

/** Search for a start that does not shake down below the upper limit: an observed upper
    estimate of the lower limit λ1. Halves the interval between the proven lower bound and the
    upper limit, each time marching from multiples of the optimal slip and from random slips of
    the same size. */
struct CounterExampleSettings
{
   int starts = 10;   ///< random starts per load factor, besides multiples of the optimal slip
   int halvings = 6;  ///< load factors tried
   unsigned seed = 1; ///< of the random starts
   TransientSettings transient; ///< of each march

   /// InputError naming the setting, its value and what is allowed.
   void validate() const;
};

/// The result of the search.
struct CounterExample
{
   bool found = false;     ///< a start that cycles
   double load_factor = 0; ///< the smallest at which a start was found to cycle
   Eigen::VectorXd start;  ///< that start
   double dissipation = 0; ///< of its steady cycle, at nodes that stay closed
   double quiet = 0;       ///< the largest load factor tried at which every start shook down
   /// The smallest load factor tried at which a start ended in nodes that open and slip in
   /// every cycle, infinite if none did. λ1 of a contact that is free to open is no larger.
   double opens = std::numeric_limits<double>::infinity();
   Eigen::VectorXd opening_start; ///< that start
   int marches = 0;               ///< number of marches
   std::string message;           ///< what is observed, in one sentence
   Counters counters;             ///< of all marches
};

/// @a proven: load factor below which no start can cycle (lower_limit; 0 if nothing is known).
CounterExample find_counter_example(const LimitProblem &problem, const LimitReport &limit,
                                    double proven, const CounterExampleSettings &settings = {});

} // namespace cattaneo
