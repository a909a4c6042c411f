#pragma once

#include <cattaneo/fretting/half_plane.hpp>

namespace cattaneo::fretting
{

/** Stress under a whole Hertz contact in partial slip ([Hertz 1882], [Cattaneo 1938],
    [Mindlin 1949]), in units of p0 and a:
    pressure √(1-x²), shear f√(1-x²) less f c √(1-(x/c)²) in the stick zone |x| < c = √(1-Q/fP),
    pulling the body in +x, so that x = -1 is the trailing edge. y >= 0 is the depth.
    @param load_ratio Q/(fP), from 0 (no shear) to 1 (sliding) */
InPlaneStress hertz_stress(double friction, double load_ratio, double x, double y);

/** The friction coefficient above which the largest von Mises stress of a Hertz contact lies on
    the surface and no longer below it (thesis 2.4): 0.262825847 for ν = 0.3 in plane strain and
    full sliding, more in partial slip; 0 if it is always on the surface (plane stress).
    InputError unless 0 < load_ratio <= 1. */
double hertz_transition_friction(double constraint, double load_ratio);

} // namespace cattaneo::fretting
