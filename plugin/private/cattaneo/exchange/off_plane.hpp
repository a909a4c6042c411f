#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace cattaneo
{

/// The first of the places that is not in the plane z = const of the first one, to 1e-9 of
/// their extent along x and y and 1e-12 of z: round-off is no third dimension, and the plane
/// may be anywhere.
std::optional<std::size_t> first_off_plane(const std::vector<Eigen::Vector3d> &places);

} // namespace cattaneo
