#pragma once

#include "common/scene.hpp"

#include <vector>

namespace miniapp
{

/** Two equal bodies of revolution in place of half-spaces, with a gap r²/(2 R) between them, E
    = 1. Load patterns, motions of the far boundary of the upper one: "approach" (down) and
    "twist" (about the axis). */
struct TwistedBodies
{
   std::vector<double> contact; ///< radii of the grid lines in the contact, from 0 to 1
   int order = 2;
   double growth = 1.25; ///< of the elements away from the contact
   double far = 1e4;     ///< radius and height of each body
   double sphere = 5;    ///< R
   double poisson = 0.3;
};

Scene make_scene(const TwistedBodies &options);

} // namespace miniapp
