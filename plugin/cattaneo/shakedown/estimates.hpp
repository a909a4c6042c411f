#pragma once

#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>

namespace cattaneo
{

/** Estimates of the shakedown limit that look at one node at a time (thesis 4.3.1). Like the
    stuck contact's ratios they do not converge at a corner's nodes, which `nodes` leaves out
    (monolith.hpp; empty: all). */
struct PointwiseEstimate
{
   double value = 0;      ///< friction coefficient or load factor; infinite if there is none
   Eigen::Index node = 0; ///< where it is decided
};

/** Method 1 (4.9): only the shear tractions redistribute, independently at each node and
    without regard to equilibrium, and the pressure stays that of the stuck contact:

       f = max |q_a - q_b| / (p_a + p_b)

    over nodes and pairs of load vertices. With two tangential components and more than two
    vertices it is the pairwise necessary condition. */
PointwiseEstimate method1_friction(const ReducedProblem &problem, const LoadCycle &cycle,
                                   double load_factor, const NodeList &nodes = {});

/// The load factor of method 1 for the friction of the problem: the largest λ with
/// |q_a - q_b| ≤ f (p_a + p_b) everywhere.
PointwiseEstimate method1_load(const ReducedProblem &problem, const LoadCycle &cycle,
                               const NodeList &nodes = {});

/** Method 2 (thesis 4.3.1.2): a residual shear r that method 1 allows at its own f and that has
    no resultant changes the pressure by M r, and (4.9) is evaluated again with p + M r. The
    choice of r is free, so the result is a range over all choices. One tangential component
    only. */
struct Method2Estimate
{
   /// Is there a permissible residual shear without a resultant? If not, the estimates are
   /// zero.
   bool exists = false;
   std::string message; ///< what was found, in one sentence
   double low = 0;      ///< the choice that needs the least friction
   double high = 0;     ///< the choice that needs the most
   double natural = 0;  ///< r at the same fraction of its permissible range at every node
   Eigen::VectorXd natural_residual; ///< that choice, size n
   Eigen::VectorXd residual_low;  ///< lower end of the permissible range, size n (figure 4.9)
   Eigen::VectorXd residual_high; ///< upper end
   Counters counters;             ///< of the limit programme
};

/// `low` is a limit programme and needs Ipopt; without it, low is NaN and the message says so.
Method2Estimate method2_friction(const LimitProblem &problem, double load_factor,
                                 const NodeList &nodes = {});

} // namespace cattaneo
