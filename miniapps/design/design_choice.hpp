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
   /// Largest change of a gap; largest coefficient of each power at the ends of the line;
   /// largest 1/R.
   double most = 1;
   double curvature = std::numeric_limits<double>::quiet_NaN(); ///< largest gap; NaN: no limit
   bool begins_flat = true; ///< the gap becomes smaller nowhere
   std::string loads; ///< names, separated by semicolons, of patterns whose sum is constant
   std::vector<double> coat; ///< least and most friction
   int zones = 4;            ///< of friction, of equal lengths, of each line

   /// The chosen quantity: "gap", "loads" or "coat".
   std::string what() const
   {
      return !loads.empty() ? "loads" : !coat.empty() ? "coat" : "gap";
   }
};

/// The variables of a design: names, starting values, and printed values.
struct DesignVariables
{
   std::vector<std::string> names;
   Eigen::VectorXd start;
   /// Added to a variable when it is printed, so that loads and friction appear as a whole.
   Eigen::VectorXd before;
};

/** Sets variables, bounds and limits of the design. Its problem and cases must be known. Each
    line of contact has its own variables, measured from its middle, which for half a model lies
    on the plane or axis of symmetry. InputError naming the option. */
DesignVariables choose_variables(cattaneo::DesignProblem &design, const DesignChoice &choice);

} // namespace miniapp
