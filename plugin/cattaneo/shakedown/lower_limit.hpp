#pragma once

#include <cattaneo/shakedown/limit.hpp>

namespace cattaneo
{

/// What is known of the lower limit λ1, and why.
enum class LowerLimitKind
{
   uncoupled, ///< B = 0: every start shakes down below λ2 (Klarbring, Ciavarella, Barber 2007)
   two_nodes, ///< exact by the geometry of the constraint lines (Ahn, Bertocchi, Barber 2008)
   bound,     ///< λ1 is at least the value
   none       ///< no statement: coupling times friction is too large for the bound
};

/** The lower limit λ1 of a coupled contact: for load factors below it every initial slip ends
   in shakedown; between λ1 and λ2 that depends on the start (thesis 4.1).

    Two nodes (exact, with v the plane of the two slips): each of the four conditions
    f p ± q ≥ 0 is a half-plane that moves with the loads; its extreme position over the cycle
    bounds the safe region. A start can cycle for ever exactly if the two conditions of one and
   the same node meet in a corner of that region. λ1 is the smallest λ at which that is so.
   Assumes that the contact stays closed and that the rate problem is unique (f |B_ii| < A_ii).

    More nodes (proven bound). Let F = |M| f with M the transfer of residual to normal forces.
   In any admissible closed state |q| ≤ f p and p = h + M q with h = p^w - M q^w, so that

       p ≤ (I - F)⁻¹ h =: p_high,    p ≥ h - F p_high = 2 h - p_high =: p_low,

    if F has a spectral radius below one. If some slip v* keeps |q*| ≤ f p_low at every vertex,
    then for every evolution v(t) from any admissible closed start

       d/dt ½ (v - v*)ᵀ A (v - v*) = Σ (q - q*)·v̇ ≤ -Σ (f p - |q*|) |v̇| ≤ 0,

    p never falls to zero, and with a load factor strictly below the bound the total slip is
   finite: the contact shakes down. p_low is linear in the loads, so the bound is one more limit
    programme, of an uncoupled contact with pressures p_low. |M| grows like the logarithm of the
    number of nodes: the bound is true on each mesh but weakens as the mesh is refined. */
struct LowerLimitReport
{
   LowerLimitKind kind = LowerLimitKind::none;
   LimitStatus status = LimitStatus::failed; ///< of the programme behind it
   std::string message;                      ///< what is proven, in one sentence
   double value = 0; ///< λ1, or a number that λ1 is proven not to be below
   /// v* of the bound, c·n; for two nodes the corner of the safe region at λ1.
   Eigen::VectorXd slip;
   Counters counters;
};

/// @a upper is the report of load_limit for the same problem.
LowerLimitReport lower_limit(const LimitProblem &problem, const LimitReport &upper,
                             const LimitSettings &settings = {});

} // namespace cattaneo
