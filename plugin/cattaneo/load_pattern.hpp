#pragma once

#include <Eigen/Dense>
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

/// The nodal forces f^w at the contact by one load pattern, per unit multiplier, with the
/// contact nodes clamped (thesis 3.4, 3.17, 3.19).
struct LoadPattern
{
   std::string name;                 ///< name in histories and results
   Control control = Control::force; ///< what its multiplier scales
   Eigen::VectorXd q;                ///< tangential, size c·n as ReducedProblem::A
   Eigen::VectorXd p;                ///< normal, compression positive, size n
};

/// Load multipliers by the names of their patterns: {{"P", 1}, {"Q", 0.2}}.
using NamedLoads = std::map<std::string, double>;

} // namespace cattaneo
