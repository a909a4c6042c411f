#pragma once

#include "fretting/pad.hpp"

namespace miniapp
{

/// The assessment of a pad, as a page with the meaning of each number.
void print_page(Study &study, const Pad &pad, const PadContact &contact,
                const JudgedEdge &judged, const cattaneo::fretting::FrettingSettings &criteria);

/// The same with the results of the finite element contact.
void print_solution(Study &study, const SolvedPad &solved);

} // namespace miniapp
