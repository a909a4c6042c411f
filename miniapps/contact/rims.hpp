#pragma once

#include "common/scene.hpp"

#include <cattaneo/reduced/interfaces.hpp>
#include <vector>

namespace miniapp
{

/// Marks the contact nodes of bodies in space at which an interface ends although the
/// boundaries of both sides go on beyond it (ReducedProblem::rim). A march warns if they bear
/// forces. `given`: the interfaces of the reduction.
void mark_rims(Scene &scene, const std::vector<cattaneo::Interface> &given);

} // namespace miniapp
