#pragma once

namespace cattaneo::fretting
{

/** Von Mises stress on the surface over K_N √d, at t/d; the constraint is that of
    out_of_plane_constraint(). Closed forms of (2.17) for the free surface, the slip zone and
    the stick zone (thesis Fig. 2.3). Beyond the slip zone the near-edge field grows as √t
    without bound, so its maximum there has no meaning. */
double surface_von_mises(double friction, double constraint, double t_over_d);

/** The yield map of thesis Fig. 2.4: K_N √d over the yield stress k in pure shear,
    - at first yield of the slip zone, √3/√(3f² + m max(1, f²)) with m = (1-2c)² (at t = d for
      f < 1, at the contact edge for f > 1),
    - when the whole slip zone has yielded: 1/f, for any constraint. */
double first_yield_load(double friction, double constraint);
/// When the whole slip zone has yielded, see above.
double full_yield_load(double friction);

} // namespace cattaneo::fretting
