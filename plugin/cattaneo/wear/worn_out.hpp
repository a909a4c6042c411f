#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/settled_states.hpp>

namespace cattaneo
{

/// The state in which a cycle wears off nothing more.
struct WornOut
{
   FrictionStatus status = FrictionStatus::stalled; ///< converged if the state was found
   std::string message;                             ///< empty if found (converged)
   Eigen::VectorXd depth;                           ///< worn off at each node, size n, ≥ 0
   /// Overlap of the unworn surfaces, size n, also beyond the contact. It crosses zero where
   /// wear ends. The depth is its positive part, except at nodes that stick, where it is 0.
   Eigen::VectorXd overlap;
   std::vector<bool> stick; ///< nodes that never slip in a cycle: they alone carry the loads
   ContactState contact;    ///< at the end of a cycle
   SlipRange range;         ///< of the unworn cycle that was found first
   ContactState unworn;     ///< at its end
   double loss = 0;         ///< energy loss of a cycle, over that of the unworn contact
   int searches = 0; ///< number of sets of sticking nodes that were tried; 0: nothing slips, so
                     ///< nothing wears
   /// Ends of the line that contact or wear reaches although the bodies go on there: depth and
   /// volume are too small then, and may be zero.
   std::vector<CutOffContact> cut_off;
};

/** The fully worn state of partial slip, without the cycles that lead there. Slipping nodes
    carry no force and sticking nodes keep their place, which is one linear problem at each
    point of the cycle. The depth is the largest overlap at any of these points.

    The nodes that stick are those of the unworn cycle. Where A = C and B = 0 (half-planes of
    one material) and pressures do not vary in the cycle they stay the same while the surfaces
    wear [Ciavarella 1999]. Otherwise the worn contact is marched. Nodes that then slip under
    pressure, or open, are left out, and the problem is solved again with the slip that is now
    locked in. This ends when a cycle takes no more than 1e-8 of the energy of the unworn one.
    This is one state in which wear ends. A march may end in another one, if it has worn nodes
    that stick here.

    Wear is that of any law without a threshold: the final state does not depend on k, as long
    as k > 0 wherever a node slips.

    `contact`: a state at the beginning of the cycle (or before the opening part) of the unworn
    problem. Status: converged; stalled if the cycle never repeats itself or the set is not
    found; stopped, which is asked before each set; gross_sliding if no node sticks, where wear
    may have no end; or the status of a march without equilibrium. InputError as wear(). */
WornOut worn_out(const ReducedProblem &problem, const LoadHistory &history,
                 const ContactState &contact, const MarchSettings &settings = {});

} // namespace cattaneo
