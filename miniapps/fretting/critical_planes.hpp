#pragma once

#include "fretting/pad.hpp"

#include <vector>

namespace miniapp
{

/** What criteria on critical planes say along the specimen's surface over the steady cycle of a
    solved pad, each as a share of what a plain specimen endures: a table `planes` and its
    figure, and the worst place of each with its ±, the largest difference to @a coarser
    solutions of the same pad, of whose cycle every second instant is taken. Stresses are those
    of a half-plane under the computed tractions, with the bulk stress, averaged over @a depth
    below the surface, mm; @a weights: k of the criteria. */
void report_critical_planes(Study &study, const Pad &pad, const SolvedPad &solved,
                            const std::vector<SolvedPad> &coarser, double depth,
                            const cattaneo::fretting::PlaneWeights &weights);

} // namespace miniapp
