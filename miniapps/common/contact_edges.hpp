#pragma once

#include "common/study.hpp"

#include <cattaneo/fretting/edge_report.hpp>

namespace miniapp
{

/// Prints the data of an edge under a name, and adds them to the results; `shift` is added to
/// its position.
nlohmann::ordered_json report_edge(Study &study, const cattaneo::fretting::SolvedEdge &solved,
                                   const std::string &name, double shift = 0);

/// All edges, also in the results and as a CSV file, `edges`; units are those of the study.
void report_edges(Study &study, const cattaneo::fretting::EdgeReport &report, double shift = 0);

} // namespace miniapp
