#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/shakedown/limit.hpp>

namespace cattaneo
{

/** Marches in time on either side of a limit (thesis 4.4): does the contact that starts with a
   given slip shake down under a load factor, and how fast?

    History: the constant loads in one increment, then the cycle's vertices again and again. The
    cycle starts at the constant loads if they lie on its last edge (between the last and the
   first vertex), as for a shear cycled through zero; else at its first vertex. */
struct TransientSettings
{
   int cycles = 200;
   /// Shaken down: the last cycle loses at most this much of what the first one does, or of the
   /// elastic energy of the stuck contact if that is more. A corner node that opens for a
   /// moment goes on losing 1e-8 of it.
   double shaken_down = 1e-6;
   MarchSettings march;

   void validate() const;
};

struct TransientReport
{
   FrictionStatus status = FrictionStatus::converged;
   std::string message;
   double load_factor = 0;
   std::vector<double> dissipation; ///< of each cycle, until steady
   /// Elastic energy that the slip of a stuck contact could release, the scale of dissipation:
   /// the largest ½ qᵀ A⁻¹ q over the vertices.
   double energy = 0;
   bool shaken_down = false;
   /// Loss of a cycle over that of the one before: geometric mean over the later half of the
   /// cycles before shakedown, all of them if it does not shake down; 0 if there are too few.
   double decay = 0;
   int steady_cycle = 0, steady_period = 0; ///< as MarchReport
   Eigen::VectorXd slip;                    ///< at the end
   Counters counters;
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
   std::vector<TransientReport> below, above;
};

/// @a limit is the report of load_limit.
TransientBracket transient_bracket(const LimitProblem &problem, const LimitReport &limit,
                                   double margin, const TransientSettings &settings = {});

/** Search for a start that does not shake down below the upper limit: what is observed of the
   lower limit λ1. Halves the interval between the proven lower bound and the upper limit, each
   time marching from multiples of the optimal slip and from random admissible-sized ones. */
struct CounterExampleSettings
{
   int starts = 10;   ///< random starts a load factor, besides multiples of the optimal slip
   int halvings = 6;  ///< load factors tried
   unsigned seed = 1; ///< of the random starts
   TransientSettings transient;

   void validate() const;
};

struct CounterExample
{
   bool found = false;
   double load_factor = 0; ///< the smallest at which a start was found to cycle
   Eigen::VectorXd start;  ///< that start
   double dissipation = 0; ///< of its steady cycle
   double quiet = 0;       ///< the largest load factor tried at which every start shook down
   int marches = 0;
   std::string message; ///< what is observed, in one sentence
   Counters counters;
};

/// @a proven: load factor below which no start can cycle (lower_limit; 0 if nothing is known).
CounterExample find_counter_example(const LimitProblem &problem, const LimitReport &limit,
                                    double proven, const CounterExampleSettings &settings = {});

} // namespace cattaneo
