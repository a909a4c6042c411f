#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/** Coefficients of friction, the same at every node, at which a contact changes its character.
    Properties only of the stiffness: the loads and the problem's own friction play no part. */
struct CriticalFriction
{
   /// Least A_ii/|B_ii| of any node (two components: least mᵀA m/|bᵀm| over all directions m,
   /// with the node's blocks of A and B), and the node that has it. With more friction the rate
   /// problem of that node alone has several answers, or none. Infinite without coupling.
   double node = 0;
   Eigen::Index weakest_node = 0; ///< at which `node` is decided

   /** The contact can lock itself: above it there are contact forces inside the friction cones,
       not all zero, that balance each other on the bodies without any load (a wedge that stays
       where it was driven in); below it there are none, whatever the elasticity. It depends on
       the directions of the contact normals in the rigid motions: tan α for a wedge with flanks
       at ±α to its axis, infinite for a flat contact. It is also infinite where directions do
       not decide: if supports hold both bodies they balance any forces, and on a pin in the
       middle of its hole pressures balance without friction. Elasticity then decides, as for a
       single node.

       By Gordan's theorem either such forces exist, or there is a rigid motion that all edges
       of all cones oppose. */
   double locking = 0;

   /** Below it an increment, and the rates, have at most one answer, for any loads, initial gap
       and slip (proven); above it they may still have only one. Zero if nothing can be said (a
       body that is free to slide).

       For two answers, Δ their difference: Δyᵀ Δp <= 0 by complementarity, so that with
       Δp = B Δx + C Δy the pressure meets |Δp|² <= Δpᵀ C⁻¹ B Δx in the norm π² = Δpᵀ C⁻¹ Δp;
       and Coulomb's law gives Δxᵀ Δq <= f Σ |Δp_i| |Δx_i|. With Δq = (A - Bᵀ C⁻¹ B) Δx + Bᵀ C⁻¹
       Δp both together are

           Δxᵀ (A - Bᵀ C⁻¹ B) Δx + π² <= f Σ |Δp_i| |Δx_i| <= f c π ξ,   ξ = |S⁻¹ Δx|,

       for any diagonal S (here C_ii^-½), c² = λ_max(S C S), hence a ξ² + π² <= f c π ξ with
       a = λ_min(S (A - Bᵀ C⁻¹ B) S), while π <= b ξ, b² = λ_max(S Bᵀ C⁻¹ B S). There is no such
       difference if

           f < min over 0 < τ <= b of (a + τ²)/(c τ),

       which for one node with weak coupling (2 B² < A C) is A/|B| itself. */
   double unique_below = 0;
};

/// Validates the problem. A coupled problem without rigid motions costs about ten Cholesky
/// factors of half its size.
CriticalFriction critical_friction(const ReducedProblem &problem);

/// Can the contact lock itself with the largest friction coefficient of its nodes at all of
/// them? This is a property of the problem. In a given state nothing needs to be locked.
bool can_lock(const ReducedProblem &problem);

} // namespace cattaneo
