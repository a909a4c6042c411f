#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>
#include <string>

namespace cattaneo
{

/** Archard's law of wear [Archard 1953] at each contact node:

       depth rate = k (p - p_th)₊ |slip rate|,

    p is the pressure (nodal force over consistent weight). k is that of both bodies together,
    which share the depth in the ratio k₁ : k₂ of their own. With `of_energy` k is the wear per
    energy that friction loses per area, so that f k takes the place of k. Worn material
    disappears. There is no debris. */
struct WearLaw
{
   Eigen::VectorXd coefficient; ///< k of each node, size n, ≥ 0, in 1/pressure
   Eigen::VectorXd threshold;   ///< p_th of each node, size n, ≥ 0; none if empty
   /// k multiplies the energy lost by friction, not pressure times slip
   bool of_energy = false;

   /// The same k at every node, no threshold.
   static WearLaw uniform(const ReducedProblem &problem, double coefficient);
   /// Another k at the nodes of an interface. InputError if the problem has none of that name.
   void set(const ReducedProblem &problem, const std::string &interface, double coefficient);

   /// InputError if sizes do not fit the problem, a value is negative or not finite, or the
   /// problem has no tangential displacements or no weights.
   void validate(const ReducedProblem &problem) const;
};

/// Depth that each node (size n, ≥ 0) loses over an increment. It is k ½ (p₀ + p₁)|Δv|, counted
/// from the point in the increment at which the node begins to slip or reverses. With a
/// threshold, (p - p_th)₊ takes the place of p.
Eigen::VectorXd worn_depth(const ReducedProblem &problem, const WearLaw &law,
                           const ContactState &before, const ContactState &after);

/// Volume that has worn off (per unit thickness; of the full circumference in axisymmetry).
double worn_volume(const ReducedProblem &problem, const Eigen::VectorXd &depth);

} // namespace cattaneo
