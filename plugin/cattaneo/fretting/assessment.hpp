#pragma once

#include <cattaneo/fretting/fatigue_material.hpp>
#include <cattaneo/fretting/threshold.hpp>
#include <vector>

namespace cattaneo::fretting
{

/** One contact edge to be judged. Units: N, mm, MPa (those of FatigueMaterial). The intensities
    may come from a closed form (calibration.hpp) or from any solution (edge_fit.hpp). */
struct FrettingProblem
{
   CrackedEdge crack;         ///< the edge, its crack and the load cycle
   FatigueMaterial material;  ///< of the cracked body
   bool plane_stress = false; ///< else plane strain

   /// Sizes against which the near-edge field is judged small; 0 where unknown.
   double half_width = 0.0;    ///< a
   double rounded_width = 0.0; ///< part of the half width on the radius: a for Hertz, a-b else
   bool bulk_known = false;    ///< crack.bulk_stress was given, and is not just the default 0
};

/// Choices that the criteria leave open.
struct FrettingSettings
{
   Criterion criterion = Criterion::open; ///< what is compared with ΔK_th
   double mode_two_ratio = 0.8;           ///< ΔK_II,th over ΔK_th (thesis 2.5.2)

   /// InputError unless the ratio is positive.
   void validate() const;
};

/// How far a number may be trusted.
enum class Trust
{
   good,
   caution,
   poor
};
/// As it is printed: its enumerator's name.
std::string to_string(Trust trust);

/// One measure of validity, in words an engineer can act on.
struct Validity
{
   std::string measure;       ///< "d/a", "a0/d", …; "" for a remark without a number
   double value = 0.0;        ///< of the measure
   Trust trust = Trust::good; ///< what it means for the report
   std::string text;          ///< a sentence that says why
};

/// Results of the criteria for the edge. Units: N, mm, MPa.
struct FrettingReport
{
   double k_t_range = 0.0;         ///< ΔK_T, MPa√mm
   double slip_zone = 0.0;         ///< d at peak load, mm
   double edge_stress = 0.0;       ///< σ_xx at the edge at peak load, MPa
   double edge_stress_range = 0.0; ///< MPa
   double yield_ratio_first = 0.0; ///< K_N√d over its value at first yield of the slip zone
   double yield_ratio_full = 0.0;  ///< … when the whole slip zone yields
   double critical_length = 0.0;   ///< a0, mm
   double k_i_max = 0.0;  ///< largest K_I of the cycle for a crack of depth a0, MPa√mm
   double k_i_min = 0.0;  ///< smallest
   double abscissa = 0.0; ///< X of Fig. 2.7
   double ordinate = 0.0; ///< Y of the design point
   double threshold_ordinate = 0.0; ///< Y of the threshold curve at X (near-edge field alone)
   ThresholdReport threshold;   ///< verdict with the bulk and gradient terms that were given
   double mode_two_range = 0.0; ///< ΔK_II, MPa√mm
   double mode_two_utilisation = 0.0; ///< over its threshold; above 1 is unsafe
   double energy_max = 0.0;           ///< per area and cycle, N/mm
   double energy_total = 0.0;         ///< per cycle and thickness, N
   Trust trust = Trust::good;         ///< the worst of validity
   std::vector<Validity> validity;    ///< all measures, those that are good as well
};

/// InputError for bad input; all other faults are in the report.
FrettingReport assess(const FrettingProblem &problem, const FrettingSettings &settings = {});

} // namespace cattaneo::fretting
