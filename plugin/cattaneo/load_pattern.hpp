#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <string>

namespace cattaneo
{

/// What a load pattern's multiplier scales: applied forces (thesis 3.2.3) or prescribed
/// displacements (thesis 3.2.4).
enum class Control
{
   force,
   displacement
};

/** How large a load is at multiplier 1, so that results can be told in physical units. A load
    of forces at multiplier λ is F = λ value, and its displacement is d = conjugate / value. A
    prescribed displacement is d = λ value, and its reaction is F = conjugate / value. Either
    way F dd is the work of the load. */
struct LoadSize
{
   /** In words, the first two of forces, the next two of prescribed displacements:
       - "force" and "displacement": a resultant and the mean displacement along it
       - "moment" or "torque", and "rotation": of a couple, and by an angle in radians
       - "opposite forces": they balance each other in pairs; the value is the sum of all on one
         side, and d is how far the places come apart along them
       - "bolt": its preload or pretension, and d is how far its ends come together
       - "stress", "pressure", "temperature", "strain": a load without a resultant; the value is
         that of the statement, and d is work over value
       - empty: not known; the value is 1, and F and d are per unit of the multiplier. */
   std::string kind;
   double value = 1; ///< above 0
   /// Of a force or displacement, a unit vector (x, y) or (r, z); (0, 0) of all others.
   std::array<double, 2> direction{0, 0};
   std::string place; ///< what is loaded, or empty
};

/// The nodal forces f^w at the contact by one load pattern, per unit multiplier, with the
/// contact nodes clamped (thesis 3.4, 3.17, 3.19).
struct LoadPattern
{
   std::string name;                 ///< name in histories and results
   Control control = Control::force; ///< what its multiplier scales
   Eigen::VectorXd q;                ///< tangential, size c·n as ReducedProblem::A
   Eigen::VectorXd p;                ///< normal, compression positive, size n
   LoadSize size = {};               ///< at multiplier 1, if known
};

/// Load multipliers by the names of their patterns: {{"P", 1}, {"Q", 0.2}}.
using NamedLoads = std::map<std::string, double>;

} // namespace cattaneo
