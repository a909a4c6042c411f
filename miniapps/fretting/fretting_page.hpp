#pragma once

#include "fretting/pad.hpp"

namespace miniapp
{

/// The assessment of a pad, which was solved (not null) or is known by closed forms: a page
/// that says what each of its numbers means.
void print_page(Study &study, const Pad &pad, const SolvedPad *solved,
                const PadContact &contact, const JudgedEdge &judged,
                const cattaneo::fretting::FrettingSettings &criteria);

/// The same with the results of the finite element contact.
void print_solution(Study &study, const SolvedPad &solved);

} // namespace miniapp
