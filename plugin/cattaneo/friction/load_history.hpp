#pragma once

#include <Eigen/Dense>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// Load multipliers, given in the order of the patterns, by the names of these: the other way
/// of ReducedProblem::multipliers().
NamedLoads named(const ReducedProblem &problem, const Eigen::VectorXd &multipliers);

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

   /// Points with times 0, 1, 2, …; each inner vector is one point's multipliers.
   static LoadHistory through(const std::vector<Eigen::VectorXd> &points);
   /// The same by names: through(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", 0.2}}}).
   static LoadHistory through(const ReducedProblem &problem,
                              const std::vector<NamedLoads> &points);

   /// Number of linear pieces, repeated cycles counted.
   int segments() const;
   /// Start and end time of a piece (time goes on through repeated cycles).
   double start_time(int segment) const;
   double end_time(int segment) const;
   /// Multipliers at the start and the end of a piece.
   Eigen::VectorXd start(int segment) const;
   Eigen::VectorXd end(int segment) const;
   /// Index of the point where a piece starts (the same in every repeated cycle).
   int point(int segment) const;
   /// Cycle that a piece belongs to: 0 for the opening part, then 1, 2, ….
   int cycle(int segment) const;
   /// True if a cycle ends with this piece.
   bool ends_cycle(int segment) const;

   /// InputError if sizes, order of times or the closing of the cycle are wrong.
   void validate(int patterns) const;

private:
   int opening() const; ///< pieces before the cycle
   int period() const;  ///< pieces of one cycle
};

} // namespace cattaneo
