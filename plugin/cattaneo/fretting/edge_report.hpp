#pragma once

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo::fretting
{

/// Data from which the edges of a marched contact are read.
struct MarchedStates
{
   const ReducedProblem &problem; ///< of both states
   const ContactState &pressed;   ///< after the normal load, before the cyclic loads
   const ContactState &peak;      ///< of the cyclic loads
   /// The other end of the cycle (which may be `pressed`) and the steady cycle itself, both for
   /// the energy. Null: no energy is compared.
   const ContactState *opposite = nullptr;
   const CycleRecord *cycle = nullptr;        ///< marched, steady
   CrackedBody cracked = CrackedBody::second; ///< its shear traction gives K_T its sign
   double modulus = 0; ///< E* of similar bodies; 0: of different materials, no energy
   /// Returns the eigensolutions of the corner at the first (side 1) or the last (side -1) node
   /// of the line, or throws InputError if there are none. Without it corners are not fitted.
   std::function<CornerModes(int side)> corner = {};
};

/// One edge, with what the near-edge field predicts beside what was computed.
struct SolvedEdge
{
   ContactEdge edge;                       ///< as contact_edges() has it
   double travel = 0;                      ///< between the pressed state and the peak load
   double k_t_range = 0;                   ///< ΔK_T of the cycle
   std::optional<EnergyComparison> energy; ///< none without a cycle
   std::optional<CornerFit> corner;        ///< complete edges only
   std::vector<std::string>
      notes; ///< sentences on what was left out and on what is not reliable
};

/// The edges of a contact, or the reason why there are none.
struct EdgeReport
{
   std::vector<SolvedEdge> edges; ///< in the order of the nodes
   std::string why_not;           ///< there are none: why
};

/** All edges of the contact, with intensities (contact_edges()), slip zones, energies and the
    fits of corners. Never throws because of the solution; the report names its faults instead.
    */
EdgeReport read_edges(const MarchedStates &states);

} // namespace cattaneo::fretting
