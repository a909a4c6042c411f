#pragma once

#include <limits>

namespace cattaneo
{

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace cattaneo
