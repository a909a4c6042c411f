#pragma once

#include "fretting/pad.hpp"

namespace miniapp
{

/// The assessment of a pad, a page that says what each of its numbers means.
void print_page(Study &study, const Pad &pad, const PadContact &contact,
                const JudgedEdge &judged, const cattaneo::fretting::FrettingSettings &criteria);

/// And what the contact that was solved for it came to.
void print_solution(Study &study, const SolvedPad &solved);

} // namespace miniapp
