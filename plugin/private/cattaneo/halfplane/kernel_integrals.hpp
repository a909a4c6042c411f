#pragma once

#include <cattaneo/halfplane/surface_trace.hpp>

namespace cattaneo
{

/// A function G(x, s) = a + b ln|x - s| with a and b analytic for x and s that lie close to
/// each other. It gets |x - s| as an argument too, because the difference of x and s would lose
/// digits.
struct SurfaceKernel
{
   double (*value)(double distance, double x, double s);
   /// True if G has the same singularity at x = -s: for rings about an axis at x = 0, with x, s
   /// >= 0.
   bool about_axis = false;
};

/** ∫∫ φ_i(x) G(x, s) φ_j(s) ds dx, with x on one surface and s on another. If both are the same
    surface G must be symmetric, and the result is symmetric to the last bit. Each integral is
    exact to round-off, about 1e-15 of the largest of its neighbours, whatever the ratios of the
    elements' sizes.

    A panel is an element or a part of one. For two panels whose distance is at least half of
    their length, Gauss's rule is used, with a number of points that depends on the distance.
    For a panel with itself, or two neighbours of similar lengths, the variable is the distance
    of x from s, or from the common end (Duffy). The singularity is then logarithmic, and
    logarithmic_rule() integrates it. For all other pairs the longer panel is halved. */
Eigen::MatrixXd kernel_integrals(const SurfaceTrace &first, const SurfaceTrace &second,
                                 const SurfaceKernel &kernel);

/// The logarithm of the distance.
SurfaceKernel logarithm();
/** Kernels of rings of radii r and s, x s ∫₀^∞ J_k(k r) J_k(k s) dk with Bessel's functions of
   order k = 0 or 1: r s K(m) 2/(π (r + s)) and [(r² + s²) K(m) - (r + s)² E(m)]/(π (r + s)), m
   = 4 r s/(r + s)². By the arithmetic-geometric mean, without loss of digits for m close to 0
   or 1. */
SurfaceKernel ring_even();
SurfaceKernel ring_odd();

/// Integrals over one axisymmetric surface, with the kernels ring_even(), ring_odd(), and
/// ring_odd() times r s, which torsion needs. All of them follow from one arithmetic-geometric
/// mean for each pair of points.
struct RingIntegrals
{
   Eigen::MatrixXd even, odd, levered;
};
RingIntegrals ring_integrals(const SurfaceTrace &trace);

} // namespace cattaneo
