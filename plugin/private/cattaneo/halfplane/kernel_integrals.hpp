#pragma once

#include <cattaneo/halfplane/surface_trace.hpp>

namespace cattaneo
{

/// A function G(x, s) = a + b ln|x - s| with a and b analytic for x and s that lie close to
/// each other, of the sign of a distance: it is given |x - s| as well, with all its digits.
struct SurfaceKernel
{
   double (*value)(double distance, double x, double s);
   /// True if G is as singular at x = -s: of rings about an axis at x = 0, in x, s >= 0.
   bool about_axis = false;
};

/** ∫∫ φ_i(x) G(x, s) φ_j(s) ds dx, x on one surface and s on another, or on the same, where G
    must be symmetric (the result is so to the last bit). Each to round-off, about 1e-15 of the
    largest of its neighbours, whatever the ratios of the elements' sizes.

    Two panels (elements, and parts of them) that are at least half as far from each other as
    they are long: Gauss's rule of as many points as their distance asks for. The same panel, or
    two neighbours of similar lengths: in the distance of x from s, or from the common end,
    where the singularity is that of a logarithm (Duffy), by logarithmic_rule(). Of all other
    pairs the longer one is halved. */
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

/// Integrals over one surface about an axis, with the kernels ring_even(), ring_odd(), and
/// ring_odd() times r s, which torsion needs. All of them come from one mean for each pair of
/// points.
struct RingIntegrals
{
   Eigen::MatrixXd even, odd, levered;
};
RingIntegrals ring_integrals(const SurfaceTrace &trace);

} // namespace cattaneo
