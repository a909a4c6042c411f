#pragma once

#include <cattaneo/fretting/near_edge.hpp>
#include <cattaneo/friction/loop.hpp>
#include <cattaneo/readout/contact_edges.hpp>

namespace cattaneo::fretting
{

/// An edge as input of the near-edge fields and the criteria. InputError with
/// ContactEdge::why_not if that is not empty.
Edge near_edge(const ContactEdge &edge);

/// Frictional energy of one marched cycle, computed and as the near-edge field predicts it.
struct EnergyComparison
{
   /// Per cycle and thickness: this edge's half of the contact, and what is beyond the edge at
   /// the peak load but in contact at other times of the cycle.
   double computed_total = 0.0;
   double predicted_total = 0.0; ///< slip_energy_total()
   double computed_max = 0.0;    ///< per area: largest nodal value over its weight
   double predicted_max = 0.0;   ///< slip_energy_max()
};

/** @param k_t_range ΔK_T of the cycle, (1-R) |K_T|
    @param modulus E*
    InputError as near_edge(), as ContactEdge::validate(), and if the cycle
    has not the problem's number of nodes. */
EnergyComparison compare_energy(const ReducedProblem &problem, const ContactEdge &edge,
                                const CycleRecord &cycle, double k_t_range, double modulus);

} // namespace cattaneo::fretting
