#pragma once

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/// One edge of a marched contact, with what the near-edge field predicts beside what was
/// computed.
struct SolvedEdge
{
   cattaneo::ContactEdge edge;
   double travel = 0;    ///< of the edge between the pressed state and the peak load
   double k_t_range = 0; ///< ΔK_T of the cycle
   std::optional<cattaneo::fretting::EnergyComparison> energy; ///< none without a cycle
   std::optional<cattaneo::fretting::CornerFit> corner;        ///< complete edges only
   std::vector<std::string> notes; ///< what was left out, and what not to trust
};

/// What the edges are read from.
struct EdgeStudy
{
   const cattaneo::ReducedProblem &problem;
   const cattaneo::ContactState &pressed; ///< after the normal load, before the cyclic loads
   const cattaneo::ContactState &peak;    ///< of the cyclic loads
   /// The other end of the cycle and the steady cycle itself: for the energy.
   const cattaneo::ContactState *opposite = nullptr;
   const cattaneo::CycleRecord *cycle = nullptr;
   cattaneo::CrackedBody cracked = cattaneo::CrackedBody::second;
   double modulus = 0; ///< E* of similar bodies; 0: of different materials, no energy
   /// Eigensolutions of the corner at the first (side 1) or the last (side -1) node of the
   /// line, InputError where there are none. Without it corners are not fitted.
   std::function<cattaneo::fretting::CornerModes(int side)> corner = {};
};

struct EdgeReport
{
   std::vector<SolvedEdge> edges; ///< in the order of the nodes
   std::string why_not;           ///< there are none: why
};

/// Never throws for what the solution is like: that is the report's to say.
EdgeReport read_edges(const EdgeStudy &study);

/// `coordinate` maps arc length to what is shown; units are those of the study.
void print(const EdgeReport &report, const std::function<double(double)> &coordinate);

nlohmann::ordered_json to_json(const cattaneo::FittedIntensity &fitted);
nlohmann::ordered_json to_json(const SolvedEdge &solved);
nlohmann::ordered_json to_json(const EdgeReport &report);

} // namespace miniapp
