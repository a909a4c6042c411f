#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace cattaneo
{

/// Index of the first place that is not in the plane z = const of the first one, to 1e-9 of the
/// extent along x and y and 1e-12 of z. The tolerances allow for round-off and for a plane far
/// from z = 0.
std::optional<std::size_t> first_off_plane(const std::vector<Eigen::Vector3d> &places);

} // namespace cattaneo
