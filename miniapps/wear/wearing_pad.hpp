#pragma once

#include "common/study.hpp"

#include <cattaneo/friction/load_history.hpp>
#include <string>

namespace miniapp
{

using cattaneo::LoadHistory;
using cattaneo::ReducedProblem;

/// A contact that wears through a history with a cycle.
struct WearCase
{
   ReducedProblem problem;
   LoadHistory history;
   double middle = 0; ///< arc length of the point of symmetry
};

/// A pad on a half-plane of the same material.
struct WearingPad
{
   std::string profile = "parabola";
   double flat = 0.5, poisson = 0.3;
   int nodes = 201, order = 2;
};

/// P = 1 and R = 1, so that a = 1 unworn if it is a parabola; Q between ±shear f P. The line is
/// longer than contact and wear ever are.
WearCase pad_on_half_plane(Study &study, const WearingPad &pad, double shear, double friction);

} // namespace miniapp
