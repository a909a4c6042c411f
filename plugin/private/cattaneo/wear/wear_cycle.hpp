#pragma once

#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/wear/wear_march.hpp>

namespace cattaneo
{

/// The effect of one cycle on each node (all of size n).
struct WearCycle
{
   Eigen::VectorXd depth; ///< depth that it loses
   Eigen::VectorXd loss;  ///< energy that it loses by friction
   /// Nodal force that wear can take away: the mean along its slip of the force above the
   /// threshold. A node that never exceeds the threshold has its mean force along its slip, and
   /// a node that does not slip its mean force in time.
   Eigen::VectorXd force;
   Eigen::VectorXd opening; ///< least opening, 0 if it touches at some time
   double negligible = 0;   ///< depth that may be due to round-off
   SlipRange range;
   MarchReport report;
   /// From repeated(): the largest difference of a node's depth between the cycles that were
   /// marched.
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
   /// Marches the part before the cycle, or one cycle, with the wear so far. With `update` the
   /// wear of each piece is added to the gap.
   WearCycle opening(ContactState &contact, const Eigen::VectorXd &depth);
   WearCycle march(ContactState &contact, const Eigen::VectorXd &depth, bool update);
   /// Marches cycles at this fixed depth until they repeat themselves: until `cycles` more of
   /// them would change the wear of a cycle by no more than a share of the largest depth, or of
   /// `least` if that is more. Not found if 30 cycles do not suffice.
   WearCycle repeated(ContactState &contact, const Eigen::VectorXd &depth, double share,
                      double least = 0, double cycles = 1);
   /// Moves the contact to its equilibrium at the worn gap, under the same loads. Returns
   /// false, and leaves the contact unchanged, if none is found.
   bool settle(ContactState &contact, const Eigen::VectorXd &depth);

   long marched = 0; ///< cycles marched to their end
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

/// The wear of `cycles` cycles like this one, computed with the pressures at their end, size n,
/// ≥ 0. Empty if these pressures were not found.
Eigen::VectorXd implicit_wear(const ReducedProblem &problem, const WearCycle &cycle,
                              double cycles);

/// See WearReport::explicit_limit.
double explicit_limit(const ReducedProblem &problem, const WearCycle &cycle);

} // namespace cattaneo
