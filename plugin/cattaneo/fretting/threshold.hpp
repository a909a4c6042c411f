#pragma once

#include <cattaneo/fretting/near_edge.hpp>
#include <string>

namespace cattaneo::fretting
{

/// The quantity that is compared with ΔK_th. The thesis does not say which of them Fig. 2.7
/// shows.
enum class Criterion
{
   open,  ///< A: the part of the cycle in which the crack is open (a closed one does not count)
   range, ///< B: the algebraic range of K_I, closed or not
   half_range ///< C: half of that, the tensile half of the shear part
};

/// Load states of an edge crack over one cycle.
struct CrackCycle
{
   double max = 0.0; ///< K_I at the peak of the load
   double min = 0.0; ///< K_I at its valley, negative if closed
   /// The driving force that the criterion compares with ΔK_th.
   double drive(Criterion criterion) const;
};

/** A contact edge with a crack and its load cycle. Stresses that the near-edge field omits can
    be added. It is unconservative to leave the bulk stress out. */
struct CrackedEdge
{
   Edge edge;                    ///< at peak load
   double stress_ratio = -1;     ///< valley load over peak load, -1 <= R < 1 (K_N is constant)
   double bulk_stress = 0.0;     ///< mean (σ1+σ2)/2 of the bulk stresses at peak load
   double stress_gradient = 0.0; ///< static line stress per depth, edge_gradient()

   /// InputError outside the ranges above.
   void validate() const;
};

/** K_I at both ends of the steady cycle for a crack of depth c:

       peak:   2K_T κ(c/d) - n K_N c + (σ1+σ2)/2 h(0) √(πc) + gradient c h(1) √(πc)
       valley: the peak less 2ΔK_T κ(c/d_r) and less the range of the bulk term. */
CrackCycle crack_cycle(const CrackedEdge &crack, double depth);

/// The verdict on a crack at the edge.
enum class CrackVerdict
{
   arrests,          ///< K_I falls below the short-crack threshold before a0
   propagates,       ///< above ΔK_th at a0 and rising
   arrests_beyond_a0 ///< above ΔK_th at a0 but falling: stops at arrest_depth
};
/// As it is printed, in words.
std::string to_string(CrackVerdict verdict);

/// The verdict on the crack, and its distance to the threshold.
struct ThresholdReport
{
   CrackVerdict verdict = CrackVerdict::arrests; ///< of the whole way from the surface on
   double drive = 0.0;                           ///< at a0, to be compared with ΔK_th
   double arrest_depth = 0.0; ///< where the drive falls below ΔK_th; infinite if it propagates,
                              ///< at most a0 if it arrests before
};

/** Verdict after [Kitagawa 1976] (thesis 2.5.1): a crack grows while its drive exceeds
    ΔK_th √(c/a0) for c < a0 and ΔK_th beyond. @a threshold is ΔK_th, @a critical is a0, in the
    units of the edge. InputError unless both are positive. */
ThresholdReport assess_threshold(const CrackedEdge &crack, double threshold, double critical,
                                 Criterion criterion = Criterion::open);

/** Ordinate Y = ΔK_T/ΔK_th of the threshold of Fig. 2.7 at abscissa X = ΔK_th K_N/(π σ_fl²),
    for the near-edge field alone; a0/d_r = f X/Y. With the range of K_T the curves B and C do
    not depend on R; A does for R > -1. InputError unless X, f > 0 and -1 <= R < 1. */
double threshold_ordinate(Criterion criterion, double friction, double abscissa,
                          double stress_ratio = -1);

} // namespace cattaneo::fretting
