#pragma once

#include <Eigen/Dense>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <vector>

namespace cattaneo
{

/// Load multipliers by the names of the patterns, from those in the order of the patterns: the
/// inverse of ReducedProblem::multipliers().
NamedLoads named(const ReducedProblem &problem, const Eigen::VectorXd &multipliers);

/// One linear piece of a load history.
struct LoadPiece
{
   /// Number of the history's point where it starts, the same in every repeated cycle
   int point = 0;
   int cycle = 0; ///< cycle that it belongs to: 0 for the opening part, then 1, 2, …
   bool begins_cycle = false; ///< it starts where the cycle does
   bool ends_cycle = false;   ///< it ends where the cycle does
   double start = 0;          ///< time, which increases through repeated cycles
   double end = 0;            ///< likewise
   Eigen::VectorXd from;      ///< multipliers at its start
   Eigen::VectorXd to;        ///< multipliers at its end

   /// In the history's time.
   double duration() const { return end - start; }
   /// The multipliers at a share of its duration.
   Eigen::VectorXd at(double share) const { return from + share * (to - from); }
};

/** A piecewise-linear history of load multipliers: an opening part, then a cycle that repeats.

    The points 0 … cycle_start are marched once, the points cycle_start … last `cycles` times;
    the last point of a cycle must have the loads of its first. Time is only a parameter (rate
    independence). */
struct LoadHistory
{
   Eigen::VectorXd times;       ///< strictly increasing
   Eigen::MatrixXd multipliers; ///< patterns × points
   int cycle_start = -1;        ///< index of the point where the cycle starts; -1: no cycle
   int cycles = 0;              ///< how often the cycle is marched (1 if there is no cycle)
   /// Numbers of the loads that each point names; empty: not known. Only bolts ask for it, see
   /// Bolt: a point that names a bolt tightens it, also where its multiplier stays.
   std::vector<std::vector<int>> stated;

   /// Does this point name this load?
   bool states(int point, Eigen::Index load) const;
   /// Points with times 0, 1, 2, …; each inner vector is one point's multipliers.
   static LoadHistory through(const std::vector<Eigen::VectorXd> &points);
   /** Points with times 0, 1, 2, … by the names of loads. A point names the loads that it
       changes: through(problem, {{}, {{"P", 1}}, {{"Q", 0.2}}}). A load that a point does not
       name keeps its value. All loads begin at 0.
       @param cycle_start the point from which on the rest repeats; -1: no cycle
       @param cycles how often it repeats
       InputError as validate(), and for a name that no pattern has. */
   static LoadHistory through(const ReducedProblem &problem,
                              const std::vector<NamedLoads> &points, int cycle_start = -1,
                              int cycles = 1);

   /// Number of linear pieces, repeated cycles counted.
   int pieces() const;
   /// Piece k, counted from 0 in the order in which they are marched.
   LoadPiece piece(int k) const;

   /// InputError if sizes, order of times or the closing of the cycle are wrong.
   void validate(const ReducedProblem &problem) const;
};

} // namespace cattaneo
