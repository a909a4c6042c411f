#pragma once

#include "fretting/pad.hpp"

#include <functional>
#include <vector>

namespace miniapp
{

/// σ_xx on the surface of the specimen of a solved pad at peak load, MPa over x in mm: that of
/// a half-plane under the computed tractions, and the bulk stress.
std::function<double(double)> surface_stress(const Pad &pad, const SolvedPad &solved);

/** Criteria on critical planes along the specimen's surface over the steady cycle of a solved
    pad, each as a share of the endurance of a plain specimen: a table `planes`, its figure, and
    the worst place of each. The ± is the largest difference to @a coarser solutions of the same
    pad. Only every second instant of their cycle is used. Stresses are those of a half-plane
    under the computed tractions, with the bulk stress, averaged over @a depth below the
    surface, mm;
    @a weights: k of the criteria. */
void report_critical_planes(Study &study, const Pad &pad, const SolvedPad &solved,
                            const std::vector<SolvedPad> &coarser, double depth,
                            const cattaneo::fretting::PlaneWeights &weights);

} // namespace miniapp
