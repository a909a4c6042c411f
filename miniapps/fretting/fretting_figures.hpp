#pragma once

#include "fretting/pad.hpp"

#include <string>
#include <vector>

namespace miniapp
{

/// Are the tractions of a pad known in closed form?
bool has_closed_tractions(const Pad &pad);

/// Tractions and stress on the specimen at peak load in MPa, of a solved pad (not null) or by
/// closed forms, where there are any.
void draw_tractions(Study &study, const Pad &pad, const SolvedPad *solved);

/// The universal curves of the near-edge field (thesis figures 2.2 to 2.7) with the design
/// among them, and its Kitagawa-Takahashi diagram.
void draw_design(Study &study, const Pad &pad, const JudgedEdge &judged,
                 const cattaneo::fretting::FrettingSettings &criteria);

/** Measures of the tests in a file: a header line, then one test a line, '#' for comments.
    Columns cycles (required), and series, runout (0 or 1), P, Q, bulk, bulk_pad, load_ratio,
    radius, flat, friction, pad, material (the name of one of @a materials, with which a
    friction must be given), yield (in shear, MPa), threshold_ratio (R of the threshold); if a
    column is missing or a cell is empty, the value of `common` holds. The result is a table,
    drawn against the lives (thesis figures 2.5 and 2.8 to 2.10) with the limits of all
    materials and the threshold of each friction. For each measure it has the level that divides
    broken from lasting tests best. InputError with the line and column of the fault. */
void correlate(Study &study, const std::string &file, const Pad &common,
               const cattaneo::fretting::FrettingSettings &criteria,
               const std::vector<cattaneo::fretting::FatigueMaterial> &materials);

} // namespace miniapp
