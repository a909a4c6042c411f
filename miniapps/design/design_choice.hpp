#pragma once

#include <cattaneo/design/design.hpp>
#include <limits>
#include <string>
#include <vector>

namespace miniapp
{

/// The quantity that a design chooses, one of three: the gap, loads, or friction in zones.
struct DesignChoice
{
   /// Shape of the gap: "free" at each node; "crown", powers of the distance from the middle of
   /// each line; "rounded", flat in the middle and a parabola on either side.
   std::string profile = "free";
   std::vector<double> powers = {2, 4}; ///< of the crown, whole numbers from 1
   /// Most that a gap changes by; coefficient of each power at the ends of the line; 1/R.
   double most = 1;
   double curvature = std::numeric_limits<double>::quiet_NaN(); ///< most of a gap; NaN: any
   bool begins_flat = true;  ///< a gap is taken off nowhere, it is only crowned
   std::string loads;        ///< patterns whose sum stays, by names with semicolons between
   std::vector<double> coat; ///< least and most friction
   int zones = 4;            ///< of friction, of equal lengths, of each line

   /// The chosen quantity: "gap", "loads" or "coat".
   std::string what() const
   {
      return !loads.empty() ? "loads" : !coat.empty() ? "coat" : "gap";
   }
};

/// The variables of a design by name, where they begin, and what is printed of them at a value.
struct DesignVariables
{
   std::vector<std::string> names;
   Eigen::VectorXd start;
   /// Added to a variable when it is printed, so that loads and friction appear as a whole.
   Eigen::VectorXd before;
};

/** Sets variables, bounds and limits of the design, whose problem and cases are known. Each
    line of contact has its own variables, measured from its middle, which for half a model lies
    on the plane or axis of symmetry. InputError naming the option. */
DesignVariables choose_variables(cattaneo::DesignProblem &design, const DesignChoice &choice);

} // namespace miniapp
