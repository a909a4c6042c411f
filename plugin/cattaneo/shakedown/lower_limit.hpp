#pragma once

#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>

namespace cattaneo
{

/// The state of knowledge of the lower limit λ1, and the reason.
enum class LowerLimitKind
{
   uncoupled, ///< B = 0: every start shakes down below λ2 [Klarbring 2007]
   two_nodes, ///< exact by the geometry of the constraint lines [Ahn 2008]
   bound,     ///< λ1 is at least the value
   apart,     ///< the same, but slip without end at the exempt nodes is not excluded
   none       ///< no statement: coupling times friction is too large for the bound
};

/** Lower bounds of the pressures of all admissible closed states, whatever their slip: if
    |q| ≤ f p with p = h + M q, h = p^w - M q^w, then

       p ≥ by_normal p^w + by_shear q^w.

    M is the transfer of residual to normal forces. By weak duality: for a row a of M and any
    y ≥ 0 with |a - s tᵀ - y f M| ≤ y at every node,

       a q ≥ s tᵀ q - y f h,

    t a rigid motion, on which every state has the load's resultant. Repeating
    y ← |a - s tᵀ - y f M| ends where this bound is also attained (the linear programme's
    optimum), the same y for all loads. */
struct LeastPressure
{
   bool exists = false; ///< coupling times friction is small enough for the repetition to end
   Eigen::MatrixXd by_normal; ///< n × n
   Eigen::MatrixXd by_shear;  ///< n × c·n
};

/// @a pressure has typical normal forces, size n, positive. Among the many possible s those for
/// this pressure are chosen.
LeastPressure least_pressure(const ReducedProblem &problem, const ResidualForces &residual,
                             const Eigen::VectorXd &pressure);

/** The lower limit λ1 of a coupled contact: for load factors below it every initial slip ends
    in shakedown; between λ1 and λ2 that depends on the start (thesis 4.1).

    Two nodes (exact, with v the plane of the two slips): each of the four conditions
    f p ± q ≥ 0 is a half-plane that moves with the loads; its extreme position over the cycle
    bounds the safe region. A start can cycle for ever exactly if the two conditions of one and
    the same node meet in a corner of that region. λ1 is the smallest λ at which that is so.
    Assumes that the contact stays closed and that the rate problem is unique (f |B_ii| < A_ii).

    More nodes (proven bound). Let p_low bound the pressures of every admissible closed state
    from below (LeastPressure). If some slip v* keeps |q*| ≤ f p_low at every vertex, then for
    every evolution v(t) from any admissible closed start

       d/dt ½ (v - v*)ᵀ A (v - v*) = Σ (q - q*)·v̇ ≤ -Σ (f p - |q*|) |v̇| ≤ 0,

    p never falls to zero, and with a load factor strictly below the bound the total slip is
    finite: the contact shakes down. p_low is linear in the loads, so the bound is one more
    limit programme, of an uncoupled contact with pressures p_low.

    No better bound can be proven from pressures alone. Where an admissible state has a node
    without pressure, as the corners of a square punch on a similar half-plane above f = 0.6, no
    λ1 is proven. The proof then exempts some nodes. The inequality holds as long as these
    stick, and their slip adds a term in proportion to it. Slip that never ends therefore
    includes slip without end at one of them. At these nodes there is no condition on q*, and on
    the pressure only that the contact is closed. Where slip does go on, marches show
    (find_counter_example). */
struct LowerLimitReport
{
   LowerLimitKind kind = LowerLimitKind::none; ///< kind of the result
   LimitStatus status = LimitStatus::failed;   ///< of the programme behind it
   std::string message;                        ///< what is proven, in one sentence
   double value = 0;                           ///< λ1, or a proven lower bound of it
   /// v* of the bound, c·n; for two nodes the corner of the safe region at λ1.
   Eigen::VectorXd slip;
   Counters counters; ///< of the programme behind it
};

/// @a upper is the report of load_limit for the same problem. Slip at the nodes @a apart is not
/// excluded (see @ref LowerLimitReport). They are used for the bound of three or more coupled
/// nodes only. InputError if a node of @a apart does not exist.
LowerLimitReport lower_limit(const LimitProblem &problem, const LimitReport &upper,
                             const LimitSettings &settings = {}, const NodeList &apart = {});

/// Writes λ1 into the report of a load limit: LimitReport::every_start and starts. If @a lower
/// has no message, λ1 was not requested.
void tell_starts(LimitReport &upper, const LowerLimitReport &lower);

} // namespace cattaneo
