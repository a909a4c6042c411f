#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/shakedown/load_cycle.hpp>

namespace cattaneo
{

/** A receding contact under cyclic load: the shakedown limit on the part that stays closed.

    Assumption: the nodes of `closed` are closed and all others open throughout the cycle. The
    open nodes carry no force and are condensed out of the reduced problem,

       K_cc - K_co K_oo⁻¹ K_oc,   f_c - K_co K_oo⁻¹ f_o,

    which leaves a contact of fewer nodes that is always closed. Afterwards open_gaps shows
    whether the assumption holds (and, for the closed nodes, the cone condition). */
struct ClosedContact
{
   ReducedProblem reduced;           ///< of the closed nodes
   std::vector<Eigen::Index> closed; ///< nodes of the whole problem that stay closed
   std::vector<Eigen::Index> open;   ///< all others

   /// w + g of the open nodes when the closed ones have slipped by @a slip under the loads
   /// @a multipliers: negative where the assumption fails (the bodies overlap).
   Eigen::VectorXd open_gaps(const Eigen::VectorXd &slip,
                             const Eigen::VectorXd &multipliers) const;

   Eigen::MatrixXd open_by_slip; ///< w of the open nodes by the closed nodes' slip
   Eigen::MatrixXd open_by_load; ///< w of the open nodes by the load multipliers
   Eigen::VectorXd open_gap;     ///< g of the open nodes
};

/// InputError if a node is listed twice or does not exist, if none is closed, if a closed node
/// has a gap, or if the open nodes' motion is not determined by the closed ones'.
ClosedContact closed_contact(const ReducedProblem &problem,
                             const std::vector<Eigen::Index> &closed);

/// The input of closed_contact().
struct StayedClosed
{
   std::vector<Eigen::Index> nodes; ///< closed throughout the cycles, in increasing order
   MarchReport march;               ///< `nodes` are correct only if it converged
};

/** Finds the nodes that stay closed throughout some cycles at a load factor. Marches from rest
    through the constant load and then through the vertices of the cycle in their order. Ends
    earlier if cycles are steady. Nodes that are open while the constant load is applied may
    close. InputError as
    LoadCycle::validate() and for less than one cycle. */
StayedClosed stay_closed(const ReducedProblem &problem, const LoadCycle &cycle,
                         double load_factor, int cycles, const Monitor &monitor = {});

} // namespace cattaneo
