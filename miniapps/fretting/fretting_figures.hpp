#pragma once

#include "fretting/pad.hpp"

#include <string>
#include <vector>

namespace miniapp
{

/// The universal curves of the near-edge field (thesis figures 2.2 to 2.7) with the design
/// among them, and its Kitagawa-Takahashi diagram.
void draw_design(Study &study, const Pad &pad, const JudgedEdge &judged,
                 const cattaneo::fretting::FrettingSettings &criteria);

/** Measures of the tests in a file: a header line, then one test a line, '#' for comments.
    Columns cycles (required), and series, runout (0 or 1), P, Q, bulk, bulk_pad, load_ratio,
    radius, flat, friction, pad, material (the name of one of @a materials, with which a
    friction must be given), yield (in shear, MPa), threshold_ratio (R of the threshold); where
    a column is missing or a cell empty, the value of `common` holds. A table, drawn against the
    lives (thesis figures 2.5 and 2.8 to 2.10) with the limits of all materials and the
    threshold of each friction; and of each measure the level that divides broken from lasting
    tests best. InputError with the line and column of what is wrong. */
void correlate(Study &study, const std::string &file, const Pad &common,
               const cattaneo::fretting::FrettingSettings &criteria,
               const std::vector<cattaneo::fretting::FatigueMaterial> &materials);

} // namespace miniapp
