#pragma once

#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/wear/wear_march.hpp>

namespace cattaneo
{

/// The effect of one cycle on each node (all of size n).
struct WearCycle
{
   Eigen::VectorXd depth; ///< that it loses
   Eigen::VectorXd loss;  ///< energy that friction takes
   /// Nodal force that wear can take away: the mean along its slip of the force above the
   /// threshold. A node that never exceeds the threshold has its mean force along its slip, and
   /// a node that does not slip its mean force in time.
   Eigen::VectorXd force;
   Eigen::VectorXd opening; ///< least opening, 0 if it bears at all
   double negligible = 0;   ///< depth that round-off may wear
   SlipRange range;
   MarchReport report;
   /// From repeated(): the largest difference by which a node lost more or less in the cycles
   /// on the way there.
   double passing = 0;
   /// From repeated(): by how much more a node lost in the first of these cycles.
   Eigen::VectorXd lag;

   bool found() const
   {
      return report.status == FrictionStatus::converged ||
             report.status == FrictionStatus::not_unique;
   }
   bool idle() const { return depth.maxCoeff() <= negligible; }
   /// Depth over nodal force of each node.
   Eigen::VectorXd compliance() const;
};

/// Cycles of a history at a gap that wears.
class WearCycles
{
public:
   /// All must outlive this.
   WearCycles(const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
              const MarchSettings &settings, const WornIncrementObserver &watch = {});

   bool begins(const ContactState &contact) const { return contact.time < start_; }
   double start() const { return start_; }
   /// The opening part, or one cycle, with what has worn off so far. With `update` the gap
   /// takes in the wear of each piece.
   WearCycle opening(ContactState &contact, const Eigen::VectorXd &depth);
   WearCycle march(ContactState &contact, const Eigen::VectorXd &depth, bool update);
   /// Cycles at this depth, which wears no more, until they repeat themselves: until `cycles`
   /// more would change what a cycle wears by no more than a share of the largest depth, or of
   /// `least` if that is more. Not found if they do not within 30.
   WearCycle repeated(ContactState &contact, const Eigen::VectorXd &depth, double share,
                      double least = 0, double cycles = 1);
   /// The contact as it is when the gap takes in what has worn off, with its loads as they are.
   /// False, and the contact as it was, if there is none.
   bool settle(ContactState &contact, const Eigen::VectorXd &depth);

   long marched = 0; ///< cycles, to their end
   Counters counters;

private:
   WearCycle march(const LoadHistory &part, ContactState &contact, const Eigen::VectorXd &depth,
                   WearCycle cycle);
   WearCycle none() const;

   const ReducedProblem &problem_;
   const WearLaw &law_;
   FrictionSolver solver_;
   MarchSettings settings_;
   LoadHistory history_;
   double start_;
   const WornIncrementObserver watch_;
};

/// The wear of `cycles` cycles like this one with the pressures at their end, size n, ≥ 0.
/// Empty if these were not found.
Eigen::VectorXd implicit_wear(const ReducedProblem &problem, const WearCycle &cycle,
                              double cycles);

/// See WearReport::explicit_limit.
double explicit_limit(const ReducedProblem &problem, const WearCycle &cycle);

} // namespace cattaneo
