#pragma once

#include <cattaneo/fretting/assessment.hpp>
#include <limits>
#include <string>

/// Fretting problems and what their reports say.
namespace cattaneo_test
{

const double infinity = std::numeric_limits<double>::infinity();

cattaneo::fretting::FatigueMaterial aluminium();

/// An edge of round numbers: f K_N = 1.2, E* = 1000, d = 2·0.3/1.2 = 0.5, and a0 = 0.04.
cattaneo::fretting::FrettingProblem round_numbers();

/// Is this said of the validity?
bool mentions(const cattaneo::fretting::FrettingReport &report, const std::string &text);

/// What a report says of a measure, which it must have.
const cattaneo::fretting::Validity &measure(const cattaneo::fretting::FrettingReport &report,
                                            const std::string &name);

} // namespace cattaneo_test
