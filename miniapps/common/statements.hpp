#pragma once

#include <cattaneo/elastic/body.hpp>
#include <cattaneo/friction/load_history.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// The small language in which supports, loads and load histories are written
/// (docs/contact2d.md has its rules). Every function throws an InputError that quotes the
/// statement.

/// Boundary attributes, perhaps with an interval: "3", "3,4", "3[-1<x<1]".
cattaneo::BoundaryPart boundary_part(const std::string &where, const std::string &text);

/// A constant or a linear function of the coordinates: "0.5", "-3*x", "1+2*x-y".
cattaneo::ScalarField linear_field(const std::string &where, const std::string &text);

/// Supports separated by spaces: "1:x 2,4:xy" fixes components on boundary attributes,
/// "@0,-1:x" at the node nearest to a point.
void add_supports(cattaneo::ElasticBody &body, const std::string &option,
                  const std::string &text);

/// Loads separated by semicolons, each "PATTERN KIND WHERE VALUES": "P pressure 3 100",
/// "Q traction 3 0.5 0", "G body-force 0 -9.81", "D displacement-x 3[0<y<1] 0.01".
void add_loads(cattaneo::ElasticBody &body, const std::string &option, const std::string &text);

/// Points separated by semicolons, at times 0, 1, 2, …: "P=0; P=1; Q=0.1; Q=-0.1". A pattern
/// that is not named keeps its value; all are 0 at the first point. Without text: all from 0
/// to 1.
cattaneo::LoadHistory load_history(const std::string &option, const std::string &text,
                                   const cattaneo::ReducedProblem &problem);

} // namespace miniapp
