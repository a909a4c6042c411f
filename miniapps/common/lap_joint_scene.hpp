#pragma once

#include "common/scene.hpp"

#include <string>
#include <vector>

namespace miniapp
{

/** The lap joint of thesis chapter 6 and rows of bolts (thesis 8.2, item 3). t is the thickness
    of the whole joint, each lap is t/2. With d the position of the outermost bolt: upper lap
    -16 t - d < x < d + protrusion, 0 < y < t/2, lower lap the same turned by 180° about the
    origin. u_y = 0 at the mid-height node of both loaded ends; nothing else is held, so that
    both laps are free bodies whose common motions (x only) do no work.

    Units t = p0 = E' = 1, E' = E/(1-ν²). Load patterns: one pinch pressure p0 on both outer
    faces for every bolt and every width, see pinch_load(), and "T", the uniform traction of
    resultant 1 on both far ends, outward. */
struct LapJointOptions
{
   std::vector<double> widths = {1.0}; ///< of the pinch pressure, in t
   std::vector<double> bolts = {0.0};  ///< centres, in t
   double protrusion = 1.95;           ///< of the free ends beyond the outermost bolt, in t
   double remote = 16;                 ///< from the outermost bolt to the loaded end, in t
   /// Thickness of the lower lap over the upper's, whose own is t/2. Equal laps are one body
   /// turned by 180°, factored once; unequal ones couple normal loads to slip.
   double lower_thickness = 1.0;
   int order = 2;
   double spacing = 0.0125; ///< of the contact nodes where the contact is expected, in t
   /// Growth of the elements away from the contact. They are at most 0.4, 1 and 0.2 (growth -
   /// 1) t long along the overlap, beyond it, and across.
   double growth = 1.25;
   /// Grid lines of the overlap from 0 to its end in place of `spacing`; its mirror image is
   /// the other half.
   std::vector<double> grid = {};
   double poisson = 0.3;

   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

/// Name of the load pattern of a bolt's (from 0) pinch pressure of the given width.
std::string pinch_load(int bolt, double width);

Scene make_lap_joint(const LapJointOptions &options);

} // namespace miniapp
