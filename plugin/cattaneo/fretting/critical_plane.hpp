#pragma once

#include <Eigen/Core>
#include <cattaneo/fretting/fatigue_material.hpp>

namespace cattaneo::fretting
{

/* Multiaxial criteria of fatigue at a point whose stresses are known through a steady cycle:
    also where the near-edge field does not hold. They consider planes that contain the z axis,
    along which a body in plane strain or stress cracks. */

/// Stress at a point: a row for each instant of a cycle, columns σ_xx, σ_yy, σ_zz, τ_xy in MPa,
/// tension positive.
using StressCycle = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// The quantity that is largest on the critical plane. An amplitude is half of the range of the
/// cycle.
enum class PlaneCriterion
{
   findley,             ///< τ_a + k σ_n,max, MPa [Findley 1959]
   smith_watson_topper, ///< ε_n,a σ_n,max where that is tension, MPa [Smith 1970, Socie 1987]
   fatemi_socie ///< γ_a (1 + k σ_n,max/σ_y), σ_n,max where that is tension [Fatemi 1988]
};

/// The k of the two criteria that have one: 0.2 to 0.3 for ductile metals (Findley), 0.3 to 1
/// (Fatemi–Socie).
struct PlaneWeights
{
   double findley = 0.3;      ///< of Findley's criterion
   double fatemi_socie = 1.0; ///< of the criterion of Fatemi and Socie
};

/// The plane on which a criterion is largest; of equal ones the plane with the smallest angle.
struct CriticalPlane
{
   double value = 0; ///< of the criterion
   double angle = 0; ///< of the plane's normal from the x axis, in [0, π)
};

/** The plane on which the criterion is largest; strains are elastic, σ_y is √3 times the lower
    yield stress in shear. Maxima are searched in steps of half a degree and found to an angle
    of 1e-7. A narrower maximum may be missed, which changes the result by less than 1e-4 of the
    largest stress. InputError for a cycle without instants, stresses that are not finite, k <
    0. */
CriticalPlane critical_plane(PlaneCriterion criterion, const StressCycle &cycle,
                             const FatigueMaterial &material, const PlaneWeights &weights = {});

/// The cycle of uniaxial stress that a plain specimen just endures: at the lower fatigue limit,
/// and at the load ratio at which that was measured.
StressCycle plain_fatigue_cycle(const FatigueMaterial &material);

} // namespace cattaneo::fretting
