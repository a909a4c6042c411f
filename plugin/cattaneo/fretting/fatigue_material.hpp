#pragma once

#include <string>
#include <vector>

namespace cattaneo::fretting
{

/// How a cyclic strength is quoted: the whole range of the cycle or half of it.
enum class Basis
{
   range,
   amplitude
};

/// A value that is known between two bounds (equal if it is known exactly).
struct Interval
{
   double low = 0.0;  ///< lower bound
   double high = 0.0; ///< upper bound
   /// Half-way between.
   double middle() const { return 0.5 * (low + high); }
};

/** The properties of a material that the criteria need (thesis Table 2.1). Units: N, mm, MPa,
    MPa√mm. Where a strength is an interval, the criteria use its low end. */
struct FatigueMaterial
{
   std::string name;            ///< of the record
   double young = 0.0;          ///< E
   double poisson = 0.0;        ///< ν
   double threshold = 0.0;      ///< ΔK_th, MPa√mm
   Interval fatigue_limit;      ///< σ_fl
   Interval shear_yield;        ///< k, yield stress in pure shear
   Interval friction;           ///< f that tests report; 0 if unknown
   double threshold_ratio = -1; ///< load ratio R at which ΔK_th and σ_fl were measured
   Basis threshold_basis = Basis::range;     ///< how ΔK_th is quoted
   Basis fatigue_limit_basis = Basis::range; ///< how σ_fl is quoted

   /// InputError for values out of range, and if ΔK_th and σ_fl are not both ranges or both
   /// amplitudes: their ratio would be wrong by 2, a0 by 4.
   void validate() const;
};

/// a0 = (ΔK_th/σ_fl)²/π (2.21): shorter cracks obey the fatigue limit, longer ones ΔK_th. In
/// mm.
double critical_length(const FatigueMaterial &material);

/// 1 MPa√m in MPa√mm.
constexpr double mpa_sqrt_m = 31.622776601683793;

/** Reads a file of records: {"materials": [{"name", "young_GPa", "poisson",
    "threshold_MPa_sqrt_m", "fatigue_limit_MPa", "shear_yield_MPa", optional "friction",
    "stress_ratio", "threshold_basis", "fatigue_limit_basis" ("range" or "amplitude"),
    "source"}]}. Intervals are a number or [low, high].
    InputError naming the file, the record and the key for anything missing or malformed. */
std::vector<FatigueMaterial> read_materials(const std::string &file);

/// The record of that name (letter case ignored); InputError with the names there are.
const FatigueMaterial &find_material(const std::vector<FatigueMaterial> &materials,
                                     const std::string &name);

} // namespace cattaneo::fretting
