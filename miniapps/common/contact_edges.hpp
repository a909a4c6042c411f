#pragma once

#include "common/study.hpp"

#include <cattaneo/fretting/edge_report.hpp>

namespace miniapp
{

/// Prints what is known of an edge, under a name; `shift` is added to its position.
void report_edge(Study &study, const cattaneo::fretting::SolvedEdge &solved,
                 const std::string &name, double shift = 0);

/// All edges, also in the results, as `edges`; units are those of the study.
void report_edges(Study &study, const cattaneo::fretting::EdgeReport &report, double shift = 0);

nlohmann::ordered_json to_json(const cattaneo::fretting::SolvedEdge &solved);

} // namespace miniapp
