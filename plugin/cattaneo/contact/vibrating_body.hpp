#pragma once

#include <cattaneo/elastic/body.hpp>
#include <cattaneo/joints/vibration.hpp>
#include <vector>

namespace cattaneo
{

/// A body of MFEM with its mass, as condense() takes it; see mass_matrix(). InputError as
/// there.
VibratingBody vibrating_body(const ElasticBody &body, const std::vector<double> &density);

} // namespace cattaneo
