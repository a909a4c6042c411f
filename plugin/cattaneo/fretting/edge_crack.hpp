#pragma once

#include <cattaneo/fretting/near_edge.hpp>

namespace cattaneo::fretting
{

/** Stress intensity of an edge crack of depth c normal to a free surface, under the line stress
    σ0 (y/c)^λ: K_I = σ0 √(πc) h(λ), λ > -1.

    h is the exact Mellin-transform (Wiener–Hopf) solution; h(0) = 1.1215222552 is the uniform
    stress, h(1) = 0.682862877687 the linear one. Real argument; accurate to about 1e-14. */
double power_law_factor(double exponent);

/** κ(c/d): the shear part of the near-edge field gives K_I = 2 K_T κ(c/d).

    κ → 2.24304451 √(πc/d) for short cracks (uniform stress of twice f K_N √d), 1.84545280601
    for cracks much longer than the slip zone. Relative accuracy about 1e-13 for any c/d >= 0.

    Computed as an inverse Mellin integral: the transform of the line stress is a product of
    Gamma functions, that of the crack is h. */
double crack_factor(double ratio);

/// n = 1.56500339142: the pressure part of the near-edge field gives K_I = -n K_N c.
double crack_closing_factor();

/** K_I of a crack of depth c at the contact edge: 2 K_T κ(c/d) - n K_N c. Negative when the
    crack is pressed shut. InputError for c < 0. */
double crack_intensity(const Edge &edge, double depth);

/** Range of K_I when K_T changes by @a k_t_range in the steady cycle: the reversal slips with
    twice the friction over half the distance, 2 ΔK_T κ(c/d_r) with d_r = ΔK_T/(f K_N).
    @a edge.k_t is not used. */
double crack_intensity_range(const Edge &edge, double k_t_range, double depth);

} // namespace cattaneo::fretting
