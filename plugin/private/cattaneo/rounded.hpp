#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace cattaneo
{

/// A measured number in a sentence: six digits, because the rest may be round-off.
inline double rounded(double value)
{
   char text[32];
   std::snprintf(text, sizeof text, "%.6g", value);
   return std::strtod(text, nullptr);
}
/// A measured place in a sentence. A coordinate that is round-off of the other one is written
/// as 0.
inline Eigen::Vector2d rounded(const Eigen::Vector2d &place)
{
   const double least = 1e-9 * place.cwiseAbs().maxCoeff();
   return place.unaryExpr([&](double x) { return std::abs(x) < least ? 0.0 : rounded(x); });
}

} // namespace cattaneo
